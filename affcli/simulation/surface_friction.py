"""Friction between the puck and the table.

A puck that presses evenly on the table resists sliding and turning together: the faster it turns
about its own centre, the less it resists being moved sideways. One joint for sliding and one for
turning miss that; a ring of points, each with its share of the weight, gets it right.
"""

import math

import pymunk
from pymunk._chipmunk_cffi import lib as chipmunk

from affcli.core.workspace import PuckGeometry, SurfaceFriction

POINTS = 12
"""Against a quasi-static solver with even pressure, 300 pushes of 5 in end off by 0.001 in in the
median and 0.15 in at most; with 8 points by 0.01 and 0.18, with 6 by 0.03 and 0.28. A few points
favour some directions, and roll a puck along an edge that should only push it."""
RING_RADIUS = 2.0 / 3.0
"""Share of the puck's radius at which a ring resists turning as an even pressure does: the mean
distance of a disc's points from its centre."""


def surface_friction(
    table: pymunk.Body,
    puck: pymunk.Body,
    shape: PuckGeometry,
    friction: SurfaceFriction,
    *,
    straight: bool = False,
) -> list[pymunk.PivotJoint]:
    """Return the joints by which the table brakes the puck, to be added to the Space.

    Each pivot opposes the velocity of one point of the puck with at most its share of the friction
    force. `max_bias` is 0: a pivot brakes, it never pulls the puck back to where it was.

    A puck whose centre of mass lies off its middle by the share e of its radius presses with
    1 + 3 e cos of the even pressure, by the angle from there: then that is where its weight acts.

    Args:
        table, puck: the bodies.
        shape: of the puck.
        friction: all coefficients.
        straight: each joint brakes straight against its point's velocity; see `_straightener`.
    """
    share = friction.puck_table * shape.mass * friction.gravity / POINTS
    heavy = math.radians(shape.mass_direction_degrees)
    joints = []
    for k in range(POINTS):
        angle = 2.0 * math.pi * k / POINTS
        radius = RING_RADIUS * shape.radius
        point = (radius * math.cos(angle), radius * math.sin(angle))
        most = share * (1.0 + 3.0 * shape.mass_offset * math.cos(angle - heavy))
        joints.append(_brake(table, puck, point, most))
    return [*joints, _straightener(table, puck, joints[0])] if straight else joints


def _brake(
    table: pymunk.Body, puck: pymunk.Body, point: tuple[float, float], most: float
) -> pymunk.PivotJoint:
    """Return what opposes the velocity of one point of the puck with at most this force."""
    joint = pymunk.PivotJoint(table, puck, (0.0, 0.0), point)
    joint.max_force = most
    joint.max_bias = 0.0
    # Nothing of a deviation is corrected: told so, the engine need not compute how much.
    joint.error_bias = 1.0
    return joint


def _straightener(
    table: pymunk.Body, puck: pymunk.Body, first: pymunk.PivotJoint
) -> pymunk.PivotJoint:
    """Return what goes after the joints, so that each brakes straight against its point's velocity.

    The engine takes the impulse that would stop a point, and cuts it to the greatest force. Across
    the radius a smaller one stops it, for there the puck gives way by turning; so what is left of
    it points too much along the radius, and a puck turns by a fifth too much. Here the puck cannot
    turn while the joints are prepared, and any point resists alike.
    """
    body, moment = puck._body, puck.moment  # noqa: SLF001
    last = _brake(table, puck, (0.0, 0.0), 0.0)
    first.pre_solve = lambda *_: chipmunk.cpBodySetMoment(body, math.inf)
    last.pre_solve = lambda *_: chipmunk.cpBodySetMoment(body, moment)
    return last
