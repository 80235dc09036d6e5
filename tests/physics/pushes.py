"""Pushes that the tests of this folder share: drawn from a seed, all of them touching the puck."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.workspace import Workspace
from affcli.simulation.contact import travel_to_contact
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.pushing import PushSimulator
from affcli.simulation.tools.paper import paper_tools
from affcli.simulation.wrist_motion import Stretch, on_grid, trapezoid
from tests.physics.quasi_static import Push

WORKSPACE = Workspace()
RADIUS = WORKSPACE.puck.radius
AHEAD, BACK, LEFT, RIGHT = Point(0.0, 1.0), Point(0.0, -1.0), Point(-1.0, 0.0), Point(1.0, 0.0)
DIRECTIONS = (AHEAD, BACK, LEFT, RIGHT)
"""Extend, contract, slide left, slide right."""


def turned_box(
    degrees: float, x: float = 0.0, y: float = 6.0, half_length: float = 3.0
) -> ConvexPolygon:
    """Return a bar about (x, y), as wide as the tools' parts, turned by an angle."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    a, b = half_length, WORKSPACE.tools.part_width / 2.0
    corners = ((-a, -b), (a, -b), (a, b), (-a, b))
    return ConvexPolygon(tuple(Point(x + c * u - s * v, y + s * u + c * v) for u, v in corners))


def fork(left: float, right: float) -> tuple[ConvexPolygon, ...]:
    """Return two bars that fall and rise by `left` and `right` degrees and meet at (0, 6)."""
    a, b = math.radians(left), math.radians(right)
    return (
        turned_box(-left, -3.0 * math.cos(a), 6.0 + 3.0 * math.sin(a)),
        turned_box(right, 3.0 * math.cos(b), 6.0 + 3.0 * math.sin(b)),
    )


def seat(left: float, right: float) -> Point:
    """Return the centre of a puck that touches both bars of a fork."""
    a, b = math.radians(left), math.radians(right)
    clear = RADIUS + WORKSPACE.tools.part_width / 2.0
    normals = np.array([[math.sin(a), math.cos(a)], [-math.sin(b), math.cos(b)]])
    x, y = np.linalg.solve(normals, [clear, clear])
    return Point(float(x), 6.0 + float(y))


def wedge(degrees: float) -> tuple[ConvexPolygon, ...]:
    """Return an isosceles triangle whose sharp corner points along +x."""
    half = 3.0 * math.tan(math.radians(degrees / 2.0))
    return (ConvexPolygon((Point(3.0, 6.0), Point(0.0, 6.0 + half), Point(0.0, 6.0 - half))),)


PAPER_SHAPES: dict[str, tuple[ConvexPolygon, ...]] = {
    str(name): tool.outlines for name, tool in paper_tools(WORKSPACE.tools).items()
}
INCLINED_SHAPES: dict[str, tuple[ConvexPolygon, ...]] = {
    "bar at 15 degrees": (turned_box(15.0),),
    "bar at 35 degrees": (turned_box(35.0),),
    "bar at -60 degrees": (turned_box(-60.0),),
    "wedge of 50 degrees": wedge(50.0),
    "wedge of 120 degrees": wedge(120.0),
}
FORK_ANGLES = ((45.0, 45.0), (30.0, 30.0), (20.0, 60.0), (75.0, 15.0))
FORKS: dict[str, tuple[ConvexPolygon, ...]] = {
    f"fork of {left:.0f} and {right:.0f} degrees": fork(left, right) for left, right in FORK_ANGLES
}
"""Shapes that, pushed ahead, hold the puck with two contacts at once, both loaded."""
SHAPES = PAPER_SHAPES | INCLINED_SHAPES | FORKS


def distance_to_union(polygons: Sequence[ConvexPolygon], point: Point) -> float:
    """Return the distance from `point` to the union of `polygons` (in); 0 inside."""
    return min(polygon.distance(point) for polygon in polygons)


@dataclass(frozen=True, slots=True)
class Case:
    """One push of a shape from a wrist position."""

    shape: str
    wrist: Point
    direction: Point
    distance: float
    puck: Pose

    @property
    def motion(self) -> tuple[Stretch, ...]:
        """The motion of the wrist, at the speed of the exploratory behaviors."""
        timing = WORKSPACE.motion
        return trapezoid(self.distance, timing.push_speed, timing.push_acceleration)

    @property
    def parts(self) -> tuple[ConvexPolygon, ...]:
        """The tool's parts where the motion starts (in, table frame)."""
        return tuple(part.moved(self.wrist.x, self.wrist.y) for part in SHAPES[self.shape])

    @property
    def quasi_static(self) -> Push:
        """The same push for the quasi-static solver."""
        return Push(self.parts, self.direction, self.distance, self.puck)


def simulator(shape: str, settings: PhysicsSettings | None = None) -> PushSimulator:
    """Return a fresh simulator of one of the shapes."""
    return PushSimulator(
        SHAPES[shape], WORKSPACE.puck, WORKSPACE.friction, settings or PhysicsSettings()
    )


def draw_case(
    rng: np.random.Generator, shape: str, direction: Point, distance: float = 5.0, gap: float = 0.02
) -> Case:
    """Return a push in which the tool meets the puck after `gap` inches.

    The puck is drawn anywhere across the sweep of the tool and up to a radius beyond, so that many
    pushes meet a corner, and at any depth, so that some meet the inside of a hook.
    """
    wrist = Point(on_grid(rng.uniform(-4.0, 4.0)), on_grid(rng.uniform(6.0, 15.0)))
    tool = SHAPES[shape]
    corners = np.array([corner for part in tool for corner in part.vertices])
    aside = Point(-direction.y, direction.x)
    across = corners @ np.array(aside)
    along = corners @ np.array(direction)
    while True:
        side = rng.uniform(across.min() - RADIUS, across.max() + RADIUS)
        ahead = rng.uniform(along.min(), along.max() + RADIUS)
        puck = Point(
            ahead * direction.x + side * aside.x,
            ahead * direction.y + side * aside.y,
        )
        travel = travel_to_contact(tool, direction, 60.0, puck, RADIUS)
        if not travel:
            continue
        back = travel - gap
        puck = Point(puck.x - back * direction.x, puck.y - back * direction.y)
        if distance_to_union(tool, puck) > RADIUS:
            angle = rng.uniform(-3.0, 3.0)
            pose = Pose(float(wrist.x + puck.x), float(wrist.y + puck.y), float(angle))
            return Case(shape, wrist, direction, distance, pose)


def draw_cases(
    seed: int, each: int, shapes: Iterable[str] = tuple(SHAPES), furthest: float = 0.02
) -> list[Case]:
    """Return `each` pushes of 5 in for every shape and direction, with gaps up to `furthest`."""
    rng = np.random.default_rng(seed)
    return [
        draw_case(rng, shape, direction, gap=rng.uniform(0.0, furthest))
        for shape in shapes
        for direction in DIRECTIONS
        for _ in range(each)
    ]
