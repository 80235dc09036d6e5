"""Goal regions (§7.1, Fig. 8)."""

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.geometry import Point
from tests.factories import eighths, goal_at, observation, places


@settings(deadline=None)
@given(places, places)
def test_a_goal_region_is_the_square_about_its_centre_with_its_edge(
    center: Point, place: Point
) -> None:
    goal = goal_at(*center, half_width=2.5)
    off = max(abs(place.x - center.x), abs(place.y - center.y))
    assert goal.contains(place) is (off <= 2.5)


def test_the_edge_and_the_corner_of_a_goal_region_belong_to_it() -> None:
    goal = goal_at(1.0, 10.0, half_width=2.5)
    for dx, dy in ((2.5, 0.0), (0.0, -2.5), (2.5, 2.5), (-2.5, -2.5)):
        assert goal.contains(Point(1.0 + dx, 10.0 + dy))
    assert not goal.contains(Point(3.5 + 1e-9, 10.0))
    assert not goal.contains(Point(1.0, 7.5 - 1e-9))


@given(places, places, st.lists(st.tuples(eighths, eighths), max_size=6))
def test_squared_distances_are_taken_to_the_centre(
    center: Point, at: Point, movements: list[tuple[float, float]]
) -> None:
    """On a binary grid sums and squares are exact, so the distances are equal, not about equal."""
    dx, dy = np.array(movements, dtype=float).reshape(-1, 2).T.copy()
    given_dx, given_dy = dx.copy(), dy.copy()
    squared = goal_at(*center).squared_distance(at, dx, dy)
    expected = [
        (Fraction(at.x) + Fraction(x) - Fraction(center.x)) ** 2
        + (Fraction(at.y) + Fraction(y) - Fraction(center.y)) ** 2
        for x, y in movements
    ]
    assert squared.tolist() == expected
    assert np.array_equal(dx, given_dx)
    assert np.array_equal(dy, given_dy)


@given(places, places)
def test_a_goal_is_reached_where_the_attractor_is_seen_over_it(center: Point, at: Point) -> None:
    goal = goal_at(*center, half_width=2.5)
    assert goal.reached(observation(at)) is goal.contains(at)
    left, bottom, right, top = goal.outline().bounds
    assert (0.5 * (left + right), 0.5 * (bottom + top)) == center
    assert goal.contains(at) is (left <= at.x <= right and bottom <= at.y <= top)
