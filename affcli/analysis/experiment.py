"""What the robots of an experiment gave, condition by condition (§7)."""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from affcli.core.results import SuccessCount
from affcli.core.specs import Protocol


class Tally(NamedTuple):
    """Trials of one kind under one condition.

    Args:
        solved: how many each robot solved, by its number.
        tried: how many they ended, in all.
    """

    solved: Mapping[int, int]
    tried: int


def tallies(counts: Iterable[SuccessCount]) -> dict[str, Tally]:
    """Sum up the trials of a condition by kind: a set of tasks, or ``broken tool``."""
    solved: dict[str, Counter[int]] = {}
    tried: Counter[str] = Counter()
    for one in counts:
        kind = "broken tool" if one.protocol is Protocol.TOOL_ADAPTATION else one.task_set
        solved.setdefault(kind, Counter())[one.robot] += one.solved
        tried[kind] += one.trials
    return {kind: Tally(by_robot, tried[kind]) for kind, by_robot in solved.items()}
