"""The page's answers in words, each made of the numbers that stand below it."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from affcli.analysis.breaking import DeadRow, Tally, dead_rows, missing_side
from affcli.analysis.paper import (
    BROKEN,
    BROKEN_TRIALS,
    EXTENSION_OF_REACH,
    TOTAL,
    TRIALS,
    papers_breaking,
)
from affcli.analysis.prediction import scores
from affcli.analysis.regions import UNKNOWN, region_of
from affcli.analysis.reproduction import Reproduction
from affcli.analysis.statistics import ENOUGH_ROBOTS, Spread
from affcli.core.affordance import Affordance, is_probable
from affcli.core.replay import Replay
from affcli.core.specs import Protocol, TrialRecord
from affcli.core.trial import Outcome, is_counted
from affcli.errors import one_line
from affcli.report.breaking import growth_words
from affcli.report.page.content import Broken, Content, LearnedRows
from affcli.report.page.drawings import sector
from affcli.report.replaying import by_reason
from affcli.report.verification import found_words
from affcli.report.words import many


def reproduced(result: Reproduction) -> str:
    """Return whether the paper's table is reproduced by many robots."""
    if not result.cells:
        return "These robots did nothing that the paper has beside it; what they did stands below."
    outside = [
        f"{tool} at goal {goal}"
        for (tool, goal), counts in result.cells.items()
        if Spread.of(counts).holds(EXTENSION_OF_REACH[tool, goal]) is False
    ]
    numbers = _sums(result)
    if result.robots < ENOUGH_ROBOTS:
        few = f"{result.robots} robot{'s are' if result.robots != 1 else ' is'} too few to say"
        return f"{few} cell by cell ({ENOUGH_ROBOTS} or more). {numbers}"
    cells = len(result.cells)
    inside = f"in {cells - len(outside)} of {cells} cells the paper's count lies within the central"
    if outside:
        return f"Not wholly: {inside} 95 % of robots; not so: {', '.join(outside)}. {numbers}"
    yes = "Yes" if result.totals else "As far as it was tried"
    return f"{yes}: {inside} 95 % of robots. {numbers}"


def _sums(result: Reproduction) -> str:
    """Return the total and the broken tool's successes in words."""
    robots = f"{many(result.robots, 'robot')} solve{'s' if result.robots == 1 else ''}"
    broken = (
        f"{Spread.of(result.broken).mean:.1f} of {BROKEN_TRIALS}, the paper's {BROKEN}"
        if result.broken
        else ""
    )
    if not result.totals:
        words = f"Not all of the paper's {TRIALS} trials were tried."
        return f"{words} With the broken tool {robots} {broken}." if broken else words
    total = Spread.of(result.totals, TRIALS)
    ci = total.mean_ci
    mean = "" if ci is None else f" (95 % interval of the mean {ci[0]:.1f} to {ci[1]:.1f})"
    return (
        f"{robots} {total.mean:.1f} of the {TRIALS} trials on average{mean}, the paper's robot "
        f"{TOTAL}{f'; with the broken tool {broken}' if broken else ''}."
    )


def solved_by_one(trials: Sequence[Replay]) -> str:
    """Return what one robot solved with whole tools."""
    whole = [t for t in trials if t.spec.protocol is Protocol.EXTENSION_OF_REACH]
    ended = [t for t in whole if is_counted(t.outcome)]
    if not ended:
        return "One robot cannot tell, and no trial of this one counts yet: affcli solve --goal 1"
    solved = sum(t.outcome is Outcome.SOLVED for t in ended)
    return (
        f"One robot cannot tell. It solved {solved} of {len(ended)} trials with whole tools, each "
        "from the table as it was then. For an answer with intervals: affcli reproduce --robots 20"
    )


def pulls(learned: LearnedRows) -> str:
    """Return where a tool affords pulling: which of its parts, and by which behaviors."""
    tool = learned.run.spec.held
    name = one_line(tool.name, 60)
    pulling = [
        row
        for row in learned.rows.values()
        if sector(row.expected_movement.dx, row.expected_movement.dy) == "toward"
    ]
    if not pulling:
        return f"The {name} has no row that moves the puck toward the robot."
    parts = Counter(region_of(tool, row) for row in pulling)
    calls = Counter(row.exploratory.name for row in pulling)
    near = "" if UNKNOWN in parts else f" The puck was nearest to the {_counted(parts)}; by"
    return (
        f"{len(pulling)} of the {len(learned.rows)} rows of the {name} move the puck toward the "
        f"robot{_of_these_excluded(pulling)}.{near or ' By'} {_counted(calls)}."
    )


