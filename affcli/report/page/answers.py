"""The page's answers in words, each made of the numbers that stand below it."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from affcli.core.affordance import Affordance
from affcli.core.replay import Replay
from affcli.core.trial import Outcome, Protocol, TrialRecord
from affcli.report.breaking import Tally
from affcli.report.page.content import Broken, Content, LearnedRows
from affcli.report.page.drawings import sector
from affcli.report.paper import BROKEN_TOOL, EXTENSION_OF_REACH, TOTAL
from affcli.report.reproduction import ENOUGH_ROBOTS, Reproduction
from affcli.report.statistics import Spread

MANY_ROBOTS = 40
"""With fewer, no robot lies outside the central 95 %."""


def reproduced(result: Reproduction) -> str:
    """Return whether the paper's table is reproduced by many robots."""
    total, broken = Spread.of(result.totals), Spread.of(result.broken)
    outside = [
        f"{tool} at goal {goal}"
        for tool, counts in EXTENSION_OF_REACH.items()
        for goal, paper in enumerate(counts, 1)
        if not Spread.of(result.cells[tool, goal]).holds(paper)
    ]
    low, high = total.mean_ci
    numbers = (
        f"{result.robots} robots solve {total.mean:.1f} of the 80 trials on average "
        f"(95 % interval of the mean {low:.1f} to {high:.1f}), the paper's robot {TOTAL}; with the "
        f"broken tool {broken.mean:.1f} of 16, the paper's {BROKEN_TOOL}."
    )
    if result.robots < ENOUGH_ROBOTS:
        few = f"{result.robots} robot{'s are' if result.robots != 1 else ' is'} too few to say."
        return f"{few} {numbers}"
    if result.robots < MANY_ROBOTS:
        numbers += " Of so few robots the central 95 % are all; what is rare may be missing."
    cells = len(result.cells)
    inside = f"in {cells - len(outside)} of {cells} cells the paper's count lies within the central"
    if outside:
        return f"Not wholly: {inside} 95 % of robots; not so: {', '.join(outside)}. {numbers}"
    return f"Yes: {inside} 95 % of robots. {numbers}"


def solved_by_one(trials: Sequence[Replay]) -> str:
    """Return what one robot solved with whole tools."""
    ended = [t for t in trials if t.spec.protocol is Protocol.EXTENSION_OF_REACH and t.end]
    if not ended:
        return "One robot cannot tell, and this one has tried nothing yet: affcli solve --goal 1"
    solved = sum(t.end.outcome is Outcome.SOLVED for t in ended if t.end)
    return (
        f"One robot cannot tell. It solved {solved} of {len(ended)} trials with whole tools, each "
        "from the table as it was then. For an answer with intervals: affcli reproduce --robots 20"
    )


def pulls(learned: LearnedRows) -> str:
    """Return where a tool affords pulling: which of its parts, and by which behaviors."""
    rows = learned.rows.values()
    pulling = [
        row
        for row in rows
        if sector(row.expected_movement.dx, row.expected_movement.dy) == "toward"
    ]
    if not pulling:
        return f"The {learned.tool.name} has no row that moves the puck toward the robot."
    parts = Counter(learned.tool.part_nearest(row.start.wrist_to_object).name for row in pulling)
    calls = Counter(row.exploratory.name for row in pulling)
    return (
        f"{len(pulling)} of the {len(learned.rows)} rows of the {learned.tool.name} move the puck "
        f"toward the robot{_of_these_excluded(pulling)}. The puck was nearest to the "
        f"{_counted(parts)}; by {_counted(calls)}."
    )


def _of_these_excluded(rows: Sequence[Affordance]) -> str:
    """Return how many of some rows are not used any more, nothing when all are."""
    gone = sum(2 * row.times_successful <= row.times_used for row in rows)
    return f"; {gone} of these {'are' if gone != 1 else 'is'} excluded by now" if gone else ""


def _counted(counts: Mapping[Any, int]) -> str:
    """Return ``left hook (12), right hook (9)``, the commonest first."""
    ordered = sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    return ", ".join(f"{name} ({count})" for name, count in ordered)


@dataclass(frozen=True, slots=True)
class Unlearned:
    """What trials with a broken tool made of the rows.

    Args:
        excluded: in how many trials a row was excluded, by the row's number.
        lost: numbers of rows tried that the broken shape truly cannot do.
        missing: numbers of excluded rows whose attractor lay on the missing side.
        tally: figures of the trials.
    """

    excluded: dict[int, int]
    lost: frozenset[int]
    missing: frozenset[int]
    tally: Tally


def unlearned(broken: Broken) -> Unlearned:
    """Return what the trials with a broken tool made of its rows."""
    excluded: Counter[int] = Counter()
    lost: set[int] = set()
    for trial in broken.trials:
        for one in trial.steps:
            number = one.considered[0].id
            excluded[number] += one.step.record.died
            if one.step.lost:
                lost.add(number)
    gone = {number: count for number, count in excluded.items() if count}
    missing = frozenset(
        n for n in gone if broken.rows[n].start.wrist_to_object_x * broken.missing_side > 0.0
    )
    records = [
        TrialRecord(t.spec, tuple(one.step for one in t.steps), t.end)
        for t in broken.trials
        if t.end is not None
    ]
    return Unlearned(gone, frozenset(lost), missing, Tally.of(records))


def forgot(broken: Broken, result: Unlearned) -> str:
    """Return what the robot unlearned when its tool broke."""
    tally = result.tally
    sure = len(set(result.excluded) & result.lost)
    side = (
        f"with {len(result.missing)} of these the puck lay on the side that is gone, and "
        if broken.missing_side
        else "of these, "
    )
    return (
        f"{len(result.excluded)} of its {len(broken.rows)} rows were excluded in at least one of "
        f"{tally.trials} trials; {side}{sure} are truly lost: the {broken.shape.name} cannot do "
        "them. "
        f"{tally.tries_on_lost} of {tally.tries} tries went to lost rows. Each trial began with "
        f"the table as learned; {tally.solved} of {tally.trials} were solved (paper: {BROKEN_TOOL} "
        "of 16)."
    )


def same(content: Content) -> str:
    """Return whether the replays equal their records."""
    equal = sum(not replay.differences for replay in content.replays)
    return (
        f"{equal} of {len(content.replays)} replays equal their stored record to the bit, step by "
        "step: poses, rows and counters."
        + (" Those that differ say so." if equal < len(content.replays) else "")
    )
