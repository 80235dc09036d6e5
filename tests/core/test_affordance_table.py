"""The affordance table in memory: age, columns, counters, colours (§3.2, §6.2)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.affordance import Affordance
from affcli.core.affordance_table import COLOR_TOLERANCE, AffordanceTable
from affcli.core.geometry import Point
from affcli.core.tool import PUCK_COLOR, Color, ToolName
from affcli.simulation.tools.paper import TOOL_COLORS
from tests.factories import TOOL_COLOR, affordance, eighths, observation, places, table_of

STICK_COLOR = TOOL_COLORS[ToolName("stick")]


def numbered(steps: list[int]) -> list[Affordance]:
    """Return a row for each step, each with its own movement."""
    return [affordance(step, moved=(float(step), 1.0)) for step in steps]


@settings(deadline=None)
@given(st.permutations(range(1, 9)))
def test_rows_stand_in_the_order_in_which_they_were_made(steps: list[int]) -> None:
    table = AffordanceTable(numbered(steps))
    assert [row.step for row in table] == sorted(steps)
    assert len(table) == len(steps)


def test_initially_the_affordance_table_is_blank() -> None:
    """§3.2: "Initially the affordance table is blank."."""
    table = AffordanceTable()
    assert len(table) == 0
    assert list(table) == []
    assert table.with_colors_of(observation()).tolist() == []


@settings(deadline=None)
@given(st.lists(st.tuples(places, eighths, eighths), min_size=1, max_size=6))
def test_the_columns_say_what_the_rows_say(drawn: list[tuple[Point, float, float]]) -> None:
    rows = [
        affordance(step, offset=offset, moved=(dx, dy))
        for step, (offset, dx, dy) in enumerate(drawn)
    ]
    table = AffordanceTable(rows)
    assert table.movement_x.tolist() == [row.expected_movement.dx for row in rows]
    assert table.movement_y.tolist() == [row.expected_movement.dy for row in rows]
    assert table.movement_z.tolist() == [0.0] * len(rows)
    assert table.offset_x.tolist() == [row.start.wrist_to_object.x for row in rows]
    assert table.offset_y.tolist() == [row.start.wrist_to_object.y for row in rows]
    assert list(table) == rows


@settings(deadline=None)
@given(st.lists(st.tuples(st.integers(0, 2), st.booleans()), max_size=40))
def test_a_use_counts_once_and_a_success_counts_in_both_counters(
    uses: list[tuple[int, bool]],
) -> None:
    """§3.2: "the integer counters of all rows are set to 1. They are updated during testing
    trials.": one more use each time, one more success when it replicated; other rows untouched."""
    table = AffordanceTable(numbered([1, 2, 3]))
    for position, success in uses:
        table.count_use(position, success=success)
    for position, row in enumerate(table):
        tries = [success for used, success in uses if used == position]
        assert row.times_used == 1 + len(tries)
        assert row.times_successful == 1 + sum(tries)
        assert row == table.row(position)
        assert bool(table.probable[position]) is (2 * row.times_successful > row.times_used)


@settings(deadline=None)
@given(st.lists(st.tuples(st.integers(0, 2), st.booleans()), min_size=1, max_size=20))
def test_counters_of_a_table_as_learned_leave_the_table_it_came_from_alone(
    uses: list[tuple[int, bool]],
) -> None:
    """§7.2: each experiment "started the testing trial with the original representation"."""
    rows = numbered([1, 2, 3])
    table = AffordanceTable(rows)
    twin = table.as_learned()
    for position, success in uses:
        twin.count_use(position, success=success)
    assert list(table) == rows
    assert table.probable.tolist() == [True, True, True]
    assert list(twin) != rows
    assert list(table.as_learned()) == rows
    assert [row.step for row in twin] == [1, 2, 3]


def test_counters_that_a_row_brings_are_kept() -> None:
    table = table_of(affordance(1, used=7, successful=4))
    assert (table.row(0).times_used, table.row(0).times_successful) == (7, 4)


def test_counters_read_from_a_table_are_plain_numbers() -> None:
    row = table_of(affordance()).row(0)
    assert type(row.times_used) is type(row.times_successful) is int


@pytest.mark.parametrize("end", ["object", "tool"])
def test_colours_fit_up_to_the_tolerance_and_not_beyond(end: str) -> None:
    """§6.2, search 1: "consistent with the colors of the current tool and object". Both count."""
    table = table_of(affordance())
    for off, fits in ((0.0, True), (COLOR_TOLERANCE, True), (COLOR_TOLERANCE + 1e-6, False)):
        color = PUCK_COLOR if end == "object" else TOOL_COLOR
        shifted = (color[0], color[1] + off, color[2])
        seen = (
            observation(object_color=shifted)
            if end == "object"
            else observation(tool_color=shifted)
        )
        assert table.with_colors_of(seen).tolist() == ([0] if fits else [])


palette = st.sampled_from([*TOOL_COLORS.values()])
tints = st.tuples(*[st.floats(-8.0, 8.0)] * 3)


def tinted(color: Color, tint: tuple[float, ...]) -> Color:
    """Return a colour as a noisy sensor sees it."""
    return Color(min(255.0, max(0.0, c + t)) for c, t in zip(color, tint, strict=True))


@settings(deadline=None)
@given(st.lists(st.tuples(palette, tints), max_size=12), palette, tints)
def test_rows_of_the_current_tool_are_found_through_noise_and_rows_of_others_are_not(
    drawn: list[tuple[Color, tuple[float, ...]]], held: Color, tint: tuple[float, ...]
) -> None:
    """§6.2, search 1: "Select all rows that have observation vectors consistent with the colors of
    the current tool and object"; one table may hold the rows of several tools."""
    rows = [affordance(k, tool_color=tinted(*colored)) for k, colored in enumerate(drawn)]
    found = AffordanceTable(rows).with_colors_of(observation(tool_color=tinted(held, tint)))
    assert found.tolist() == [k for k, (color, _) in enumerate(drawn) if color == held]


def test_positions_found_can_index_the_columns() -> None:
    table = table_of(affordance(1), affordance(2, tool_color=STICK_COLOR), affordance(3))
    found = table.with_colors_of(observation())
    assert found.dtype == np.intp
    assert table.times_used[found].tolist() == [1, 1]
    assert found.tolist() == [0, 2]


def test_a_colour_that_is_not_known_contradicts_none() -> None:
    """And rows of a log, which has none, found one class, however many they are."""
    unknown = Color((np.nan,) * 3)
    table = table_of(
        affordance(1, object_color=unknown, tool_color=unknown),
        affordance(2, tool_color=Color((0.0, 0.0, 0.0))),
        affordance(3, object_color=unknown, tool_color=unknown),
    )
    assert table.with_colors_of(observation()).tolist() == [0, 1, 2]
