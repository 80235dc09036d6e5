"""What is said of a figure, over and under it: what it shows, of whom, and what is not default."""

from collections.abc import Sequence
from typing import NamedTuple

from affcli.analysis.adaptation import AdaptationCourse
from affcli.analysis.comparison import Results
from affcli.analysis.curves import Curve
from affcli.analysis.paired import Comparison
from affcli.analysis.paper import PLANNER
from affcli.analysis.prediction import Push
from affcli.core.records import LearningRunInfo, SessionInfo, TrialInfo
from affcli.core.specs import LearningSpec, SessionSpec, TrialSpec, VerificationSpec
from affcli.core.tool import Tool
from affcli.report.figures.words import broken_words, tool_words
from affcli.report.paired import title as comparison_title
from affcli.report.words import (
    clock,
    few_robots_note,
    many,
    planner_words,
    run_words,
    settings_words,
)
from affcli.simulation.arm import Reach

HOURS = 1.0
"""Of a learning run that says nothing of its length: the paper's hour (§6)."""


LEARNING = "Learning over robot time"


class Words(NamedTuple):
    """What is said of a figure.

    Args:
        title: what it shows.
        caption: whose it is: tool, run, seed, robots, session, what is not default.
    """

    title: str
    caption: str


def joined(*facts: str) -> str:
    """Return facts as one line, without those that are empty."""
    return "; ".join(filter(None, facts))


def differing(spec: LearningSpec | SessionSpec) -> str:
    """Return what of a run or session is not default: settings, parts, sensor."""
    return run_words(spec) if spec.logged else _not_default(run_words(spec))


def differing_settings(settings: str) -> str:
    """Return what of settings, as a spec keeps them, is not default."""
    return _not_default(settings_words(settings))


def _not_default(words: str) -> str:
    return "default settings" if words == "defaults" else f"not default: {words}"


def workspace_words(tool: Tool, reach: Reach, settings: str) -> Words:
    """Return what lies on the table, and what of its sizes is not default."""
    bare = f"the bare arm reaches from {reach.inner:.1f} to {reach.outer:.1f} in"
    what = f"{tool_words(tool.name)} at the centre"
    return Words("The table as a trial begins", joined(what, bare, differing_settings(settings)))


def tools_words(whole: Tool, left: Tool, settings: str) -> Words:
    """Return which tool broke, and what of the sizes is not default."""
    broke = broken_words(whole.name, left.name)
    return Words("The tools, to scale", joined(broke, differing_settings(settings)))


def run_name(run: LearningRunInfo) -> str:
    """Return what tells a learning run from others: ``run 5: T-hook, seed 3``."""
    spec = run.spec
    robot = "" if run.session_id is None else f", robot {spec.robot} of session {run.session_id}"
    unfinished, length = run.status != "done", clock(run.robot_seconds)
    far = f", {length}" if unfinished or spec.hours != HOURS else ""
    so_far = " so far (unfinished)" if unfinished else ""
    if spec.logged:
        return f"run {run.id}: {tool_words(spec.tool)}"
    return f"run {run.id}: {tool_words(spec.tool)}, seed {spec.seed}{robot}{far}{so_far}"


def run_caption(*runs: LearningRunInfo) -> str:
    """Return which learning runs it is of, and what is not default; once, if it is the same."""
    differences = [differing(run.spec) for run in runs]
    if len(set(differences)) == 1:
        return joined(*map(run_name, runs), differences[0])
    return joined(*(f"{run_name(r)}, {d}" for r, d in zip(runs, differences, strict=True)))


def session_caption(session: SessionInfo, robots: int) -> str:
    """Return which session it is of, of how many robots, and what is not default."""
    spec = session.spec
    unfinished = "" if session.status == "done" else ", unfinished"
    which = f"session {session.id} ({spec.kind}{unfinished})"
    return joined(f"{which}, {many(robots, 'robot')}, seed {spec.seed}", differing(spec))


def trial_words(info: TrialInfo, run: LearningRunInfo) -> Words:
    """Return which trial it is."""
    spec = info.spec
    tool = broken_words(spec.tool, spec.shape)
    return Words(
        f"Trial {info.id}: {tool}, goal {spec.goal}, start {spec.start}",
        joined(f"trial: {trial_seed(spec)}", run_caption(run)),
    )


