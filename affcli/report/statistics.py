"""The few statistics that the reports state, in plain Python."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist, fmean, stdev

LOW, HIGH = 0.025, 0.975
"""The central 95 % of robots."""

Z95 = NormalDist().inv_cdf(HIGH)


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


def quantile(counts: Sequence[int], share: float) -> int:
    """Return the smallest k among `counts` with P(X <= k) >= share."""
    ordered = sorted(counts)
    # The (i + 1)-th smallest count has P(X <= it) >= (i + 1) / n; in whole numbers of robots, so
    # that 0.025 of 200 robots is 5 and not 5.000000000000001.
    needed = math.ceil(round(share * len(ordered), 9))
    return ordered[max(needed, 1) - 1]
