"""Our results beside the paper's: what the figure is made of, and what stands in it."""

import json
from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text

from affcli.analysis.comparison import Beside, Results, results_of_many, results_of_single
from affcli.analysis.paper import BROKEN as IN_PAPER
from affcli.analysis.paper import EXTENSION_OF_REACH, GOALS, TOOLS, TOTAL
from affcli.analysis.statistics import Spread
from affcli.core.records import TrialInfo
from affcli.core.specs import Protocol
from affcli.core.trial import Outcome
from affcli.report.captions import results_words
from affcli.report.figures.canvas import INK, SKY, TWO_COLUMNS, VERMILION, encoded
from affcli.report.figures.results import results_figure
from tests.report.hand_made import FOUR_ROBOTS, MANY_ROBOTS, RUNS, session_of, trial_info


def result(
    tool: str, goal: str, start: int, *, solved: bool = True, shape: str | None = None, **more: Any
) -> TrialInfo:
    """Return how a trial of run 1 ended."""
    usual: dict[str, Any] = {
        "shape": shape or tool,
        "protocol": Protocol.TOOL_ADAPTATION if shape else Protocol.EXTENSION_OF_REACH,
        "outcome": Outcome.SOLVED if solved else Outcome.STEP_LIMIT,
    }
    return trial_info(1, RUNS[0], tool, goal, str(start), **(usual | more))


SOLVED = [result(tool, goal, start) for tool, goal in EXTENSION_OF_REACH for start in range(1, 5)]
BROKEN = [
    result("t-hook", goal, start, shape="l-hook", solved=(goal, start) != ("1", 1))
    for goal in GOALS
    for start in range(1, 5)
]


def single(whole: list[TrialInfo], broken: list[TrialInfo]) -> Results:
    found = results_of_single(whole, broken)
    assert found is not None
    return found


def points(line: Line2D) -> list[tuple[float, float]]:
    """Return the points of a line."""
    return [(float(x), float(y)) for x, y in np.column_stack(line.get_data())]


def marks(axes: Axes, color: str, marker: str) -> list[tuple[float, float]]:
    """Return where marks of a colour and form stand."""
    lines = [line for line in axes.lines if line.get_marker() == marker]
    return [
        at for line in lines if to_hex(line.get_markeredgecolor()) == color for at in points(line)
    ]


def bars(axes: Axes) -> dict[float, tuple[float, float]]:
    """Return the central 95 % of robots that is drawn in each row."""
    lines = [line for line in axes.lines if line.get_color() == SKY and line.get_marker() == "None"]
    ends = [points(line) for line in lines]
    return {y: (low, high) for (low, y), (high, _) in ends}


def words_in(figure: Figure) -> set[str]:
    return {text.get_text() for text in figure.findobj(Text)}


def test_each_cell_has_the_paper_s_count_and_every_robot_s() -> None:
    results = results_of_many(MANY_ROBOTS)
    assert list(results.cells) == list(EXTENSION_OF_REACH)
    for (tool, goal), cell in results.cells.items():
        assert cell.paper == EXTENSION_OF_REACH[tool, goal]
        assert cell.counts == MANY_ROBOTS.cells[tool, goal]
        assert cell.spread == Spread.of(cell.counts, 4)
    assert results.total is not None
    assert (results.total.paper, results.total.tried) == (TOTAL, 80)
    assert list(results.total.counts) == MANY_ROBOTS.totals
    assert results.broken is not None
    assert (results.broken.paper, results.broken.tried) == (IN_PAPER, 16)


def test_the_figure_shows_means_intervals_and_the_paper_s_counts() -> None:
    results = results_of_many(MANY_ROBOTS)
    figure = results_figure(results)
    *goals, total, broken = figure.axes
    assert figure.get_size_inches()[0] == TWO_COLUMNS
    assert [axes.get_title() for axes in goals] == ["goal 1", "goal 2", "goal 3", "goal 4"]
    names = ["Stick", "L-stick", "L-hook", "T-stick", "T-hook"]
    assert [label.get_text() for label in goals[0].get_yticklabels()] == names
    for goal, axes in zip(GOALS, goals, strict=True):
        rows = [results.cells[tool, goal] for tool in TOOLS]
        assert [x for x, _ in marks(axes, VERMILION, "D")] == [cell.paper for cell in rows]
        assert marks(axes, INK, "o") == [(cell.spread.mean, y) for y, cell in enumerate(rows)]
        for y, cell in enumerate(rows):
            assert bars(axes)[y] == pytest.approx((cell.spread.low, cell.spread.high), abs=0.03)
    for axes, counts, paper in ((total, MANY_ROBOTS.totals, 69), (broken, MANY_ROBOTS.broken, 16)):
        spread = Spread.of(counts)
        assert marks(axes, INK, "o") == [(spread.mean, 0.0)]
        assert bars(axes)[0] == pytest.approx((spread.low, spread.high), abs=0.03)
        assert marks(axes, VERMILION, "D")[0][0] == paper


