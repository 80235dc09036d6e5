"""A push as one would write it in pymunk: a Space for each, one step size, from beginning to end.

The same shapes, joints and settings as affcli's own push, and none of its ways to do less: it
simulates what comes before contact, misses as well as hits, never takes a longer step, and calls
pymunk as its documentation does.
"""

import pymunk
from workload import OUTLINES, SETTINGS, Push

from affcli.core.geometry import Pose
from affcli.simulation.pushing import REST_SPEED
from affcli.simulation.surface_friction import surface_friction
from affcli.simulation.wrist_motion import STEP

DEAD = 1.0
"""Stop at the latest so long after the tool has stopped (s)."""


def push_plainly(push: Push) -> Pose:
    """Return where the puck comes to rest."""
    space, puck, tool, counterpart = _world()
    puck.angle, puck.position = push.puck.angle, push.puck.point
    tool.position = push.wrist
    for speed, steps in push.motion:
        tool.velocity = (speed * push.direction.x, speed * push.direction.y)
        for _ in range(steps):
            space.step(STEP)
            counterpart.angle = puck.angle
    tool.velocity = (0.0, 0.0)
    for _ in range(round(DEAD / STEP)):
        if puck.velocity.length < REST_SPEED:
            break
        space.step(STEP)
    return Pose(puck.position.x, puck.position.y, puck.angle)


def _world() -> tuple[pymunk.Space, pymunk.Body, pymunk.Body, pymunk.Body]:
    """Return a Space with puck and tool, the two, and what makes the puck's brakes act straight."""
    shape, friction, physics = (
        SETTINGS.workspace.puck,
        SETTINGS.workspace.friction,
        SETTINGS.physics,
    )
    space = pymunk.Space()
    space.iterations = physics.iterations
    space.collision_slop = physics.collision_slop
    space.collision_bias = (1.0 - physics.overlap_mended) ** round(1.0 / STEP)
    puck = pymunk.Body(shape.mass, 0.5 * shape.mass * shape.radius**2)
    rim = pymunk.Circle(puck, shape.radius)
    rim.friction = 1.0
    tool = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    parts = [pymunk.Poly(tool, list(outline.vertices)) for outline in OUTLINES]
    for part in parts:
        part.friction = friction.tool_puck
    brakes = surface_friction(puck, shape, friction)
    space.add(puck, rim, tool, *parts, *brakes.joints)
    return space, puck, tool, brakes.counterpart
