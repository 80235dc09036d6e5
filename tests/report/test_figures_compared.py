"""Figures of conditions: what is drawn where, and that it fits a column."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text

from affcli.analysis.courses import Course, Line, Point, course_line, swept_line
from affcli.analysis.paired import Comparison
from affcli.core.results import ConditionCounts
from affcli.report.captions import comparison_words
from affcli.report.figures.canvas import INK, ONE_COLUMN, TWO_COLUMNS, encoded
from affcli.report.figures.compare import compare_figure
from affcli.report.figures.curve import curve_figure
from affcli.report.paired import comparison_tables, ranges, signed
from affcli.report.text_tables import latex, markdown
from tests.analysis.test_paired import condition
from tests.report.drawn import drawn

BASE = condition("paper", [1] * 12, [2, 3] * 6, [4] * 12)
OTHER = condition("two moves", [3] * 11 + [1], [3, 2] * 6, [4] * 12)
THIRD = condition("three moves", [1] * 11 + [0], [2, 3] * 6, [3] * 12)
OTHER_HOOK = condition("hooks", [1] * 12, [3, 2] * 6, [3] * 12)
ONE = Comparison.of(BASE, [OTHER])
TWO = Comparison.of(BASE, [OTHER, THIRD])


def texts(figure: Figure) -> set[str]:
    return {text.get_text() for text in figure.findobj(Text)}


def test_each_difference_stands_in_its_row_with_its_interval() -> None:
    figure = compare_figure(ONE)
    assert figure.get_size_inches()[0] == ONE_COLUMN
    *_, cells = figure.axes
    assert [label.get_text() for label in cells.get_yticklabels()] == [
        "Stick, goal 1",
        "T-hook, goal 1",
    ]
    lines = [(line, np.column_stack(line.get_data())) for line in cells.lines]
    marks = {
        float(at[0][1]): (float(at[0][0]), line.get_markerfacecolor())
        for line, at in lines
        if line.get_marker() == "o"
    }
    stick, hook = ONE.cells
    assert marks == {0.0: (stick.mean, INK), 1.0: (hook.mean, "white")}
    assert (stick.significant, hook.significant) == (True, False)
    assert hook.interval is not None
    assert stick.interval is None
    bars = [tuple(at[:, 0]) for _, at in lines if len(at) == 2 and at[0][1] == 1.0]
    assert bars == [hook.interval]
    assert "not drawn: 1 cell the same in all robots" in comparison_words(ONE).caption
    assert "solved by a robot: two moves minus paper" in texts(figure)


def test_several_conditions_differ_in_mark_and_colour() -> None:
    figure = compare_figure(TWO)
    assert figure.get_size_inches()[0] == TWO_COLUMNS
    assert {"two moves", "three moves"} <= texts(figure)
    drawn_as = {
        (line.get_marker(), to_hex(line.get_color()))
        for line in figure.axes[-1].lines
        if line.get_marker() not in ("None", "")
    }
    assert len({mark for mark, _ in drawn_as}) == len({color for _, color in drawn_as}) == 2
    assert encoded(figure, ".png") == encoded(compare_figure(TWO), ".png")


def test_rows_are_in_the_order_of_the_paper_whichever_condition_differs_first() -> None:
    changed = condition("stick", [2] * 12, [2, 3] * 6, [4] * 12)
    figure = compare_figure(Comparison.of(BASE, [OTHER_HOOK, changed]))
    labels = [label.get_text() for label in figure.axes[-1].get_yticklabels()]
    assert labels == ["Stick, goal 1", "T-hook, goal 1", "T-hook as L-hook, goal 1"]


def test_tasks_that_are_not_the_papers_are_named() -> None:
    wide, narrow = "anywhere:half_width=2.25", "anywhere:half_width=0.5"

    def both(one: ConditionCounts) -> ConditionCounts:
        stick = next(iter(one.cells.items()))
        cells = {stick[0]._replace(task_set=tasks): stick[1] for tasks in (wide, narrow)}
        return replace(one, cells=cells)

    figure = compare_figure(Comparison.of(both(BASE), [both(OTHER)], ()))
    labels = [axes.get_yticklabels()[0].get_text() for axes in figure.axes]
    assert labels == [f"{tasks}, of 4" for tasks in (wide, narrow)]


def test_a_caption_counts_the_robots_that_lived() -> None:
    lived = replace(BASE, cells={c: {0: own[0], 1: own[1]} for c, own in BASE.cells.items()})
    planned = BASE.session.spec.robots
    words = comparison_words(Comparison.of(lived, [OTHER])).caption
    assert words.startswith("paper: session ")
    assert "(reproduce), 2 robots, seed" in words.split("two moves")[0]
    assert f"{planned} robots, seed" not in words.split("two moves")[0]


def test_marks_of_the_key_are_hollow_but_for_the_significant() -> None:
    (key,) = compare_figure(TWO).legends
    fills = {
        text.get_text(): handle.get_markerfacecolor()
        for text, handle in zip(key.get_texts(), key.legend_handles, strict=True)
        if isinstance(handle, Line2D) and handle.get_marker() != "None"
    }
    filled = [words for words, fill in fills.items() if fill != "white"]
    assert filled == ["significant, corrected"]
    assert {"two moves", "three moves"} <= fills.keys()


def course(rows: float) -> Course:
    minutes = [0.0, 1.0, 2.0, 3.0]
    return Course(minutes, [rows * m for m in minutes], [np.nan, *[rows / 10] * 3])


def test_courses_are_lines_with_bands_and_begin_where_all_are_known() -> None:
    lines = [course_line(f"c{n}", [course(r + n) for r in range(1, 7)], "share", "minutes")
             for n in range(2)]  # fmt: skip
    assert [point.x for point in lines[0].points] == [1.0, 2.0]  # the end is each robot's own
    assert lines[0].points[0].mean == pytest.approx(0.35)
    assert lines[0].points[0].interval is not None
    figure = curve_figure(lines, "minutes", "share")
    (axes,) = figure.axes
    assert len(axes.lines) == len(axes.collections) == 2
    assert {"c0", "c1", "95 % interval of the mean"} <= texts(figure)


def test_a_sweep_is_points_with_bars_on_an_axis_that_fits() -> None:
    values = {0.25: [60, 62, 64, 66, 70], 0.008: [69] * 5, 0.06: [68, 69]}
    line = swept_line("of 80", "", values, 80)
    assert [(point.x, point.robots) for point in line.points] == [(0.008, 5), (0.06, 2), (0.25, 5)]
    assert [point.interval is None for point in line.points] == [True, True, False]
    figure = curve_figure([line, replace(line, panel="of 16")], "noise (in)", "solved")
    above, below = figure.axes
    assert (above.get_xscale(), above.get_title(loc="left")) == ("log", "of 80")
    assert [label.get_text() for label in below.get_xticklabels()] == ["0.008", "0.06", "0.25"]
    alone = curve_figure([Line("", "", (Point.of(1.0, [3.0]),))], "x", "y")
    assert "mean of the robots" in texts(alone)


def test_conditions_along_time_are_marks_that_nothing_joins() -> None:
    lines = [
        swept_line("", name, {10.0: [float(n), *range(6)]}, 80.0) for n, name in enumerate("ab")
    ]
    (axes,) = curve_figure(lines, "minutes", "solved").axes
    marks = [line for line in axes.lines if line.get_marker() in {"o", "s"}]
    assert [np.size(line.get_xdata()) for line in marks] == [1, 1]
    assert {line.get_linestyle() for line in marks} == {"None"}
    assert len({line.get_color() for line in marks}) == 2
    several = [replace(line, panel=panel) for panel in ("x", "y") for line in lines]
    figure = curve_figure(several, "minutes", "solved")
    words = [text.get_text() for text in figure.findobj(Text)]
    assert (words.count("a"), words.count("b")) == (1, 1)


def test_sweeps_of_several_conditions_are_lines_of_their_own() -> None:
    lines = [swept_line("", name, {1.0: [1.0], 2.0: [2.0]}, 80.0) for name in "ab"]
    (axes,) = curve_figure(lines, "noise", "solved").axes
    assert [line.get_linestyle() for line in axes.lines] == ["-", "-"]
    assert len({line.get_marker() for line in axes.lines}) == 2


@pytest.mark.parametrize("columns", [80, 40])
def test_the_tables_fit_the_screen(columns: int) -> None:
    text = drawn(comparison_tables(TWO), columns)
    assert all(len(line.rstrip()) <= columns for line in text.splitlines())
    words = " ".join(text.split())
    for name in ("two moves", "three moves"):
        assert f"{name} against paper: 12 pairs of robots" in words
    assert "corrected by Holm in each table (3 and 4 tests)" in words


def test_a_total_stands_in_one_line_of_80_columns() -> None:
    text = drawn(comparison_tables(Comparison.of(BASE, [replace(OTHER, name="other")])), 80)
    title = "12 pairs of robots, extension of reach of 8, tool adaptation of 4 trials"
    assert title in " ".join(text.split())
    (row,) = (line for line in text.splitlines() if line.startswith("extension of reach "))
    assert row.split()[3:6] == ["3.50", "5.33", "+1.83"]
    alone = replace(BASE, cells=dict(list(BASE.cells.items())[:1]))
    assert "12 pairs of robots, of 4 trials" in drawn(
        comparison_tables(Comparison.of(alone, [OTHER])), 80
    )


def test_marks_of_markdown_and_latex_are_escaped() -> None:
    odd = Comparison.of(BASE, [replace(OTHER, name="50 % | a_b*")])
    assert "50 % \\| a\\_b\\*" in markdown(comparison_tables(odd))
    text = latex(comparison_tables(odd))
    assert "50 \\% \\textbar{} a\\_b*" in text
    assert text.count("{") == text.count("}")


def test_numbers_in_words() -> None:
    assert ranges([0, 3, 4, 5, 9]) == "0, 3 to 5, 9"
    assert ranges([]) == ""
    assert [signed(x) for x in (0.004, -0.004, 1.0, -0.126)] == ["0.00", "0.00", "+1.00", "-0.13"]