def trial_seed(spec: TrialSpec) -> str:
    """Return the seed of a trial, and its planner and sensor where they are not the usual ones."""
    planner = "" if str(spec.planner) == PLANNER else f", planner {planner_words(spec.planner)}"
    sensor = "" if spec.sensor == "noisy" else f", sensor {spec.sensor}"
    return f"seed {spec.seed}{planner}{sensor}"


def curves_words(curves: Sequence[Curve]) -> Words:
    """Return which learning runs they are; the key of the figure tells several apart."""
    if len(curves) == 1:
        return Words(LEARNING, run_caption(curves[0].run))
    by_difference: dict[str, list[str]] = {}
    for curve in curves:
        by_difference.setdefault(differing(curve.run.spec), []).append(str(curve.run.id))
    facts = [f"{', '.join(ids)}: {words}" for words, ids in by_difference.items()]
    counted = many(len(curves), "learning run")
    return Words(LEARNING, joined(counted, *(facts if len(facts) > 1 else by_difference)))


def robots_words(session: SessionInfo, robots: int) -> Words:
    """Return whose learning it is."""
    return Words(LEARNING, session_caption(session, robots))


def results_words(results: Results) -> Words:
    """Return whose results they are, and why there are no intervals where some are expected."""
    if results.session is not None:
        whose = session_caption(results.session, results.robots)
        whose = joined(whose, few_robots_note(results.robots))
    else:
        runs = [
            f"run {number}: {tool_words(spec.tool)}, seed {spec.seed}, sensor {sensor}"
            for sensor, some in results.runs.items()
            for number, spec in some.items()
        ]
        whose = joined(f"one robot a tool: {'; '.join(runs)}")
    return Words("Successes beside the paper's", whose)


def adaptation_words(course: AdaptationCourse) -> Words:
    """Return whose trials they are, and why there are no intervals.

    Over one robot's trials there are some.
    """
    robots = course.robots
    return Words(
        f"Adaptation: {broken_words(course.tool, course.shape)}",
        joined(
            f"{many(course.trials, 'trial')} with the broken tool",
            session_caption(course.session, robots),
            "" if course.run is None else run_name(course.run),
            few_robots_note(robots) if robots > 1 else "",
        ),
    )


def prediction_words(run: LearningRunInfo, spec: VerificationSpec, pushes: Sequence[Push]) -> Words:
    """Return whose table predicts, and what."""
    sensor = "" if spec.sensor == run.spec.sensor else f", sensor {spec.sensor}"
    moved = f"{sum(push.moved for push in pushes)} moved the puck"
    if run.spec.logged:
        trials = f"trials: {len(pushes)}, each predicted by the others; of these {moved}"
        return Words(
            "Predictions of logged trials as the table grows", joined(trials, run_caption(run))
        )
    return Words(
        "Predictions of fresh pushes as the table grows",
        joined(
            f"pushes: {len(pushes)}, of which {moved}; their seed: {spec.seed}{sensor}",
            run_caption(run),
        ),
    )


def comparison_words(result: Comparison) -> Words:
    """Return which conditions are compared, each with its session, and what is not drawn."""
    return Words(
        comparison_title(result),
        joined(
            *(
                condition_name(one.name, one.session, len(one.robots))
                for one in (result.against, *result.others)
            ),
            f"not drawn: {many(len(result.same), 'cell')} the same in all robots"
            if result.same
            else "",
        ),
    )


def conditions_words(what: str, conditions: Sequence[tuple[str, SessionInfo, int]]) -> Words:
    """Return a title, and which conditions it is of."""
    return Words(what, joined(*(condition_name(*one) for one in conditions)))


def experiment_words(
    what: str,
    name: str,
    conditions: Sequence[tuple[str, SessionInfo, int]],
    tools: Sequence[str] = (),
) -> Words:
    """Return a title, and of which experiment and robots it is; the key names the conditions."""
    sessions = [session for _, session, _ in conditions]
    spec, differences = sessions[0].spec, {differing(session.spec) for session in sessions}
    # A robot that failed is in no condition.
    robots = conditions[0][2]
    return Words(
        what,
        joined(
            f"experiment {name}, sessions {sessions[0].id} to {sessions[-1].id}",
            f"{many(robots, 'robot')}, seed {spec.seed}",
            ", ".join(map(tool_words, tools)),
            *(differences if len(differences) == 1 else ()),
        ),
    )


def condition_name(name: str, session: SessionInfo, robots: int) -> str:
    """Return a condition with what makes it: its session, robots, seed, what is not default."""
    caption = session_caption(session, robots)
    return caption if caption.startswith(name) else f"{name}: {caption}"
