"""Goal regions (§7.1, Fig. 8)."""

from hypothesis import given, settings

from affcli.core.geometry import Point
from tests.factories import goal_at, places


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
