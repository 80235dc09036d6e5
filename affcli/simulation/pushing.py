"""The physics of one push: a tool slides or turns on the table against the puck (pymunk)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.workspace import PuckGeometry, SurfaceFriction
from affcli.errors import SimulationDivergedError
from affcli.simulation.contact import arc_to_contact, travel_to_contact
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.puck_and_tool import PuckAndTool
from affcli.simulation.strides import Course, Moment, Strides, Surroundings
from affcli.simulation.wrist_motion import STEP, Stretch, distance_of, skip, tip_of

REST_SPEED = 1e-6
"""The puck rests when it moves slower than this (in/s) and the tool has stopped."""
REST_SECONDS = 1.0
"""Friction stops a puck pushed at 5 in/s within 0.04 s; after a second something is wrong."""
NOTHING = 1e-150
"""Nearer to 0 no place or angle is told (in, rad). The engine squares impulses to forget them, and
those below 1e-162 have no square: what they leave would depend on the pushes before."""
CONTACT_MARGIN = 0.02
"""Start this far before contact (in): two steps at full speed."""


class _Way(Protocol):
    """How the tool goes, told by how far it has gone (in)."""

    def lay_out(self, bodies: PuckAndTool, puck: Pose, gone: float) -> None:
        """Put puck and tool where they are, at rest."""

    def to_contact(self, puck: Pose, gone: float, length: float) -> float | None:
        """Return how far the tool surely goes from there before it touches the puck (in)."""

    def course(self, bodies: PuckAndTool) -> Course:
        """Return how it is done."""


@dataclass(frozen=True, slots=True)
class _Slide:
    """A slide of the tool from a wrist position along a direction."""

    outlines: tuple[ConvexPolygon, ...]
    radius: float
    wrist: Point
    direction: Point

    def lay_out(self, bodies: PuckAndTool, puck: Pose, gone: float) -> None:
        x, y = self.direction
        bodies.lay_out(puck, Point(self.wrist.x + gone * x, self.wrist.y + gone * y))

    def to_contact(self, puck: Pose, gone: float, length: float) -> float | None:
        x, y = self.direction
        center = Point(puck.x - self.wrist.x - gone * x, puck.y - self.wrist.y - gone * y)
        return travel_to_contact(self.outlines, self.direction, length, center, self.radius)

    def course(self, bodies: PuckAndTool) -> Course:
        x, y = self.direction

        def move(speed: float) -> None:
            bodies.move_tool((speed * x, speed * y))

        return Course(bodies, move, bodies.puck_from_tool, 1.0)


@dataclass(frozen=True, slots=True)
class _Turn:
    """A turn of the tool about a wrist position, told as an arc at a lever."""

    outlines: tuple[ConvexPolygon, ...]
    radius: float
    wrist: Point
    lever: float

    def lay_out(self, bodies: PuckAndTool, puck: Pose, gone: float) -> None:
        bodies.lay_out(puck, self.wrist, gone / self.lever)

    def to_contact(self, puck: Pose, gone: float, length: float) -> float | None:
        x, y = puck.x - self.wrist.x, puck.y - self.wrist.y
        if gone:
            cos, sin = math.cos(gone / self.lever), math.sin(gone / self.lever)
            x, y = cos * x + sin * y, cos * y - sin * x
        return arc_to_contact(self.outlines, self.lever, length, Point(x, y), self.radius)

    def course(self, bodies: PuckAndTool) -> Course:
        def turn(speed: float) -> None:
            bodies.turn_tool(speed / self.lever)

        fastest = tip_of(self.outlines) / abs(self.lever)
        return Course(bodies, turn, bodies.puck_from_turned_tool, fastest)


class PushSimulator:
    """Pushes of one puck with one tool shape, sliding or turning.

    A push is a pure function of where tool and puck are and of the motion: the Space holds nothing
    over from the push before.

    Args:
        outlines: the tool's convex parts in the tool frame (in).
        puck: the puck.
        friction: all coefficients.
        settings: how finely to solve.
    """

    def __init__(
        self,
        outlines: Sequence[ConvexPolygon],
        puck: PuckGeometry,
        friction: SurfaceFriction,
        settings: PhysicsSettings,
    ) -> None:
        self._outlines = tuple(outlines)
        self._puck, self._friction = puck, friction
        self._around = Surroundings(self._outlines, puck.radius)
        self._bodies = PuckAndTool(self._outlines, puck, friction, settings)

    def push(
        self,
        puck: Pose,
        wrist: Point,
        direction: Point,
        motion: tuple[Stretch, ...],
        watch: Moment | None = None,
        *,
        whole: bool = False,
        finer: int = 0,
    ) -> Pose:
        """Return where the puck comes to rest.

        Args:
            puck: pose of the puck at rest (in, rad, table frame).
            wrist: where the tool's grasp point is (in, table frame, on the wrist's grid).
            direction: unit vector along which the tool moves.
            motion: the stretches of the motion, along `direction`.
            watch: called after each short step; makes the push run whole.
            whole: simulate the motion from its first step. Without it the steps in which nothing
                touches are skipped, and a push that never touches is not simulated; the result is
                the same.
            finer: take no strides, but so many equal steps in each short one.

        Raises:
            SimulationDivergedError: the engine gave a number that is not finite.
        """
        way = _Slide(self._outlines, self._puck.radius, wrist, direction)
        return self._run(way, puck, motion, watch, whole=whole, finer=finer)

    def turn(
        self,
        puck: Pose,
        wrist: Point,
        lever: float,
        motion: tuple[Stretch, ...],
        watch: Moment | None = None,
        *,
        whole: bool = False,
        finer: int = 0,
    ) -> Pose:
        """Return where the puck comes to rest when the tool turns about the wrist.

        Args:
            puck, wrist, watch, whole, finer: as for `push`.
            lever: at which the arc of the motion is told: a power of two, or its negative to turn
                clockwise (in).
            motion: the stretches of the arc.

        Raises:
            SimulationDivergedError: the engine gave a number that is not finite.
        """
        way = _Turn(self._outlines, self._puck.radius, wrist, lever)
        return self._run(way, puck, motion, watch, whole=whole, finer=finer)

    def _run(
        self,
        way: _Way,
        puck: Pose,
        motion: tuple[Stretch, ...],
        watch: Moment | None,
        *,
        whole: bool,
        finer: int,
    ) -> Pose:
        """Run a motion to its end, from each contact until the puck lies still behind the tool."""
        bodies, elapsed, gone = self._bodies, 0.0, 0.0
        whole = whole or watch is not None
        while motion:
            if not whole:
                travel = way.to_contact(puck, gone, distance_of(motion))
                if travel is None:
                    break
                skipped, motion = skip(motion, max(0.0, travel - CONTACT_MARGIN))
                gone += skipped
            way.lay_out(bodies, puck, gone)
            course = way.course(bodies)
            if finer:
                in_equal_steps(course, motion, finer)
                motion = ()
            else:
                given = (course, self._around, self._puck, self._friction)
                strides = Strides(*given, watch, elapsed, gone)
                length, motion = distance_of(motion), strides.run(motion)
                elapsed, gone = strides.elapsed, gone + length - distance_of(motion)
            puck = _where(bodies, puck)
        return puck


def in_equal_steps(course: Course, motion: tuple[Stretch, ...], finer: int) -> None:
    """Take a push to its end in equal steps: the simple way, which `Strides` is held against.

    Args:
        course: the push, laid out.
        motion: the stretches that are left.
        finer: so many steps in each short one.
    """
    bodies, step = course.bodies, STEP / finer
    bodies.other_steps(step)
    for speed, steps in motion:
        course.move(speed)
        for _ in range(steps * finer):
            bodies.step(step)
            bodies.align_brakes()
    course.move(0.0)
    for _ in range(round(REST_SECONDS / step)):
        if math.hypot(*bodies.velocity()[:2]) < REST_SPEED:
            return
        bodies.step(step)


def _where(bodies: PuckAndTool, before: Pose) -> Pose:
    """Return where the puck lies now; SimulationDivergedError when that is nowhere."""
    pose = Pose(
        *(
            0.0 if abs(part) < NOTHING and part != was else part
            for part, was in zip(bodies.puck_pose(), before, strict=True)
        )
    )
    if not all(map(math.isfinite, pose)):
        raise SimulationDivergedError(
            f"the push of the puck from ({before.x:.3f}, {before.y:.3f}) gave {pose}; the behavior "
            "counts for nothing"
        )
    return pose
