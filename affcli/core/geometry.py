"""Points, convex polygons and boxes in the table frame or in a tool's own frame.

Frames: the table frame has its origin under the arm's shoulder, x to the robot's right, y away
from the robot, z up. Inches. Polygons list their vertices counter-clockwise.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple


class Point(NamedTuple):
    """A point on the table plane: x to the right, y away from the robot (in)."""

    x: float
    y: float


class Pose(NamedTuple):
    """A rigid pose on the table: position (in) and angle (rad, counter-clockwise)."""

    x: float
    y: float
    angle: float = 0.0

    @property
    def point(self) -> Point:
        """The position without the angle."""
        return Point(self.x, self.y)


@dataclass(frozen=True, slots=True)
class ConvexPolygon:
    """A convex polygon, counter-clockwise.

    Args:
        vertices: at least three (x, y) pairs, in.

    Attributes:
        edges: the edges as (start, end), in order.
        bounds: left, bottom, right and top of the bounding box (in).
        is_box: it fills its bounding box.
    """

    vertices: tuple[Point, ...]
    is_box: bool = field(init=False, repr=False, compare=False)
    edges: tuple[tuple[Point, Point], ...] = field(init=False, repr=False, compare=False)
    bounds: tuple[float, float, float, float] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        following = self.vertices[1:] + self.vertices[:1]
        object.__setattr__(self, "edges", tuple(zip(self.vertices, following, strict=True)))
        xs, ys = zip(*self.vertices, strict=True)
        bounds = (min(xs), min(ys), max(xs), max(ys))
        object.__setattr__(self, "bounds", bounds)
        corners = {(x, y) for x in bounds[::2] for y in bounds[1::2]}
        object.__setattr__(self, "is_box", set(self.vertices) == corners)

    @classmethod
    def box(cls, left: float, bottom: float, right: float, top: float) -> "ConvexPolygon":
        """Return the axis-aligned box between two corners (in)."""
        corners = ((left, bottom), (right, bottom), (right, top), (left, top))
        return cls(tuple(Point(*corner) for corner in corners))

    @property
    def area(self) -> float:
        """Signed area by the shoelace formula (in^2); positive when counter-clockwise."""
        return 0.5 * sum(a.x * b.y - b.x * a.y for a, b in self.edges)

    def moved(self, dx: float, dy: float) -> "ConvexPolygon":
        """Return this polygon translated by (dx, dy) (in)."""
        return ConvexPolygon(tuple(Point(x + dx, y + dy) for x, y in self.vertices))

    def turned(self, angle: float) -> "ConvexPolygon":
        """Return this polygon turned about the origin by `angle` (rad, counter-clockwise)."""
        if angle == 0.0:
            return self
        cos, sin = math.cos(angle), math.sin(angle)
        return ConvexPolygon(
            tuple(Point(cos * x - sin * y, sin * x + cos * y) for x, y in self.vertices)
        )

    def placed(self, pose: Pose) -> "ConvexPolygon":
        """Return this polygon, given in the frame of `pose`, in the frame that `pose` is given in.

        A part of a tool, placed at the wrist, is where it lies on the table.
        """
        return self.turned(pose.angle).moved(pose.x, pose.y)

    def distance(self, point: Point) -> float:
        """Return the distance from `point` to the polygon (in); 0 inside or on the edge."""
        inside = True
        nearest = math.inf
        for a, b in self.edges:
            ex, ey = b.x - a.x, b.y - a.y
            px, py = point.x - a.x, point.y - a.y
            if ex * py - ey * px < 0.0:
                inside = False
            squared = ex * ex + ey * ey
            along = min(1.0, max(0.0, (px * ex + py * ey) / squared)) if squared > 0.0 else 0.0
            nearest = min(nearest, math.hypot(px - along * ex, py - along * ey))
        return 0.0 if inside else nearest


def near_any(polygons: Sequence[ConvexPolygon], point: Point, radius: float) -> bool:
    """Tell whether `point` is less than `radius` (in) from the union of `polygons`."""
    x, y = point
    for polygon in polygons:
        left, bottom, right, top = polygon.bounds
        in_box = left - radius < x < right + radius and bottom - radius < y < top + radius
        if in_box and polygon.distance(point) < radius:
            return True
    return False


def direction_degrees(dx: float, dy: float) -> float:
    """Return the direction of (dx, dy) in degrees in [0, 360): 0 is right, 90 is away."""
    # A tiny negative angle plus 360 rounds to 360 itself, hence twice.
    return math.degrees(math.atan2(dy, dx)) % 360.0 % 360.0