def test_counts_of_the_paper_that_lie_outside_are_hollow() -> None:
    results = results_of_many(MANY_ROBOTS)
    figure = results_figure(results)
    for goal, axes in zip(GOALS, figure.axes[:4], strict=True):
        outside = [
            not Spread.of(results.cells[tool, goal].counts).holds(EXTENSION_OF_REACH[tool, goal])
            for tool in TOOLS
        ]
        diamonds = [line for line in axes.lines if line.get_marker() == "D"]
        assert [line.get_markerfacecolor() == "white" for line in diamonds] == outside
    assert "the paper, outside the central 95 %" in words_in(figure)


def test_of_fewer_than_forty_robots_each_is_shown() -> None:
    """In the size of how many gave the same; fewer than five have no interval."""
    figure = results_figure(results_of_many(FOUR_ROBOTS))
    words = words_in(figure)
    assert (
        "too few robots for intervals: it takes 5"
        in results_words(results_of_many(FOUR_ROBOTS)).caption
    )
    assert not {"mean with its 95 % interval, where it has one", "central 95 % of robots"} & words
    counts = Counter(FOUR_ROBOTS.cells["stick", "1"])
    dots = {
        x: line.get_markersize()
        for line in figure.axes[0].lines
        for x, y in points(line)
        if line.get_color() == SKY and y == 0
    }
    assert set(dots) == set(counts) == {0, 1, 2}
    assert dots[1] ** 2 / dots[0] ** 2 == pytest.approx(counts[1] / counts[0])


def test_one_robot_is_a_dot() -> None:
    """A reproduction of one robot has no intervals and no sizes."""
    cells = {cell: counts[:1] for cell, counts in FOUR_ROBOTS.cells.items()}
    one = replace(FOUR_ROBOTS, robots=1, cells=cells, broken=[14])
    results = results_of_many(one)
    assert ", 1 robot, seed 1000; " in results_words(results).caption
    assert {"the paper", "one robot"} <= words_in(results_figure(results))


@pytest.mark.parametrize("robots", [1, 2, 4, 5, 39, 40])
def test_any_number_of_robots_can_be_drawn(robots: int) -> None:
    def repeated(counts: list[int]) -> list[int]:
        return (counts * 10)[:robots]

    cells = {cell: repeated(list(counts)) for cell, counts in FOUR_ROBOTS.cells.items()}
    many = replace(FOUR_ROBOTS, robots=robots, cells=cells, broken=repeated([14, 15, 15, 16]))
    results = results_of_many(many)
    spread = results.cells["stick", "1"].spread
    assert (spread.mean_ci is None, spread.holds(0) is None) == (robots < 5, robots < 40)
    figure = results_figure(results)
    assert len(figure.axes) == 6
    words = words_in(figure)
    assert ("mean with its 95 % interval, where it has one" in words) == (robots >= 5)
    assert ("central 95 % of robots" in words) == (robots >= 40)
    assert ("robots (area: how many)" in words) == (1 < robots < 40)


def test_single_robots_have_what_they_tried() -> None:
    figure = results_figure(single(SOLVED, BROKEN))
    *goals, total, broken = figure.axes
    for axes in goals:
        assert marks(axes, INK, "o") == [(4.0, y) for y in range(5)]
        assert not axes.texts
    assert marks(total, INK, "o") == [(80.0, 0.0)]
    assert marks(broken, INK, "o") == [(15.0, 0.0)]


def test_where_not_all_starts_were_tried_it_says_how_many() -> None:
    some = [result("stick", "2", start, solved=start == 1) for start in (1, 2, 3)]
    results = single(some, BROKEN[:15])
    assert results_words(results).caption == (
        f"one robot a tool: run 1: T-hook, seed {RUNS[0].spec.seed}, sensor noisy"
    )
    assert results.total is None
    assert results.broken is None
    (axes,) = results_figure(results).axes
    assert [text.get_text() for text in axes.texts] == ["of 3"]
    assert marks(axes, INK, "o") == [(1.0, 0.0)]


def test_what_was_not_tried_is_left_out_or_says_so() -> None:
    """Tools and goals without a trial have no place; a cell of the others has the paper's count."""
    some = [result("t-hook", "2", 1), result("stick", "4", 1), result("stick", "4", 2)]
    figure = results_figure(single(some, []))
    second, fourth = figure.axes
    assert [axes.get_title() for axes in (second, fourth)] == ["goal 2", "goal 4"]
    assert [label.get_text() for label in second.get_yticklabels()] == ["Stick", "T-hook"]
    assert [text.get_text() for text in second.texts] == ["not tried", "of 1"]
    assert [text.get_text() for text in fourth.texts] == ["of 2", "not tried"]
    assert [x for x, _ in marks(second, VERMILION, "D")] == [2, 4]
    assert marks(second, INK, "o") == [(1.0, 1.0)]


