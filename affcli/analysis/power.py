"""How many robots it takes to see a difference (Student's t of pairs, two-sided)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from affcli.analysis.statistics import FEWEST, deviation, saturates
from affcli.core.results import Cell

CERTAIN = 37.0
"""A mean so many of its standard errors from 0 is seen; SciPy knows no chance that near 1."""
MOST = 10_000_000
"""More robots than these are not counted."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What it takes to see differences of one kind.

    Args:
        cell: over which trials.
        robots: from how many its spread is known.
        spread: standard deviation of the paired differences.
        level: a difference is significant when its p is at most this.
        needed: for each difference asked for how many robots; None when more than `MOST`.
        visible: the smallest difference that as many robots as `robots` see.
    """

    cell: Cell
    robots: int
    spread: float
    level: float
    needed: dict[float, int | None]
    visible: float | None


class Untold(NamedTuple):
    """A cell of which nothing can be planned, and why, in words."""

    cell: Cell
    why: str


def power(robots: int, difference: float, spread: float, level: float) -> float:
    """Return the chance that so many robots show a difference.

    The square of the noncentral t is the noncentral F. Too few robots for the exact test to reach
    the level have none.
    """
    from scipy.special import ncfdtr, stdtrit

    if robots < least_robots(level):
        return 0.0
    center = abs(difference) / spread * math.sqrt(robots)
    if center > CERTAIN:
        return 1.0
    bound = stdtrit(robots - 1, 1.0 - level / 2.0)
    return float(1.0 - ncfdtr(1, robots - 1, center**2, bound**2))


def least_robots(level: float) -> int:
    """Return how many robots must all differ alike for the exact test to reach a level."""
    return max(FEWEST, math.ceil(1.0 - math.log2(level)))


def robots_needed(difference: float, spread: float, level: float, wanted: float) -> int | None:
    """Return the fewest robots that show a difference with the power wanted; None if too many."""
    low, high = least_robots(level) - 1, least_robots(level)
    while power(high, difference, spread, level) < wanted:
        low, high = high, 2 * high
        if high > MOST:
            return None
    while high - low > 1:
        middle = (low + high) // 2
        if power(middle, difference, spread, level) < wanted:
            low = middle
        else:
            high = middle
    return high


def visible_difference(robots: int, spread: float, level: float, wanted: float) -> float | None:
    """Return the smallest difference that so many robots show with the power wanted.

    None when no difference is, of so few robots.
    """
    if robots < least_robots(level):
        return None
    low, high = 0.0, spread
    while power(robots, high, spread, level) < wanted:
        low, high = high, 2.0 * high
    for _ in range(40):
        middle = (low + high) / 2.0
        if power(robots, middle, spread, level) < wanted:
            low = middle
        else:
            high = middle
    return high


def plan(
    cell: Cell,
    values: Sequence[int],
    correlation: float | None,
    differences: Sequence[float],
    level: float,
    wanted: float,
) -> Plan | Untold:
    """Return what it takes; why not, where the values do not even tell the interval of their mean.

    Args:
        cell: over which trials.
        values: one a robot: paired differences; or counts of one condition.
        correlation: of the counts with those of the other condition, which is taken to vary as
            much; None when the values are differences.
        differences: to be seen.
        level, wanted: of p, and of the chance that it is reached.
    """
    if len(values) < FEWEST:
        return Untold(cell, f"fewer than {FEWEST} robots")
    if saturates(values):
        return Untold(cell, "too few robots differ")
    spread = deviation(values)
    if correlation is not None:
        spread *= math.sqrt(2.0 * (1.0 - correlation))
    needed = {one: robots_needed(one, spread, level, wanted) for one in differences}
    visible = visible_difference(len(values), spread, level, wanted)
    return Plan(cell, len(values), spread, level, needed, visible)
