"""The few statistics that the reports state, and the one rule for when there is an interval.

README.md of this folder says why these, and how often they were right when measured. SciPy is
imported where a quantile is needed: its start takes 0.2 s.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean, mode
from typing import TypeVar

LOW, HIGH = 0.025, 0.975
"""The central 95 % of robots; the ends of every interval."""

FEWEST = 5
"""Of fewer robots no interval of a mean is given, nor of a share of trials that they share."""
ENOUGH_OFF = 10
"""A mean has an interval if so many robots differ from the commonest value, or half of all, of an
odd number the smaller half."""
ENOUGH_ROBOTS = 40
"""Of fewer, the central 95 % is all of them: it is called their range, and compared with nothing.
The range of n robots leaves out another one of their kind 2 times in n + 1."""

Value = TypeVar("Value", int, float)


def exact_interval(successes: float, tries: float) -> tuple[float, float]:
    """Return the exact 95 % interval of a share (Clopper and Pearson, 1934); (0, 1) without tries.

    Args:
        successes, tries: counts; parts of them where several tries tell no more than one (Korn and
            Graubard, 1998).
    """
    if tries == 0:
        return 0.0, 1.0
    from scipy.special import betaincinv

    failures = tries - successes
    low = float(betaincinv(successes, failures + 1, LOW)) if successes else 0.0
    return low, float(betaincinv(successes + 1, failures, HIGH)) if failures else 1.0


def mean_interval(
    values: Sequence[float], least: float = -math.inf, most: float = math.inf
) -> tuple[float, float] | None:
    """Return the 95 % interval of the mean by Student's t; None where it would not hold.

    That is for fewer than `FEWEST` values, and for values that saturate: all but a few are the
    same, and how far the others lie off says little of how far they may.

    Args:
        values: one a robot.
        least, most: no mean lies beyond.
    """
    if len(values) < FEWEST or saturates(values):
        return None
    mean = fmean(values)
    half = t95(len(values) - 1) * deviation(values) / math.sqrt(len(values))
    return max(least, mean - half), min(most, mean + half)


def deviation(values: Sequence[float]) -> float:
    """Return the standard deviation, ten times as fast as `statistics.stdev` with its fractions."""
    mean = fmean(values)
    return math.sqrt(math.fsum((value - mean) ** 2 for value in values) / (len(values) - 1))


def saturates(values: Sequence[float]) -> bool:
    """Tell whether of some values fewer than half, and fewer than ten, differ from the commonest.

    Half of an odd number is rounded down: two of five are enough to differ.
    """
    commonest = mode(values)
    same = sum(value == commonest for value in values)
    return same > (len(values) + 1) // 2 and len(values) - same < ENOUGH_OFF


def t95(freedom: float) -> float:
    """Return the 0.975 quantile of Student's t."""
    from scipy.special import stdtrit

    return float(stdtrit(freedom, HIGH))


@dataclass(frozen=True, slots=True)
class Spread:
    """Counts of many robots.

    Args:
        mean: over the robots.
        mean_ci: 95 % interval of the mean; None where `mean_interval` gives none.
        low, high: the central 95 % of robots: the smallest k with P(X <= k) at least 0.025, 0.975;
            the range of fewer than `ENOUGH_ROBOTS`.
        robots: how many.
    """

    mean: float
    mean_ci: tuple[float, float] | None
    low: int
    high: int
    robots: int

    @classmethod
    def of(cls, counts: Sequence[int], most: float = math.inf) -> "Spread":
        """Summarise one count for each robot, of at most `most`; ValueError when there are none."""
        mean, interval = fmean(counts), mean_interval(counts, 0.0, most)
        return cls(mean, interval, quantile(counts, LOW), quantile(counts, HIGH), len(counts))

    def holds(self, count: int) -> bool | None:
        """Tell whether `count` lies in the central 95 % of robots; None where they are too few."""
        return self.low <= count <= self.high if self.robots >= ENOUGH_ROBOTS else None


def quantile(values: Sequence[Value], share: float) -> Value:
    """Return the smallest k among `values` with P(X <= k) >= share."""
    ordered = sorted(values)
    # The (i + 1)-th smallest count has P(X <= it) >= (i + 1) / n; in whole numbers of robots, so
    # that 0.025 of 200 robots is 5 and not 5.000000000000001.
    needed = math.ceil(round(share * len(ordered), 9))
    return ordered[max(needed, 1) - 1]
