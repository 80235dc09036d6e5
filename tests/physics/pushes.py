"""Pushes that the tests of this folder share: drawn from a seed, all of them touching the puck."""

import math
from dataclasses import dataclass

import numpy as np

from affcli.core.geometry import ConvexPolygon, Point, Pose, distance_to_union
from affcli.core.tool import paper_tools
from affcli.core.workspace import Workspace
from affcli.simulation.contact import travel_to_contact
from affcli.simulation.pushing import PhysicsSettings, PushSimulator
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
FORKS: dict[str, tuple[ConvexPolygon, ...]] = {
    "fork of 45 and 45 degrees": fork(45.0, 45.0),
    "fork of 20 and 60 degrees": fork(20.0, 60.0),
    "fork of 30 and 30 degrees": fork(30.0, 30.0),
    "fork of 75 and 15 degrees": fork(75.0, 15.0),
}
"""Shapes that hold the puck with two contacts at once, both loaded."""
SHAPES = PAPER_SHAPES | INCLINED_SHAPES | FORKS


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

    The puck is drawn anywhere across the sweep of the tool: a third of the pushes start at less
    than a radius beyond an edge of the sweep, so they meet a corner.
    """
    wrist = Point(on_grid(rng.uniform(-4.0, 4.0)), on_grid(rng.uniform(6.0, 15.0)))
    parts = [part.moved(wrist.x, wrist.y) for part in SHAPES[shape]]
    corners = np.array([v for part in parts for v in part.vertices])
    aside = Point(-direction.y, direction.x)
    across = corners @ np.array(aside)
    along = corners @ np.array(direction)
    while True:
        offset = rng.uniform(across.min() - RADIUS, across.max() + RADIUS)
        depth = rng.uniform(along.min(), along.max() + RADIUS)
        puck = Point(*(depth * np.array(direction) + offset * np.array(aside)))
        travel = travel_to_contact(parts, direction, 60.0, puck, RADIUS)
        if not travel:
            continue
        back = travel - gap
        puck = Point(puck.x - back * direction.x, puck.y - back * direction.y)
        if distance_to_union(parts, puck) > RADIUS:
            return Case(shape, wrist, direction, distance, Pose(*puck, rng.uniform(-3.0, 3.0)))


def draw_cases(seed: int, each: int, shapes: dict[str, tuple[ConvexPolygon, ...]]) -> list[Case]:
    """Return `each` pushes of 5 in for every shape and direction."""
    rng = np.random.default_rng(seed)
    return [
        draw_case(rng, shape, direction)
        for shape in shapes
        for direction in DIRECTIONS
        for _ in range(each)
    ]
