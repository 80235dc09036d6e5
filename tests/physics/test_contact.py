"""The first contact of a moving tool in closed form agrees with a search by shapely."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from affcli.core.geometry import ConvexPolygon, Point
from affcli.simulation.contact import travel_to_contact
from tests.physics.pushes import DIRECTIONS, RADIUS, SHAPES, distance_to_union
from tests.physics.quasi_static import Array

tools = st.sampled_from(tuple(SHAPES.values()))
angles = st.floats(-math.pi, math.pi)
directions = st.one_of(
    st.sampled_from(DIRECTIONS),
    angles.map(lambda angle: Point(math.cos(angle), math.sin(angle))),
)
centers = st.builds(Point, st.floats(-12.0, 12.0), st.floats(-8.0, 26.0))
lengths = st.floats(0.0, 8.0)
GRAZE = 1e-7
"""Discs that come this close to the tool, or overlap it by no more, may count either way (in)."""


class Approach:
    """The gap between a disc and one convex part that moves: a convex function of the travel."""

    def __init__(self, part: ConvexPolygon, direction: Point, center: Point) -> None:
        self._part = shapely.Polygon(part.vertices)
        self._direction = direction
        self._center = center

    def gap(self, travel: float | Array) -> Array:
        """Return the gap after each travel (in), negative where they overlap."""
        x = self._center.x - travel * self._direction.x
        y = self._center.y - travel * self._direction.y
        gap: Array = shapely.distance(shapely.points(x, y), self._part) - RADIUS
        return gap

    def nearest(self, length: float) -> float:
        """Return the travel of at most `length` at which the gap is smallest (in)."""
        low, high = 0.0, length
        while high - low > 1e-12:
            travel = np.linspace(low, high, 9)
            best = int(np.argmin(self.gap(travel)))
            closer = float(travel[max(best - 1, 0)]), float(travel[min(best + 1, 8)])
            if closer == (low, high):
                break
            low, high = closer
        return 0.5 * (low + high)

    def closing(self, length: float) -> float:
        """Return the first travel at which the gap is closed (in); inf when it stays open."""
        low, high = 0.0, self.nearest(length)
        if self.gap(low) <= 0.0:
            return low
        if self.gap(high) > 0.0:
            return math.inf
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.gap(middle) > 0.0 else (low, middle)
        return high


@given(tool=tools, direction=directions, center=centers, length=lengths)
@settings(max_examples=200, deadline=None)
def test_the_first_contact_is_the_one_found_by_searching_the_motion(
    tool: tuple[ConvexPolygon, ...], direction: Point, center: Point, length: float
) -> None:
    approaches = [Approach(part, direction, center) for part in tool]
    smallest = min(float(a.gap(a.nearest(length))) for a in approaches)
    assume(abs(smallest) > GRAZE)
    travel = travel_to_contact(tool, direction, length, center, RADIUS)
    first = min(a.closing(length) for a in approaches)
    assert (math.inf if travel is None else travel) == pytest.approx(first, abs=1e-6)


@given(tool=tools, center=centers, data=st.data())
def test_at_the_first_contact_the_puck_touches_the_tool(
    tool: tuple[ConvexPolygon, ...], center: Point, data: st.DataObject
) -> None:
    """The tool is aimed at the puck with some corner of it, so it cannot miss."""
    corner = data.draw(st.sampled_from(tool[0].vertices))
    way = math.dist(corner, center)
    assume(way > 1e-3)
    direction = Point((center.x - corner.x) / way, (center.y - corner.y) / way)
    travel = travel_to_contact(tool, direction, way, center, RADIUS)
    assert travel is not None
    at = Point(center.x - travel * direction.x, center.y - travel * direction.y)
    if travel > 0.0:
        assert distance_to_union(tool, at) == pytest.approx(RADIUS, abs=1e-7)
    else:
        assert distance_to_union(tool, center) <= RADIUS + 1e-7


def touching(a: Point, b: Point, share: float) -> tuple[Point, Point]:
    """Return the centre of a disc that touches the edge from a to b, and the edge's normal."""
    length = math.dist(a, b)
    normal = Point((b.y - a.y) / length, (a.x - b.x) / length)
    x, y = a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)
    return Point(x + RADIUS * normal.x, y + RADIUS * normal.y), normal


@pytest.mark.parametrize("shape", tuple(SHAPES))
def test_a_disc_that_touches_the_tool_to_the_last_bits_has_no_way_to_contact(shape: str) -> None:
    """Whether or not rounding makes it overlap the edge that is about to push it."""
    tool = SHAPES[shape]
    for a, b in (edge for part in tool for edge in part.edges):
        for share in np.linspace(0.0, 1.0, 101):
            center, normal = touching(a, b, float(share))
            for direction in DIRECTIONS:
                if direction.x * normal.x + direction.y * normal.y > 0.1:
                    travel = travel_to_contact(tool, direction, 5.0, center, RADIUS)
                    assert travel == pytest.approx(0.0, abs=1e-9)


@given(tool=tools, direction=directions, center=centers, length=lengths, more=lengths)
def test_a_longer_motion_has_the_same_first_contact(
    tool: tuple[ConvexPolygon, ...],
    direction: Point,
    center: Point,
    length: float,
    more: float,
) -> None:
    travel = travel_to_contact(tool, direction, length, center, RADIUS)
    longer = travel_to_contact(tool, direction, length + more, center, RADIUS)
    if travel is not None:
        assert longer == travel
    else:
        assert longer is None or longer > length
