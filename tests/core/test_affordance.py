"""A row of the affordance table: its prediction, its counters, its replication (§3.2, §5.2)."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.affordance import REPLICATION_ANGLE_DEGREES, Affordance, replicates
from affcli.core.geometry import Point
from affcli.core.observation import Movement
from tests.factories import EIGHTH, affordance, eighths, moved_by, places

degrees = st.floats(0.0, 360.0, allow_nan=False)


def turned(length: float, direction: float) -> Movement:
    """Return a movement by its length (in) and direction (degrees)."""
    a = math.radians(direction)
    return moved_by(length * math.cos(a), length * math.sin(a))


def test_both_counters_are_1_when_a_row_is_made() -> None:
    """§3.2: "During learning, the integer counters of all rows are set to 1"."""
    row = affordance()
    assert (row.times_used, row.times_successful) == (1, 1)
    assert row.replication_probability == 1.0


@settings(deadline=None)
@given(st.integers(1, 500), st.integers(0, 500))
def test_the_replication_probability_is_successes_over_uses(used: int, successful: int) -> None:
    """§6.2: "replication probability (times_successful/times_used)"."""
    row = affordance(used=used, successful=min(used, successful))
    assert row.replication_probability * used == pytest.approx(min(used, successful))


def test_the_sample_row_of_the_paper_has_a_probability_of_75_percent() -> None:
    """§3.2: performed 4 times, similar in 3: "its probability of success is 75%"."""
    assert affordance(used=4, successful=3).replication_probability == 0.75


@settings(deadline=None)
@given(places, places, eighths, eighths)
def test_the_expected_movement_is_the_end_less_the_start(
    at: Point, offset: Point, dx: float, dy: float
) -> None:
    """§6.1: an arrow "represents the observed distance and direction of movement of the attractor
    in camera coordinates": O^e - O^s over o1 to o3, wherever the wrist was."""
    row = affordance(at=at, offset=offset, moved=(dx, dy))
    assert row.expected_movement == (dx, dy, 0.0)
    assert row.start.wrist_to_object == offset


@settings(deadline=None)
@given(degrees, st.floats(-180.0, 180.0), st.floats(0.6, 9.0), st.floats(0.51, 9.0))
def test_a_use_is_successful_within_40_degrees_of_the_stored_movement(
    direction: float, off: float, expected: float, seen: float
) -> None:
    """§5.2: "The times-successful counter is incremented if the observed attractor movement is
    within 40 degrees of the expected movement stored in the affordance table." Both signs, any
    lengths above T's threshold."""
    if abs(abs(off) - 40.0) > 1e-9:
        fits = replicates(turned(expected, direction), turned(seen, direction + off))
        assert fits is (abs(off) < 40.0)


def test_40_degrees_itself_is_within_40_degrees() -> None:
    """§5.2: "within 40 degrees": a millionth of a degree farther off is a failure."""
    assert REPLICATION_ANGLE_DEGREES == 40.0
    for off in (39.999999, -39.999999):
        assert replicates(moved_by(2.0, 0.0), turned(2.0, off))
    for off in (40.000001, -40.000001):
        assert not replicates(moved_by(2.0, 0.0), turned(2.0, off))
    at_the_edge = moved_by(1.0, math.tan(math.radians(40.0)))
    angle = math.degrees(math.atan2(at_the_edge.dy, at_the_edge.dx))
    assert angle == 40.0, "the example must lie on the edge for this test to mean anything"
    assert replicates(moved_by(1.0, 0.0), at_the_edge)


@settings(deadline=None)
@given(degrees, st.floats(0.0, 0.4999), st.floats(0.6, 9.0))
def test_a_movement_that_t_would_not_detect_is_a_failure_in_whatever_direction(
    direction: float, seen: float, expected: float
) -> None:
    """§3.2, §5.2: a puck that moved at most 0.5 in did not move, so nothing was replicated."""
    assert not replicates(turned(expected, direction), turned(seen, direction))


def test_exactly_half_an_inch_is_a_failure_and_just_above_it_a_success() -> None:
    expected = moved_by(0.0, 5.0)
    assert not replicates(expected, moved_by(0.0, 0.0))
    assert not replicates(expected, moved_by(0.0, 4 * EIGHTH))
    assert replicates(expected, moved_by(0.0, math.nextafter(0.5, 1.0)))


def test_how_far_it_moved_does_not_count_beyond_the_threshold() -> None:
    """§5.2 compares directions alone."""
    assert replicates(moved_by(0.0, 5.0), moved_by(0.0, 0.625))
    assert replicates(moved_by(0.0, 0.625), moved_by(0.0, 50.0))


def test_a_row_of_which_nothing_else_is_said_was_made_with_the_wrist_straight_and_once() -> None:
    row = affordance(1)
    plain = Affordance(row.step, row.binding, row.exploratory, row.start, row.end)
    assert (plain.wrist_angle, plain.travel, plain.truncated) == (0.0, Point(0.0, 0.0), False)
    assert (plain.times_used, plain.times_successful) == (1, 1)