def test_dollars_are_letters() -> None:
    settings = json.dumps({"$\\frac{1}{": 0.45})
    strange = replace(MANY_ROBOTS, session=session_of(5, settings=settings))
    assert encoded(results_figure(results_of_many(strange)), ".svg").startswith(b"<?xml")


def test_any_number_of_goals_and_tools_stands_in_rows_that_fit() -> None:
    """Of what the paper does not have, our counts stand alone."""
    cells = {
        (f"tool {n}", str(goal)): Beside(None if n == 6 else 3, [2, 3], 4)
        for n in range(1, 7)
        for goal in range(1, 10)
        if (n, goal) != (6, 9)
    }
    figure = results_figure(Results(session_of(5), 2, {}, cells, None, None))
    panels = {axes.get_title(): axes for axes in figure.axes}
    assert set(panels) == {f"goal {n}" for n in range(1, 10)}
    for goal in range(1, 10):
        axes = panels[f"goal {goal}"]
        assert len(axes.get_yticks()) == 6
        assert len(marks(axes, VERMILION, "D")) == 5
    figure.draw_without_rendering()
    boxes = [axes.get_window_extent() for axes in figure.axes]
    assert all(box.width > 0.6 * figure.dpi < 1.2 * box.height for box in boxes)


@pytest.mark.parametrize("robots", [2, 40])
def test_each_panel_is_out_of_what_was_tried_in_it(robots: int) -> None:
    """A goal of many starts does not stretch the others; a row out of fewer says so."""
    cells = {
        ("stick", "1"): Beside(0, [1] * robots, 4),
        ("rake", "1"): Beside(None, [2] * robots, 3),
        ("stick", "5"): Beside(None, [5] * robots, 16),
        ("rake", "5"): Beside(None, [4] * robots, 4),
        ("rake", "6"): Beside(None, [1] * robots, 2),
    }
    figure = results_figure(Results(session_of(5), robots, {}, cells, None, None))
    panels = {axes.get_title(): axes for axes in figure.axes}
    labels = {goal: panels[f"goal {goal}"].get_xlabel() for goal in "156"}
    of = {"1": 4, "5": 16, "6": 2}
    assert labels == {goal: f"successes of {most}" for goal, most in of.items()}
    said = {goal: [text.get_text() for text in panels[f"goal {goal}"].texts] for goal in "156"}
    assert said == {"1": ["of 3"], "5": ["of 4"], "6": ["not tried"]}
    assert panels["goal 1"].get_xlim()[1] < 5.0
    assert panels["goal 5"].get_xlim()[1] > 16.0


def test_of_each_start_the_latest_trial_counts_and_only_the_paper_s_are_compared() -> None:
    again = [
        result("stick", "2", 1, solved=False, run_id=7),
        result("stick", "2", 1, run_id=8, sensor="camera"),
        result("stick", "2", 2, run_id=8, outcome=Outcome.INVALID),
    ]
    others = [
        result("stick", "2", 3, planner="nested-query:share=0.05"),
        result("stick", "5", 1, solved=False),
        result("stick", "5", 1),
        result("stick", "5", 2, solved=False),
        result("stick", "2", 4, task_set="far-corners"),
        result("spoon", "2", 1),
    ]
    found = single(again, [])
    assert (found.cells["stick", "2"].counts, found.cells["stick", "2"].tried) == ([1], 1)
    assert sum(cell.tried for cell in found.cells.values()) == 1
    assert results_words(found).caption.startswith("one robot a tool: run 8: T-hook, seed ")
    assert results_words(found).caption.endswith(", sensor camera")
    alone = single(others, BROKEN)
    assert alone.cells == {
        ("stick, nested-query:share=0.05", "2"): Beside(None, [1], 1),
        ("stick", "5"): Beside(None, [1], 2),
        ("stick, far-corners", "2"): Beside(None, [1], 1),
        ("spoon", "2"): Beside(None, [1], 1),
    }
    assert alone.total == Beside(None, [4], 5)
    both = single([*others, *again], BROKEN)
    assert both.cells == {**found.cells, **alone.cells}
    assert both.total is None
    assert single([*others, *SOLVED], BROKEN).total == Beside(TOTAL, [80], 80)
    figure = results_figure(both)
    assert figure.axes[0].get_xlabel() == "successes of 4"
    names = [label.get_text().replace("\n", " ") for label in figure.axes[0].get_yticklabels()]
    assert [name.replace("- ", "-") for name in names] == [
        *("Stick", "Stick, nested-query:share=0.05", "Stick, far-corners", "Spoon"),
    ]
    figure.draw_without_rendering()
    assert all(axes.get_window_extent().width > 0.4 * figure.dpi for axes in figure.axes)
    assert results_of_single(again[2:], BROKEN) is None
