"""The table as a predictive model, against a naive search (§6.1)."""

import math

from hypothesis import given
from hypothesis import strategies as st

from affcli.behaviors.moving import CONTRACT_ARM, EXTEND_ARM
from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.core.observation import Movement
from affcli.planning.prediction import NO_MOVEMENT, RADIUS, TablePredictor
from tests.factories import EXTEND_5, affordance, eighths, places

CALLS = tuple(
    BehaviorCall.of(name, {"offset_distance": distance})
    for name in (EXTEND_ARM, CONTRACT_ARM)
    for distance in (2.0, 5.0)
)
near = st.integers(-32, 32).map(lambda n: n / 8)
"""Offsets within 4 in, on a binary grid: many are equally near."""
offsets = st.builds(Point, near, near)
movements = st.tuples(eighths, eighths).filter(lambda m: math.hypot(*m) > 0.5)


@st.composite
def tables(draw: st.DrawFn) -> list[Affordance]:
    """Return up to 20 rows of four behaviors, of which the oldest may be borrowed."""
    count, borrowed = draw(st.integers(0, 20)), draw(st.integers(0, 3))
    return [
        affordance(
            step,
            moved=draw(movements),
            offset=draw(offsets),
            at=draw(places),
            call=draw(st.sampled_from(CALLS)),
        )
        for step in range(1 - borrowed, count + 1 - borrowed)
    ]


@given(tables(), st.sampled_from(CALLS), offsets, st.integers(-2, 20))
def test_a_row_that_is_left_out_is_as_if_it_were_not_there(
    rows: list[Affordance], call: BehaviorCall, offset: Point, without: int
) -> None:
    """So each trial of a log is predicted by the others."""
    others = TablePredictor([row for row in rows if row.step != without])
    table = TablePredictor(rows)
    assert table.predict(call, offset, without) == others.predict(call, offset)
    assert table.mean_movement(call, without) == others.mean_movement(call)


def naive(rows: list[Affordance], call: BehaviorCall, offset: Point, radius: float) -> Movement:
    """Return the movement of the nearest row, looking at one after the other, older ones first."""
    best, nearest = NO_MOVEMENT, math.inf
    for row in rows:
        away = math.dist(row.start.wrist_to_object, offset)
        if row.exploratory == call and away <= radius and away < nearest:
            best, nearest = row.expected_movement, away
    return best


@given(tables(), st.sampled_from(CALLS), offsets, st.sampled_from([0.5, 1.0, RADIUS, 3.0]))
def test_the_nearest_row_of_the_same_behavior_and_parameter_tells(
    rows: list[Affordance], call: BehaviorCall, offset: Point, radius: float
) -> None:
    predicted = TablePredictor(rows, radius).predict(call, offset)
    assert predicted == naive(rows, call, offset, radius)


@given(tables(), st.sampled_from(CALLS))
def test_where_a_row_was_made_it_tells_its_own_movement(
    rows: list[Affordance], call: BehaviorCall
) -> None:
    predictor = TablePredictor(rows)
    for row in rows:
        here = row.start.wrist_to_object
        twins = [
            r for r in rows if (r.start.wrist_to_object, r.exploratory) == (here, row.exploratory)
        ]
        assert predictor.predict(row.exploratory, here) == twins[0].expected_movement


def test_a_row_tells_something_up_to_the_radius_and_nothing_beyond() -> None:
    row = affordance(1, moved=(0.0, 5.0), offset=Point(0.0, 8.0))
    predictor = TablePredictor([row])
    assert predictor.predict(EXTEND_5, Point(RADIUS, 8.0)) == row.expected_movement
    beyond = Point(math.nextafter(RADIUS, 9.0), 8.0)
    assert predictor.predict(EXTEND_5, beyond) == NO_MOVEMENT


def test_a_blank_table_foretells_that_nothing_will_move() -> None:
    predictor = TablePredictor([])
    assert predictor.predict(EXTEND_5, Point(0.0, 8.0)) == NO_MOVEMENT
    assert predictor.mean_movement(EXTEND_5) == NO_MOVEMENT


@given(tables(), st.sampled_from(CALLS))
def test_the_mean_is_that_of_all_rows_of_the_behavior(
    rows: list[Affordance], call: BehaviorCall
) -> None:
    mine = [row.expected_movement for row in rows if row.exploratory == call]
    mean = TablePredictor(rows).mean_movement(call)
    for have, column in zip(mean, zip(*mine, strict=True), strict=False):
        assert math.isclose(have, sum(column) / len(mine), abs_tol=1e-9)
    assert mine or mean == NO_MOVEMENT
