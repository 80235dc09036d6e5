"""Points, polygons and directions, checked against shapely."""

import math

import pytest
import shapely
import shapely.affinity
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from affcli.core.geometry import (
    ConvexPolygon,
    Point,
    Pose,
    direction_degrees,
    near_any,
)

coordinates = st.floats(-40.0, 40.0, allow_nan=False)
thousandths = st.integers(-40_000, 40_000).map(lambda n: n / 1000.0)
points = st.builds(Point, thousandths, thousandths)


@st.composite
def convex_polygons(draw: st.DrawFn) -> ConvexPolygon:
    """Draw a convex polygon: the hull of a few points that enclose some area."""
    cloud = draw(st.lists(points, min_size=3, max_size=8))
    hull = shapely.MultiPoint(cloud).convex_hull
    assume(hull.geom_type == "Polygon" and hull.area > 0.5)
    ring = shapely.geometry.polygon.orient(hull).exterior.coords[:-1]
    return ConvexPolygon(tuple(Point(x, y) for x, y in ring))


def in_shapely(polygon: ConvexPolygon) -> shapely.Polygon:
    return shapely.Polygon(polygon.vertices)


def test_a_box_lists_its_corners_counter_clockwise_from_the_near_left_one() -> None:
    box = ConvexPolygon.box(-1.0, 2.0, 3.0, 5.0)
    assert box.vertices == ((-1.0, 2.0), (3.0, 2.0), (3.0, 5.0), (-1.0, 5.0))
    assert box.bounds == (-1.0, 2.0, 3.0, 5.0)
    assert box.area == 12.0


def test_a_clockwise_polygon_shows_itself_by_a_negative_area() -> None:
    box = ConvexPolygon.box(0.0, 0.0, 2.0, 3.0)
    assert ConvexPolygon(box.vertices[::-1]).area == -6.0


@settings(deadline=None)
@given(convex_polygons())
def test_area_and_bounds_are_those_of_shapely(polygon: ConvexPolygon) -> None:
    assert polygon.area == pytest.approx(in_shapely(polygon).area, abs=1e-9)
    assert polygon.bounds == in_shapely(polygon).bounds


@settings(deadline=None)
@given(convex_polygons(), points)
def test_distance_is_that_of_shapely_and_zero_inside(polygon: ConvexPolygon, point: Point) -> None:
    expected = in_shapely(polygon).distance(shapely.Point(point))
    assert polygon.distance(point) == pytest.approx(expected, abs=1e-9)


@settings(deadline=None)
@given(convex_polygons(), points)
def test_the_bounding_box_is_never_farther_than_the_polygon(
    polygon: ConvexPolygon, point: Point
) -> None:
    box = ConvexPolygon.box(*polygon.bounds)
    assert box.distance(point) <= polygon.distance(point) + 1e-9
    assert box.is_box
    assert polygon.is_box is (abs(box.area - polygon.area) < 1e-9)


@settings(deadline=None)
@given(convex_polygons(), points, points)
def test_moving_polygon_and_point_together_keeps_their_distance(
    polygon: ConvexPolygon, point: Point, shift: Point
) -> None:
    moved = polygon.moved(shift.x, shift.y)
    there = Point(point.x + shift.x, point.y + shift.y)
    assert moved.distance(there) == pytest.approx(polygon.distance(point), abs=1e-9)
    assert moved.area == pytest.approx(polygon.area, abs=1e-8)


@settings(deadline=None)
@given(st.lists(convex_polygons(), min_size=1, max_size=4), points, st.floats(0.1, 10.0))
def test_near_any_says_whether_the_distance_to_the_union_is_less_than_the_radius(
    polygons: list[ConvexPolygon], point: Point, radius: float
) -> None:
    distance = min(polygon.distance(point) for polygon in polygons)
    assert near_any(polygons, point, radius) is (distance < radius)


def test_what_only_touches_is_not_near() -> None:
    box = (ConvexPolygon.box(0.0, 0.0, 2.0, 2.0),)
    assert not near_any(box, Point(3.5, 1.0), 1.5)
    assert near_any(box, Point(3.4375, 1.0), 1.5)


@pytest.mark.parametrize(
    ("dx", "dy", "degrees"),
    [(1.0, 0.0, 0.0), (0.0, 2.0, 90.0), (-3.0, 0.0, 180.0), (0.0, -1.0, 270.0), (1.0, 1.0, 45.0)],
)
def test_directions_count_from_the_right_toward_away(dx: float, dy: float, degrees: float) -> None:
    assert direction_degrees(dx, dy) == pytest.approx(degrees)


@settings(deadline=None)
@given(coordinates, coordinates)
@example(5.0, -1e-16)
def test_every_direction_lies_from_0_up_to_360_degrees(dx: float, dy: float) -> None:
    assume(math.hypot(dx, dy) > 1e-6)
    direction = direction_degrees(dx, dy)
    assert 0.0 <= direction < 360.0
    turned = math.radians(direction)
    assert math.cos(turned) == pytest.approx(dx / math.hypot(dx, dy), abs=1e-9)
    assert math.sin(turned) == pytest.approx(dy / math.hypot(dx, dy), abs=1e-9)


def test_a_pose_knows_its_point() -> None:
    assert Pose(1.0, 2.0, 3.0).point == Point(1.0, 2.0)
    assert Pose(1.0, 2.0).angle == 0.0


@given(convex_polygons(), points, st.floats(-7.0, 7.0))
def test_a_placed_polygon_is_turned_about_the_pose_as_shapely_turns_it(
    polygon: ConvexPolygon, at: Point, angle: float
) -> None:
    placed = polygon.placed(Pose(*at, angle))
    turned = shapely.affinity.rotate(
        shapely.Polygon(polygon.vertices), angle, origin=(0.0, 0.0), use_radians=True
    )
    expected = shapely.affinity.translate(turned, *at).exterior.coords[:-1]
    assert placed.vertices == tuple(pytest.approx(corner, abs=1e-9) for corner in expected)


@given(convex_polygons(), points)
def test_at_an_angle_of_zero_a_polygon_is_moved_to_the_bit(
    polygon: ConvexPolygon, at: Point
) -> None:
    assert repr(polygon.placed(Pose(*at, 0.0))) == repr(polygon.moved(*at))
