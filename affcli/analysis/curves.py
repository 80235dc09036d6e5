"""How learning went over robot time: rows made, and how often a behavior had an effect."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import accumulate
from statistics import fmean

from affcli.analysis.statistics import HIGH, LOW, mean_interval, quantile
from affcli.core.records import LearningRunInfo
from affcli.core.results import LearningInterval

INTERVALS = 60
"""Points of a curve."""
ENOUGH_BEHAVIORS = 20
"""Of fewer, a share says hardly anything: the curve of the share begins there."""


@dataclass(frozen=True, slots=True)
class Curve:
    """One learning run.

    Args:
        run: which.
        minutes: of robot time, from 0 to the end of the run.
        rows: made by then.
        share: of the behaviors by then that had an effect; NaN while they are few.
    """

    run: LearningRunInfo
    minutes: Sequence[float]
    rows: Sequence[float]
    share: Sequence[float]

    @classmethod
    def of(
        cls, run: LearningRunInfo, intervals: Iterable[LearningInterval], seconds: float
    ) -> "Curve":
        """Sum up what a run did.

        Args:
            run: which; it has begun.
            intervals: what it did in each; those in which nothing ended may be left out.
            seconds: length of an interval.
        """
        robot_seconds = run.robot_seconds
        count = max(1, math.ceil(round(robot_seconds / seconds, 9)))
        behaviors, effects = [0] * (count + 1), [0] * (count + 1)
        for interval in intervals:
            # A behavior that ended on the last edge belongs to the last interval.
            end = min(max(interval.number, 0) + 1, count)
            behaviors[end] += interval.behaviors
            effects[end] += interval.effects
        rows = list(accumulate(effects))
        share = [
            made / done if done >= ENOUGH_BEHAVIORS else math.nan
            for made, done in zip(rows, accumulate(behaviors), strict=True)
        ]
        ends = [min(number * seconds, robot_seconds) / 60.0 for number in range(count + 1)]
        return cls(run, ends, [float(made) for made in rows], share)


@dataclass(frozen=True, slots=True)
class Band:
    """A number of many robots over time.

    Args:
        mean: over the robots.
        low, high: the central 95 % of robots, as in the tables of `reproduce`.
        mean_low, mean_high: 95 % interval of the mean; NaN where `mean_interval` gives none.
    """

    mean: Sequence[float]
    low: Sequence[float]
    high: Sequence[float]
    mean_low: Sequence[float]
    mean_high: Sequence[float]

    @classmethod
    def of(cls, lines: Sequence[Sequence[float]], most: float = math.inf) -> "Band":
        """Summarise lines of one length, one for each robot; NaN where a robot has none.

        Args:
            lines: of values from 0 on.
            most: no value lies above.
        """
        points = [_point(values, most) for values in zip(*lines, strict=True)]
        return cls(*([point[i] for point in points] for i in range(5)))


def _point(values: Sequence[float], most: float) -> tuple[float, float, float, float, float]:
    """Return the numbers of a band at one time."""
    if any(map(math.isnan, values)):
        return (math.nan,) * 5
    certain = mean_interval(values, 0.0, most)
    spread = quantile(values, LOW), quantile(values, HIGH)
    return fmean(values), *spread, *(certain or (math.nan, math.nan))


@dataclass(frozen=True, slots=True)
class ToolCurves:
    """The learning runs of many robots with one tool, while all of them were learning.

    Args:
        tool: its name.
        robots: how many.
        minutes: of robot time.
        rows, share: as in `Curve`.
    """

    tool: str
    robots: int
    minutes: Sequence[float]
    rows: Band
    share: Band

    @classmethod
    def of(cls, tool: str, curves: Sequence[Curve]) -> "ToolCurves":
        """Summarise the runs of one tool, which share the length of their intervals."""
        # The last point of a run is its own end, not that of an interval.
        common = min(len(curve.minutes) for curve in curves) - 1
        return cls(
            tool,
            len(curves),
            curves[0].minutes[:common],
            Band.of([curve.rows[:common] for curve in curves]),
            Band.of([curve.share[:common] for curve in curves], 1.0),
        )
