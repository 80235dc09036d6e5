"""What stands in figures of affordance tables, read back from the figures."""

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba_array

from affcli.analysis.regions import parts_at
from affcli.analysis.row_status import RowStatus
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import ConvexPolygon
from affcli.core.tool import ToolPart
from affcli.report.figures.affordances import affordances_figure
from affcli.report.figures.arrows import Arrow, Look, draw_arrows
from affcli.report.figures.canvas import TWO_COLUMNS, canvas, encoded
from tests.factories import affordance, places
from tests.report import drawn_figures as drawn
from tests.report.drawn_figures import CALLS, FIGURES, KEY
from tests.report.reading import (
    arrows_in,
    corners,
    kinds_in,
    lower_edge,
    outlines,
    right_edge,
    texts,
)

TITLES = [
    f"{name} arm{side}, {inches} in"
    for inches in (2, 5)
    for name, side in (("Extend", ""), ("Slide", " left"), ("Slide", " right"), ("Contract", ""))
]
"""In the order of Fig. 6."""


def head_of(axes: Axes) -> tuple[str, str]:
    """Return the title of a panel, and how many rows it says it has."""
    title, _, counts = axes.get_title().rpartition("\n")
    return title, counts


def test_eight_panels_share_their_axes_and_say_what_they_show() -> None:
    figure = FIGURES["affordances"](None)
    panels = figure.axes
    assert len(panels) == 8
    assert [head_of(axes)[0] for axes in panels] == TITLES
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in panels}) == 1
    assert {axes.get_aspect() for axes in panels} == {1.0}
    sizes = {tuple(round(float(v), 6) for v in axes.get_position().size) for axes in panels}
    assert len(sizes) == 1
    assert figure.get_size_inches()[0] == TWO_COLUMNS
    assert all(outlines(axes, dashed=False) == 5 for axes in panels)
    assert figure.legends == []


def test_every_row_is_an_arrow_where_the_attractor_was_from_the_wrist() -> None:
    """Fig. 6: start in wrist-centred coordinates, movement in camera coordinates."""
    rows = drawn.table()
    figure = affordances_figure(CALLS, [drawn.view([(row, RowStatus.LIVE) for row in rows])], KEY)
    titles = dict(zip(CALLS, sorted(TITLES, key=by_registry), strict=True))
    for axes in figure.axes:
        title, counts = head_of(axes)
        expected = [row for row in rows if titles[row.exploratory] == title]
        shown = arrows_in(axes)
        assert len(shown) == len(expected) == 3
        assert counts == "3 rows"
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
    left, right = (page.axes for page in figure.subfigs)
    assert (len(left), len(right)) == (8, 8)
    assert len({(a.get_xlim(), a.get_ylim()) for a in figure.axes}) == 1
    for axes, view in ((left, views[0]), (right, views[1])):
        assert sorted(head_of(a)[0] for a in axes) == sorted(TITLES)
        assert sum(len(arrows_in(a)) for a in axes) == len(view.rows)
    assert all(outlines(a, dashed=True) == 0 for a in left)
    assert all(outlines(a, dashed=True) == 2 for a in right)
    assert {"Run 1", "Run 2"} <= set(texts(figure))


