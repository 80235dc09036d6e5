"""What stands in the other figures of what was learned, read back from the figures."""

import math
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.patches import Arc, Rectangle

from affcli.analysis.row_status import RowStatus
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import Point
from affcli.core.tool import ToolName
from affcli.report.figures.affordances import affordances_figure
from affcli.report.figures.canvas import FORMATS, ONE_COLUMN, encoded, style
from affcli.report.figures.learning import MOST_CURVES, bands_figure, curves_figure
from affcli.report.figures.row import row_figure
from affcli.report.figures.things import round_length
from affcli.report.figures.tools import tools_figure
from affcli.report.figures.workspace import workspace_figure
from affcli.report.table_views import RowView
from affcli.simulation.tasks.extension_of_reach import goal_regions, start_positions
from tests.factories import affordance, learning_spec
from tests.report import drawn_figures as drawn
from tests.report.drawn_figures import (
    CALLS,
    FIGURES,
    L_HOOK,
    REACH,
    T_HOOK,
    TASKS,
    TOOLS,
    WORKSPACE,
)
from tests.report.reading import (
    arrows_in,
    circles,
    laid_out,
    outlines,
    right_edge,
    texts,
    written,
)

ROOT = Path(__file__).parents[2]
SEED = learning_spec().seed
MISCHIEF = "$x_{^\\frac <script>[/]\x1b[31m" + "č机" * 9


def test_names_are_shown_as_they_are_and_never_as_formulas() -> None:
    call = BehaviorCall.of(BehaviorName(MISCHIEF), {"$d$": 3.0})
    row = replace(affordance(call=call), binding=call)
    table = affordances_figure(
        [], [drawn.view([(row, RowStatus.LIVE)], "$h_{$")], {RowStatus.LIVE: "$"}
    )
    one = row_figure(RowView(row, T_HOOK, 1.5))
    lines = curves_figure([drawn.curve(MISCHIEF, slope) for slope in (1.0, 2.0)])
    for figure in (table, one, lines):
        assert encoded(figure, ".svg")
        shown = [text for text in written(figure) if "<script>" in text.get_text()]
        assert shown
        for text in shown:
            assert "$x_{" in text.get_text()
            assert text.get_text().replace("\n", " ").isprintable()
            assert not text.get_parse_math()


@pytest.mark.parametrize(("used", "successful"), [(1, 1), (4, 3), (2, 1)])
def test_a_row_says_what_the_robot_keeps_of_it(used: int, successful: int) -> None:
    row = affordance(
        moved=(0.0, -3.04),
        offset=Point(2.0, 9.0),
        at=Point(-0.01, 22.4),
        used=used,
        successful=successful,
        call=CALLS[3],
    )
    figure = row_figure(RowView(row, T_HOOK, 1.5))
    said = "\n".join(texts(figure))
    for words in ("Contract arm\n5 in", "Grasp, 1 in\nthe cross is the grasp point"):
        assert words in said
    assert "attractor (0.0, 22.4)" in said
    assert "attractor (0.0, 19.4)" in said
    assert said.count("wrist (-2.0, 13.4)") == 2
    assert "detected movement 3.0 in" in said
    assert f"= {successful} / {used} = {successful / used:.2f}" in said
    assert ("excluded: not" in said) == (2 * successful <= used)
    assert "cut short: it met the" not in said
    cut_short = row_figure(RowView(replace(row, truncated=True), T_HOOK, 1.5))
    assert "cut short: it met the" in "\n".join(texts(cut_short))


def test_a_row_is_drawn_where_it_was_seen() -> None:
    """Attractor before (dashed) and after, and the movement between, from where the wrist was."""
    row = drawn.table()[3]
    figure = row_figure(RowView(row, T_HOOK, 1.5))
    before, after = (axes for axes in figure.axes if circles(axes))
    began, moved = row.start.wrist_to_object, row.expected_movement
    ended = (began.x + moved.dx, began.y + moved.dy)
    assert [circle.center for circle in circles(before)] == [began]
    assert [circle.center for circle in circles(after)] == [began, pytest.approx(ended)]
    ((start, end),) = arrows_in(after)
    assert start == began
    assert end == pytest.approx(ended)
    assert (outlines(before, dashed=True), outlines(after, dashed=True)) == (0, 5)
    assert (before.get_xlim(), before.get_ylim()) == (after.get_xlim(), after.get_ylim())


