"""A measure of many robots against time, rows or a swept setting, condition by condition."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

from affcli.analysis.curves import Curve
from affcli.analysis.statistics import mean_interval


@dataclass(frozen=True, slots=True)
class Point:
    """The mean of a measure over robots, at one place of the other axis.

    Args:
        x: where.
        mean: over the robots.
        interval: 95 % of the mean; None where `mean_interval` has none.
        robots: how many.
    """

    x: float
    mean: float
    interval: tuple[float, float] | None
    robots: int

    @classmethod
    def of(cls, x: float, values: Sequence[float], most: float = math.inf) -> "Point":
        """Summarise one value a robot, none above `most`."""
        return cls(x, fmean(values), mean_interval(values, 0.0, most), len(values))


@dataclass(frozen=True, slots=True)
class Line:
    """Points that belong together.

    Args:
        panel: which measure they are of, where there are several.
        name: of the condition, or of what the conditions of the points share; empty for all.
        points: in the order of their x.
        course: followed over time; else each point is of a condition that says nothing of others.
    """

    panel: str
    name: str
    points: tuple[Point, ...]
    course: bool = False


@dataclass(frozen=True, slots=True)
class Course:
    """How one robot learned, with all its tools: what a table of it had on average.

    Args:
        minutes: of robot time with each tool.
        rows: made by then, mean of its tools.
        share: of all behaviors by then that had an effect; NaN while they are few.
    """

    minutes: Sequence[float]
    rows: Sequence[float]
    share: Sequence[float]

    @classmethod
    def of(cls, curves: Sequence[Curve]) -> "Course":
        """Sum up the learning runs of one robot, as far as all of them came."""
        common = min(len(curve.minutes) for curve in curves)
        minutes = min((curve.minutes for curve in curves), key=lambda ends: ends[-1])
        rows = [fmean(values) for values in _columns((c.rows for c in curves), common)]
        share = [fmean(values) for values in _columns((c.share for c in curves), common)]
        return cls(minutes[:common], rows, share)


def _columns(lines: Iterable[Sequence[float]], common: int) -> Iterable[tuple[float, ...]]:
    """Return the first values of some lines, then the second, and so on."""
    return zip(*(line[:common] for line in lines), strict=True)


def course_line(name: str, courses: Sequence[Course], y: str, x: str) -> Line:
    """Return the mean course of robots: `y` against `x`, each ``minutes``, ``rows``, ``share``."""
    # The last point of a course is its own end, not that of an interval.
    common = min(len(course.minutes) for course in courses) - 1
    points = []
    for number in range(common):
        values = [getattr(course, y)[number] for course in courses]
        at = fmean(getattr(course, x)[number] for course in courses)
        if not any(map(math.isnan, (at, *values))):
            points.append(Point.of(at, values, 1.0 if y == "share" else math.inf))
    return Line("", name, tuple(points), course=True)


def swept_line(
    panel: str,
    name: str,
    points: Mapping[float, Sequence[float]],
    most: float,
    *,
    course: bool = False,
) -> Line:
    """Return a point for each condition, from the values of its robots by where it lies."""
    found = tuple(Point.of(x, values, most) for x, values in sorted(points.items()))
    return Line(panel, name, found, course)
