"""The quasi-static solver has converged and agrees with what is known in closed form."""

import math
import sys

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from affcli.core.geometry import ConvexPolygon, Point, Pose
from tests.physics.pushes import AHEAD, RADIUS, RIGHT, WORKSPACE, draw_cases, fork, seat
from tests.physics.quasi_static import (
    NODES,
    STRIDE,
    Array,
    Push,
    contact_law,
    limit_surface,
    push_all,
)

FRICTION = WORKSPACE.friction.tool_puck
NEEDLE = (ConvexPolygon((Point(0.0, 0.0), Point(-4.0, 1e-4), Point(-4.0, -1e-4))),)
"""As good as a point that is pushed along +x."""


def moved(
    parts: tuple[ConvexPolygon, ...],
    center: Point,
    direction: Point = RIGHT,
    length: float = 1.0,
    friction: float = FRICTION,
) -> Array:
    """Return the displacement (in, in) and turn (rad) of a disc that one push meets at `center`."""
    end = push_all([Push(parts, direction, length, Pose(*center))], RADIUS, friction)[0]
    shift: Array = end - np.array([*center, 0.0])
    return shift


def edge_facing(degrees: float) -> tuple[ConvexPolygon, ...]:
    """Return a half-plane, 40 in wide, through the origin, that faces `degrees` above +x."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    corners = ((0.0, 20.0), (-5.0, 20.0), (-5.0, -20.0), (0.0, -20.0))
    return (ConvexPolygon(tuple(Point(c * x - s * y, s * x + c * y) for x, y in corners)),)


def at_angle(degrees: float) -> Point:
    """Return the centre of a disc that touches the origin from the direction `degrees`."""
    angle = math.radians(degrees)
    return Point(RADIUS * math.cos(angle), RADIUS * math.sin(angle))


@pytest.mark.parametrize("distance", [0.0, 0.3, 0.9, 1.1, 2.0, 30.0])
def test_the_limit_surface_is_the_sum_over_small_areas_of_the_disc(distance: float) -> None:
    rings, spokes = 400, 800
    radius = (np.arange(rings) + 0.5)[:, None] / rings
    angle = (np.arange(spokes) + 0.5) * 2.0 * np.pi / spokes
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    share = radius * 2.0 / (rings * spokes)
    speed = np.hypot(x + distance, y)
    force = np.sum(share * (x + distance) / speed)
    torque = np.sum(share * (x * (x + distance) + y * y) / speed)
    assert limit_surface(distance) == pytest.approx((force, torque), abs=2e-5)


def test_the_limit_surface_has_its_known_values() -> None:
    """A disc that spins resists with 2/3 mu m g R; about a point of its rim, 8/(3 pi), 8/(9 pi)."""
    assert limit_surface(0.0) == pytest.approx((0.0, 2.0 / 3.0), abs=1e-12)
    assert limit_surface(1.0) == pytest.approx((8 / (3 * np.pi), 8 / (9 * np.pi)), abs=1e-9)
    assert limit_surface(1e6) == pytest.approx((1.0, 0.25e-6), rel=1e-9)


@pytest.mark.parametrize("distance", [0.1, 0.99, 0.9999, 1.0001, 1.01, 5.0])
def test_more_angles_do_not_change_the_limit_surface(distance: float) -> None:
    fine = limit_surface(distance, 64 * NODES)
    assert limit_surface(distance) == pytest.approx(fine, abs=1e-6)


@pytest.mark.parametrize("degrees", [0.0, 10.0, -25.0, 40.0])
def test_a_sticking_contact_turns_the_disc_so_that_friction_takes_the_least_power(
    degrees: float,
) -> None:
    """Among all turns that keep the rim with the tool; no contact law is used to find it."""
    contact = -np.array(at_angle(degrees))
    tool = np.array(RIGHT)

    def velocity(turn: float) -> Array:
        return np.array([tool[0] + turn * contact[1], tool[1] - turn * contact[0]])

    def power(turn: float) -> float:
        speed = float(np.hypot(*velocity(turn)))
        force, torque = limit_surface(speed / max(abs(turn) * RADIUS, 1e-12))
        return speed * force + abs(turn) * RADIUS * torque

    best = minimize_scalar(power, bracket=(-0.5, 0.5), tol=1e-10).x
    length = 1e-3
    found = moved(edge_facing(degrees), at_angle(degrees), RIGHT, length) / length
    assert found == pytest.approx([*velocity(best), best], abs=2e-4)


def test_the_contact_slides_when_the_tool_passes_by_faster_than_the_rim_can_follow() -> None:
    law = contact_law(FRICTION)
    assert law.force[[0, -1]] == pytest.approx([-FRICTION, FRICTION])
    assert np.all(np.diff(law.rim) > 0.0)
    aside, _ = law(np.array([1.0, 1.0]), np.array([-50.0, 50.0]), np.zeros(2))
    assert aside == pytest.approx([-FRICTION, FRICTION])


def test_a_straight_edge_takes_the_disc_along() -> None:
    assert moved(edge_facing(0.0), at_angle(0.0), length=2.0) == pytest.approx([2.0, 0.0, 0.0])


def test_a_point_that_pushes_through_the_centre_takes_the_disc_along() -> None:
    assert moved(NEEDLE, at_angle(0.0), length=2.0) == pytest.approx([2.0, 0.0, 0.0])


@pytest.mark.parametrize("degrees", [-50.0, 20.0, 70.0])
def test_without_friction_an_inclined_edge_moves_the_disc_along_its_normal(degrees: float) -> None:
    shift = math.cos(math.radians(degrees)) * np.array(at_angle(degrees)) / RADIUS
    found = moved(edge_facing(degrees), at_angle(degrees), friction=0.0)
    assert found == pytest.approx([*shift, 0.0], abs=1e-6)


@pytest.mark.parametrize("degrees", [60.0, 75.0])
def test_an_edge_that_slides_along_the_rim_moves_the_disc_along_the_edge_of_the_friction_cone(
    degrees: float,
) -> None:
    cone = math.radians(degrees) - math.atan(FRICTION)
    normal = math.cos(math.radians(degrees))
    length = normal * math.hypot(1.0, FRICTION)
    found = moved(edge_facing(degrees), at_angle(degrees))[:2]
    assert found == pytest.approx([length * math.cos(cone), length * math.sin(cone)], abs=1e-6)


@pytest.mark.parametrize(
    ("friction", "degrees"), [(0.0, 25.0), (0.0, 45.0), (0.25, 50.0), (0.25, 60.0)]
)
def test_the_disc_rolls_off_a_point_as_the_closed_form_says(
    friction: float, degrees: float
) -> None:
    """The centre stays at R from the point, in the direction a with R a' = sin a - mu cos a.

    That is the velocity along the edge of the friction cone, while the contact slides; it
    integrates to tan((a - b) / 2) growing by exp(sqrt(1 + mu^2) / R) an inch, with b = atan(mu).
    """
    length = 0.5
    cone = math.atan(friction)
    growth = math.exp(math.hypot(1.0, friction) * length / RADIUS)
    half = math.atan(math.tan((math.radians(degrees) - cone) / 2.0) * growth)
    end = at_angle(math.degrees(cone + 2.0 * half))
    start = at_angle(degrees)
    found = moved(NEEDLE, start, RIGHT, length, friction)[:2]
    assert found == pytest.approx([end.x + length - start.x, end.y - start.y], abs=1e-3)


def test_the_disc_stays_behind_when_it_has_rolled_off_a_point() -> None:
    first = moved(NEEDLE, at_angle(60.0), length=2.0, friction=0.0)
    assert at_angle(60.0).y + first[1] == pytest.approx(RADIUS, abs=2e-3)
    assert moved(NEEDLE, at_angle(60.0), length=3.0, friction=0.0) == pytest.approx(first, abs=1e-4)


def test_a_disc_that_the_tool_misses_stays() -> None:
    assert np.all(moved(NEEDLE, Point(2.0, 1.6), length=5.0) == 0.0)


@pytest.mark.parametrize(("left", "right"), [(45.0, 45.0), (20.0, 60.0), (75.0, 15.0)])
def test_two_loaded_contacts_take_the_disc_along_without_turning_it(
    left: float, right: float
) -> None:
    found = moved(fork(left, right), seat(left, right), AHEAD, 2.0)
    assert found == pytest.approx([0.0, 2.0, 0.0], abs=1e-6)


def test_finer_steps_and_a_finer_quadrature_change_no_end_by_a_hundredth_of_an_inch() -> None:
    """Half the step and twice the angles, over pushes of every shape and direction."""
    pushes = [case.quasi_static for case in draw_cases(seed=11, each=2)]
    coarse = push_all(pushes, RADIUS, FRICTION)
    fine = push_all(pushes, RADIUS, FRICTION, STRIDE / 2.0, 2 * NODES)
    change = np.hypot(*(coarse - fine)[:, :2].T)
    sys.stdout.write(f"\n{len(pushes)} pushes, step halved: at most {change.max():.4f} in\n")
    assert change.max() < 0.01
