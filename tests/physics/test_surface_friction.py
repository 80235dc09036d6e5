"""The pivots that brake the puck do what an even pressure on the table does."""

import math

import pymunk
import pytest

from affcli.core.geometry import Point, Pose
from affcli.simulation.surface_friction import surface_friction
from affcli.simulation.wrist_motion import STEP, Stretch, trapezoid
from tests.physics.pushes import AHEAD, RADIUS, WORKSPACE, simulator
from tests.physics.quasi_static import limit_surface

FRICTION = WORKSPACE.friction
PUCK = WORKSPACE.puck
BRAKE = FRICTION.puck_table * FRICTION.gravity
"""Deceleration of a puck that slides without turning (in/s^2)."""
SPEED = WORKSPACE.motion.push_speed


def slide(
    speed: float, spin: float, heading: float, step: float = STEP / 16
) -> tuple[float, float]:
    """Return how far (in) and how much (rad) a free puck slides and turns until it rests.

    Args:
        speed: at the beginning (in/s).
        spin: at the beginning (rad/s).
        heading: direction of the motion against the puck's own frame (rad).
        step: time step (s); fine, since the law is tested here and not the integration.
    """
    space = pymunk.Space()
    space.iterations = 50
    body = pymunk.Body(PUCK.mass, 0.5 * PUCK.mass * RADIUS**2)
    brakes = surface_friction(body, PUCK, FRICTION)
    space.add(body, *brakes.joints)
    body.velocity = (speed * math.cos(heading), speed * math.sin(heading))
    body.angular_velocity = spin
    while body.velocity.length > 1e-3 or abs(body.angular_velocity) > 1e-3:
        space.step(step)
        brakes.counterpart.angle = body.angle
    return body.position.length, body.angle


def slide_of_a_disc(speed: float, spin: float, step: float = STEP / 64) -> tuple[float, float]:
    """Return the same for a disc with an even pressure, by the integral over its area."""
    distance = angle = 0.0
    while speed > 1e-3 or spin > 1e-3:
        turning_point = speed / max(spin * RADIUS, 1e-9)
        force, torque = limit_surface(turning_point, 64)
        distance += speed * step
        angle += spin * step
        speed = max(0.0, speed - BRAKE * force * step)
        spin = max(0.0, spin - 2.0 * BRAKE / RADIUS * torque * step)
    return distance, angle


@pytest.mark.parametrize("heading", [0.0, 0.2, math.pi / 8, 1.0])
def test_a_puck_that_slides_without_turning_stops_after_v_squared_over_two_mu_g(
    heading: float,
) -> None:
    """Within 3 %: a pivot off the centre brakes a little aside of its velocity, through the puck's
    inertia about the centre, and what two opposite pivots do across the motion cancels."""
    distance, angle = slide(SPEED, 0.0, heading)
    assert distance == pytest.approx(SPEED**2 / (2.0 * BRAKE), rel=0.03)
    assert angle == pytest.approx(0.0, abs=1e-3)


def test_a_puck_that_only_spins_stops_as_two_thirds_of_its_radius_make_it() -> None:
    """The torque is 2/3 mu m g R; with I = m R^2 / 2 it stops after w^2 R / (8/3 mu g)."""
    spin = 3.0
    distance, angle = slide(0.0, spin, 0.0)
    assert angle == pytest.approx(spin**2 * RADIUS / (8.0 / 3.0 * BRAKE), rel=0.03)
    assert distance == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("spin", [0.5, 1.5, 3.0])
@pytest.mark.parametrize("heading", [0.0, 0.2, 1.0])
def test_a_puck_that_slides_and_spins_stops_where_an_even_pressure_stops_it(
    spin: float, heading: float
) -> None:
    """Within five thousandths of an inch and a degree."""
    distance, angle = slide(SPEED, spin, heading)
    right_distance, right_angle = slide_of_a_disc(SPEED, spin)
    assert distance == pytest.approx(right_distance, abs=0.005)
    assert angle == pytest.approx(right_angle, abs=math.radians(1.0))


def test_all_pivots_together_brake_with_mu_m_g() -> None:
    brakes = surface_friction(pymunk.Body(PUCK.mass, 1.0), PUCK, FRICTION)
    assert sum(joint.max_force for joint in brakes.joints) == pytest.approx(BRAKE * PUCK.mass)


def test_a_tool_that_stops_at_once_lets_the_puck_slide_until_friction_has_taken_its_speed() -> None:
    """v^2 / (2 mu g), give or take what the puck moves in one step at full speed."""
    puck = Pose(3.0, 10.0 + WORKSPACE.tools.handle_length + RADIUS)
    motion = (Stretch(SPEED, round(1.0 / STEP)),)
    end = simulator("t-stick").push(puck, Point(0.0, 10.0), AHEAD, motion)
    assert end.y - (puck.y + SPEED) == pytest.approx(SPEED**2 / (2.0 * BRAKE), abs=SPEED * STEP)
    assert end.x == pytest.approx(puck.x, abs=1e-3)


def test_a_tool_that_slows_down_as_the_arm_does_keeps_the_puck() -> None:
    """The wrist brakes more gently than the table does, so the puck stays at the bar."""
    puck = Pose(3.0, 10.0 + WORKSPACE.tools.handle_length + RADIUS)
    motion = trapezoid(5.0, SPEED, WORKSPACE.motion.push_acceleration)
    end = simulator("t-stick").push(puck, Point(0.0, 10.0), AHEAD, motion)
    assert end.y == pytest.approx(puck.y + 5.0, abs=0.001)
