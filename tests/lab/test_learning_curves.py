"""Curves of learning runs end where the store says that the runs came to."""

import pytest

from affcli.config import settings_with
from affcli.errors import UsageError
from affcli.lab.learning_curves import by_kind, curves_of, curves_of_robots
from affcli.report.captions import curves_words, robots_words
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import Store
from tests.lab.quick import LEISURELY, counted, now, reproducing, spec_of, stored, taken
from tests.store.records import begun


def test_a_curve_ends_with_the_rows_and_the_time_of_its_run(store: Store) -> None:
    for tool, behaviors in (("t-hook", 120), ("stick", 40)):
        stored(store, spec_of(tool, behaviors))
    runs = store.learning.runs()
    curves = curves_of(store, runs)
    assert curves_words(curves).caption == "2 learning runs; default settings"
    for curve, run in zip(curves, runs, strict=True):
        assert curve.rows[-1] == run.rows
        assert curve.share[-1] == pytest.approx(run.rows / run.behaviors)
        assert curve.minutes[-1] == pytest.approx(run.robot_seconds / 60.0)


def test_runs_that_differ_by_their_seed_alone_are_one_kind(store: Store) -> None:
    """What is called by its tool, or by what is not default where another kind has the tool."""
    quiet = settings_with({"sensor": {"position_noise": 0.5}}, "a test")
    for seed in (1, 2):
        stored(store, spec_of("t-hook", 40, seed=seed))
    stored(store, spec_of("t-hook", 40, settings=quiet))
    stored(store, spec_of("stick", 40))
    kinds = by_kind(curves_of(store, store.learning.runs()))
    assert [(kind.tool, kind.robots) for kind in kinds] == [
        ("t-hook, defaults", 2),
        ("t-hook, sensor.position_noise = 0.5", 1),
        ("stick", 1),
    ]


def test_a_run_that_has_not_begun_has_no_curve(store: Store) -> None:
    store.learning.begin(spec_of(), {}, now())
    with pytest.raises(UsageError, match="run 1 has not begun"):
        curves_of(store, store.learning.runs())


def test_robots_of_a_reproduction_are_summed_up_by_tool(store: Store) -> None:
    """LEISURELY robots, whose hour holds few behaviors."""
    taken(reproducing(store, LEISURELY, 2, 7), 3)
    words = robots_words(curves_of_robots(store, 1)[0], 1).caption
    assert words.startswith("session 1 (reproduce, unfinished), 1 robot, seed 7; not default: ")
    counted(reproducing(store, LEISURELY, 2, 7))
    session, tools = curves_of_robots(store, 1)
    assert robots_words(session, 2).caption.startswith("session 1 (reproduce), 2 robots, seed 7; ")
    assert [tool.tool for tool in tools] == list(TOOL_PARTS)
    for tool in tools:
        runs = [run for run in store.learning.runs(session_id=1) if run.spec.tool == tool.tool]
        assert tool.robots == len(runs) == 2
        assert 0.0 <= tool.rows.mean[-1] <= max(run.rows for run in runs)
        assert tool.rows.low[-1] <= tool.rows.mean[-1] <= tool.rows.high[-1]
        assert tool.minutes[-1] <= min(run.robot_seconds for run in runs) / 60.0
    assert [tool.tool for tool in curves_of_robots(store, 1, ["stick"])[1]] == ["stick"]


def test_a_session_that_is_no_reproduction_has_no_robots(store: Store) -> None:
    with pytest.raises(UsageError, match="--session 1: no such reproduction; there is none yet"):
        curves_of_robots(store, 1)
    begun(store, "reproduce", robots=4)
    with pytest.raises(UsageError, match="--session 2: no such reproduction; there is 1"):
        curves_of_robots(store, 2)
    with pytest.raises(UsageError, match="--session 1: no robot saved yet"):
        curves_of_robots(store, 1)
