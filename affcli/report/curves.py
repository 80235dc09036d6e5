"""Words for curves of learning."""

from collections.abc import Iterable, Sequence

from affcli.analysis.curves import Curve, ToolCurves
from affcli.core.records import LearningRunInfo, SessionInfo
from affcli.report.figures.words import tool_words
from affcli.report.words import many


def run_name(run: LearningRunInfo) -> str:
    """Return what a run is called in a figure: ``T-hook (run 5)``."""
    unfinished = "" if run.status == "done" else ", unfinished"
    return f"{tool_words(run.spec.tool)} (run {run.id}{unfinished})"


def curves_title(curves: Iterable[Curve]) -> str:
    """Return which runs they are."""
    return f"learning of {', '.join(run_name(curve.run) for curve in curves)}"


def robots_title(session: SessionInfo, tools: Sequence[ToolCurves]) -> str:
    """Return whose learning it is."""
    unfinished = "" if session.status == "done" else ", unfinished"
    robots = many(max(tool.robots for tool in tools), "robot")
    return f"learning of {robots} (session {session.id}{unfinished})"
