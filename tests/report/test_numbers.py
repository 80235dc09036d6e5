"""What the reports say as JSON, against hand-made records whose numbers are known."""

import json
from dataclasses import replace

import pytest

from affcli.analysis.breaking import Tally, dead_rows
from affcli.analysis.overview import breaking_of
from affcli.analysis.paper import BROKEN as IN_PAPER
from affcli.analysis.paper import EXTENSION_OF_REACH, GOALS, TOOLS, TOTAL
from affcli.analysis.reproduction import failures_in
from affcli.core.geometry import Point
from affcli.core.specs import Protocol
from affcli.core.trial import Outcome
from affcli.report.breaking import broken_json, broken_tables
from affcli.report.learning import groups_json, run_json, summary
from affcli.report.overview import overview_json, overview_tables
from affcli.report.reproduction import reproduction_json
from affcli.report.words import clock, settings_words, whole_degrees
from tests.report.drawn import drawn
from tests.report.hand_made import (
    BROKEN,
    FOUR_ROBOTS,
    GROUPS,
    OVERVIEW,
    RUNS,
    WHOLE,
    learned_run,
    row,
    session_of,
    step,
    trial_info,
)


def test_the_papers_table() -> None:
    """§7.1: 69 of 80; its row and column sums."""
    assert TOTAL == 69
    by_tool = [[EXTENSION_OF_REACH[tool, goal] for goal in GOALS] for tool in TOOLS]
    assert [sum(counts) for counts in by_tool] == [10, 14, 15, 14, 16]
    assert [sum(counts) for counts in zip(*by_tool, strict=True)] == [15, 14, 20, 20]
    assert len(EXTENSION_OF_REACH) * 4 == 80
    assert IN_PAPER == 16


def test_tally() -> None:
    assert Tally.of(BROKEN) == Tally(
        trials=3,
        solved=2,
        steps=4,
        tries=6,
        replicated=3,
        tries_on_lost=3,
        trials_with_lost=2,
        excluded=3,
    )
    assert Tally.of(BROKEN).mean_steps == 2.0
    assert Tally.of(BROKEN[2:]).mean_steps is None
    assert Tally.of(()) == Tally(0, 0, 0, 0, 0, 0, 0, 0)


def test_trials_whose_simulation_failed_count_for_nothing() -> None:
    failed = replace(BROKEN[1], end=replace(BROKEN[1].end, outcome=Outcome.INVALID))
    counted = [BROKEN[0], BROKEN[2]]
    assert Tally.of([*counted, failed]) == Tally.of(counted)
    assert dead_rows([*counted, failed], 3.5) == dead_rows(counted, 3.5)
    value = broken_json(RUNS[0], [failed, *counted, *WHOLE])
    assert value["broken"]["trials"] == 2
    assert drawn(broken_tables(RUNS[0], [failed]), 80)
    ends = {Outcome.STEP_LIMIT: 2, Outcome.NO_ROW: 3, Outcome.INVALID: 4, Outcome.SOLVED: 5}
    ends[Outcome.NO_PLAN] = 1
    kinds = {"no row left": 3, "step limit": 2, "no plan found": 1}
    assert failures_in(ends) == (kinds, 11, 4)
    assert failures_in({Outcome.INVALID: 4}) == ({}, 0, 4)
    outcomes = (Outcome.SOLVED, Outcome.INVALID, Outcome.NO_ROW)
    shape, protocol = "l-hook", Protocol.TOOL_ADAPTATION
    ended = [
        trial_info(
            n, RUNS[0], "t-hook", "1", str(n), shape=shape, protocol=protocol, outcome=outcome
        )
        for n, outcome in enumerate(outcomes, 1)
    ]
    losses = dict.fromkeys(Protocol, (0, 0))
    session = session_of(1, kind="break-tool")
    found = breaking_of(session, ended, losses)
    assert found is not None
    assert (found.broken.solved, found.broken.trials) == (1, 2)
    assert breaking_of(session, ended[1:2], losses) is None


def test_a_row_that_fails_and_stays_probable_is_not_excluded() -> None:
    """§6.2: rows of a probability of at most 1/2 are."""
    failed = replace(BROKEN[2], steps=(step(1, row(9, used=4, successful=4), seen=(0.0, 0.0)),))
    tally = Tally.of([failed])
    assert (tally.tries, tally.replicated, tally.excluded) == (1, 0, 0)
    assert dead_rows([failed], 3.5) == []


def test_dead_rows_and_their_side() -> None:
    """Row 9 stood to the right of the wrist, row 11 to the left; the tool lost its right side."""
    dead = {row.row.step: row for row in dead_rows(BROKEN, 3.5)}
    assert list(dead) == [9, 11]
    assert (dead[9].on_missing_side, dead[9].lost, dead[9].trials) == (True, True, 2)
    assert (dead[11].on_missing_side, dead[11].lost, dead[11].trials) == (False, False, 1)
    assert [row.on_missing_side for row in dead_rows(BROKEN, -3.5)] == [False, True]
    assert [row.on_missing_side for row in dead_rows(BROKEN, 0.0)] == [False, False]


