"""Friction between the puck and the table.

A puck that presses evenly on the table resists sliding and turning together: the faster it turns
about its own centre, the less it resists being moved sideways. One joint for sliding and one for
turning miss that; a set of points, each with its share of the weight, gets it right.
"""

import math

import pymunk

from affcli.core.workspace import PuckGeometry, SurfaceFriction

POINTS_A_RING = 4
RING_RADII = (0.4714, 0.8619)
"""Radii of the two rings as shares of the puck's radius: where the inner and the outer half of a
disc's area have their mean distance from the centre. Both rings of four then resist turning as an
even pressure does (mean distance 2/3 of the radius)."""


def surface_friction(
    table: pymunk.Body, puck: pymunk.Body, shape: PuckGeometry, friction: SurfaceFriction
) -> list[pymunk.PivotJoint]:
    """Return the joints by which the table brakes the puck, to be added to the Space.

    Each pivot opposes the velocity of one point of the puck with at most its share of the friction
    force. `max_bias` is 0: a pivot brakes, it never pulls the puck back to where it was.
    """
    share = friction.puck_table * shape.mass * friction.gravity / (POINTS_A_RING * len(RING_RADII))
    joints = []
    for ring, relative in enumerate(RING_RADII):
        for k in range(POINTS_A_RING):
            angle = math.pi * (k + 0.5 * ring) * 2.0 / POINTS_A_RING
            point = (
                relative * shape.radius * math.cos(angle),
                relative * shape.radius * math.sin(angle),
            )
            joint = pymunk.PivotJoint(table, puck, (0.0, 0.0), point)
            joint.max_force = share
            joint.max_bias = 0.0
            joints.append(joint)
    return joints
