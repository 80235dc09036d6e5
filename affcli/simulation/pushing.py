"""The physics of one straight push: a tool slides on the table against the puck (pymunk)."""

import math
from collections.abc import Callable, Sequence
from functools import partial

import pymunk
from pymunk._chipmunk_cffi import lib as chipmunk

from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.workspace import PuckGeometry, SurfaceFriction
from affcli.errors import SimulationDivergedError
from affcli.simulation.contact import travel_to_contact
from affcli.simulation.pace import Pace
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.surface_friction import surface_friction
from affcli.simulation.wrist_motion import STEP, Stretch, distance_of, skip

REST_SPEED = 1e-6
"""The puck rests when it moves slower than this (in/s) and the tool has stopped."""
SETTLE_STEPS = 512
"""Friction stops a puck pushed at 5 in/s within 0.04 s; after a second something is wrong."""
CONTACT_MARGIN = 0.02
"""Start this far before contact (in): two steps at full speed."""

FAR_AWAY = Pose(1e3, 1e3)
"""Where no tool touches the puck (in)."""

Moment = Callable[[float, float, Pose], None]
"""Called after each physics step: seconds since the push began, the tool's travel (in), the puck's
pose."""


class PushSimulator:
    """Pushes of one puck with one tool shape.

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
        self._space = pymunk.Space()
        self._space.iterations = settings.iterations
        self._space.collision_slop = settings.collision_slop
        # The engine wants the share of an overlap that is left after a second.
        self._space.collision_bias = (1.0 - settings.overlap_mended) ** round(1.0 / STEP)
        # 1 is the least that works: with 0 the engine drops a contact before it is solved. No
        # impulse outlives the step after a contact ends.
        self._space.collision_persistence = 1
        self._space.use_spatial_hash(64.0, 16)
        self._puck = pymunk.Body(puck.mass, 0.5 * puck.mass * puck.radius**2)
        rim = pymunk.Circle(self._puck, puck.radius)
        rim.friction = 1.0
        self._tool = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        self._space.add(self._puck, rim, self._tool)
        for outline in self._outlines:
            part = pymunk.Poly(self._tool, list(outline.vertices))
            # The engine multiplies the two coefficients of a contact.
            part.friction = friction.tool_puck
            self._space.add(part)
        joints = surface_friction(self._space.static_body, self._puck, puck, friction)
        self._space.add(*joints)
        self._joints = joints
        # Space.step() looks before and after each step for what callbacks have added or removed.
        # There are none here, and without that a push takes a fifth less time.
        self._step = partial(chipmunk.cpSpaceStep, self._space._space)  # noqa: SLF001
        self._friction_share = joints[0].max_force

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
        gone = elapsed = 0.0
        if not whole and watch is None:
            center = Point(puck.x - wrist.x, puck.y - wrist.y)
            length = distance_of(motion)
            travel = travel_to_contact(self._outlines, direction, length, center, self._radius)
            if travel is None:
                return puck
            gone, motion = skip(motion, max(0.0, travel - CONTACT_MARGIN))
        self._lay_out(puck, Point(wrist.x + gone * direction.x, wrist.y + gone * direction.y))
        pace = Pace(self._outlines, self._radius)
        for speed, steps in motion:
            self._tool.velocity = (speed * direction.x, speed * direction.y)
            left = steps
            while left > 0:
                stride, count = 1, 1
                if left > 1:
                    puck_now, tool_now = self._puck.position, self._tool.position
                    stride, count = pace.next(puck_now, tool_now, speed, left)
                left -= stride * count
                for _ in range(count):
                    self._step(stride * STEP)
                    if watch is not None:
                        elapsed += stride * STEP
                        gone += stride * speed * STEP
                        watch(elapsed, gone, self._puck_pose())
        self._settle(elapsed, gone, watch)
        pose = self._puck_pose()
        if not all(map(math.isfinite, pose)):
            raise SimulationDivergedError(
                f"the push from wrist ({wrist.x:.3f}, {wrist.y:.3f}) with the puck at "
                f"({puck.x:.3f}, {puck.y:.3f}) gave {pose}; the behavior counts for nothing"
            )
        return pose

    def _lay_out(self, puck: Pose, wrist: Point) -> None:
        """Put puck and tool, at rest, where the push begins, with nothing left of the last one."""
        # The engine starts each step from the impulses of the step before, also when that step was
        # the last of another push. A step with the puck far away ends every contact, and one in
        # which the joints may not exceed zero is the only way to make them forget.
        self._place(FAR_AWAY, wrist)
        for joint in self._joints:
            joint.max_force = 0.0
        self._step(STEP)
        for joint in self._joints:
            joint.max_force = self._friction_share
        self._place(puck, wrist)

    def _place(self, puck: Pose, wrist: Point) -> None:
        """Put puck and tool somewhere, at rest."""
        self._puck.angle = puck.angle
        self._puck.position = (puck.x, puck.y)
        self._puck.velocity = (0.0, 0.0)
        self._puck.angular_velocity = 0.0
        self._tool.position = (wrist.x, wrist.y)
        self._tool.velocity = (0.0, 0.0)
        self._space.reindex_shapes_for_body(self._puck)
        self._space.reindex_shapes_for_body(self._tool)

    def _settle(self, elapsed: float, gone: float, watch: Moment | None) -> None:
        """Let the puck come to rest after the tool has stopped."""
        self._tool.velocity = (0.0, 0.0)
        for step in range(1, SETTLE_STEPS + 1):
            if self._puck.velocity.length < REST_SPEED:
                return
            self._step(STEP)
            if watch is not None:
                watch(elapsed + step * STEP, gone, self._puck_pose())

    def _puck_pose(self) -> Pose:
        """Return the puck's pose now."""
        x, y = self._puck.position
        return Pose(x, y, self._puck.angle)
