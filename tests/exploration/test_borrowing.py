"""Borrowing: which rows carry over to a new tool, and as what (§8)."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.behaviors.moving import paper_repertoire
from affcli.core.affordance import Affordance
from affcli.core.behavior import Repertoire, composed
from affcli.core.geometry import Point
from affcli.core.identity import stream_number
from affcli.core.mask import Mask
from affcli.core.motion import Carry, Slide, Turn
from affcli.core.transfer import Borrowed, Borrowing
from affcli.exploration.borrowing import Lender, borrow, mirrored_motion, sweep, way_of
from tests.factories import affordance

REPERTOIRE = paper_repertoire()
CALLS = {str(one.call): one.call for one in REPERTOIRE}
GREEN, BLUE = (10.0, 200.0, 10.0), (10.0, 10.0, 200.0)
ALL = Borrowing(each=100, most=10_000)
Box = tuple[float, float, float, float]
HOOK: tuple[Box, ...] = ((-0.4, 0.0, 0.4, 14.0), (-5.6, 13.2, -0.4, 14.0), (-5.6, 9.0, -4.8, 13.2))
"""A handle, a bar and a hook on the left: left, near, right, far (in)."""


def streams(name: str) -> np.random.Generator:
    """Return the random stream of a name."""
    return np.random.default_rng(stream_number(name))


def mask_of(boxes: Sequence[Box], color: tuple[float, float, float] = GREEN) -> Mask:
    """Return the mask of a tool of boxes."""
    x, y = np.meshgrid(0.1 * np.arange(-200, 200) + 0.05, 0.1 * np.arange(-50, 250) + 0.05)
    grid = np.zeros((400, 300), dtype=bool)
    for left, near, right, far in boxes:
        grid |= ((x >= left) & (x <= right) & (y >= near) & (y <= far)).T
    return Mask.of(grid, -200, -50, color)


def moved(boxes: Sequence[Box], dx: float, dy: float) -> tuple[Box, ...]:
    """Return boxes elsewhere."""
    return tuple((a + dx, b + dy, c + dx, d + dy) for a, b, c, d in boxes)


def mirrored(boxes: Sequence[Box]) -> tuple[Box, ...]:
    """Return boxes with left and right exchanged."""
    return tuple((-c, b, -a, d) for a, b, c, d in boxes)


ROWS = (
    affordance(3, offset=Point(-2.4, 8.0), moved=(0.5, 0.2), call=CALLS["slide arm left 5"]),
    affordance(7, offset=Point(-3.0, 12.0), moved=(0.0, -0.4), call=CALLS["contract arm 5"]),
    affordance(8, offset=Point(-4.0, 15.5), moved=(-0.3, 0.0), call=CALLS["extend arm 2"]),
    affordance(9, offset=Point(1.95, 6.0), moved=(0.1, 0.3), call=CALLS["slide arm right 5"]),
)
LENDER = Lender("a" * 64, "hook", ROWS, mask_of(HOOK))


def plain(borrowed: Sequence[Borrowed]) -> list[Borrowed]:
    """Return what was not mirrored."""
    return [one for one in borrowed if not one.mirrored]


def test_a_tool_borrows_from_itself_its_own_rows() -> None:
    """Each where it was, in the new colour, with the counters of a new row, behind all others."""
    used = tuple(replace(row, times_used=9, times_successful=2) for row in ROWS)
    new = mask_of(HOOK, BLUE)
    found = borrow([replace(LENDER, rows=used)], new, REPERTOIRE, ALL, streams)
    own = plain(found)
    assert [one.step for one in own] == [3, 7, 8, 9]
    assert {one.shift for one in own} == {(0.0, 0.0)}
    for one, row in zip(own, ROWS, strict=True):
        assert one.row.start[:9] == row.start[:9]
        assert one.row.end[:9] == row.end[:9]
        assert one.row.start.colors[3:] == one.row.end.colors[3:] == BLUE
        assert (one.row.exploratory, one.lender, one.tool) == (row.exploratory, "a" * 64, "hook")
        assert (one.row.times_used, one.row.times_successful) == (1, 1)
    assert [one.row.step for one in found] == list(range(1 - len(found), 1))
    assert all(one.row.is_borrowed for one in found)


def test_a_mirrored_tool_borrows_mirrored_rows() -> None:
    found = borrow([LENDER], mask_of(mirrored(HOOK)), REPERTOIRE, ALL, streams)
    there = {one.step: one for one in found if one.mirrored and one.shift == (0.0, 0.0)}
    assert sorted(there) == [3, 7, 8, 9]
    calls = [str(there[step].row.exploratory) for step in (3, 7, 8, 9)]
    assert calls == ["slide arm right 5", "contract arm 5", "extend arm 2", "slide arm left 5"]
    for row in ROWS:
        new = there[row.step].row
        assert new.start.wrist_to_object == (-row.start.wrist_to_object.x, row.start[4])
        assert new.start.wrist == (-row.start.wrist.x, row.start.wrist.y)
        assert new.expected_movement[:2] == pytest.approx(
            (-row.expected_movement.dx, row.expected_movement.dy)
        )


def test_what_the_robot_cannot_do_mirrored_is_not_mirrored() -> None:
    """Without the slides to the right, what slides left carries over as it is alone."""
    less = tuple(one for one in REPERTOIRE if not str(one.call).startswith("slide arm right"))
    rows = [row for row in ROWS if row.step != 9]
    found = borrow([replace(LENDER, rows=rows)], mask_of(HOOK), less, ALL, streams)
    assert {one.step for one in found} == {3, 7, 8}
    assert {one.step for one in found if one.mirrored} <= {7, 8}


@pytest.mark.parametrize("far", [(0.0, 1.5), (0.7, 0.0), (-0.4, -1.2)])
def test_a_shifted_tool_shifts_the_rows_that_tell_the_place(far: tuple[float, float]) -> None:
    """The inside of the hook is there but once, so the row in it goes where the hook went."""
    inside = affordance(4, offset=Point(-2.6, 11.0), moved=(-0.2, 0.0), call=CALLS["extend arm 2"])
    lender = replace(LENDER, rows=[inside])
    new = mask_of(moved(HOOK, *far))
    wide = replace(ALL, radius=2.6, limit=0.05, shifts=50)
    found = plain(borrow([lender], new, REPERTOIRE, wide, streams))
    assert found
    for one in found:
        assert one.shift == pytest.approx(far, abs=0.11)
        start, old = one.row.start, inside.start
        assert start.wrist_to_object == pytest.approx(
            (old.wrist_to_object.x + one.shift.x, old.wrist_to_object.y + one.shift.y)
        )
        assert start.wrist == pytest.approx(old.wrist)
        assert one.row.expected_movement == pytest.approx(inside.expected_movement)


def test_a_turned_row_is_shifted_with_the_tool() -> None:
    """A shift is told in the tool frame: at a wrist turned by 90 degrees to the left of it."""
    turned = replace(ROWS[2], wrist_angle=math.pi / 2.0)
    offset = Point(-15.5, -4.0)  # beyond the bar, as the hand sees it
    for name in ("start", "end"):
        seen = getattr(turned, name)
        seen = seen._replace(wrist_to_object_x=offset.x, wrist_to_object_y=offset.y)
        turned = replace(turned, **{name: seen})
    lender = replace(LENDER, rows=[turned])
    new = mask_of(moved(HOOK, 0.0, 1.0))
    (first, *_) = plain(borrow([lender], new, REPERTOIRE, replace(ALL, shifts=40), streams))
    start = first.row.start.wrist_to_object
    assert (start.x - offset.x, start.y - offset.y) == pytest.approx(
        (-first.shift.y, first.shift.x)
    )


boxes = st.lists(
    st.tuples(st.integers(-8, 6), st.integers(0, 12), st.integers(1, 8), st.integers(1, 8)),
    min_size=1,
    max_size=4,
).map(lambda found: tuple((float(x), float(y), float(x + w), float(y + h)) for x, y, w, h in found))
offsets = st.tuples(st.floats(-6.0, 6.0), st.floats(2.0, 16.0))


@given(boxes, boxes, st.lists(offsets, min_size=1, max_size=4), st.floats(0.0, 3.0))
def test_nothing_along_the_way_differs_by_more_than_the_limit(
    old: tuple[Box, ...],
    new: tuple[Box, ...],
    places: list[tuple[float, float]],
    limit: float,
) -> None:
    """Counted cell by cell, at the place to which a row was brought."""
    calls = list(CALLS.values())
    rows = [
        affordance(step, offset=Point(*place), moved=(1.0, -0.5), call=calls[step % len(calls)])
        for step, place in enumerate(places, 1)
    ]
    borrowing = replace(ALL, limit=limit)
    lent, seen = mask_of(old), mask_of(new)
    lender = Lender("b" * 64, "old", rows, lent)
    for one in borrow([lender], seen, REPERTOIRE, borrowing, streams):
        before = lent.mirrored() if one.mirrored else lent
        row, (sx, sy) = one.row, one.shift
        way = way_of(row, REPERTOIRE)
        assert way is not None
        # Where it was, so that both are counted by the same cells.
        back = way._replace(
            start=Point(way.start.x - sx, way.start.y - sy),
            end=Point(way.end.x - sx, way.end.y - sy),
        )
        column, first, swept = sweep(back, borrowing.radius)
        i, j = round(sx / 0.1), round(sy / 0.1)
        differ = before.window(column, first, *swept.shape) ^ seen.window(
            column + i, first + j, *swept.shape
        )
        # Back and forth may lose the last bit of a place, and so a cell at the edge of the disc.
        assert (differ & swept).sum() * 0.01 <= limit + 0.05


def test_beside_the_tool_nothing_is_told_of_it() -> None:
    """A row far off the mask would look alike beside any tool."""
    far = affordance(1, offset=Point(9.0, 4.0), call=CALLS["extend arm 2"])
    assert borrow([replace(LENDER, rows=[far])], LENDER.mask, REPERTOIRE, ALL, streams) == ()


def test_so_many_are_drawn_of_each_and_so_many_kept_whatever_the_order() -> None:
    rows = [
        affordance(step, offset=Point(-2.4, 4.0 + 0.1 * step), call=CALLS["slide arm left 5"])
        for step in range(1, 60)
    ]
    others = [Lender(letter * 64, "hook", rows, LENDER.mask) for letter in "abc"]
    new = mask_of(((-0.4, 0.0, 0.4, 14.0),))
    few = Borrowing(each=10, most=25, shifts=1)
    found = borrow(others, new, REPERTOIRE, few, streams)
    assert found == borrow(others[::-1], new, REPERTOIRE, few, streams)
    assert len(found) == 25
    for letter in "abc":
        assert len({one.step for one in found if one.lender == letter * 64}) <= 10
    without = borrow(others, new, REPERTOIRE, replace(few, most=1000, shifts=0), streams)
    assert {one.shift for one in without} == {(0.0, 0.0)}


def test_the_whole_table_of_the_most_similar_tool() -> None:
    stick = Lender("c" * 64, "stick", ROWS[:1], mask_of(HOOK[:1]))
    whole = Borrowing(way="whole")
    found = borrow([stick, LENDER], mask_of(HOOK[:2], BLUE), REPERTOIRE, whole, streams)
    assert [(one.tool, one.step) for one in found] == [("hook", row.step) for row in ROWS]
    assert not any(one.mirrored or any(one.shift) for one in found)
    assert {one.row.start.colors[3:] for one in found} == {BLUE}


def test_a_wrong_mask_carries_less_over() -> None:
    grown = Borrowing(each=100, most=1000, shifts=0, grown=0.4)
    found = borrow([LENDER], LENDER.mask, REPERTOIRE, grown, streams)
    assert len(found) < len(
        borrow([LENDER], LENDER.mask, REPERTOIRE, replace(grown, grown=0.0), streams)
    )


def test_what_turns_is_mirrored_by_turning_the_other_way() -> None:
    assert mirrored_motion((Slide(0.0, 2.0), Turn(30.0))) == (Slide(0.0, 2.0), Turn(-30.0))
    assert mirrored_motion((Carry(ROWS[0].as_placed[0]),)) is None
    turns: Repertoire = (composed((Turn(30.0),)), composed((Turn(-30.0),)))
    row = affordance(2, offset=Point(-2.3, 6.0), moved=(0.3, 0.3), call=turns[0].call)
    cut = replace(row, step=5, truncated=True)
    found = borrow([replace(LENDER, rows=[row, cut])], LENDER.mask, turns, ALL, streams)
    assert {one.step for one in found} == {2}
    assert {str(one.row.exploratory) for one in found if one.mirrored} == {"turn -30"}


def test_rows_of_a_log_that_say_no_place_are_left_out() -> None:
    blind: Affordance = replace(ROWS[0], start=ROWS[0].start._replace(wrist_to_object_x=math.nan))
    assert borrow([replace(LENDER, rows=[blind])], LENDER.mask, REPERTOIRE, ALL, streams) == ()
