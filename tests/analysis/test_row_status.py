"""Which rows two tables share, and what a trial leaves of one."""

import math

from hypothesis import given
from hypothesis import strategies as st

from affcli.analysis.row_status import (
    MATCHING_DISTANCE,
    RowStatus,
    around_trial,
    compared,
    current,
    same_effect,
)
from affcli.behaviors.moving import CONTRACT_ARM, EXTEND_ARM
from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from tests.factories import affordance

CALLS = [
    BehaviorCall.of(name, {"offset_distance": inches})
    for name in (EXTEND_ARM, CONTRACT_ARM)
    for inches in (2.0, 5.0)
]
near = st.integers(-12, 12).map(lambda n: n / 4)
"""Places so near to one another that many rows have partners and many have none."""


@st.composite
def rows(draw: st.DrawFn) -> Affordance:
    """Return a row, some of them excluded."""
    moved = draw(st.tuples(near, near).filter(lambda m: math.hypot(*m) > 0.5))
    used = draw(st.integers(1, 4))
    return affordance(
        moved=moved,
        offset=Point(draw(near), 10.0 + draw(near)),
        used=used,
        successful=draw(st.integers(0, used)),
        call=draw(st.sampled_from(CALLS)),
    )


tables = st.lists(rows(), max_size=12)


def degrees(row: Affordance) -> float:
    movement = row.expected_movement
    return math.degrees(math.atan2(movement.dy, movement.dx))


def partners(one: Affordance, other: Affordance) -> bool:
    """Say again, in other words, when two rows are of the same effect."""
    turn = abs(degrees(one) - degrees(other)) % 360.0
    a, b = one.start.wrist_to_object, other.start.wrist_to_object
    return (
        str(one.exploratory) == str(other.exploratory)
        and math.hypot(a.x - b.x, a.y - b.y) <= MATCHING_DISTANCE
        and min(turn, 360.0 - turn) <= 40.0
    )


def live(row: Affordance) -> bool:
    return 2 * row.times_successful > row.times_used


@given(tables, tables)
def test_a_row_is_kept_when_a_live_row_of_the_other_table_is_its_partner(
    before: list[Affordance], after: list[Affordance]
) -> None:
    for rows, others, statuses, alone in (
        (before, after, compared(before, after)[0], RowStatus.LOST),
        (after, before, compared(before, after)[1], RowStatus.WON),
    ):
        assert len(statuses) == len(rows)
        for row, status in zip(rows, statuses, strict=True):
            if not live(row):
                assert status is RowStatus.EXCLUDED
            elif any(partners(row, other) and live(other) for other in others):
                assert status is RowStatus.KEPT
            else:
                assert status is alone


@given(tables, tables)
def test_what_one_way_is_lost_is_won_the_other_way(
    one: list[Affordance], other: list[Affordance]
) -> None:
    there, back = compared(one, other), compared(other, one)
    turned = {RowStatus.LOST: RowStatus.WON, RowStatus.WON: RowStatus.LOST}
    assert [turned.get(status, status) for status in back[1]] == there[0]
    assert [turned.get(status, status) for status in back[0]] == there[1]


@given(tables)
def test_a_table_loses_nothing_against_itself(table: list[Affordance]) -> None:
    for statuses in compared(table, table):
        assert set(statuses) <= {RowStatus.KEPT, RowStatus.EXCLUDED}


@given(tables, tables, tables)
def test_more_rows_in_the_other_table_never_lose_a_kept_one(
    before: list[Affordance], after: list[Affordance], more: list[Affordance]
) -> None:
    few, many = compared(before, after)[0], compared(before, [*after, *more])[0]
    kept = zip(few, many, strict=True)
    assert all(now_kept is RowStatus.KEPT for was, now_kept in kept if was is RowStatus.KEPT)


def test_partners_start_near_each_other_move_alike_and_come_of_the_same_behavior() -> None:
    row = affordance(offset=Point(1.0, 10.0), moved=(0.0, 3.0), call=CALLS[1])
    turned = [(3.0 * math.sin(a), 3.0 * math.cos(a)) for a in map(math.radians, (39.9, 40.1))]
    others = {
        "1.5 in away": (affordance(offset=Point(2.5, 10.0), moved=(0.0, 1.0), call=CALLS[1]), True),
        "1.6 in away": (
            affordance(offset=Point(2.6, 10.0), moved=(0.0, 3.0), call=CALLS[1]),
            False,
        ),
        "39.9 degrees": (affordance(offset=Point(1.0, 10.0), moved=turned[0], call=CALLS[1]), True),
        "40.1 degrees": (
            affordance(offset=Point(1.0, 10.0), moved=turned[1], call=CALLS[1]),
            False,
        ),
        "2 in": (affordance(offset=Point(1.0, 10.0), moved=(0.0, 3.0), call=CALLS[0]), False),
        "contract": (affordance(offset=Point(1.0, 10.0), moved=(0.0, 3.0), call=CALLS[3]), False),
    }
    for what, (other, alike) in others.items():
        assert same_effect(row, other) is alike, what
        assert same_effect(other, row) is alike, what


@given(tables)
def test_a_row_counts_while_its_probability_is_greater_than_one_half(
    table: list[Affordance],
) -> None:
    assert [status is RowStatus.LIVE for status in current(table)] == [live(row) for row in table]


@given(st.integers(0, 30), st.data())
def test_a_trial_keeps_a_row_or_loses_it_unless_it_was_excluded_before(
    count: int, data: st.DataObject
) -> None:
    ids = list(range(100, 100 + count))
    some = st.sets(st.sampled_from(ids)) if ids else st.just(set[int]())
    excluded = data.draw(some)
    died = data.draw(some) - excluded
    before, after = around_trial(ids, excluded, died)
    for one, was, became in zip(ids, before, after, strict=True):
        assert was is (RowStatus.EXCLUDED if one in excluded else RowStatus.LIVE)
        if one in died:
            assert became is RowStatus.LOST
        else:
            assert became is (RowStatus.EXCLUDED if one in excluded else RowStatus.KEPT)
