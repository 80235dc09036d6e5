"""Friction between the puck and the table.

A puck that presses evenly on the table resists sliding and turning together: the faster it turns
about its own centre, the less it resists being moved sideways. One joint for sliding and one for
turning miss that; points with a share of the weight each get it right.
"""

import math
from typing import NamedTuple

import pymunk

from affcli.core.workspace import PuckGeometry, SurfaceFriction


class Ring(NamedTuple):
    """So many points, an even number, at a share of the puck's radius."""

    points: int
    radius: float


RINGS = (Ring(4, 2.0 / 3.0 * math.sqrt(1.0 / 3.0)), Ring(8, 1.0 - math.sqrt(1.0 / 27.0)))
"""One ring for the inner third of the area and one for the rest, each at the mean distance of its
area's points from the centre. Against a quasi-static solver with even pressure, at 1.25 in/s, 300
pushes of 5 in turn by 0.2 degrees too much in the median and 5.5 at most; with twelve points in one
ring by 0.7 and 11, with three and six by 0.5 and 13."""
POINTS = sum(ring.points for ring in RINGS)
GIVES_WAY = 1e300
"""The mass of what never moves and only turns (kg); the engine takes none that is infinite."""


class Brakes(NamedTuple):
    """What brakes the puck.

    Args:
        joints: to be added to the Space.
        counterpart: a body that stays out of the Space, and is to be turned as the puck is, to some
            degrees.
    """

    joints: list[pymunk.PivotJoint]
    counterpart: pymunk.Body


class Place(NamedTuple):
    """A point where the puck is braked, from its middle (in, the puck's own frame).

    Args:
        x, y: the point (in).
        side: 1 or -1, other than that of its neighbours on the ring.
    """

    x: float
    y: float
    side: float


def places(radius: float) -> list[Place]:
    """Return where a puck of this radius is braked: opposite points after each other.

    The solver takes the joints in turn. One that follows its opposite makes good what that one did
    to the puck's turning, so mirrored pushes end mirrored after few sweeps.
    """
    return [
        Place(ring.radius * radius * math.cos(angle), ring.radius * radius * math.sin(angle), side)
        for ring in RINGS
        for k in range(ring.points // 2)
        for angle, side in (
            (2.0 * math.pi * n / ring.points, -1.0 if n % 2 else 1.0)
            for n in (k, k + ring.points // 2)
        )
    ]


def surface_friction(puck: pymunk.Body, shape: PuckGeometry, friction: SurfaceFriction) -> Brakes:
    """Return the joints by which the table brakes the puck.

    Each pivot opposes the velocity of one point of the puck with at most its share of the friction
    force. `max_bias` is 0: a pivot brakes, it never pulls the puck back to where it was.

    A puck whose centre of mass lies off its middle by the share e of its radius presses with
    1 + 3 e cos of the even pressure, by the angle from there: then that is where its weight acts.

    The engine takes the impulse that would stop a point, and cuts it to the greatest force. Across
    the radius a smaller one stops it, for there the puck gives way by turning; so what is left of
    it would point too much along the radius, and a puck would turn by a fifth too much. Hence the
    joints do not hold the puck to the table but to a counterpart, which can turn as easily as the
    puck does, by arms across those of the puck: it gives way along the radius by as much, so any
    point resists alike in all directions. On each ring every other arm points the other way, so
    what turns the counterpart cancels, and it stands still as the table does.

    Args:
        puck: the body.
        shape: of the puck.
        friction: all coefficients.
    """
    share = friction.puck_table * shape.mass * friction.gravity / POINTS
    heavy = math.radians(shape.mass_direction_degrees)
    middle = puck.center_of_gravity
    counterpart = pymunk.Body(GIVES_WAY, puck.moment)
    joints = []
    for x, y, side in places(shape.radius):
        arm = (-side * (y - middle.y), side * (x - middle.x))
        joint = pymunk.PivotJoint(counterpart, puck, arm, (x, y))
        angle = math.atan2(y, x)
        joint.max_force = share * (1.0 + 3.0 * shape.mass_offset * math.cos(angle - heavy))
        joint.max_bias = 0.0
        # Nothing of a deviation is corrected: told so, the engine need not compute how much.
        joint.error_bias = 1.0
        joints.append(joint)
    return Brakes(joints, counterpart)
