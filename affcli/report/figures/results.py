"""Our results with the paper's counts: each cell, the total, the broken tool (§7.1, §7.2)."""

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from affcli.analysis.comparison import Beside, Results
from affcli.analysis.paper import STARTS
from affcli.analysis.statistics import ENOUGH_ROBOTS
from affcli.report.figure_titles import results_note, results_title
from affcli.report.figures.canvas import INK, PALE, SKY, TWO_COLUMNS, VERMILION, canvas, head
from affcli.report.figures.key import draw_key
from affcli.report.figures.maps import columns_for
from affcli.report.words import in_order

MOST_BESIDE = 4
"""Goals in a row of the page."""
UNTRIED = Beside(None, [], 0)
"""A cell of which nothing is known."""
DOT = 0.02
"""What an interval of one count is made longer by on both sides, or nothing of it would be seen."""
RAISED = 0.3
"""How far the paper's mark stands over ours, in rows: most lie at the same count."""
PAPER: dict[str, Any] = {
    "marker": "D",
    "markersize": 4.2,
    "linestyle": "none",
    "markeredgecolor": VERMILION,
}


def results_figure(results: Results) -> Figure:
    """Draw the results: a panel a goal with a row a tool; total and broken tool beside them."""
    goals = in_order(goal for _, goal in results.cells)
    tools = list(dict.fromkeys(tool for tool, _ in results.cells))
    across = columns_for(len(goals), MOST_BESIDE)
    rows = math.ceil(len(goals) / across)
    with canvas(TWO_COLUMNS, 0.85 + rows * (0.5 + 0.2 * len(tools))) as figure:
        grid = figure.add_gridspec(2 * rows, across + 1)
        for number, goal in enumerate(goals):
            row, column = divmod(number, across)
            axes = figure.add_subplot(grid[2 * row : 2 * row + 2, column])
            cells = {tool: results.cells.get((tool, goal), UNTRIED) for tool in tools}
            most = _most_tried(cells.values())
            _draw_rows(axes, cells, most)
            axes.set_title(f"goal {goal}")
            axes.set_xlabel(f"successes of {most}")
            axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))
            axes.set_xlim(-0.35, most + 0.35)
            axes.tick_params(labelleft=column == 0)
        sums = (("all trials", results.total), ("broken tool", results.broken))
        for row, (name, beside) in enumerate(sums):
            _draw_sum(figure.add_subplot(grid[row, across]), name, beside)
        draw_key(figure, _key(results))
        words = (results_title(results), results_note(results))
        head(figure, "; ".join(filter(None, words)))
    return figure


def _most_tried(cells: Iterable[Beside]) -> int:
    """Return out of how many the cells of a panel are: the paper's are of 4, though none be tried.

    Ours that are out of fewer say so.
    """
    return max(max(cell.tried, 0 if cell.paper is None else STARTS) for cell in cells)


def _draw_sum(axes: Axes, name: str, beside: Beside | None) -> None:
    """Draw one row over many trials, or say that they were not all done."""
    axes.set_title(name)
    axes.spines["left"].set_visible(False)
    if beside is None:
        axes.set_xticks([])
        axes.set_yticks([])
        axes.spines["bottom"].set_visible(False)
        axes.text(0.5, 0.5, "not all done", transform=axes.transAxes, ha="center", va="center")
        return
    _draw_rows(axes, {"": beside}, beside.tried)
    axes.set_xlabel(f"successes of {beside.tried}")
    axes.xaxis.set_major_locator(MaxNLocator(4, integer=True))
    axes.set_xlim(*_limits(beside))


def _draw_rows(axes: Axes, rows: Mapping[str, Beside], most: int) -> None:
    """Draw a row for each name, the first on top; it says so where it is not out of `most`."""
    axes.set_yticks(range(len(rows)), list(rows))
    axes.set_ylim(len(rows) - 0.45, -0.65)
    axes.tick_params(axis="y", length=0.0)
    axes.grid(axis="x", color=PALE, linewidth=0.5)
    axes.set_axisbelow(True)
    for y, beside in enumerate(rows.values()):
        _draw_ours(axes, y, beside)
        if beside.counts and beside.tried != most:
            at = (beside.spread.high, y)
            axes.annotate(f"of {beside.tried}", at, (4, 0), textcoords="offset points", va="center")
        if beside.paper is not None:
            fill = "white" if beside.outside else VERMILION
            axes.plot([beside.paper], [y - RAISED], **PAPER, markerfacecolor=fill, zorder=5)


def _draw_ours(axes: Axes, y: float, beside: Beside) -> None:
    """Draw our successes: the mean with its interval, over the robots, or over each of few."""
    if not beside.counts:
        return
    spread = beside.spread
    if spread.robots >= ENOUGH_ROBOTS:
        axes.plot(
            [spread.low - DOT, spread.high + DOT],
            [y, y],
            color=SKY,
            linewidth=5.0,
            solid_capstyle="round",
        )
    elif spread.robots > 1:
        for count, robots in Counter(beside.counts).items():
            size = 9.0 * (robots / spread.robots) ** 0.5
            axes.plot([count], [y], marker="o", markersize=size, color=SKY, zorder=3)
    if spread.mean_ci is not None:
        axes.errorbar(
            *(sum(spread.mean_ci) / 2, y), xerr=(spread.mean_ci[1] - spread.mean_ci[0]) / 2,
            fmt="none", color=INK, ecolor=INK, capsize=2.0, elinewidth=0.8, zorder=4,
        )  # fmt: skip
    axes.plot([spread.mean], [y], marker="o", markersize=2.6, color=INK, zorder=4)


def _limits(beside: Beside) -> tuple[float, float]:
    """Return how far the axis of one row reaches: from below all that is drawn to all solved."""
    low = min([*beside.counts, *([] if beside.paper is None else [beside.paper])])
    room = max(1.0, 0.1 * (beside.tried - low))
    return low - room, beside.tried + 0.4 * room


def _key(results: Results) -> list[tuple[Artist, str]]:
    """Return what stands for what, of all that is drawn."""
    every = [*results.cells.values(), *(b for b in (results.total, results.broken) if b)]
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **PAPER, markerfacecolor=VERMILION), "the paper")
    ]
    if any(beside.outside for beside in every):
        mark = Line2D([], [], **PAPER, markerfacecolor="white")
        entries.append((mark, "the paper, outside the central 95 %"))
    dot: dict[str, Any] = {"marker": "o", "linestyle": "none"}
    if any(beside.counts and beside.spread.mean_ci for beside in every):
        mean = Line2D([], [], marker="o", markersize=2.6, color=INK, linewidth=0.8)
        entries.append((mean, "mean with its 95 % interval, where it has one"))
    else:
        label = "mean" if results.robots > 1 else "one robot"
        entries.append((Line2D([], [], **dot, markersize=2.6, color=INK), label))
    if results.robots >= ENOUGH_ROBOTS:
        entries.append((Line2D([], [], color=SKY, linewidth=5.0), "central 95 % of robots"))
    elif results.robots > 1:
        robots = Line2D([], [], **dot, markersize=6.0, color=SKY)
        entries.append((robots, "robots (area: how many)"))
    return entries
