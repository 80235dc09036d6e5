"""What stands in the figures of what was learned, read back from the figures."""

import math
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba_array
from matplotlib.patches import Arc, Circle, Polygon, Rectangle
from matplotlib.text import Text

from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.task import goal_regions, start_positions
from affcli.core.tool import ToolName, ToolPart
from affcli.errors import BadInputError
from affcli.report.fates import Fate, RowView
from affcli.report.figures.affordances import affordances_figure
from affcli.report.figures.arrows import Arrow, Look, draw_arrows
from affcli.report.figures.canvas import FORMATS, ONE_COLUMN, TWO_COLUMNS, canvas, encoded, style
from affcli.report.figures.learning import MOST_CURVES, curves_figure
from affcli.report.figures.row import row_figure
from affcli.report.figures.scale import round_length
from affcli.report.figures.tools import tools_figure
from affcli.report.figures.workspace import workspace_figure
from tests.factories import affordance, places
from tests.report import drawn_figures as drawn
from tests.report.drawn_figures import CALLS, FIGURES, KEY, L_HOOK, REACH, T_HOOK, TOOLS, WORKSPACE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROOT = Path(__file__).parents[2]
TITLES = [
    f"{name} arm{side}, {inches} in"
    for inches in (2, 5)
    for name, side in (("Extend", ""), ("Contract", ""), ("Slide", " left"), ("Slide", " right"))
]
MISCHIEF = "$x_{^\\frac <script>[/]\x1b[31m" + "č机" * 9


def arrows_in(axes: "Axes") -> list[Arrow]:
    """Return the arrows of a panel: from the beginning of each line to the tip of its head."""
    return [
        (Point(*map(float, line[0])), Point(*map(float, head[0])))
        for lines, heads in kinds_in(axes)
        for line, head in zip(lines.get_segments(), corners(heads), strict=True)
    ]


def kinds_in(axes: "Axes") -> list[tuple[LineCollection, PolyCollection]]:
    """Return the lines and the heads of each kind of arrows of a panel."""
    lines = [c for c in axes.collections if isinstance(c, LineCollection)]
    heads = [c for c in axes.collections if isinstance(c, PolyCollection)]
    return list(zip(lines, heads, strict=True))


def corners(heads: PolyCollection) -> list[list[tuple[float, float]]]:
    """Return the tip and the other two corners of each head."""
    vertices = [np.asarray(path.vertices, dtype=float) for path in heads.get_paths()]
    return [[(float(x), float(y)) for x, y in some[:3]] for some in vertices]


def texts(figure: "Figure") -> list[str]:
    """Return all that is written in a figure, empty texts left out."""
    return [text.get_text() for text in written(figure) if text.get_text()]


def written(figure: "Figure") -> Iterator[Text]:
    """Yield the texts of a figure."""
    found: list[Any] = figure.findobj(Text)
    yield from found


def outlines(axes: "Axes", *, dashed: bool) -> int:
    """Return how many parts of tools a panel has, whole or missing ones."""
    polygons = [patch for patch in axes.patches if isinstance(patch, Polygon)]
    return sum((polygon.get_linestyle() not in {"-", "solid"}) == dashed for polygon in polygons)


def test_eight_panels_share_their_axes_and_say_what_they_show() -> None:
    figure = FIGURES["affordances"]()
    panels = figure.axes
    assert len(panels) == 8
    assert sorted(axes.get_title() for axes in panels) == sorted(TITLES)
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in panels}) == 1
    assert {axes.get_aspect() for axes in panels} == {1.0}
    sizes = {tuple(round(float(v), 9) for v in axes.get_position().size) for axes in panels}
    assert len(sizes) == 1
    assert figure.get_size_inches()[0] == TWO_COLUMNS
    assert all(outlines(axes, dashed=False) == 5 for axes in panels)
    assert figure.legends == []


