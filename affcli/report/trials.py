"""Tables of testing trials of one robot, and the words for a step (§6.2, §7.1)."""

import math
from collections.abc import Mapping, Sequence

from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.text import Text

from affcli.core.geometry import direction_degrees
from affcli.core.observation import Movement
from affcli.core.task import GoalRegion
from affcli.core.trial import Outcome, StepRecord, Survivors, TrialEnd, TrialSpec
from affcli.report.learning import whole_degrees
from affcli.report.paper import EXTENSION_OF_REACH
from affcli.report.sheet import Sheet


def explain_trial(
    spec: TrialSpec, end: TrialEnd, steps: Sequence[tuple[int, StepRecord]], goal: GoalRegion
) -> RenderableType:
    """Return how a trial ended, and step by step why each row was chosen and what came of it.

    Args:
        spec: which trial.
        end: how it ended.
        steps: each with the number of its row in the store.
        goal: of the trial.
    """
    solved = end.outcome is Outcome.SOLVED
    head = Text(f"{spec.tool}, goal {spec.goal}, start {spec.start}: ")
    head.append(end.outcome.value, style="green" if solved else "red")
    head.append(f" ({end.steps} step{'s' if end.steps != 1 else ''})")
    lines: list[RenderableType] = [head]
    for row, step in steps:
        lines.append(_indented(2, f"step {step.number}: row {row}, {step.row.exploratory}"))
        lines += [_indented(4, line) for line in step_lines(step, goal)]
    if end.last_survivors is not None:
        lines.append(_indented(2, f"rows left: {_survivors(end.last_survivors)}"))
    return Group(*lines, "")


def _indented(by: int, line: str) -> Padding:
    """Return a line that stays indented where it is wrapped."""
    return Padding(Text(line), (0, 0, 0, by), expand=False)


def distances(step: StepRecord, goal: GoalRegion) -> tuple[float, float, float]:
    """Return what searches 3 and 4 weighed (in).

    Returns:
        How far the attractor was seen from the goal's centre, how far the row expects to leave it,
        and how far the wrist travelled to its place.
    """
    x, y = step.start.object_position
    now = math.dist((x, y), goal.center)
    then = math.dist((x + step.expected.dx, y + step.expected.dy), goal.center)
    return now, then, math.dist(step.placing.wrist_start, step.placing.wrist_end)


def step_lines(step: StepRecord, goal: GoalRegion) -> tuple[str, ...]:
    """Return the rows left by each search, why this one, the movements, and the probability."""
    row = step.row
    now, then, travel = distances(step, goal)
    x, y = step.start.object_position
    expected, seen = movement_in_words(step.expected), movement_in_words(step.seen)
    verdict = "replicated" if step.replicated else "not replicated"
    if step.execution is None:
        verdict = f"{step.placing.status}, counted as a failure"
    if step.died:
        verdict += ", row excluded from now on"
    before = f"{row.times_successful}/{row.times_used}"
    after = f"{step.times_successful_after}/{step.times_used_after}"
    return (
        f"attractor at ({x:.1f}, {y:.1f}), {now:.1f} in from the goal's centre",
        f"rows left: {_survivors(step.survivors)}, 1 chosen",
        f"chosen for least re-positioning, {travel:.1f} in; should end {then:.1f} in from there",
        f"expected {expected}, seen {seen}: {verdict}",
        f"probability {before} -> {after}",
    )


def _survivors(left: Survivors) -> str:
    """Return how many rows each search left."""
    return (
        f"{left.consistent} by colour, {left.probable} probable, {left.reachable} in reach, "
        f"{left.nearest} nearest"
    )


def movement_in_words(movement: Movement) -> str:
    """Return a movement as length and direction."""
    if movement.distance == 0.0:
        return "none"
    direction = whole_degrees(direction_degrees(movement.dx, movement.dy))
    return f"{movement.distance:.1f} in at {direction} deg"


def solve_table(
    goal: int, ends: Sequence[tuple[TrialSpec, TrialEnd]], runs: Mapping[str, int]
) -> Sheet:
    """Return the trials of one goal: a row a tool, a column a start.

    Args:
        goal: 1 to 4.
        ends: the trials.
        runs: the learning run whose table was used, by tool; named with the sensor.
    """
    starts = sorted({spec.start for spec, _ in ends})
    columns = [f"start {start}" for start in starts]
    sensors = {spec.tool: spec.sensor for spec, _ in ends}
    used = ", ".join(f"run {runs[tool]} ({sensor})" for tool, sensor in sensors.items())
    table = Sheet(
        ("tool", *columns, "solved", "paper"),
        title=f"Goal {goal}: outcome (steps) by start",
        caption=f"{used}; counters of the rows used were updated in the stored table",
        left=("tool", *columns),
    )
    for tool in dict.fromkeys(spec.tool for spec, _ in ends):
        mine = {spec.start: end for spec, end in ends if spec.tool == tool}
        solved = sum(end.outcome is Outcome.SOLVED for end in mine.values())
        paper = f"{EXTENSION_OF_REACH[tool][goal - 1]}/4" if tool in EXTENSION_OF_REACH else "-"
        cells = [f"{mine[s].outcome} ({mine[s].steps})" for s in starts]
        table.add(tool, *cells, f"{solved}/{len(mine)}", paper)
    return table


def counts_table(solved: Mapping[tuple[int, str, str, int], tuple[int, int]]) -> Sheet:
    """Return successes of single robots by learning run and goal beside the paper's.

    Args:
        solved: (solved, tried) by (learning run, tool, sensor, goal).
    """
    table = Sheet(
        ("run", "tool", "sensor", "goal 1", "goal 2", "goal 3", "goal 4"),
        title="Extension of reach, by learning run",
        caption="solved/tried|the paper's successes of 4",
        left=("tool", "sensor"),
    )
    for run, tool, sensor in dict.fromkeys(key[:3] for key in solved):
        paper = EXTENSION_OF_REACH.get(tool, (None,) * 4)
        cells = []
        for goal in (1, 2, 3, 4):
            good, tried = solved.get((run, tool, sensor, goal), (0, 0))
            beside = "-" if paper[goal - 1] is None else str(paper[goal - 1])
            cells.append(f"{good}/{tried}|{beside}" if tried else f"-|{beside}")
        table.add(str(run), tool, sensor, *cells)
    return table
