"""Straight wrist motion: exact in binary, within the speed, and inside the reach."""

import math
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from affcli.core.geometry import Point
from affcli.simulation.arm import Reach, reach_at
from affcli.simulation.wrist_motion import (
    GRID,
    STAIR,
    STEP,
    Stretch,
    distance_of,
    duration,
    on_grid,
    skip,
    stop_at_edge,
    trapezoid,
    trapezoid_time,
)
from tests.physics.pushes import DIRECTIONS, WORKSPACE

TIMING = WORKSPACE.motion
SPEED = TIMING.push_speed
ACCELERATION = TIMING.push_acceleration
REACH = reach_at(WORKSPACE.arm, WORKSPACE.arm.flange_height)

distances = st.one_of(
    st.sampled_from((2.0, 5.0)),
    st.integers(0, round(20.0 / GRID)).map(lambda steps: steps * GRID),
    st.integers(0, 2000).map(lambda steps: steps * GRID),
)
speeds = st.sampled_from((SPEED, 1.0, 2.5, 3.3, 10.0, 20.0))
accelerations = st.sampled_from((ACCELERATION, 10.0, 20.0, 77.0, 1000.0))
bearings = st.floats(-REACH.waist_max, REACH.waist_max)
radii = st.floats(REACH.inner, REACH.outer)


def speeds_of(stretches: tuple[Stretch, ...]) -> list[float]:
    """Return the wrist's speed in every physics step (in/s)."""
    return [stretch.speed for stretch in stretches for _ in range(stretch.steps)]


def place(radius: float, bearing: float) -> Point:
    """Return a wrist position on the wrist's grid."""
    return Point(on_grid(-radius * math.sin(bearing)), on_grid(radius * math.cos(bearing)))


@given(distance=distances, speed=speeds, acceleration=accelerations)
def test_the_steps_of_a_motion_add_up_to_its_distance_to_the_last_bit(
    distance: float, speed: float, acceleration: float
) -> None:
    stretches = trapezoid(distance, speed, acceleration)
    exact = sum(Fraction(s.speed) * s.steps for s in stretches) * Fraction(STEP)
    assert exact == Fraction(distance)
    assert distance_of(stretches) == distance


@given(distance=distances, speed=speeds, acceleration=accelerations)
def test_every_stride_lies_on_the_wrists_grid(
    distance: float, speed: float, acceleration: float
) -> None:
    for stretch in trapezoid(distance, speed, acceleration):
        assert stretch.steps > 0
        assert stretch.speed > 0.0
        assert (Fraction(stretch.speed) * Fraction(STEP) / Fraction(GRID)).denominator == 1


@given(distance=distances)
def test_a_push_keeps_to_its_speed_and_acceleration(distance: float) -> None:
    """As finely as its ramps have stairs; a stair or a last step may be half a step off."""
    for stair in (1, STAIR):
        taken = speeds_of(trapezoid(distance, SPEED, ACCELERATION, stair))
        assert max(taken, default=0.0) <= SPEED
        changes = [abs(b - a) for a, b in pairwise([0.0, *taken, 0.0])]
        assert max(changes) <= (stair + 0.5) * ACCELERATION * STEP


@given(distance=distances)
def test_a_push_speeds_up_then_cruises_then_slows_down(distance: float) -> None:
    taken = speeds_of(trapezoid(distance, SPEED, ACCELERATION))
    changes = [b - a for a, b in pairwise(taken)]
    slowing = next((i for i, change in enumerate(changes) if change < 0.0), len(changes))
    assert all(change <= 0.0 for change in changes[slowing:])


def test_five_inches_take_the_time_of_cruising_and_of_one_ramp() -> None:
    assert duration(trapezoid(5.0, SPEED, ACCELERATION)) == 5.0 / SPEED + SPEED / ACCELERATION
    assert trapezoid_time(5.0, SPEED, ACCELERATION) == 5.0 / SPEED + SPEED / ACCELERATION


@given(distance=distances, speed=speeds, acceleration=accelerations)
def test_the_steps_take_as_long_as_the_trapezoid(
    distance: float, speed: float, acceleration: float
) -> None:
    """Within two steps and what rounding the ramps to whole steps costs."""
    taken = duration(trapezoid(distance, speed, acceleration))
    rounding = 2.0 * STEP + 2.0 * STEP * acceleration / speed * speed / acceleration
    ideal = trapezoid_time(distance, speed, acceleration)
    assert taken == pytest.approx(ideal, abs=rounding + 0.02 * ideal)


def test_no_distance_takes_no_steps() -> None:
    assert trapezoid(0.0, SPEED, ACCELERATION) == ()
    assert trapezoid_time(0.0, SPEED, ACCELERATION) == 0.0


@given(distance=distances, passed=st.floats(0.0, 25.0))
def test_skipping_drops_whole_steps_and_as_many_as_fit(distance: float, passed: float) -> None:
    stretches = trapezoid(distance, SPEED, ACCELERATION)
    gone, left = skip(stretches, passed)
    every, rest = speeds_of(stretches), speeds_of(left)
    dropped = every[: len(every) - len(rest)]
    assert every[len(dropped) :] == rest
    assert Fraction(gone) == sum(map(Fraction, dropped)) * Fraction(STEP)
    assert gone <= passed
    if rest:
        assert gone + rest[0] * STEP > passed


@given(
    start=st.builds(place, radii, bearings), towards=st.sampled_from(DIRECTIONS), length=distances
)
def test_a_motion_stops_where_the_reach_ends(start: Point, towards: Point, length: float) -> None:
    """The wrist stays in reach all the way, and a stop short of the end is at the very edge."""
    assume(REACH.holds(start))
    end = Point(start.x + length * towards.x, start.y + length * towards.y)
    stop = stop_at_edge(REACH, start, end)
    gone = (stop.x - start.x) * towards.x + (stop.y - start.y) * towards.y
    assert 0.0 <= gone <= length
    assert stop == Point(start.x + gone * towards.x, start.y + gone * towards.y)
    assert (gone / GRID).is_integer()
    for share in range(33):
        travel = share / 32 * gone
        assert REACH.holds(Point(start.x + travel * towards.x, start.y + travel * towards.y))
    if gone < length:
        beyond = gone + 2.0 * GRID
        assert not REACH.holds(Point(start.x + beyond * towards.x, start.y + beyond * towards.y))


def test_a_motion_across_the_inner_edge_stops_before_it_although_its_end_is_in_reach() -> None:
    ring = Reach(5.0, 18.0, -math.radians(90.0), math.radians(90.0))
    start, end = Point(6.0, 0.5), Point(-6.0, 0.5)
    assert ring.holds(start)
    assert ring.holds(end)
    assert stop_at_edge(ring, start, end).x == pytest.approx(
        math.sqrt(5.0**2 - 0.5**2), abs=2.0 * GRID
    )


@given(start=st.builds(place, radii, bearings))
def test_a_motion_of_no_length_stays(start: Point) -> None:
    assert stop_at_edge(REACH, start, start) == start


@given(length=st.floats(-50.0, 50.0))
def test_rounding_to_the_grid_moves_by_at_most_half_of_it(length: float) -> None:
    assert abs(on_grid(length) - length) <= GRID / 2.0
    assert on_grid(on_grid(length)) == on_grid(length)
