"""The change detection function T (§3.2, §5.2)."""

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.change_detection import MOVEMENT_THRESHOLD, change_detected
from affcli.core.geometry import Point
from tests.factories import EIGHTH, eighths, observation, places


def test_the_threshold_is_half_an_inch() -> None:
    """§5.2: "thresholds it with an empirically determined value (0.5 inches)"."""
    assert MOVEMENT_THRESHOLD == 0.5


@settings(deadline=None)
@given(places, st.integers(-12, 12), st.integers(-12, 12))
def test_t_is_1_when_the_attractor_moved_more_than_half_an_inch(
    at: Point, east: int, north: int
) -> None:
    """§5.2: "T calculates the Euclidean distance and thresholds it with an empirically determined
    value (0.5 inches)". Strictly: at 0.5 inches T is 0."""
    dx, dy = east * EIGHTH, north * EIGHTH
    start = observation(at)
    end = observation(Point(at.x + dx, at.y + dy))
    assert change_detected(start, end) is (64 * (dx * dx + dy * dy) > 16)
    assert change_detected(end, start) is change_detected(start, end)


def test_t_is_0_at_exactly_half_an_inch_and_1_just_above() -> None:
    start = observation(Point(0.0, 20.0))
    assert not change_detected(start, observation(Point(0.5, 20.0)))
    assert not change_detected(start, observation(Point(0.0, 19.5)))
    assert change_detected(start, observation(Point(math.nextafter(0.5, 1.0), 20.0)))


@settings(deadline=None)
@given(places, eighths, eighths)
def test_a_wrist_that_moves_alone_is_no_change(at: Point, x: float, y: float) -> None:
    """§5.2: T "was defined with the first three components": the wrist does not count."""
    assert not change_detected(observation(at), observation(at, wrist=Point(x, y)))


def test_all_three_components_count() -> None:
    start = observation()
    assert change_detected(start, start._replace(object_z=0.75))
    tilted = start._replace(object_x=start.object_x + 0.375, object_z=0.375)
    assert change_detected(start, tilted)