def test_every_row_is_an_arrow_where_the_attractor_was_from_the_wrist() -> None:
    """Fig. 6: start in wrist-centred coordinates, movement in camera coordinates."""
    rows = drawn.table()
    figure = affordances_figure(CALLS, [drawn.view([(row, Fate.ROW) for row in rows])], KEY)
    titles = dict(zip(CALLS, sorted(TITLES, key=by_registry), strict=True))
    for axes in figure.axes:
        expected = [row for row in rows if titles[row.exploratory] == axes.get_title()]
        shown = arrows_in(axes)
        assert len(shown) == len(expected) == 3
        assert "3 rows" in [text.get_text() for text in axes.texts]
        for (start, end), row in zip(shown, expected, strict=True):
            moved = row.expected_movement
            assert start == pytest.approx(row.start.wrist_to_object)
            assert end == pytest.approx((start.x + moved.dx, start.y + moved.dy))
            assert all(
                axes.get_xlim()[0] < p.x < axes.get_xlim()[1]
                and axes.get_ylim()[0] < p.y < axes.get_ylim()[1]
                for p in (start, end)
            )


def by_registry(title: str) -> tuple[int, int]:
    """Sort titles as the registry sorts behaviors."""
    names = ("Extend", "Contract", "Slide arm left", "Slide arm right")
    return next(i for i, n in enumerate(names) if title.startswith(n)), int(title[-4])


def test_two_tables_stand_side_by_side_on_the_same_axes() -> None:
    views = drawn.compared_views()
    figure = affordances_figure(CALLS, views, KEY)
    left = [a for a in figure.axes if a.get_position().x1 < 0.5]
    right = [a for a in figure.axes if a.get_position().x0 > 0.5]
    assert (len(left), len(right)) == (8, 8)
    assert len({(a.get_xlim(), a.get_ylim()) for a in figure.axes}) == 1
    for axes, view in ((left, views[0]), (right, views[1])):
        assert sorted(a.get_title() for a in axes) == sorted(TITLES)
        assert sum(len(arrows_in(a)) for a in axes) == len(view.rows)
    assert all(outlines(a, dashed=True) == 0 for a in left)
    assert all(outlines(a, dashed=True) == 2 for a in right)
    assert {"Run 1", "Run 2"} <= set(texts(figure))


