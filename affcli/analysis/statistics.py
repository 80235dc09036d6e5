"""The few statistics that the reports state, in plain Python."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist, fmean, stdev
from typing import TypeVar

LOW, HIGH = 0.025, 0.975
"""The central 95 % of robots."""

ENOUGH_ROBOTS = 20
"""With fewer, the central 95 % of robots is hardly more than their range: it is compared with
nothing, and shares and probabilities over robots get no interval."""

Value = TypeVar("Value", int, float)

Z95 = NormalDist().inv_cdf(HIGH)


def wilson(successes: float, tries: float) -> tuple[float, float]:
    """Return the 95 % interval of a share by Wilson's score (1927); (0, 1) without tries.

    Args:
        successes, tries: counts; parts of them where several tries tell no more than one.
    """
    if tries == 0:
        return 0.0, 1.0
    share, z2 = successes / tries, Z95 * Z95
    middle = (share + z2 / (2 * tries)) / (1 + z2 / tries)
    half = Z95 * math.sqrt(share * (1 - share) / tries + z2 / (4 * tries * tries))
    half /= 1 + z2 / tries
    # All or none of them: the interval ends there, whatever the last bit says.
    low = 0.0 if successes == 0 else middle - half
    return low, 1.0 if successes == tries else middle + half


def mean_interval(values: Sequence[float]) -> tuple[float, float] | None:
    """Return the 95 % interval of the mean by Student's t; None for a single value."""
    if len(values) < 2:
        return None
    mean = fmean(values)
    half = t95(len(values) - 1) * stdev(values) / math.sqrt(len(values))
    return mean - half, mean + half


def t95(freedom: int) -> float:
    """Return the 0.975 quantile of Student's t.

    Exact for 1 and 2 degrees of freedom; for more, the expansion 26.7.5 of Abramowitz and Stegun
    (1964), which is right to 2 in 1,000 for 3 and better for each more.
    """
    if freedom == 1:
        return math.tan(math.pi * (HIGH - 0.5))
    if freedom == 2:
        return (2.0 * HIGH - 1.0) * math.sqrt(2.0 / (4.0 * HIGH * LOW))
    z = Z95
    terms = (
        (z**3 + z) / 4,
        (5 * z**5 + 16 * z**3 + 3 * z) / 96,
        (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384,
        (79 * z**9 + 776 * z**7 + 1482 * z**5 - 1920 * z**3 - 945 * z) / 92160,
    )
    return z + sum(term / float(freedom**power) for power, term in enumerate(terms, start=1))


@dataclass(frozen=True, slots=True)
class Spread:
    """Counts of many robots.

    Args:
        mean: over the robots.
        mean_ci: 95 % interval of the mean; None for one robot.
        low, high: the central 95 % of robots: the smallest k with P(X <= k) at least 0.025, 0.975.
    """

    mean: float
    mean_ci: tuple[float, float] | None
    low: int
    high: int

    @classmethod
    def of(cls, counts: Sequence[int]) -> "Spread":
        """Summarise one count for each robot; ValueError when there are none."""
        mean, interval = fmean(counts), mean_interval(counts)
        return cls(mean, interval, quantile(counts, LOW), quantile(counts, HIGH))

    def holds(self, count: int) -> bool:
        """Tell whether `count` lies in the central 95 % of robots."""
        return self.low <= count <= self.high


def quantile(values: Sequence[Value], share: float) -> Value:
    """Return the smallest k among `values` with P(X <= k) >= share."""
    ordered = sorted(values)
    # The (i + 1)-th smallest count has P(X <= it) >= (i + 1) / n; in whole numbers of robots, so
    # that 0.025 of 200 robots is 5 and not 5.000000000000001.
    needed = math.ceil(round(share * len(ordered), 9))
    return ordered[max(needed, 1) - 1]