def test_broken_json() -> None:
    value = broken_json(RUNS[0], [*WHOLE, *BROKEN])
    assert value["broken"]["solved"] == 2
    assert value["whole"]["trials"] == 3
    assert value["whole"]["mean_steps"] == 1.0
    assert value["excluded_rows"][0] == {
        "step": 9,
        "behavior": "slide arm left 5",
        "on_missing_side": True,
        "lost": True,
        "trials": 2,
    }
    json.dumps(value, allow_nan=False)


def test_reproduction_json() -> None:
    value = reproduction_json(FOUR_ROBOTS)
    assert (value["robots"], len(value["cells"])) == (4, 20)
    first, second, *_ = value["cells"]
    assert (first["tool"], first["goal"], first["paper"]) == ("stick", "1", 0)
    assert (first["mean"], first["low"], first["high"]) == (1.0, 0, 2)
    assert (first["p_paper"], first["inside"]) == (0.25, None)
    assert (second["paper"], second["p_paper"], second["inside"]) == (2, 0.25, None)
    other = value["cells"][4:]
    assert all(cell["p_paper"] == 1.0 for cell in other)
    assert all(cell["mean"] == cell["low"] == cell["high"] == cell["paper"] for cell in other)
    assert FOUR_ROBOTS.totals == [59, 63, 63, 67]
    total = value["total"]
    assert (total["paper"], total["mean"], total["inside"]) == (69, 63.0, None)
    assert value["broken"]["mean"] == 15.0
    assert value["failures"] == FOUR_ROBOTS.failures
    json.dumps(value, allow_nan=False)


def test_overview_json_is_json() -> None:
    value = json.loads(json.dumps(overview_json(OVERVIEW), allow_nan=False))
    assert [run["status"] for run in value["learned"]] == ["done", "running"]
    assert value["solved"][0] == {
        "run": 1,
        "tool": "t-hook",
        "sensor": "noisy",
        "planner": "nested-query",
        "task_set": "extension-of-reach",
        "goal": "1",
        "solved": 3,
        "tried": 4,
        "paper": 4,
    }
    assert value["broken"][1]["broken"]["mean_steps"] is None
    assert [again["robots"] for again in value["reproductions"]] == [4]


def test_groups_and_runs_json() -> None:
    none, some, *_ = groups_json(GROUPS)
    assert none["behavior"] == "contract arm"
    assert none["params"] == {"offset_distance": 2}
    assert none["mean_movement"] is None
    assert (some["tried"], some["rows"], some["mean_dy"]) == (99, 12, -3.4)
    assert run_json(RUNS[1])["seed"] == 2**63 - 1


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.0, "0 min 00 s"),
        (59.6, "1 min 00 s"),
        (3599.4, "59 min 59 s"),
        (3599.6, "1 h 00 min"),
        (3661.0, "1 h 01 min"),
        (36_000_000.0, "10000 h 00 min"),
    ],
)
def test_robot_time(seconds: float, words: str) -> None:
    assert clock(seconds) == words


def test_one_is_not_many() -> None:
    one = learned_run(1, RUNS[0].spec, behaviors=1, rows=1, resets=1, robot_seconds=5.2)
    assert summary(one) == "0 min 05 s, 1 behavior, 1 row, 1 reset"
    none = learned_run(1, RUNS[0].spec, behaviors=2, rows=0, resets=2, robot_seconds=5.2)
    assert summary(none) == "0 min 05 s, 2 behaviors, 0 rows, 2 resets"


@pytest.mark.parametrize(
    ("direction", "degrees"), [(359.7, 0), (-0.2, 0), (-90.0, 270), (180.4, 180), (0.6, 1)]
)
def test_directions_are_0_to_359(direction: float, degrees: int) -> None:
    assert whole_degrees(direction) == degrees


def test_the_hand_made_rows_are_what_they_say() -> None:
    row = BROKEN[0].steps[0].record.row
    assert row.start.wrist_to_object == Point(-5.0, 8.0)
    assert (row.expected_movement.dx, row.expected_movement.dy) == (-4.0, 0.0)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ("{}", "defaults"),
        ('{"a":0.123456789,"b":0.45,"c":1e-07}', "a = 0.123456789, b = 0.45, c = 1e-07"),
        ('{"a":12345678,"b":3.0,"c":"camera"}', "a = 12345678, b = 3, c = camera"),
        ('{"a":[1,null],"b":null,"c":true,"d":{"e":0.5}}',
         'a = [1, null], b = null, c = true, d = {"e": 0.5}'),
        ('{"a":[1e999],"b":1e999,"c":1' + 400 * "0" + "}",
         "a = [Infinity], b = inf, c = 1" + 400 * "0"),
    ],
)  # fmt: skip
def test_settings_are_exact_whatever_a_database_holds(settings: str, words: str) -> None:
    assert settings_words(settings) == words
    run = learned_run(1, replace(RUNS[0].spec, settings=settings))
    kept = replace(OVERVIEW, learned=[(run, ())])
    assert overview_json(kept)["learned"][0]["settings"] == words
    assert overview_tables(kept)
    again = replace(FOUR_ROBOTS, session=session_of(5, settings=settings))
    assert reproduction_json(again)["settings"] == words
