"""The physics of one push: a tool slides or turns on the table against the puck (pymunk)."""

import math
from collections.abc import Callable, Sequence
from functools import cached_property, partial

from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.workspace import PuckGeometry, SurfaceFriction
from affcli.errors import SimulationDivergedError
from affcli.simulation.contact import arc_to_contact, travel_to_contact
from affcli.simulation.pace import Pace
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.puck_and_tool import PuckAndTool
from affcli.simulation.wrist_motion import STEP, Stretch, distance_of, skip, tip_of

REST_SPEED = 1e-6
"""The puck rests when it moves slower than this (in/s) and the tool has stopped."""
SETTLE_STEPS = 512
"""Friction stops a puck pushed at 5 in/s within 0.04 s; after a second something is wrong."""
CONTACT_MARGIN = 0.02
"""Start this far before contact (in): two steps at full speed."""

Moment = Callable[[float, float, Pose], None]
"""Called after each physics step: seconds since the push began, the tool's travel or arc (in), the
puck's pose."""


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
        self._radius = puck.radius
        self._tip = tip_of(self._outlines)
        self._bodies = partial(PuckAndTool, self._outlines, puck, friction, settings)
        # Straight pushes of an even puck, which all stored runs are made of, keep the friction that
        # they had: so these runs can be done again to the bit.
        self._straight = puck.mass_offset > 0.0
        self._sliding = self._bodies(straight=self._straight)

    @cached_property
    def _turning(self) -> PuckAndTool:
        """The bodies of turns, made when they are first needed."""
        return self._sliding if self._straight else self._bodies(straight=True)

    def push(
        self,
        puck: Pose,
        wrist: Point,
        direction: Point,
        motion: tuple[Stretch, ...],
        watch: Moment | None = None,
        *,
        whole: bool = False,
    ) -> Pose:
        """Return where the puck comes to rest.

        Args:
            puck: pose of the puck at rest (in, rad, table frame).
            wrist: where the tool's grasp point is (in, table frame, on the wrist's grid).
            direction: unit vector along which the tool moves.
            motion: the stretches of the motion, along `direction`.
            watch: called after each physics step; makes the push run whole.
            whole: simulate the motion from its first step. Without it the steps before contact are
                skipped, and a push that never touches is not simulated; the result is the same.

        Raises:
            SimulationDivergedError: the engine gave a number that is not finite.
        """
        gone = 0.0
        if not whole and watch is None:
            center = Point(puck.x - wrist.x, puck.y - wrist.y)
            length = distance_of(motion)
            travel = travel_to_contact(self._outlines, direction, length, center, self._radius)
            if travel is None:
                return puck
            gone, motion = skip(motion, max(0.0, travel - CONTACT_MARGIN))
        table = self._sliding
        table.lay_out(puck, Point(wrist.x + gone * direction.x, wrist.y + gone * direction.y))

        def move(speed: float) -> None:
            table.move_tool((speed * direction.x, speed * direction.y))

        self._simulate(table, move, 1.0, table.puck_from_tool, motion, gone, watch)
        return _rest(table, puck, wrist)

    def turn(
        self,
        puck: Pose,
        wrist: Point,
        lever: float,
        motion: tuple[Stretch, ...],
        watch: Moment | None = None,
        *,
        whole: bool = False,
    ) -> Pose:
        """Return where the puck comes to rest when the tool turns about the wrist.

        Args:
            puck, wrist, watch, whole: as for `push`.
            lever: at which the arc of the motion is told: a power of two, or its negative to turn
                clockwise (in).
            motion: the stretches of the arc.

        Raises:
            SimulationDivergedError: the engine gave a number that is not finite.
        """
        gone = 0.0
        if not whole and watch is None:
            center = Point(puck.x - wrist.x, puck.y - wrist.y)
            length = distance_of(motion)
            arc = arc_to_contact(self._outlines, lever, length, center, self._radius)
            if arc is None:
                return puck
            gone, motion = skip(motion, max(0.0, arc - CONTACT_MARGIN))
        table = self._turning
        table.lay_out(puck, wrist, gone / lever)

        def turn(speed: float) -> None:
            table.turn_tool(speed / lever)

        fastest, seen = self._tip / abs(lever), table.puck_from_turned_tool
        self._simulate(table, turn, fastest, seen, motion, gone, watch)
        return _rest(table, puck, wrist)

    def _simulate(
        self,
        table: PuckAndTool,
        move: Callable[[float], None],
        fastest: float,
        seen: Callable[[], tuple[float, float]],
        motion: tuple[Stretch, ...],
        gone: float,
        watch: Moment | None,
    ) -> None:
        """Run a motion from where everything was laid out until the puck rests.

        Args:
            table: the bodies.
            move: gives the tool a speed (in/s).
            fastest: no point of the tool moves faster than this many times that speed.
            seen: gives where the puck is in the tool's own frame (in).
            motion: the stretches that are left.
            gone: how far the tool is already (in).
            watch: called after each physics step.
        """
        elapsed = 0.0
        pace = Pace(self._outlines, self._radius)
        for speed, steps in motion:
            move(speed)
            left = steps
            while left > 0:
                stride, count = 1, 1
                if left > 1:
                    stride, count = pace.next(seen(), fastest * speed, left)
                left -= stride * count
                for _ in range(count):
                    table.step(stride * STEP)
                    if watch is not None:
                        elapsed += stride * STEP
                        gone += stride * speed * STEP
                        watch(elapsed, gone, table.puck_pose())
        move(0.0)
        _settle(table, elapsed, gone, watch)


def _settle(table: PuckAndTool, elapsed: float, gone: float, watch: Moment | None) -> None:
    """Let the puck come to rest after the tool has stopped."""
    for step in range(1, SETTLE_STEPS + 1):
        if table.puck_speed() < REST_SPEED:
            return
        table.step(STEP)
        if watch is not None:
            watch(elapsed + step * STEP, gone, table.puck_pose())


def _rest(table: PuckAndTool, puck: Pose, wrist: Point) -> Pose:
    """Return where the puck lies now; SimulationDivergedError when that is nowhere."""
    pose = table.puck_pose()
    if not all(map(math.isfinite, pose)):
        raise SimulationDivergedError(
            f"the push from wrist ({wrist.x:.3f}, {wrist.y:.3f}) with the puck at "
            f"({puck.x:.3f}, {puck.y:.3f}) gave {pose}; the behavior counts for nothing"
        )
    return pose
