"""A puck and a tool on the table, as bodies of the physics engine (pymunk)."""

import math
import weakref
from collections.abc import Callable, Sequence
from functools import partial

import pymunk
from pymunk._chipmunk_cffi import lib as chipmunk

from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.workspace import PuckGeometry, SurfaceFriction
from affcli.memory import ask_for
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.surface_friction import surface_friction
from affcli.simulation.wrist_motion import STEP

FAR_AWAY = (1e3, 1e3)
"""Where no tool touches the puck (in)."""
AT_REST = (0.0, 0.0)
ROOM = 4 << 20
"""Bytes that are free where a simulation begins. The engine takes memory in blocks of 32 kB, and
where it gets none the process ends (SIGSEGV)."""


class PuckAndTool:
    """One Space with the puck, which the table brakes, and the tool, which goes where it is moved.

    What happens many times a push calls the engine's own functions: pymunk's wrappers of the same
    functions, which make vectors and look for callbacks that we do not have, would cost as much as
    the physics.

    Args:
        outlines: the tool's convex parts in the tool frame (in).
        puck: the puck.
        friction: all coefficients.
        settings: how finely to solve.

    Attributes:
        step: advances everything by a time (s).
        move_tool: gives the tool a velocity (in/s, table frame), which it keeps.
        turn_tool: gives it an angular velocity about its grasp point (rad/s), which it keeps.
    """

    step: Callable[[float], None]
    move_tool: Callable[[tuple[float, float]], None]
    turn_tool: Callable[[float], None]

    def __init__(
        self,
        outlines: Sequence[ConvexPolygon],
        puck: PuckGeometry,
        friction: SurfaceFriction,
        settings: PhysicsSettings,
    ) -> None:
        ask_for(ROOM)
        space = pymunk.Space()
        space.iterations = settings.iterations
        space.collision_slop = settings.collision_slop
        # The engine wants the share of an overlap that is left after a second.
        space.collision_bias = (1.0 - settings.overlap_mended) ** round(1.0 / STEP)
        # 1 is the least that works: with 0 the engine drops a contact before it is solved. No
        # impulse outlives the step after a contact ends.
        space.collision_persistence = 1
        space.use_spatial_hash(64.0, 16)
        off = puck.mass_offset * puck.radius
        body = pymunk.Body(puck.mass, puck.mass * (0.5 * puck.radius**2 - off**2))
        if off:
            heavy = math.radians(puck.mass_direction_degrees)
            body.center_of_gravity = (off * math.cos(heavy), off * math.sin(heavy))
        rim = pymunk.Circle(body, puck.radius)
        rim.friction = 1.0
        tool = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        space.add(body, rim, tool)
        for outline in outlines:
            part = pymunk.Poly(tool, list(outline.vertices))
            # The engine multiplies the two coefficients of a contact.
            part.friction = friction.tool_puck
            space.add(part)
        brakes = surface_friction(body, puck, friction)
        space.add(*brakes.joints)
        self._owned = (space, body, rim, tool, brakes)  # the engine does not keep them alive
        # A space that is freed goes over what is in it, and the program is aborted when garbage is
        # collected meanwhile that a body is in: so nothing is left in it.
        weakref.finalize(self, _empty, space).atexit = False
        self._space, self._puck, self._tool = space._space, body._body, tool._body  # noqa: SLF001
        self._counterpart = brakes.counterpart._body  # noqa: SLF001
        self._joints = [(joint._constraint, joint.max_force) for joint in brakes.joints]  # noqa: SLF001
        self._mass, self._moment = body.mass, body.moment
        self.step = partial(chipmunk.cpSpaceStep, self._space)
        self._sweeps = settings.iterations
        self.move_tool = partial(chipmunk.cpBodySetVelocity, self._tool)
        self.turn_tool = partial(chipmunk.cpBodySetAngularVelocity, self._tool)

    def lay_out(self, puck: Pose, wrist: Point, turned: float = 0.0) -> None:
        """Put puck and tool somewhere, at rest, with nothing left of the push before.

        Args:
            puck: the puck's pose (in, rad, table frame).
            wrist: where the tool's grasp point is (in, table frame).
            turned: by how much the tool is turned about it (rad).
        """
        # The engine starts each step from the impulses of the step before, also when that step was
        # the last of another push. A step with the puck far away ends every contact, and one in
        # which the joints may not exceed zero is the only way to make them forget.
        self.other_steps(STEP)
        self._place(Pose(*FAR_AWAY), wrist, turned)
        for joint, _ in self._joints:
            chipmunk.cpConstraintSetMaxForce(joint, 0.0)
        self.step(STEP)
        for joint, share in self._joints:
            chipmunk.cpConstraintSetMaxForce(joint, share)
        self._place(puck, wrist, turned)
        self.align_brakes()
        chipmunk.cpBodySetVelocity(self._counterpart, AT_REST)

    def _place(self, puck: Pose, wrist: Point, turned: float) -> None:
        """Put puck and tool somewhere, at rest."""
        # The angle first: setting it later would move the body about its centre of gravity.
        chipmunk.cpBodySetAngle(self._puck, puck.angle)
        chipmunk.cpBodySetPosition(self._puck, (puck.x, puck.y))
        chipmunk.cpBodySetVelocity(self._puck, AT_REST)
        chipmunk.cpBodySetAngularVelocity(self._puck, 0.0)
        chipmunk.cpBodySetAngle(self._tool, turned)
        chipmunk.cpBodySetPosition(self._tool, wrist)
        chipmunk.cpBodySetVelocity(self._tool, AT_REST)
        chipmunk.cpBodySetAngularVelocity(self._tool, 0.0)
        chipmunk.cpSpaceReindexShapesForBody(self._space, self._puck)
        chipmunk.cpSpaceReindexShapesForBody(self._space, self._tool)

    def other_steps(self, seconds: float) -> None:
        """Prepare for steps of another length.

        The engine begins each step from the impulses of the one before. It scales them by the
        lengths of the two, but what it adds to them it limits as if it had not: so it is told that
        the step before was as long. In a long step friction can do more, and it takes the solver
        more sweeps to find what it does.

        Args:
            seconds: how long (s).
        """
        chipmunk.cpSpaceSetCurrentTimeStep(self._space, seconds)
        chipmunk.cpSpaceSetIterations(self._space, self._sweeps + int(seconds / STEP) // 2)

    def puck_pose(self) -> Pose:
        """Return the puck's pose now (in, rad, table frame)."""
        at = chipmunk.cpBodyGetPosition(self._puck)
        return Pose(at.x, at.y, chipmunk.cpBodyGetAngle(self._puck))

    def puck_from_tool(self) -> tuple[float, float]:
        """Return where the puck's centre is now, seen from the tool's grasp point (in)."""
        puck = chipmunk.cpBodyGetPosition(self._puck)
        tool = chipmunk.cpBodyGetPosition(self._tool)
        return puck.x - tool.x, puck.y - tool.y

    def puck_from_turned_tool(self) -> tuple[float, float]:
        """Return the same in axes that turn with the tool (in)."""
        at = chipmunk.cpBodyWorldToLocal(self._tool, chipmunk.cpBodyGetPosition(self._puck))
        return at.x, at.y

    def velocity(self) -> tuple[float, float, float]:
        """Return how fast the puck's centre of mass moves and the puck turns now (in/s, rad/s)."""
        moves = chipmunk.cpBodyGetVelocity(self._puck)
        return moves.x, moves.y, chipmunk.cpBodyGetAngularVelocity(self._puck)

    def set_velocity(self, x: float, y: float, turning: float) -> None:
        """Give the puck another velocity (in/s, rad/s)."""
        chipmunk.cpBodySetVelocity(self._puck, (x, y))
        chipmunk.cpBodySetAngularVelocity(self._puck, turning)

    def accelerate(self, x: float, y: float, turning: float) -> None:
        """Let a force and a torque act in the next step that would accelerate the puck so much if
        nothing else did (in/s^2, rad/s^2).
        """
        chipmunk.cpBodySetForce(self._puck, (self._mass * x, self._mass * y))
        chipmunk.cpBodySetTorque(self._puck, self._moment * turning)

    def shift(self, x: float, y: float, turn: float) -> None:
        """Move the puck a little (in), and turn it about its centre of mass (rad)."""
        puck = self._puck
        chipmunk.cpBodySetAngle(puck, chipmunk.cpBodyGetAngle(puck) + turn)
        at = chipmunk.cpBodyGetPosition(puck)
        chipmunk.cpBodySetPosition(puck, (at.x + x, at.y + y))

    def align_brakes(self) -> None:
        """Turn what makes the brakes act straight as the puck is turned now."""
        chipmunk.cpBodySetAngle(self._counterpart, chipmunk.cpBodyGetAngle(self._puck))
        chipmunk.cpBodySetAngularVelocity(self._counterpart, 0.0)


def _empty(space: pymunk.Space) -> None:
    """Take everything out of a space."""
    space.remove(*space.shapes, *space.constraints, *space.bodies)