def test_a_row_of_a_turned_wrist_is_drawn_with_the_tool_turned() -> None:
    row = replace(drawn.table()[3], wrist_angle=-math.pi / 2)
    before, _ = (axes for axes in row_figure(RowView(row, T_HOOK, 1.5)).axes if circles(axes))
    ahead = max(y for part in T_HOOK.parts for _, y in part.outline.vertices)
    assert right_edge(before) == pytest.approx(ahead)


def test_a_row_that_turns_the_wrist_ends_with_the_tool_turned() -> None:
    row = replace(drawn.table()[3], wrist_angle=0.0)
    ends = [
        right_edge([axes for axes in figure.axes if circles(axes)][1])
        for figure in (row_figure(RowView(row, T_HOOK, 1.5, -turn)) for turn in (0.0, math.pi / 2))
    ]
    ahead = max(y for part in T_HOOK.parts for _, y in part.outline.vertices)
    assert ends[1] == pytest.approx(ahead)
    assert ends[0] < ends[1]


def test_the_workspace_shows_goals_starts_tool_and_reach() -> None:
    figure = workspace_figure(WORKSPACE, T_HOOK, REACH, TASKS)
    (axes,) = figure.axes
    assert figure.get_size_inches()[0] == ONE_COLUMN
    said = texts(figure)
    assert {"G1", "G2", "G3", "G4", "1", "2", "3", "4", "x (in)", "y (in)"} <= set(said)
    starts = start_positions(WORKSPACE.layout)
    placed = {t.get_text(): t.get_position() for t in axes.texts if t.get_text() in "1234"}
    assert placed == {str(number): tuple(place) for number, place in starts.items()}
    centers = [circle.center for circle in circles(axes)]
    assert all(tuple(place) in centers for place in starts.values())
    squares = {
        (p.get_x() + p.get_width() / 2, p.get_y() + p.get_height() / 2)
        for p in axes.patches
        if isinstance(p, Rectangle)
    }
    for goal in goal_regions(WORKSPACE.layout).values():
        assert any(math.dist(goal.center, middle) < 1e-9 for middle in squares)
    arcs = [patch for patch in axes.patches if isinstance(patch, Arc)]
    # The inner bound, 0.04 in, would be a speck on the arm's base.
    assert [arc.width / 2 for arc in arcs] == pytest.approx([REACH.outer])
    assert [(arc.theta1, arc.theta2) for arc in arcs] == [(0.0, 180.0)]
    assert outlines(axes, dashed=False) == 5


def test_an_arm_that_cannot_come_near_has_two_bounds() -> None:
    (axes,) = workspace_figure(WORKSPACE, T_HOOK, replace(REACH, inner=6.0), TASKS).axes
    arcs = [patch for patch in axes.patches if isinstance(patch, Arc)]
    assert [arc.width / 2 for arc in arcs] == pytest.approx([6.0, REACH.outer])


def test_every_part_of_the_tools_is_named_once_and_what_broke_off_is_dashed() -> None:
    figure = FIGURES["tools"](None)
    said = texts(figure)
    for name in (*(part.name for part in T_HOOK.parts), "grasp point", "attractor", "lost"):
        assert said.count(name) == 1
    for name in ("Stick", "L-stick", "L-hook", "T-stick", "T-hook"):
        assert said.count(name) == 1
    assert "T-hook that broke: the shape of the L-hook" in [one.replace("\n", " ") for one in said]
    held = [*(len(tool.parts) for tool in TOOLS.values()), len(L_HOOK.parts)]
    assert [outlines(axes, dashed=False) for axes in figure.axes] == [0, *held]
    assert [outlines(axes, dashed=True) for axes in figure.axes] == [0] * 6 + [2]
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in figure.axes}) == 1


@pytest.mark.parametrize("left", ["stick", "l-stick", "t-stick", "l-hook"])
def test_a_tool_can_break_in_several_ways(left: str) -> None:
    rest = TOOLS[ToolName(left)]
    figure = tools_figure(list(TOOLS.values()), (T_HOOK, rest), 1.5)
    assert outlines(figure.axes[-1], dashed=True) == len(T_HOOK.parts) - len(rest.parts)


