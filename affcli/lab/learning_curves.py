"""How learning went over robot time, gathered for figures."""

from collections import defaultdict
from collections.abc import Iterable, Sequence

from affcli.core.tool import TOOL_PARTS
from affcli.errors import DatabaseError, UsageError
from affcli.report.curves import INTERVALS, Curve, Interval, ToolCurves
from affcli.report.figures.words import tool_words
from affcli.store import LearningInterval, LearningRunInfo, Store

LONGEST = 1e12
"""Seconds: no run takes so long."""


def curves_of(store: Store, runs: Sequence[LearningRunInfo]) -> tuple[str, list[Curve]]:
    """Return one curve a learning run, up to the time it has come to; and in words what they are.

    Args:
        store: open.
        runs: one at least.

    Raises:
        UsageError: a run has not begun.
    """
    seconds = _seconds(runs)
    did = _by_run(store.learning_progress(seconds, run_ids=[run.id for run in runs]))
    curves = [Curve.of(_name(run), did[run.id], seconds, run.robot_seconds) for run in runs]
    return f"learning of {', '.join(curve.name for curve in curves)}", curves


def curves_of_robots(
    store: Store, session_id: int, tools: Sequence[str] = ()
) -> tuple[str, list[ToolCurves]]:
    """Return the mean and spread of a reproduction's robots by tool; and in words what they are.

    Args:
        store: open.
        session_id: the reproduction.
        tools: only these; all if empty.

    Raises:
        UsageError: there is no such reproduction, or none of its robots is saved.
    """
    sessions = {session.id: session for session in store.sessions("reproduce")}
    if session_id not in sessions:
        known = ", ".join(map(str, sessions))
        there_are = f"there is {known}" if known else "there is none yet"
        raise UsageError(f"--session {session_id}: no such reproduction; {there_are}")
    runs = [
        run
        for run in store.learning_runs(session_id=session_id)
        if not tools or run.spec.tool in tools
    ]
    if not runs:
        raise UsageError(f"--session {session_id}: no robot saved yet; go on with it first")
    seconds = _seconds(runs)
    did = _by_run(store.learning_progress(seconds, session_id=session_id, tools=tools))
    curves = defaultdict(list)
    for run in runs:
        curve = Curve.of(_name(run), did[run.id], seconds, run.robot_seconds)
        curves[run.spec.tool].append(curve)
    order = dict.fromkeys([*map(str, TOOL_PARTS), *curves])
    by_tool = [ToolCurves.of(name, curves[name]) for name in order if name in curves]
    unfinished = "" if sessions[session_id].status == "done" else ", unfinished"
    robots = max(tool.robots for tool in by_tool)
    words = f"{robots} robot{'' if robots == 1 else 's'}"
    return f"learning of {words} (session {session_id}{unfinished})", by_tool


def _seconds(runs: Sequence[LearningRunInfo]) -> float:
    """Return the length of the intervals: so many in the longest run."""
    for run in runs:
        if run.robot_seconds == 0.0:
            raise UsageError(f"run {run.id} has not begun; go on with it first")
        if not 0.0 < run.robot_seconds <= LONGEST:
            raise DatabaseError(
                f"learning run {run.id} holds a value that affcli did not write; restore a copy of "
                "the database"
            )
    return max(run.robot_seconds for run in runs) / INTERVALS


def _by_run(intervals: Iterable[LearningInterval]) -> dict[int, list[Interval]]:
    """Return the intervals of each run."""
    by_run: dict[int, list[Interval]] = defaultdict(list)
    for interval in intervals:
        by_run[interval.run_id].append(interval)
    return by_run


def _name(run: LearningRunInfo) -> str:
    """Return what a run is called in a figure: ``T-hook (run 5)``."""
    unfinished = "" if run.status == "done" else ", unfinished"
    return f"{tool_words(run.spec.tool)} (run {run.id}{unfinished})"