def test_rows_of_different_statuses_differ_in_grey_too() -> None:
    """By dashes and by heads, and the key names each that occurs."""
    rows = drawn.table()
    statuses = (RowStatus.KEPT, RowStatus.LOST, RowStatus.WON, RowStatus.EXCLUDED)
    mixed = [(row, statuses[n // 8]) for n, row in enumerate(rows)]
    figure = affordances_figure(CALLS, [drawn.view(mixed)], KEY)
    for axes in figure.axes:
        looks = {
            (str(lines.get_linestyle()), bool(to_rgba_array(heads.get_facecolor()).min() > 0.99))
            for lines, heads in kinds_in(axes)
        }
        assert len(looks) == 3
        assert len({str(lines.get_color()) for lines, _ in kinds_in(axes)}) == 3
        assert head_of(axes)[1] == "1 kept, 1 lost, 1 won"
    (key,) = figure.legends
    assert [t.get_text() for t in key.get_texts()] == [KEY[status] for status in statuses[:3]]


def test_a_table_without_rows_is_eight_empty_panels() -> None:
    figure = affordances_figure(CALLS, [drawn.view([])], KEY)
    assert [head_of(axes)[1] for axes in figure.axes] == ["no rows"] * 8
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
    rows = [(affordance(call=jump), RowStatus.LIVE)]
    figure = affordances_figure(CALLS, [drawn.view(rows)], KEY)
    assert len(figure.axes) == 9
    assert "Jump, 3 in\n1 row" in texts(figure)


@pytest.mark.parametrize(("behaviors", "tables"), [(1, 1), (2, 3), (6, 2), (13, 1)])
def test_any_number_of_behaviors_stands_in_rows_that_fit(behaviors: int, tables: int) -> None:
    calls = [
        BehaviorCall.of(BehaviorName(f"b{n}"), {"angle": float(angle)})
        for n in range(behaviors)
        for angle in (15, 30)
    ]
    views = [drawn.view([(affordance(call=call), RowStatus.LIVE) for call in calls])] * tables
    figure = affordances_figure(calls, views, KEY)
    assert len(figure.axes) == len(calls) * tables
    titles = sorted(head_of(axes)[0] for axes in figure.axes)
    assert titles == sorted([f"B{n}, {a} deg" for n in range(behaviors) for a in (15, 30)] * tables)
    figure.draw_without_rendering()
    width, _ = figure.get_size_inches()
    for axes in figure.axes:
        box = axes.get_window_extent()
        assert box.width > 0.7 * figure.dpi
        assert 0.0 < box.x0 < box.x1 < (width + 0.01) * figure.dpi


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


def test_rows_of_a_turned_wrist_have_a_panel_where_the_tool_is_turned() -> None:
    straight, other = affordance(1, call=CALLS[0]), affordance(2, call=CALLS[0])
    turned = replace(other, wrist_angle=-math.pi / 2)
    rows = [(row, RowStatus.LIVE) for row in (straight, turned)]
    panels = affordances_figure([], [drawn.view(rows)], KEY).axes
    assert [axes.get_title() for axes in panels] == [
        "Extend arm, 2 in\nwrist at -90 deg\n1 row",
        "Extend arm, 2 in\n1 row",
    ]
    assert [len(arrows_in(axes)) for axes in panels] == [1, 1]
    parts = drawn.T_HOOK.parts
    ahead = max(y for part in parts for _, y in part.outline.vertices)
    beside = max(x for part in parts for x, _ in part.outline.vertices)
    # A quarter to the right: what was ahead of the wrist is beside it.
    assert [right_edge(axes) for axes in panels] == [pytest.approx(ahead), pytest.approx(beside)]


def test_rows_of_another_grasp_have_panels_of_their_own_over_the_tool_as_it_was_held() -> None:
    high = BehaviorCall.of(BehaviorName("grasp"), {"grasp_point": 7.0})
    rows = [affordance(1, call=CALLS[0]), affordance(2, call=CALLS[0], binding=high)]
    held = parts_at(drawn.T_HOOK, high, 0.0)
    view = replace(
        drawn.view([(row, RowStatus.LIVE) for row in rows]), regrasped={high: (held, ())}
    )
    panels = {head_of(axes)[0]: axes for axes in affordances_figure(CALLS, [view], KEY).axes}
    assert panels.keys() == {*TITLES, f"{TITLES[0]}\nGrasp, 7 in"}
    for title, axes in panels.items():
        assert lower_edge(axes) == pytest.approx(-7.0 if "Grasp" in title else -1.0)
        assert len(arrows_in(axes)) == (TITLES[0] in title)
