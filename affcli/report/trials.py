"""Tables of testing trials of one robot, and why each row was chosen (§6.2, §7.1)."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.text import Text

from affcli.analysis.overview import GoalCounts
from affcli.analysis.paper import GOALS, PLANNER, STARTS, TASK_SET, other_parts, papers_successes
from affcli.analysis.tasks import TaskSums, Trial, error_of, final_distance
from affcli.core.goal import Goal
from affcli.core.records import LearningRunInfo
from affcli.core.specs import TrialSpec
from affcli.core.trial import Outcome, StepRecord, TrialEnd, is_counted
from affcli.errors import one_line
from affcli.report.sheet import Sheet
from affcli.report.words import (
    call_words,
    fixed,
    in_order,
    many,
    movement_words,
    parts_words,
    plan_words,
    reasons_words,
    settings_words,
    trial_words,
)

Steps = Sequence[tuple[int, StepRecord]]
"""The steps of a trial, each with the number of its row in the store."""


def explain_trial(spec: TrialSpec, end: TrialEnd, steps: Steps) -> RenderableType:
    """Return how a trial ended, and step by step why each row was chosen and what came of it."""
    solved = end.outcome is Outcome.SOLVED
    head = Text(f"{trial_words(spec)}: ")
    head.append(end.outcome.value, style="green" if solved else "red")
    head.append(f" ({many(end.steps, 'step')})")
    lines: list[RenderableType] = [head]
    for row, step in steps:
        lines.append(
            _indented(2, f"step {step.number}: row {row}, {call_words(step.row.exploratory)}")
        )
        lines += [_indented(4, line) for line in step_lines(step, spec.task.goal)]
    if end.failure:
        lines.append(_indented(2, one_line(end.failure, 500)))
    elif end.last_reasons:
        lines.append(_indented(2, reasons_words(end.last_reasons, chosen=False)))
    return Group(*lines, "")


def _indented(by: int, line: str) -> Padding:
    """Return a line that stays indented where it is wrapped."""
    return Padding(Text(line), (0, 0, 0, by), expand=False)


def distances(step: StepRecord, goal: Goal) -> tuple[float, float, float]:
    """Return what a planner may weigh of a row (in).

    Returns:
        How far the attractor was seen from the goal's centre, how far the row expects to leave it,
        and how far the wrist travelled to its place.
    """
    x, y = step.start.object_position
    now = math.dist((x, y), goal.center)
    then = math.dist((x + step.expected.dx, y + step.expected.dy), goal.center)
    start, end = step.placing.wrist_start, step.placing.wrist_end
    return now, then, math.dist(start.point, end.point)


def step_lines(step: StepRecord, goal: Goal) -> tuple[str, ...]:
    """Return why a row was chosen in a step; the last two lines say what came of it."""
    row = step.row
    now, then, travel = distances(step, goal)
    x, y = step.start.object_position
    regrasped = (f"grasped anew: {call_words(row.binding)}",) if step.regrasped else ()
    before = f"{row.times_successful}/{row.times_used}"
    after = f"{step.times_successful_after}/{step.times_used_after}"
    moved = f"expected {movement_words(step.expected)}, seen {movement_words(step.seen)}"
    return (
        f"attractor at ({x:.1f}, {y:.1f}), {now:.1f} in from the goal's centre",
        reasons_words(step.reasons),
        *plan_words(step.reasons),
        *regrasped,
        f"re-positioning: {travel:.1f} in; should end {then:.1f} in from the centre",
        f"{moved}: {verdict_words(step)}",
        f"probability {before} -> {after}",
    )


def verdict_words(step: StepRecord) -> str:
    """Return whether a step replicated its row, and whether that excluded it."""
    verdict = "replicated" if step.replicated else "not replicated"
    if step.execution is None:
        verdict = f"{step.placing.status}, counted as a failure"
    return f"{verdict}, row excluded from now on" if step.died else verdict


def trial_json(spec: TrialSpec, end: TrialEnd, steps: Steps | None = None) -> dict[str, Any]:
    """Return a trial as JSON types; why each row was chosen when its steps are given.

    Args:
        spec: which trial.
        end: how it ended.
        steps: to be explained.
    """
    value: dict[str, Any] = {
        "sensor": spec.sensor,
        "planner": str(spec.planner),
        "tool": spec.tool,
        "goal": spec.goal,
        "start": spec.start,
        "outcome": end.outcome.value,
        "steps": end.steps,
        "robot_seconds": end.clock,
    }
    if steps is not None:
        left = end.last_reasons
        value["reasons_at_end"] = None if left is None else [one.json() for one in left]
        value["explain"] = [step_json(row, record, spec.task.goal) for row, record in steps]
    return value


def step_json(row: int, record: StepRecord, goal: Goal) -> dict[str, Any]:
    """Return a step as JSON types: why its row was chosen, and what came of it.

    Args:
        row: the number of the row in the store.
        record: the step.
        goal: of the trial.
    """
    now, then, travel = distances(record, goal)
    return {
        "step": record.number,
        "row": row,
        "behavior": str(record.row.exploratory),
        "reasons": [reason.json() for reason in record.reasons],
        "regrasped": record.regrasped,
        "placing": record.placing.status.value,
        "distance_to_goal": now,
        "expected_distance_to_goal": then,
        "repositioning": travel,
        "expected": [record.expected.dx, record.expected.dy],
        "seen": [record.seen.dx, record.seen.dy],
        "replicated": record.replicated,
        "excluded": record.died,
        "probability_before": record.row.replication_probability,
        "probability_after": record.times_successful_after / record.times_used_after,
    }


def solve_table(
    ends: Sequence[tuple[TrialSpec, TrialEnd]],
    runs: Mapping[str, LearningRunInfo],
) -> Sheet:
    """Return the trials of one goal: a row for each tool, a column for each start.

    Args:
        ends: the trials.
        runs: the learning run whose table was used, by tool.
    """
    starts = in_order(spec.start for spec, _ in ends)
    columns = [f"start {start}" for start in starts]
    specs = {spec.tool: spec for spec, _ in ends}
    paper = {
        tool: None if other_parts(runs[tool].spec) else papers_successes(spec)
        for tool, spec in specs.items()
    }
    used = [_used_words(runs[tool], spec) for tool, spec in specs.items()]
    planners = {str(spec.planner) for spec in specs.values()} - {PLANNER}
    notes = [", ".join(used), *(f"planner: {planner}" for planner in sorted(planners))]
    if any(end.steps for _, end in ends):
        notes.append("counters of the rows used were updated in the stored table")
    compared = any(count is not None for count in paper.values())
    task_set = ends[0][0].task_set
    tasks = "" if task_set == TASK_SET else f"{task_set}: "
    table = Sheet(
        ("tool", *columns, "solved", *(("paper",) if compared else ())),
        title=f"{tasks}Goal {ends[0][0].goal}: outcome (steps) by start",
        caption="; ".join(notes),
        left=("tool", *columns),
    )
    for tool in specs:
        mine = {spec.start: end for spec, end in ends if spec.tool == tool}
        solved = sum(end.outcome is Outcome.SOLVED for end in mine.values())
        cells = [f"{mine[s].outcome} ({mine[s].steps})" if s in mine else "-" for s in starts]
        tried = sum(is_counted(end.outcome) for end in mine.values())
        beside = f"{paper[tool]}/{STARTS}" if paper[tool] is not None else "-"
        table.add(tool, *cells, f"{solved}/{tried}", *((beside,) if compared else ()))
    return table


def tasks_table(trials: Sequence[Trial], runs: Mapping[str, LearningRunInfo]) -> Sheet:
    """Return what trials of many goals came to: a row for each tool.

    Args:
        trials: with their steps.
        runs: the learning run whose table was used, by tool.
    """
    first = trials[0][0]
    tools = dict.fromkeys(spec.tool for spec, _, _ in trials)
    sums = {tool: TaskSums.of([one for one in trials if one[0].tool == tool]) for tool in tools}
    failures = [kind for kind in Outcome if any(kind in one.failures for one in sums.values())]
    used = [_used_words(runs[tool], first) for tool in tools]
    table = Sheet(
        ("tool", "solved", "steps", "seconds", "in off", "error, in", *failures),
        title=f"{first.task_set}: {many(len(trials), 'trial')}, planner {first.planner}",
        caption="; ".join(
            (
                ", ".join(used),
                "counters of the rows used were updated in the stored table",
                "steps: of a solved trial; in off: from the goal's centre at the end, the median",
                "error: of where a step was expected to end",
            )
        ),
        left=("tool",),
    )
    for tool, one in sums.items():
        means = ((one.steps, 1), (one.seconds, 0), (one.distance, 2), (one.error, 2))
        cells = ("-" if value is None else fixed(value, digits) for value, digits in means)
        counts = (str(one.failures.get(kind, 0)) for kind in failures)
        table.add(tool, f"{one.solved}/{one.tried}", *cells, *counts)
    return table


def task_json(trial: Trial) -> dict[str, Any]:
    """Return as JSON types what of a trial tells planners apart beside how it ended."""
    spec, _, steps = trial
    (x, y), (goal_x, goal_y) = spec.task.start, spec.task.goal.center
    return {
        "tasks": spec.task_set,
        "start_at": [x, y],
        "goal_at": [goal_x, goal_y],
        "final_distance": final_distance(spec, steps),
        "errors": [error_of(step) for step in steps],
    }


def _used_words(run: LearningRunInfo, spec: TrialSpec) -> str:
    """Return which run's table was used, and what of that run is not the usual."""
    settings = settings_words(run.spec.settings)
    own = ("" if settings == "defaults" else settings, parts_words(run.spec))
    return f"run {run.id} ({', '.join(filter(None, (spec.sensor, *own)))})"


