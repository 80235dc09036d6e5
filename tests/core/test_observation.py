"""The observation vector and movements between two of them (§5.2)."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from affcli.core.geometry import Point
from affcli.core.observation import Movement, Observation, angle_between_degrees, movement
from tests.factories import moved_by, observation

components = st.floats(-100.0, 100.0, allow_nan=False, allow_subnormal=False)
movements = st.builds(Movement, components, components, components)


def test_the_vector_has_twelve_components_in_the_order_of_the_paper() -> None:
    """§5.2: position of the object, position relative to the wrist, colours of object and tool."""
    seen = Observation(*(float(k) for k in range(1, 13)))
    assert len(seen) == 12
    assert (seen.object_x, seen.object_y, seen.object_z) == (1.0, 2.0, 3.0)
    assert (seen.wrist_to_object_x, seen.wrist_to_object_y, seen.wrist_to_object_z) == (4, 5, 6)
    assert (seen.object_red, seen.object_green, seen.object_blue) == (7.0, 8.0, 9.0)
    assert (seen.tool_red, seen.tool_green, seen.tool_blue) == (10.0, 11.0, 12.0)
    assert seen.object_position == Point(1.0, 2.0)
    assert seen.wrist_to_object == Point(4.0, 5.0)
    assert seen.colors == (7.0, 8.0, 9.0, 10.0, 11.0, 12.0)


def test_a_movement_is_the_end_less_the_start_in_the_table_frame() -> None:
    """§5.2: it is of "the first three components, o1, o2, o3"; the wrist does not count."""
    start = observation(Point(1.0, 20.0), wrist=Point(0.0, 10.0))
    end = observation(Point(4.0, 16.0), wrist=Point(7.0, 3.0))
    assert movement(start, end) == (3.0, -4.0, 0.0)
    assert movement(start, end).distance == 5.0
    assert movement(start, start._replace(object_z=2.0)) == (0.0, 0.0, 2.0)


@settings(deadline=None)
@given(movements)
def test_distance_is_euclidean_over_three_components(m: Movement) -> None:
    assert m.distance == pytest.approx(math.hypot(*m))


@settings(deadline=None)
@given(movements, movements)
def test_the_angle_does_not_depend_on_order_and_lies_within_half_a_turn(
    a: Movement, b: Movement
) -> None:
    angle = angle_between_degrees(a, b)
    assert 0.0 <= angle <= 180.0
    assert angle == pytest.approx(angle_between_degrees(b, a), abs=1e-6)


@settings(deadline=None)
@given(st.floats(0.0, 360.0), st.floats(0.0, 180.0), st.floats(0.1, 30.0), st.floats(0.1, 30.0))
def test_the_angle_is_that_between_the_directions_whatever_the_lengths(
    first: float, between: float, length: float, other: float
) -> None:
    a, b = math.radians(first), math.radians(first + between)
    one = moved_by(length * math.cos(a), length * math.sin(a))
    two = moved_by(other * math.cos(b), other * math.sin(b))
    assert angle_between_degrees(one, two) == pytest.approx(between, abs=1e-6)


@settings(deadline=None)
@given(movements)
def test_a_movement_of_zero_has_no_direction_and_fits_none(m: Movement) -> None:
    zero = Movement(0.0, 0.0, 0.0)
    assert angle_between_degrees(m, zero) == angle_between_degrees(zero, m) == 180.0


@settings(deadline=None)
@given(movements)
def test_opposite_movements_are_half_a_turn_apart(m: Movement) -> None:
    assume(m.distance > 1e-3)
    back = Movement(-m.dx, -m.dy, -m.dz)
    assert angle_between_degrees(m, back) == pytest.approx(180.0)
    assert angle_between_degrees(m, m) == pytest.approx(0.0, abs=1e-6)


def test_a_log_without_heights_tells_of_movements_on_the_table() -> None:
    start = observation(Point(1.0, 20.0))._replace(object_z=math.nan)
    end = observation(Point(4.0, 16.0))
    assert movement(start, end) == movement(start, end._replace(object_z=math.nan)) == (3, -4, 0)
