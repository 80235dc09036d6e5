"""How learning went over robot time, read for figures."""

import math
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import replace

from affcli.analysis.curves import INTERVALS, Curve, ToolCurves
from affcli.core.records import LearningRunInfo, SessionInfo
from affcli.core.results import LearningInterval
from affcli.core.specs import LIVES
from affcli.errors import UsageError, one_line
from affcli.lab.run_parts import require_learned
from affcli.report.words import run_words
from affcli.store import Store


def curves_of(store: Store, runs: Sequence[LearningRunInfo]) -> list[Curve]:
    """Return one curve a learning run, up to the time it has come to.

    Args:
        store: open.
        runs: one at least.

    Raises:
        UsageError: a run has not begun, only borrowed, or was computed.
    """
    seconds = _seconds(runs)
    did: dict[int, list[LearningInterval]] = {}
    for session in dict.fromkeys(run.session_id for run in runs):
        did |= store.results.learning_intervals(seconds, session)
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
    # A run in which a robot invented for its others was not tried out.
    stored, used = store.learning.runs(session_id=session_id), store.runs.uses()
    runs = [run for run in stored if run.id in used and (not tools or run.spec.tool in tools)]
    if not runs:
        what = f"no robot saved yet with {' or '.join(map(one_line, tools))}; name another tool"
        what = what if tools else "no robot saved yet; go on with it first"
        raise UsageError(f"--session {session_id}: {what}")
    seconds = _seconds(runs)
    did = store.results.learning_intervals(seconds, session_id)
    curves: dict[str, list[Curve]] = defaultdict(list)
    for run in runs:
        curves[run.spec.tool].append(Curve.of(run, did.get(run.id, ()), seconds))
    return sessions[session_id], [ToolCurves.of(tool, some) for tool, some in curves.items()]


def by_kind(curves: Sequence[Curve]) -> list[ToolCurves]:
    """Return the mean and spread of runs that differ in nothing but seed and robot, by kind.

    A kind is called by its tool, and where others have the same tool by what is not default too.
    """
    kinds: dict[str, list[Curve]] = defaultdict(list)
    for curve in curves:
        kinds[replace(curve.run.spec, seed=0, robot=0).key].append(curve)
    specs = [some[0].run.spec for some in kinds.values()]
    tools = Counter(spec.tool for spec in specs)
    names = [
        spec.tool if tools[spec.tool] == 1 else f"{spec.tool}, {run_words(spec)}" for spec in specs
    ]
    return [ToolCurves.of(name, some) for name, some in zip(names, kinds.values(), strict=True)]


def _seconds(runs: Sequence[LearningRunInfo]) -> float:
    """Return the length of the intervals: so many in the longest run."""
    for run in runs:
        if math.isnan(run.robot_seconds):
            raise UsageError(f"run {run.id} comes from a log without times: it has no curve")
        if run.only_borrowed:
            raise UsageError(f"run {run.id} only borrowed: it has no curve")
        require_learned(run)
        if run.robot_seconds == 0.0:
            raise UsageError(f"run {run.id} has not begun; go on with it first")
    return max(run.robot_seconds for run in runs) / INTERVALS
