"""Curves of learning runs end where the store says that the runs came to."""

import sqlite3
from contextlib import closing

import pytest

from affcli.core.tool import TOOL_PARTS
from affcli.errors import DatabaseError, UsageError
from affcli.lab.learning import learn
from affcli.lab.learning_curves import curves_of, curves_of_robots
from affcli.lab.reproduction import reproduce
from affcli.store import Store
from tests.lab.quick import LEISURELY, counted, now, spec_of, taken


def test_a_curve_ends_with_the_rows_and_the_time_of_its_run(store: Store) -> None:
    for tool, behaviors in (("t-hook", 120), ("stick", 40)):
        learn(store, spec_of(tool, behaviors), now)
    runs = store.learning_runs()
    title, curves = curves_of(store, runs)
    assert title == "learning of T-hook (run 1), Stick (run 2)"
    for curve, run in zip(curves, runs, strict=True):
        assert curve.rows[-1] == run.rows
        assert curve.share[-1] == pytest.approx(run.rows / run.behaviors)
        assert curve.minutes[-1] == pytest.approx(run.robot_seconds / 60.0)


def test_a_run_that_has_not_begun_has_no_curve(store: Store) -> None:
    store.begin_learning(spec_of(), {}, now())
    with pytest.raises(UsageError, match="run 1 has not begun"):
        curves_of(store, store.learning_runs())


def test_robots_of_a_reproduction_are_summed_up_by_tool(store: Store) -> None:
    """LEISURELY robots, whose hour holds few behaviors."""
    taken(reproduce(store, LEISURELY, 2, 7, 1, now), 2)
    assert curves_of_robots(store, 1)[0].endswith("(session 1, unfinished)")
    counted(reproduce(store, LEISURELY, 2, 7, 1, now))
    title, tools = curves_of_robots(store, 1)
    assert title == "learning of 2 robots (session 1)"
    assert [tool.tool for tool in tools] == list(TOOL_PARTS)
    for tool in tools:
        runs = [run for run in store.learning_runs(session_id=1) if run.spec.tool == tool.tool]
        assert tool.robots == len(runs) == 2
        assert 0.0 <= tool.rows.mean[-1] <= max(run.rows for run in runs)
        assert tool.rows.low[-1] <= tool.rows.mean[-1] <= tool.rows.high[-1]
        assert tool.minutes[-1] <= min(run.robot_seconds for run in runs) / 60.0
    assert [tool.tool for tool in curves_of_robots(store, 1, ["stick"])[1]] == ["stick"]


def test_a_session_that_is_no_reproduction_has_no_robots(store: Store) -> None:
    with pytest.raises(UsageError, match="--session 1: no such reproduction; there is none yet"):
        curves_of_robots(store, 1)
    store.begin_session("reproduce", 0, 4, "{}", {}, now())
    with pytest.raises(UsageError, match="--session 2: no such reproduction; there is 1"):
        curves_of_robots(store, 2)
    with pytest.raises(UsageError, match="--session 1: no robot saved yet"):
        curves_of_robots(store, 1)


@pytest.mark.parametrize("value", ["-3.5", "9e999"])
def test_a_clock_that_affcli_did_not_write_is_named(value: str, store: Store) -> None:
    learn(store, spec_of("stick", 20), now)
    with closing(sqlite3.connect(store.path)) as driver, driver:
        driver.execute(f"UPDATE learning_run SET robot_seconds = {value}")
    with pytest.raises(DatabaseError, match="learning run 1 holds a value that affcli did not"):
        curves_of(store, store.learning_runs())
