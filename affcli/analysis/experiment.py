"""What the robots of an experiment gave, condition by condition (§7)."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

from affcli.analysis.paired import Comparison, Counts
from affcli.core.records import FailedRobot
from affcli.core.results import Cell, InvalidTrials
from affcli.core.specs import Protocol


class Tally(NamedTuple):
    """Trials of one kind under one condition.

    Args:
        solved: how many each robot solved, by its number.
        tried: how many they ended, in all.
    """

    solved: Mapping[int, int]
    tried: int


class ConditionResult(NamedTuple):
    """What the robots of one condition gave.

    Args:
        name, session: of the condition.
        tallies: its trials that count, by kind.
        invalid: those that count for nothing.
        failures: how many of those that count failed, by kind; the commonest first.
    """

    name: str
    session: int
    tallies: Mapping[str, Tally]
    invalid: InvalidTrials = InvalidTrials()
    failures: Mapping[str, int] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class ExperimentResult:
    """What the robots of an experiment gave.

    Args:
        name, question: of the experiment.
        robots: how many are saved.
        learning_runs: how many they made.
        results: of each condition, in order.
        failed: the robots that could not live.
        comparison: of the conditions with the first one, all trials of each kind; None where that
            was not asked for, or there is nothing to compare.
    """

    name: str
    question: str
    robots: int
    learning_runs: int
    results: Sequence[ConditionResult]
    failed: Sequence[FailedRobot]
    comparison: Comparison | None = None


def tallies(cells: Mapping[Cell, Counts]) -> dict[str, Tally]:
    """Sum up the trials of a condition by kind: a set of tasks, or ``broken tool``.

    Args:
        cells: by protocol and task set alone: they are as large as there are robots.
    """
    solved: dict[str, Counter[int]] = {}
    tried: Counter[str] = Counter()
    for cell, counts in cells.items():
        broken = cell.protocol == Protocol.TOOL_ADAPTATION.value
        kind = "broken tool" if broken else cell.task_set
        own = solved.setdefault(kind, Counter())
        for robot, (trials, won) in counts.items():
            own[robot] += won
            tried[kind] += trials
    return {kind: Tally(by_robot, tried[kind]) for kind, by_robot in solved.items()}
