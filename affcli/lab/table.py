"""Rows of affordance tables with the part of the tool that the attractor was nearest to (§6.1)."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any, TypeVar

from affcli.analysis.regions import region_at, region_of
from affcli.core.geometry import Point
from affcli.core.records import LearningRunInfo, StoredRow, StoredStep
from affcli.core.row_filter import Column, Relation, RowFilter
from affcli.core.specs import LIVES, LearningSpec, TrialSpec
from affcli.store import Store
from affcli.store.reading import behavior_call, reading_what_was_written

Made = TypeVar("Made")
Write = Callable[[Sequence[Column], Iterable[tuple[Any, ...]]], Made]
"""Makes something of columns and their values."""

REGION = Column("region", str)
"""The column that is not in the database."""


def every_run(store: Store) -> tuple[LearningRunInfo, ...]:
    """Return all learning runs, also those of reproductions and unfinished ones."""
    robots = (store.learning.runs(session_id=s.id) for s in store.sessions.all(*LIVES))
    # Conditions of an experiment share runs.
    return (*store.learning.runs(), *{run.id: run for runs in robots for run in runs}.values())


def history_of(store: Store, row_id: int) -> list[tuple[StoredStep, TrialSpec]]:
    """Return every step that tried a row, by trial and number, each with its trial."""
    steps = store.trials.steps_of_row(row_id)
    trials = {
        number: store.trials.trial(number).spec for number in {step.trial_id for step in steps}
    }
    return [(step, trials[step.trial_id]) for step in steps]


def listed_rows(
    store: Store, runs: Sequence[LearningRunInfo], wanted: RowFilter, region: str | None
) -> list[tuple[StoredRow, str]]:
    """Return the rows that filter and region leave, each with its region, oldest first.

    Args:
        store: open.
        runs: the learning runs whose rows they are.
        wanted: which rows.
        region: only those in which the attractor was nearest to this part of the tool.
    """
    specs = {run.id: run.spec for run in runs}
    found = store.selections.rows(_unless_by_region(wanted, region))
    named = (
        (row, region_of(specs[row.run_id].held, row.row))
        for row in found
        if row.run_id in specs  # and not of a run that was begun since
    )
    return list(islice((one for one in named if region in (None, one[1])), wanted.limit))


def taken_out(
    store: Store,
    what: Relation,
    runs: Sequence[LearningRunInfo],
    wanted: RowFilter,
    region: str | None,
    write: Write[Made],
) -> tuple[Made, int]:
    """Return what `write` makes of all columns of the rows or records, and how many they are.

    Rows get one column more, their region.

    Args:
        store: open.
        what: rows, or the behaviors, trials or steps of the learning runs.
        runs: the learning runs.
        wanted: which of them.
        region: only rows in which the attractor was nearest to this part of the tool.
        write: is given them one after the other.
    """
    count = 0

    def counted(rows: Iterable[tuple[Any, ...]]) -> Iterator[tuple[Any, ...]]:
        nonlocal count
        for row in rows:
            count += 1
            yield row

    def write_counted(columns: Sequence[Column], rows: Iterable[tuple[Any, ...]]) -> Made:
        return write(columns, counted(rows))

    if what != "rows":
        made = store.selections.extract(what, wanted, write_counted)
        return made, count
    specs = {run.id: run.spec for run in runs}

    def write_rows(columns: Sequence[Column], rows: Iterable[tuple[Any, ...]]) -> Made:
        chosen = _with_region(columns, rows, specs, region)
        return write_counted([*columns, REGION], islice(chosen, wanted.limit))

    made = store.selections.extract(what, _unless_by_region(wanted, region), write_rows)
    return made, count


def _with_region(
    columns: Sequence[Column],
    rows: Iterable[tuple[Any, ...]],
    specs: Mapping[int, LearningSpec],
    region: str | None,
) -> Iterator[tuple[Any, ...]]:
    """Yield the rows with their region; only those in `region` unless it is None."""
    names = [column.name for column in columns]
    run, x, y, angle = map(
        names.index, ("run", "start_wrist_to_object_x", "start_wrist_to_object_y", "wrist_angle")
    )
    name, params = map(names.index, ("binding_behavior", "binding_params"))
    for row in rows:
        spec = specs.get(row[run])
        if spec is not None:  # and not of a run that was begun since
            binding = spec.binding
            if spec.other_bindings:
                with reading_what_was_written(f"a row of run {row[run]}"):
                    binding = behavior_call(row[name], row[params])
            part = region_at(spec.held, binding, row[angle], Point(row[x], row[y]))
            if region in (None, part):
                yield (*row, part)


def _unless_by_region(wanted: RowFilter, region: str | None) -> RowFilter:
    """Return the filter without its limit when rows are left out by region afterwards."""
    return wanted if region is None else replace(wanted, limit=None)
