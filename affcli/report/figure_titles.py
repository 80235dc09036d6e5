"""What is said of a figure: whose results it shows, and what they lack."""

from collections.abc import Iterable, Sequence

from affcli.analysis.adaptation import AdaptationCourse
from affcli.analysis.comparison import Results
from affcli.analysis.curves import Curve, ToolCurves
from affcli.core.records import LearningRunInfo, SessionInfo
from affcli.report.figures.words import tool_words
from affcli.report.words import few_robots_note, many, run_words


def results_title(results: Results) -> str:
    """Return whose results they are."""
    if results.session is None:
        runs = (
            f"run{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))} ({sensor})"
            for sensor, numbers in results.runs.items()
        )
        return f"one robot a tool: {'; '.join(runs)}"
    spec = results.session.spec
    return f"{many(results.robots, 'robot')}, seed {spec.seed}, settings: {run_words(spec)}"


def results_note(results: Results) -> str:
    """Return why there are no intervals; empty when there are, or none are expected."""
    return "" if results.session is None else few_robots_note(results.robots)


def course_title(course: AdaptationCourse) -> str:
    """Return whose trials they are."""
    robots = many(course.session.spec.robots, "robot")
    return f"{course.tool}, broken: {course.shape}; {course.trials} trials of {robots}"


def course_note(course: AdaptationCourse) -> str:
    """Return why there are no intervals; empty where there are, as over one robot's trials."""
    robots = course.session.spec.robots
    return few_robots_note(robots) if robots > 1 else ""


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
