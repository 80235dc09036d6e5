"""How learning went over robot time, read for figures."""

from collections import defaultdict
from collections.abc import Sequence

from affcli.analysis.curves import INTERVALS, Curve, ToolCurves
from affcli.core.records import LearningRunInfo, SessionInfo
from affcli.core.specs import LIVES
from affcli.errors import UsageError
from affcli.store import Store


def curves_of(store: Store, runs: Sequence[LearningRunInfo]) -> list[Curve]:
    """Return one curve a learning run, up to the time it has come to.

    Args:
        store: open.
        runs: one at least.

    Raises:
        UsageError: a run has not begun.
    """
    seconds = _seconds(runs)
    did = store.results.learning_intervals(seconds)
    return [Curve.of(run, did.get(run.id, ()), seconds) for run in runs]


def curves_of_robots(
    store: Store, session_id: int, tools: Sequence[str] = ()
) -> tuple[SessionInfo, list[ToolCurves]]:
    """Return a reproduction, and the mean and spread of its robots by tool.

    Args:
        store: open.
        session_id: the reproduction, or the condition of an experiment.
        tools: only these; all if empty.

    Raises:
        UsageError: there is no such reproduction, or none of its robots is saved.
    """
    sessions = {session.id: session for session in store.sessions.all(*LIVES)}
    if session_id not in sessions:
        known = ", ".join(map(str, sessions))
        there_are = f"there is {known}" if known else "there is none yet"
        raise UsageError(f"--session {session_id}: no such reproduction; {there_are}")
    stored = store.learning.runs(session_id=session_id)
    runs = [run for run in stored if not tools or run.spec.tool in tools]
    if not runs:
        raise UsageError(f"--session {session_id}: no robot saved yet; go on with it first")
    seconds = _seconds(runs)
    did = store.results.learning_intervals(seconds, session_id)
    curves: dict[str, list[Curve]] = defaultdict(list)
    for run in runs:
        curves[run.spec.tool].append(Curve.of(run, did.get(run.id, ()), seconds))
    return sessions[session_id], [ToolCurves.of(tool, some) for tool, some in curves.items()]


def _seconds(runs: Sequence[LearningRunInfo]) -> float:
    """Return the length of the intervals: so many in the longest run."""
    for run in runs:
        if run.robot_seconds == 0.0:
            raise UsageError(f"run {run.id} has not begun; go on with it first")
    return max(run.robot_seconds for run in runs) / INTERVALS