def test_rows_of_different_fates_differ_in_grey_too() -> None:
    """By dashes and by heads, and the key names each that occurs."""
    rows = drawn.table()
    fates = (Fate.KEPT, Fate.LOST, Fate.WON, Fate.EXCLUDED)
    mixed = [(row, fates[n // 8]) for n, row in enumerate(rows)]
    figure = affordances_figure(CALLS, [drawn.view(mixed)], KEY)
    for axes in figure.axes:
        looks = {
            (str(lines.get_linestyle()), bool(to_rgba_array(heads.get_facecolor()).min() > 0.99))
            for lines, heads in kinds_in(axes)
        }
        assert len(looks) == 3
        assert len({str(lines.get_color()) for lines, _ in kinds_in(axes)}) == 3
        assert "1 kept\n1 lost\n1 won" in [text.get_text() for text in axes.texts]
    (key,) = figure.legends
    assert [t.get_text() for t in key.get_texts()] == [KEY[fate] for fate in fates[:3]]


def test_a_table_without_rows_is_eight_empty_panels() -> None:
    figure = affordances_figure(CALLS, [drawn.view([])], KEY)
    assert texts(figure).count("no rows") == 8
    assert encoded(figure, ".png")


@pytest.mark.parametrize(("x", "y"), [(0.5, 1e5), (1e5, 0.5), (1e-3, 1e-3)])
def test_however_odd_a_tool_is_its_panels_fit_a_page(x: float, y: float) -> None:
    odd = ToolPart("handle", ConvexPolygon.box(-x, 0.0, x, y))
    figure = affordances_figure(CALLS, [replace(drawn.view([]), parts=(odd,))], KEY)
    width, height = figure.get_size_inches()
    assert width == TWO_COLUMNS
    assert 1.0 < height < 11.0
    for axes in figure.axes:
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        assert left < -x
        assert right > x
        assert low < 0.0
        assert high > y


def test_rows_of_other_behaviors_are_not_hidden() -> None:
    jump = BehaviorCall.of(BehaviorName("jump"), {"height": 3.0})
    rows = [(affordance(call=jump), Fate.ROW)]
    figure = affordances_figure(CALLS, [drawn.view(rows)], KEY)
    assert len(figure.axes) == 9
    assert "Jump, 3 in" in texts(figure)
    many = [
        (affordance(call=BehaviorCall.of(BehaviorName(f"b{n}"), {"d": 1.0})), Fate.ROW)
        for n in range(40)
    ]
    with pytest.raises(BadInputError, match="44 panels side by side"):
        affordances_figure(CALLS, [drawn.view(many)], KEY)


def test_names_are_shown_as_they_are_and_never_as_formulas() -> None:
    call = BehaviorCall.of(BehaviorName(MISCHIEF), {"$d$": 3.0})
    row = replace(affordance(call=call), binding=call)
    table = affordances_figure([], [drawn.view([(row, Fate.ROW)], "$h_{$")], {Fate.ROW: "$"})
    one = row_figure(RowView(row, T_HOOK, 1.5))
    lines = curves_figure([drawn.curve(MISCHIEF, 1.0)])
    for figure in (table, one, lines):
        assert encoded(figure, ".svg")
        shown = [text for text in written(figure) if "<script>" in text.get_text()]
        assert shown
        for text in shown:
            assert "$x_{" in text.get_text()
            assert text.get_text().isprintable()
            assert not text.get_parse_math()


lengths = st.floats(0.01, 30.0)


@settings(max_examples=25)  # each needs a figure
@given(st.lists(st.tuples(places, places), min_size=1, max_size=9), lengths)
def test_no_head_is_longer_than_its_arrow(arrows: list[Arrow], head: float) -> None:
    with canvas(2.0, 2.0) as figure:
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        draw_arrows(axes, arrows, Look("#000000"), head)
    assert arrows_in(axes) == arrows
    ((_, heads),) = kinds_in(axes)
    for (start, end), (tip, left, right) in zip(arrows, corners(heads), strict=True):
        neck = (0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1]))
        assert math.dist(tip, neck) <= min(head, 0.56 * math.dist(start, end)) + 1e-9


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
    said = texts(figure)
    for words in ("Contract arm", "5 in", "Grasp, 1 in", "+ grasp point"):
        assert words in said
    assert "attractor (0.0, 22.4)" in said
    assert "attractor (0.0, 19.4)" in said
    assert said.count("wrist (-2.0, 13.4)") == 2
    assert "detected movement 3.0 in" in said
    assert f"= {successful} / {used} = {successful / used:.2f}" in said
    assert ("excluded: not" in said) == (2 * successful <= used)
    assert "cut short: it met the" not in said
    assert "cut short: it met the" in texts(
        row_figure(RowView(replace(row, truncated=True), T_HOOK, 1.5))
    )


def test_a_row_is_drawn_where_it_was_seen() -> None:
    """Tool and attractor before (dashed) and after, and the movement between them."""
    row = drawn.table()[3]
    figure = row_figure(RowView(row, T_HOOK, 1.5))
    before, after = (axes for axes in figure.axes if any_circle(axes))
    assert [circle.center for circle in circles(before)] == [row.start.object_position]
    assert [circle.center for circle in circles(after)] == [
        row.start.object_position,
        row.end.object_position,
    ]
    ((start, end),) = arrows_in(after)
    assert start == pytest.approx(row.start.object_position)
    assert end == pytest.approx(row.end.object_position)
    assert (outlines(before, dashed=True), outlines(after, dashed=True)) == (0, 5)
    assert (before.get_xlim(), before.get_ylim()) == (after.get_xlim(), after.get_ylim())


def any_circle(axes: "Axes") -> bool:
    return bool(circles(axes))


def circles(axes: "Axes") -> list[Circle]:
    return [patch for patch in axes.patches if isinstance(patch, Circle)]


def test_the_workspace_shows_goals_starts_tool_and_reach() -> None:
    figure = workspace_figure(WORKSPACE, T_HOOK, REACH)
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
    assert [arc.width / 2 for arc in arcs] == pytest.approx([REACH.inner, REACH.outer])
    assert [(arc.theta1, arc.theta2) for arc in arcs] == [(0.0, 180.0)] * 2
    assert outlines(axes, dashed=False) == 5


def test_every_part_of_the_tools_is_named_once_and_what_broke_off_is_dashed() -> None:
    figure = FIGURES["tools"]()
    (axes,) = figure.axes
    said = texts(figure)
    for name in (*(part.name for part in T_HOOK.parts), "grasp point", "attractor", "lost"):
        assert said.count(name) == 1
    for name in ("Stick", "L-stick", "L-hook", "T-stick", "T-hook"):
        assert said.count(name) == 1
    assert "T-hook that broke:\nthe shape of the L-hook" in said
    parts = sum(len(tool.parts) for tool in TOOLS.values())
    assert outlines(axes, dashed=False) == parts + len(L_HOOK.parts)
    assert outlines(axes, dashed=True) == 2
    assert axes.get_aspect() == 1.0


@pytest.mark.parametrize("left", ["stick", "l-stick", "t-stick", "l-hook"])
def test_a_tool_can_break_in_several_ways(left: str) -> None:
    rest = TOOLS[ToolName(left)]
    figure = tools_figure(list(TOOLS.values()), (T_HOOK, rest), 1.5)
    assert outlines(figure.axes[0], dashed=True) == len(T_HOOK.parts) - len(rest.parts)


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
    assert [t.get_text() for t in key.get_texts()] == [f"run {n}" for n in range(MOST_CURVES)]


def test_many_robots_are_a_column_a_tool_on_the_same_axes() -> None:
    figure = FIGURES["bands"]()
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
    assert {"mean of 3 robots", "range of the robots"} <= set(texts(figure))


@given(st.floats(1e-3, 1e6))
def test_a_bar_of_a_round_length_fits_and_is_not_much_too_short(most: float) -> None:
    length = round_length(most)
    assert 0.39 * most <= length <= most * (1 + 1e-12)
    assert f"{length:.6e}"[0] in "125"


def test_the_same_figure_gives_the_same_bytes_in_every_process() -> None:
    """Whatever the order of hashing, and whatever a person has set matplotlib to."""
    drawing = [
        subprocess.Popen(
            [sys.executable, "-m", "tests.report.drawn_figures"],
            cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": seed, "MATPLOTLIBRC": tastes},
            stdout=subprocess.PIPE,
            text=True,
        )
        for seed, tastes in (("1", os.devnull), ("2", str(ROOT / "tests/report/gaudy.mplrc")))
    ]
    one, other = (process.communicate(timeout=300)[0].splitlines() for process in drawing)
    assert one == other
    assert len(set(one)) == len(FIGURES) + len(FORMATS) - 1


@pytest.mark.parametrize("name", FIGURES)
def test_nothing_written_is_cut_off_at_the_edge_of_the_page(name: str) -> None:
    figure = FIGURES[name]()
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


def laid_out(figure: "Figure") -> Iterator[Text]:
    """Yield the texts of a figure but the numbers at its axes, some of which are not drawn."""
    yield from figure.texts
    for key in figure.legends:
        yield from key.get_texts()
    for axes in figure.axes:
        yield from axes.texts
        if axes.axison:
            yield from (axes.title, axes.xaxis.label, axes.yaxis.label)
