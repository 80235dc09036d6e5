"""Turns of a tool about its wrist that the tests of this folder share, drawn from a seed."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from affcli.core.geometry import Point, Pose
from affcli.core.tool import turned_outlines
from affcli.simulation.contact import arc_to_contact
from affcli.simulation.pushing import PushSimulator
from affcli.simulation.wrist_motion import Stretch, lever_of, on_grid, tip_of, turning
from tests.physics.pushes import RADIUS, SHAPES, WORKSPACE, Case, distance_to_union, draw_case
from tests.physics.quasi_static import Push


@dataclass(frozen=True, slots=True)
class TurnCase:
    """One turn of a shape about a wrist position, by an arc at a lever."""

    shape: str
    wrist: Point
    lever: float
    arc: float
    puck: Pose

    @property
    def motion(self) -> tuple[Stretch, ...]:
        """The motion, the tip as fast as a push."""
        timing, tip = WORKSPACE.motion, tip_of(SHAPES[self.shape])
        lever = abs(self.lever)
        return turning(self.arc, lever, tip, timing.push_speed, timing.push_acceleration)

    @property
    def quasi_static(self) -> Push:
        """The same turn for the quasi-static solver."""
        parts = tuple(part.moved(*self.wrist) for part in SHAPES[self.shape])
        angle = self.arc / self.lever
        way = abs(angle) * tip_of(SHAPES[self.shape])
        return Push(parts, Point(0.0, 0.0), way, self.puck, angle, self.wrist)

    def end(self, by: PushSimulator, *, whole: bool = False) -> Pose:
        """Return where a simulator of the shape leaves the puck."""
        return by.turn(self.puck, self.wrist, self.lever, self.motion, whole=whole)


def draw_turn(
    rng: np.random.Generator, shape: str, degrees: float, furthest: float = 0.3
) -> TurnCase:
    """Return a turn that meets the puck after at most a share `furthest` of the way.

    The puck is drawn anywhere around the wrist as far as the tool reaches, and put back along its
    circle from where the tool meets it.
    """
    wrist = Point(on_grid(rng.uniform(-4.0, 4.0)), on_grid(rng.uniform(6.0, 15.0)))
    tool = SHAPES[shape]
    lever = math.copysign(lever_of(tip_of(tool)), rng.uniform(-1.0, 1.0))
    arc = on_grid(abs(lever) * math.radians(degrees))
    while True:
        at, around = rng.uniform(1.5, 17.0), rng.uniform(-math.pi, math.pi)
        puck = Point(at * math.sin(around), at * math.cos(around))
        met = arc_to_contact(tool, lever, 7.0 * abs(lever), puck, RADIUS)
        if not met:
            continue
        back = (met - arc * rng.uniform(0.0, furthest)) / lever
        cos, sin = math.cos(-back), math.sin(-back)
        puck = Point(cos * puck.x - sin * puck.y, sin * puck.x + cos * puck.y)
        if distance_to_union(tool, puck) > RADIUS:
            pose = Pose(wrist.x + puck.x, wrist.y + puck.y, float(rng.uniform(-3.0, 3.0)))
            return TurnCase(shape, wrist, lever, arc, pose)


def draw_turns(seed: int, count: int, shapes: Sequence[str], degrees: float) -> list[TurnCase]:
    """Return so many turns, of each shape in turn."""
    rng = np.random.default_rng(seed)
    return [draw_turn(rng, shapes[k % len(shapes)], degrees) for k in range(count)]


def turned_shape(shape: str, degrees: float) -> str:
    """Return the name of a shape held at an angle, which is put among the shapes."""
    name = f"{shape} at {degrees:g} degrees"
    SHAPES[name] = turned_outlines(SHAPES[shape], math.radians(degrees))
    return name


def draw_slide(rng: np.random.Generator, shape: str, direction: float, distance: float) -> Case:
    """Return a slide of a shape in any direction (rad)."""
    way = Point(on_grid(math.cos(direction)), on_grid(math.sin(direction)))
    case = draw_case(rng, shape, way, distance, gap=rng.uniform(0.0, 0.5))
    return replace(case, distance=on_grid(distance))
