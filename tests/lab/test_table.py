"""Regions of rows: the part of the tool, as it was learned, nearest to the attractor."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, get_args

import pytest
from shapely import Point as ShapelyPoint
from shapely import Polygon

from affcli.analysis.regions import UNKNOWN, region_of
from affcli.config import Settings, settings_with
from affcli.core.records import LearningRunInfo, StoredRow
from affcli.core.row_filter import Column, Relation, RowFilter
from affcli.core.specs import Keep
from affcli.core.tool import unknown_tool
from affcli.errors import UsageError
from affcli.lab.run_parts import RunParts
from affcli.lab.table import every_run, history_of, listed_rows, taken_out
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import Store
from tests.lab.quick import NOW, altered, learned, spec_of
from tests.store.records import VERSIONS, begun, robot_record, trial_record, trial_spec

NARROW = settings_with({"tools": {"bar_reach": 3.0}}, "a test")
"""The hooks are nearer to the handle than by default."""
Taken = tuple[list[Column], list[tuple[Any, ...]]]


@pytest.fixture
def runs(store: Store) -> list[LearningRunInfo]:
    """The same babbling twice, once believed to be done with a tool of other sizes; and a stick."""
    found = []
    for spec in (spec_of(), spec_of("stick")):
        for settings in (Settings(), NARROW):
            own = RunParts.chosen(settings).spec(spec.tool, 0, 0, None, 400)
            run = store.learning.begin(own, VERSIONS, NOW)
            store.learning.append(run.id, 0, learned(spec), None, 1.0, done=True, now=NOW)
            found.append(store.learning.run(run.id))
    return found


def nearest_part(run: LearningRunInfo, row: StoredRow) -> str:
    """Return the nearest part as another library finds it."""
    place = ShapelyPoint(*row.row.start.wrist_to_object)
    away = {
        part.name: Polygon(part.outline.vertices).distance(place) for part in run.spec.held.parts
    }
    return min(away, key=lambda name: round(away[name], 9))


def keep(columns: Sequence[Column], rows: Iterable[tuple[Any, ...]]) -> Taken:
    """Return what is taken out as it is."""
    return list(columns), list(rows)


def test_the_region_is_that_of_the_tool_as_the_run_made_it(
    store: Store, runs: list[LearningRunInfo]
) -> None:
    regions = {}
    for run in runs:
        rows = listed_rows(store, [run], RowFilter(runs=(run.id,)), None)
        assert len(rows) > 20
        assert [row for row, _ in rows] == list(store.learning.rows(run.id))
        assert [region for _, region in rows] == [nearest_part(run, row) for row, _ in rows]
        assert [region for _, region in rows] == [
            region_of(run.spec.held, row.row) for row, _ in rows
        ]
        regions[run.id] = [region for _, region in rows]
        assert set(regions[run.id]) <= set(TOOL_PARTS[run.spec.held.name])
    first, narrow, *sticks = regions.values()
    assert first != narrow
    assert {region for of_stick in sticks for region in of_stick} == {"handle"}


@pytest.mark.parametrize("region", ["left hook", "handle", "right bar"])
@pytest.mark.parametrize("limit", [None, 1, 3])
def test_what_is_taken_out_is_what_is_listed(
    region: str, limit: int | None, store: Store, runs: list[LearningRunInfo]
) -> None:
    """The limit counts rows of the region, not rows that were looked at."""
    every = RowFilter(tool="t-hook")
    rows = [one for one in listed_rows(store, runs, every, None) if one[1] == region][:limit]
    assert rows
    wanted = replace(every, limit=limit)
    assert listed_rows(store, runs, wanted, region) == rows
    (columns, taken), count = taken_out(store, "rows", runs, wanted, region, keep)
    assert (columns[0], columns[-1]) == (("id", int), ("region", str))
    assert [(row[0], row[-1]) for row in taken] == [(row.id, region) for row, _ in rows]
    assert count == len(rows)


def test_other_records_are_taken_out_without_a_region(
    store: Store, runs: list[LearningRunInfo]
) -> None:
    wanted = RowFilter(runs=(runs[0].id,))
    (columns, taken), count = taken_out(store, "behaviors", runs[:1], wanted, None, keep)
    assert (len(taken), count) == (400, 400)
    assert "region" not in dict(columns)


def test_rows_of_a_run_begun_since_are_left_out(store: Store, runs: list[LearningRunInfo]) -> None:
    """All rows are asked for, but of the run nothing else is known."""
    known = runs[1:]
    listed = listed_rows(store, known, RowFilter(), None)
    assert {row.run_id for row, _ in listed} == {run.id for run in known}
    (_, taken), count = taken_out(store, "rows", known, RowFilter(), None, keep)
    assert [row[0] for row in taken] == [row.id for row, _ in listed]
    assert count == len(listed)


def test_every_run_is_there_also_unfinished_and_of_robots(
    store: Store, runs: list[LearningRunInfo]
) -> None:
    unfinished = store.learning.begin(spec_of("l-hook"), VERSIONS, NOW)
    session = begun(store, "reproduce")
    store.sessions.save_robot({session: VERSIONS}, robot_record(0), NOW)
    found = every_run(store)
    assert [run.id for run in found] == [*(run.id for run in runs), unfinished.id, 6, 7]
    assert [run.session_id for run in found] == [None] * 5 + [session] * 2
    assert found[4].status == "running"


def test_the_history_of_a_row_names_the_trial_of_each_step(
    store: Store, runs: list[LearningRunInfo]
) -> None:
    run = runs[0]
    table, ids = store.learning.table(run.id)
    specs = [
        trial_spec(1, start, shape=shape) for start in (1, 2) for shape in ("t-hook", "l-hook")
    ]
    session = begun(store, "break-tool")
    row, other = table.row(3), table.row(4)
    trials = [trial_record(spec, [row, other, row]) for spec in specs]
    store.trials.save_all(session, run.id, trials, ids)
    history = history_of(store, ids[row.step])
    assert [spec for _, spec in history] == [spec for spec in specs for _ in range(2)]
    assert [step.number for step, _ in history] == [1, 3] * 4
    assert {step.affordance_id for step, _ in history} == {ids[row.step]}
    assert history_of(store, ids[table.row(5).step]) == []


def test_a_tool_that_nobody_knows_has_no_regions(store: Store, runs: list[LearningRunInfo]) -> None:
    unknown = replace(runs[0], spec=replace(runs[0].spec, held=unknown_tool("=cmd")))
    rows = listed_rows(store, [unknown], RowFilter(runs=(1,)), None)
    assert {region for _, region in rows} == {UNKNOWN}
    assert listed_rows(store, [unknown], RowFilter(runs=(1,)), "handle") == []


@pytest.mark.parametrize("kept", list(Keep))
@pytest.mark.parametrize("what", get_args(Relation))
def test_what_was_not_kept_is_not_taken_out_as_if_it_were_all(
    store: Store, runs: list[LearningRunInfo], what: Relation, kept: Keep
) -> None:
    run, other = runs[0], runs[-1]
    altered(store.path, f"UPDATE learning_run SET kept = '{kept}' WHERE id = {run.id}")
    enough: dict[Relation, set[Keep]] = {
        "rows": {Keep.ALL, Keep.ROWS},
        "behaviors": {Keep.ALL},
        "steps": {Keep.ALL, Keep.ROWS},
        "trials": set(Keep),
    }
    for one in (run, other):
        wanted = RowFilter(runs=(one.id,))
        take = partial(taken_out, store, what, [one], wanted, None, keep)
        if one is run and kept not in enough[what]:
            words = rf"run 1: its {what} were not kept \(--keep {kept}\); .* makes them again"
            with pytest.raises(UsageError, match=words):
                take()
        else:
            take()
