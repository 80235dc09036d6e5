"""Tables of testing trials of one robot, and the words for a step (§6.2, §7.1)."""

from collections.abc import Mapping, Sequence

from rich.table import Table
from rich.text import Text

from affcli.core.geometry import direction_degrees
from affcli.core.observation import Movement
from affcli.core.trial import Outcome, StepRecord, TrialEnd, TrialSpec
from affcli.report.paper import EXTENSION_OF_REACH


def explain_step(record: StepRecord) -> Text:
    """Return the lines that say why a row was chosen and what came of it."""
    left = record.survivors
    row = record.row
    used, successful = row.times_used, row.times_successful
    after = f"{record.times_successful_after}/{record.times_used_after}"
    verdict = "replicated" if record.replicated else "not replicated"
    if record.execution is None:
        verdict = f"{record.placing.status}, counted as a failure"
    elif record.died:
        verdict += ", row excluded from now on"
    lines = [
        f"  step {record.number}: row {row.step}, {row.exploratory}",
        (
            f"    rows left: colours {left.consistent}, probability > 1/2 {left.probable}, "
            f"in reach {left.reachable}, top 20 % {left.nearest}, least re-positioning 1"
        ),
        f"    expected {_movement(record.expected)}, seen {_movement(record.seen)}: {verdict}",
        f"    probability {successful}/{used} -> {after}",
    ]
    return Text("\n".join(lines))


def _movement(movement: Movement) -> str:
    """Return a movement as length and direction."""
    if movement.distance == 0.0:
        return "none"
    direction = direction_degrees(movement.dx, movement.dy) % 360
    return f"{movement.distance:.1f} in at {direction:.0f} deg"


def trial_line(spec: TrialSpec, end: TrialEnd) -> Text:
    """Return one line that says how a trial ended."""
    solved = end.outcome is Outcome.SOLVED
    line = Text(f"{spec.tool}, goal {spec.goal}, start {spec.start}: ")
    line.append(end.outcome.value, style="green" if solved else "red")
    line.append(f" ({end.steps} step{'s' if end.steps != 1 else ''})")
    return line


def solve_table(goal: int, ends: Sequence[tuple[TrialSpec, TrialEnd]]) -> Table:
    """Return the trials of one goal: a row a tool, a column a start."""
    starts = sorted({spec.start for spec, _ in ends})
    table = Table(
        title=f"Goal {goal}: outcome (steps) by start",
        caption="counters of the rows used were updated in the stored table",
        title_justify="left",
        caption_justify="left",
    )
    table.add_column("tool")
    for start in starts:
        table.add_column(f"start {start}")
    table.add_column("solved", justify="right")
    table.add_column("paper", justify="right")
    for tool in dict.fromkeys(spec.tool for spec, _ in ends):
        mine = {spec.start: end for spec, end in ends if spec.tool == tool}
        solved = sum(end.outcome is Outcome.SOLVED for end in mine.values())
        paper = f"{EXTENSION_OF_REACH[tool][goal - 1]}/4" if tool in EXTENSION_OF_REACH else "-"
        cells = [f"{mine[s].outcome} ({mine[s].steps})" for s in starts]
        table.add_row(tool, *cells, f"{solved}/{len(mine)}", paper)
    return table


def counts_table(title: str, solved: Mapping[tuple[str, int], tuple[int, int]]) -> Table:
    """Return successes of one robot by tool and goal beside the paper's.

    Args:
        title: of the table.
        solved: (solved, tried) by (tool, goal).
    """
    table = Table(
        title=title,
        caption="solved/tried | paper's successes of 4",
        title_justify="left",
        caption_justify="left",
    )
    table.add_column("tool")
    for goal in (1, 2, 3, 4):
        table.add_column(f"goal {goal}", justify="right")
    for tool in dict.fromkeys(tool for tool, _ in solved):
        paper = EXTENSION_OF_REACH.get(tool, (None,) * 4)
        cells = []
        for goal in (1, 2, 3, 4):
            good, tried = solved.get((tool, goal), (0, 0))
            beside = "-" if paper[goal - 1] is None else str(paper[goal - 1])
            cells.append(f"{good}/{tried} | {beside}" if tried else f"- | {beside}")
        table.add_row(tool, *cells)
    return table