def worth(content: Content) -> str:
    """Return how good a table is at predicting, and what testing it found."""
    asked = next((one for one in reversed(content.tools) if one.pushes), None)
    said = "Its table was not asked for predictions."
    if asked is not None:
        name, whole = one_line(asked.run.spec.tool, 60), scores(asked.pushes)[-1]
        said = (
            f"Of {len(asked.pushes)} fresh pushes with the {name}, {whole.moved} moved the puck: "
            f"its table foretold {whole.hits} of these, and wrongly {whole.false_alarms} of the "
            f"other {whole.still}."
        )
    if not content.verifications:
        return f"{said} It has not tested its table itself: affcli verify --update"
    last = content.verifications[-1]
    return (
        f"{said} Testing the table of run {last.run_id} with the {one_line(last.shape, 60)} in its "
        f"hand, the robot found: {found_words(last)}."
    )


def _of_these_excluded(rows: Sequence[Affordance]) -> str:
    """Return how many of some rows are not used any more, nothing when all are."""
    gone = sum(not is_probable(row.times_successful, row.times_used) for row in rows)
    return f"; {gone} of these {'are' if gone != 1 else 'is'} excluded by now" if gone else ""


def _counted(counts: Mapping[Any, int]) -> str:
    """Return ``left hook (12), right hook (9)``, the commonest first."""
    ordered = sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    return ", ".join(f"{name} ({count})" for name, count in ordered)


def ended_trials(broken: Broken) -> list[TrialRecord]:
    """Return the trials with a broken tool as records."""
    return [
        TrialRecord(t.spec, tuple(one.step for one in t.steps), t.end)
        for t in broken.trials
        if t.end is not None
    ]


def excluded_rows(broken: Broken) -> dict[int, DeadRow]:
    """Return the rows that were excluded in trials with a broken tool, by number in the store."""
    numbers = {row.step: number for number, row in broken.learned.rows.items()}
    left = broken.trials[0].spec.held
    side = missing_side(broken.learned.run.spec.held, left)
    return {numbers[dead.row.step]: dead for dead in dead_rows(ended_trials(broken), side)}


def forgot(broken: Broken) -> str:
    """Return what the robot unlearned when its tool broke."""
    tally, dead = Tally.of(ended_trials(broken)), excluded_rows(broken).values()
    spec, learned = broken.trials[0].spec, broken.learned
    missing, lost = sum(row.on_missing_side for row in dead), sum(row.lost for row in dead)
    has_side = missing_side(learned.run.spec.held, spec.held) != 0.0
    side = f"with {missing} of these the puck lay on the side that is gone, and "
    paper = papers_breaking(spec, learned.run.spec)
    grew = growth_words(learned.run.spec.held, spec.held)
    return f"{grew} ".lstrip() + (
        f"{len(dead)} of its {len(learned.rows)} rows were excluded in at least one of "
        f"{tally.trials} trials; {side if has_side else 'of these, '}{lost} are truly lost: the "
        f"{one_line(spec.shape, 60)} cannot do them. {tally.tries_on_lost} of {tally.tries} tries "
        f"went to lost rows. Each trial began with the table as learned; {tally.solved} of "
        f"{tally.trials} were solved{f' (paper: {BROKEN} of 16)' if paper else ''}."
    )


def same(content: Content) -> str:
    """Return whether the replays equal their records."""
    equal = sum(not replay.differences for replay in content.replays)
    return (
        f"{equal} of {len(content.replays)} replays equal their stored record to the bit, step by "
        "step: poses, rows and counters."
        + (" Those that differ say so." if equal < len(content.replays) else "")
    )


def left_out(content: Content) -> list[str]:
    """Return which trials this affcli cannot do again, and why."""
    return [
        f"trial{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))} left out: {reason}"
        for reason, numbers in by_reason(content.not_replayed).items()
    ]
