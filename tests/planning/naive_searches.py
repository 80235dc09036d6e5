"""The four nested searches of §6.2 once more, as plainly as they can be written: lists, `sorted`,
`min`, exact fractions. Slow, obvious, and sharing no code with the product."""

import math
from collections.abc import Callable
from fractions import Fraction

from affcli.core.affordance import Affordance
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.task import GoalRegion

Aged = tuple[int, Affordance]
"""A row and its place in the table: a lower place is an older row."""


def with_fitting_colors(rows: list[Aged], seen: Observation, tolerance: float) -> list[Aged]:
    """Search 1: "all rows that have observation vectors consistent with the colors of the current
    tool and object"."""

    def fits(row: Affordance) -> bool:
        theirs, ours = row.start, seen
        return (
            math.dist(theirs[6:9], ours[6:9]) <= tolerance
            and math.dist(theirs[9:12], ours[9:12]) <= tolerance
        )

    return [(age, row) for age, row in rows if fits(row)]


def more_likely_than_not(rows: list[Aged]) -> list[Aged]:
    """Search 2: "only those rows that have a replication probability greater than 1/2"."""
    return [
        (age, row)
        for age, row in rows
        if Fraction(row.times_successful, row.times_used) > Fraction(1, 2)
    ]


def wrist_asked_for(row: Affordance, seen: Observation) -> Point:
    """Return where the wrist must be for the attractor to be at the row's O^s offset (x, y)."""
    x, y = row.start.wrist_to_object
    return Point(seen.object_x - x, seen.object_y - y)


def with_wrist_in_reach(
    rows: list[Aged], seen: Observation, reachable: Callable[[Point], bool]
) -> list[Aged]:
    """Not in the paper's list: only rows that the arm can prepare."""
    return [(age, row) for age, row in rows if reachable(wrist_asked_for(row, seen))]


def sorted_by_expected_distance(
    rows: list[Aged], seen: Observation, goal: GoalRegion
) -> list[Aged]:
    """Search 3: "Sort the remaining rows (in increasing order) based on the expected distance
    between the attractor object and the goal region". `sorted` keeps older rows first."""

    def expected_distance(aged: Aged) -> Fraction:
        row = aged[1]
        x = Fraction(seen.object_x) + Fraction(row.end.object_x) - Fraction(row.start.object_x)
        y = Fraction(seen.object_y) + Fraction(row.end.object_y) - Fraction(row.start.object_y)
        return (x - Fraction(goal.center.x)) ** 2 + (y - Fraction(goal.center.y)) ** 2

    return sorted(rows, key=expected_distance)


def top_fifth(rows: list[Aged]) -> list[Aged]:
    """Search 4, first half: "the top 20% of the sorted rows": max(1, ceil(0.2 n)) of n."""
    return rows[: max(1, math.ceil(Fraction(len(rows), 5)))]


def least_moved(rows: list[Aged], seen: Observation, wrist: Point) -> Aged | None:
    """Search 4, second half: the row "which minimizes the re-positioning of the tool relative to
    its current location", the older of equal ones."""

    def way(aged: Aged) -> tuple[Fraction, int]:
        to = wrist_asked_for(aged[1], seen)
        dx, dy = Fraction(to.x) - Fraction(wrist.x), Fraction(to.y) - Fraction(wrist.y)
        return dx**2 + dy**2, aged[0]

    return min(rows, key=way, default=None)
