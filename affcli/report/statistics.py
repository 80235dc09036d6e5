"""The few statistics that the reports state, in plain Python."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist, fmean, stdev
from typing import TypeVar

LOW, HIGH = 0.025, 0.975
"""The central 95 % of robots."""

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


@dataclass(frozen=True, slots=True)
class Spread:
    """Counts of many robots.

    Args:
        mean: over the robots.
        mean_ci: 95 % interval of the mean (normal; (mean, mean) for one robot).
        low, high: the central 95 % of robots: the smallest k with P(X <= k) at least 0.025, 0.975.
    """

    mean: float
    mean_ci: tuple[float, float]
    low: int
    high: int

    @classmethod
    def of(cls, counts: Sequence[int]) -> "Spread":
        """Summarise one count a robot; ValueError when there are none."""
        mean = fmean(counts)
        error = Z95 * stdev(counts) / math.sqrt(len(counts)) if len(counts) > 1 else 0.0
        return cls(
            mean, (mean - error, mean + error), quantile(counts, LOW), quantile(counts, HIGH)
        )

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