def test_no_two_curves_look_alike_in_grey() -> None:
    figure = curves_figure([drawn.curve(f"run {n}", 1.0 + n) for n in range(MOST_CURVES)])
    rows, share = figure.axes
    for axes in (rows, share):
        looks: list[Any] = [
            (str(line.get_linestyle()), str(line._dash_pattern), line.get_marker())  # type: ignore[attr-defined]
            for line in axes.lines
        ]
        assert len(set(looks)) == len(looks) == MOST_CURVES
    assert rows.get_xlim() == share.get_xlim()
    assert rows.get_ylim()[0] == share.get_ylim()[0] == 0.0
    assert rows.get_ylim()[1] > 60.0 * MOST_CURVES
    (key,) = figure.legends
    for n, words in enumerate(key.get_texts()):
        assert words.get_text().startswith(f"run 1: Run {n}, seed {SEED}, ")


def test_many_robots_are_a_column_a_tool_on_the_same_axes() -> None:
    figure = FIGURES["bands"](None)
    assert len(figure.axes) == 10
    above, below = figure.axes[:5], figure.axes[5:]
    assert [axes.get_title() for axes in above] == [
        "Stick",
        "L-stick",
        "L-hook",
        "T-stick",
        "T-hook",
    ]
    for row in (above, below):
        assert len({(axes.get_xlim(), axes.get_ylim()) for axes in row}) == 1
    for axes, tool in zip(above, drawn.bands(), strict=True):
        (line,) = axes.lines
        assert np.array_equal(np.asarray(line.get_ydata()), tool.rows.mean)
        top = max(tool.rows.high)
        assert axes.get_ylim()[1] >= top
    assert {"mean of the robots", "range of the robots"} <= set(texts(figure))
    assert "95 % interval of the mean" not in texts(figure)


def test_more_tools_than_a_row_holds_go_on_below() -> None:
    many = [replace(drawn.bands()[0], tool=f"tool {n}") for n in range(7)]
    few = bands_figure([many[0], replace(many[1], robots=1)])
    assert [axes.get_title() for axes in few.axes[:2]] == ["Tool 0 (3 robots)", "Tool 1 (1 robot)"]
    figure = bands_figure(many)
    titles = [axes.get_title() for axes in figure.axes if axes.get_title()]
    assert titles == [f"Tool {n}" for n in range(7)]
    assert len(figure.axes) == 14
    tools = [replace(T_HOOK, name=ToolName(f"tool {n}")) for n in range(9)]
    shown = texts(tools_figure(tools, (T_HOOK, L_HOOK), 1.5))
    assert {f"Tool {n}" for n in range(9)} <= set(shown)


@given(st.floats(1e-3, 1e6))
def test_a_bar_of_a_round_length_fits_and_is_not_much_too_short(most: float) -> None:
    length = round_length(most)
    assert 0.39 * most <= length <= most * (1 + 1e-12)
    assert f"{length:.6e}"[0] in "125"


def test_the_same_figure_gives_the_same_bytes_in_every_process() -> None:
    """Whatever the order of hashing, and whatever a person has set matplotlib to."""
    tastes = str(ROOT / "tests/report/gaudy.mplrc")
    elsewhere = subprocess.run(
        [sys.executable, "-m", "tests.report.drawn_figures"],
        cwd=ROOT,
        env={**os.environ, "PYTHONHASHSEED": "2", "MATPLOTLIBRC": tastes},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        timeout=300,
    )
    one = drawn.hashes()
    assert one == elsewhere.stdout.splitlines()
    assert len(set(one)) == len(FIGURES) + len(FORMATS) - 1


@pytest.mark.parametrize("name", FIGURES)
def test_nothing_written_is_cut_off_at_the_edge_of_the_page(name: str) -> None:
    figure = FIGURES[name](None)
    width, height = figure.get_size_inches() * figure.dpi
    with style():
        figure.draw_without_rendering()
        boxes = {text: text.get_window_extent() for text in laid_out(figure) if text.get_text()}
    assert boxes
    for text, box in boxes.items():
        assert box.x0 > -1.0, text
        assert box.y0 > -1.0, text
        assert box.x1 < width + 1.0, text
        assert box.y1 < height + 1.0, text