def counts_tables(counts: Sequence[GoalCounts], runs: Mapping[int, LearningRunInfo]) -> list[Sheet]:
    """Return successes of single robots: those beside the paper's, and those it has not.

    Args:
        counts: by whose trials.
        runs: the learning runs, by their numbers.
    """
    papers = [one for one in counts if one.papers]
    others = [one for one in counts if not one.papers]
    tables = []
    if papers:
        tables.append(
            Sheet(
                ("run", "tool", "sensor", *(f"goal {goal}" for goal in GOALS)),
                title="Extension of reach, by learning run",
                caption="solved/tried|the paper's successes of 4",
                left=("tool", "sensor"),
            )
        )
        for one in papers:
            cells = [f"{_count(one, goal)}|{one.paper(goal)}" for goal in GOALS]
            tables[-1].add(str(one.by.run), one.by.tool, one.by.sensor, *cells)
    if others:
        tables.append(_others_table(others, runs))
    return tables


def _others_table(counts: Sequence[GoalCounts], runs: Mapping[int, LearningRunInfo]) -> Sheet:
    """Return successes with what the paper has not."""
    goals = in_order(goal for one in counts for goal in one.goals)
    named = {
        "planner": [one.by.planner for one in counts],
        "tasks": [one.by.task_set for one in counts],
        "parts": [
            parts_words(runs[one.by.run].spec) if one.by.run in runs else "" for one in counts
        ],
    }
    usual = {"planner": PLANNER, "tasks": TASK_SET, "parts": ""}
    more = {name: values for name, values in named.items() if set(values) != {usual[name]}}
    table = Sheet(
        ("run", "tool", "sensor", *more, *(f"goal {goal}" for goal in goals)),
        title="Other tools, tasks and planners, by learning run",
        caption="solved/tried; the paper has nothing beside it",
        left=("tool", "sensor", *more),
    )
    for number, one in enumerate(counts):
        named_cells = (values[number] for values in more.values())
        cells = (_count(one, goal) for goal in goals)
        table.add(str(one.by.run), one.by.tool, one.by.sensor, *named_cells, *cells)
    return table


def _count(counts: GoalCounts, goal: str) -> str:
    """Return successes at one goal, - without trials."""
    solved, tried = counts.goals.get(goal, (0, 0))
    return f"{solved}/{tried}" if tried else "-"
