"""Extension-of-reach tasks: goal regions and starts (§7.1, Fig. 8)."""

from dataclasses import dataclass

from affcli.core.geometry import Point
from affcli.core.workspace import TaskLayout

GOAL_NUMBERS = (1, 2, 3, 4)
START_NUMBERS = (1, 2, 3, 4)


@dataclass(frozen=True, slots=True)
class GoalRegion:
    """A colour-coded square on the table.

    Args:
        number: 1 to 4, as in Fig. 8.
        center: of the square (in, table frame).
        half_width: half its side (in).
    """

    number: int
    center: Point
    half_width: float

    def contains(self, point: Point) -> bool:
        """Tell whether `point` (in, table frame) lies inside the square or on its edge."""
        return (
            abs(point.x - self.center.x) <= self.half_width
            and abs(point.y - self.center.y) <= self.half_width
        )


def goal_regions(layout: TaskLayout) -> dict[int, GoalRegion]:
    """Return the four goal regions by number: near, far, left and right on the mid-line."""
    centers = {
        1: Point(0.0, layout.goal_1_y),
        2: Point(0.0, layout.goal_2_y),
        3: Point(-layout.goal_side_x, layout.midline),
        4: Point(layout.goal_side_x, layout.midline),
    }
    return {n: GoalRegion(n, center, layout.goal_half_width) for n, center in centers.items()}


def start_positions(layout: TaskLayout) -> dict[int, Point]:
    """Return the four starts of the attractor by number, left to right on the mid-line."""
    middle = (START_NUMBERS[0] + START_NUMBERS[-1]) / 2
    return {n: Point((n - middle) * layout.start_spacing, layout.midline) for n in START_NUMBERS}
