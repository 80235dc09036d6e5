"""What is near a puck, told quickly, is what the distances to the polygons say."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.simulation.strides import Surroundings
from affcli.simulation.wrist_motion import trapezoid
from tests.physics.pushes import simulator

RADIUS = 1.45
PARTS = (
    ConvexPolygon.box(-0.4, -1.0, 0.4, 14.0),
    ConvexPolygon.box(0.4, 13.2, 5.0, 14.0),
    ConvexPolygon((Point(4.0, 14.0), Point(6.5, 10.0), Point(7.0, 11.0))),
)
places = st.builds(Point, st.floats(-12.0, 14.0), st.floats(-8.0, 24.0))


def gaps(place: Point) -> list[float]:
    """Return how far the puck is from each part (in), below 0 where it overlaps it."""
    return [part.distance(place) - RADIUS for part in PARTS]


@given(places)
def test_the_parts_that_touch_and_the_nearest_other_are_told(place: Point) -> None:
    found = gaps(place)
    assume(all(abs(gap) > 1e-6 for gap in found))
    touched, clearance = Surroundings(PARTS, RADIUS)(*place)
    # The slanted part is taken for the box about it until that is touched.
    left, bottom, right, top = PARTS[2].bounds
    if ConvexPolygon.box(left, bottom, right, top).distance(place) >= RADIUS:
        found[2] = ConvexPolygon.box(left, bottom, right, top).distance(place) - RADIUS
    assert touched == sum(gap < 0.0 for gap in found)
    assert clearance == pytest.approx(min((gap for gap in found if gap > 0.0), default=math.inf))


@given(places, places)
def test_the_gap_that_closes_most_is_told(before: Point, now: Point) -> None:
    boxes = PARTS[:2]
    told = [(boxes[n].distance(before) - RADIUS, boxes[n].distance(now) - RADIUS) for n in (0, 1)]
    assume(all(min(far, near) > 1e-3 for far, near in told))
    closed = Surroundings(boxes, RADIUS).closing(before, now)
    assert closed == pytest.approx(max((far - near) / near for far, near in told))


@pytest.mark.parametrize("x", [-5.5, -1.5, 0.0, 3.0, 6.0])
def test_strides_leave_the_puck_where_equal_short_steps_do(x: float) -> None:
    """Between the bar's ends and beyond its corner, where the puck turns as it slips off."""
    way = (Pose(x, 26.2, 0.3), Point(0.0, 10.0), Point(0.0, 1.0), trapezoid(5.0, 5.0, 40.0, 1))
    quick, simple = (simulator("t-hook").push(*way, finer=finer) for finer in (0, 2))
    assert simple.y > 28.0
    assert math.dist(quick.point, simple.point) < 0.01
    assert quick.angle == pytest.approx(simple.angle, abs=math.radians(0.5))


def test_a_push_that_is_simulated_whole_leaves_no_step_out() -> None:
    """The tool passes the puck: there is nothing to simulate, and nothing comes of it."""
    puck = Pose(9.0, 24.0, 0.5)
    way = (puck, Point(0.0, 10.0), Point(0.0, 1.0), trapezoid(5.0, 5.0, 40.0))

    def steps(*, whole: bool) -> int:
        by, taken = simulator("t-hook"), []
        step = by._bodies.step

        def counted(seconds: float) -> None:
            taken.append(seconds)
            step(seconds)

        by._bodies.step = counted
        assert by.push(*way, whole=whole) == puck
        return len(taken)

    assert steps(whole=False) == 0
    assert steps(whole=True) > 10
