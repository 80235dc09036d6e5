"""The first contact of a moving tool in closed form agrees with a search by shapely."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from affcli.core.geometry import ConvexPolygon, Point, distance_to_union
from affcli.simulation.contact import travel_to_contact
from tests.physics.pushes import DIRECTIONS, RADIUS, SHAPES
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


@given(tool=tools, direction=directions, center=centers)
@settings(max_examples=200, deadline=None)
def test_at_the_first_contact_the_puck_touches_the_tool(
    tool: tuple[ConvexPolygon, ...], direction: Point, center: Point
) -> None:
    travel = travel_to_contact(tool, direction, 40.0, center, RADIUS)
    assume(travel)
    assert travel is not None
    at = Point(center.x - travel * direction.x, center.y - travel * direction.y)
    assert distance_to_union(tool, at) == pytest.approx(RADIUS, abs=1e-7)


@given(tool=tools, direction=directions, center=centers)
def test_a_disc_that_the_tool_touches_already_has_no_way_to_contact(
    tool: tuple[ConvexPolygon, ...], direction: Point, center: Point
) -> None:
    assume(distance_to_union(tool, center) <= RADIUS)
    assert travel_to_contact(tool, direction, 0.0, center, RADIUS) == 0.0


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
