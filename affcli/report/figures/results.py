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
from affcli.analysis.paper import STARTS, in_papers_order
from affcli.analysis.statistics import ENOUGH_ROBOTS
from affcli.report.figures.canvas import (
    FAINT,
    INK,
    ONE_COLUMN,
    PALE,
    SKY,
    TWO_COLUMNS,
    VERMILION,
    canvas,
    wrapped,
)
from affcli.report.figures.key import draw_key
from affcli.report.figures.maps import columns_for
from affcli.report.figures.words import tool_words
from affcli.report.words import in_order

NARROWEST = 1.1
"""Width of a panel (in)."""
NAMES = 1.1
"""Room for the names of tools (in); longer ones are broken into lines."""
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


def results_figure(results: Results, width: float | None = None) -> Figure:
    """Draw the results: a panel a goal with a row a tool; then the total and the broken tool.

    Goals and tools of which nothing was tried are left out; a cell of the others says so.

    Args:
        results: whose.
        width: in; what suits it if not given.
    """
    tried = [cell for cell, beside in results.cells.items() if beside.counts]
    goals = in_order(goal for _, goal in tried)
    names = dict.fromkeys(tool for tool, _ in results.cells if tool in {t for t, _ in tried})
    tools = in_papers_order(names, lambda name: name.split(",")[0])
    sums = [
        (name, beside)
        for name, beside in (("all trials", results.total), ("broken tool", results.broken))
        if beside is not None
    ]
    panels = len(goals) + bool(sums)
    columns = columns_for(panels, int((width or TWO_COLUMNS) / NARROWEST))
    width = width or (TWO_COLUMNS if columns > 2 else ONE_COLUMN)
    lines = math.ceil(panels / columns)
    labels = [wrapped(tool_words(tool), 6.5, NAMES) for tool in tools]
    high = max(0.75, 0.15 * sum(1 + label.count("\n") for label in labels) + 0.1 * len(labels))
    with canvas(width, 0.3 + lines * (0.5 + high * (1 + (len(sums) > 1 and high < 1)))) as figure:
        grid = figure.add_gridspec(2 * lines, columns)
        for number, goal in enumerate(goals):
            line, column = divmod(number, columns)
            axes = figure.add_subplot(grid[2 * line : 2 * line + 2, column])
            cells = {tool: results.cells.get((tool, goal), UNTRIED) for tool in tools}
            _draw_goal(axes, goal, dict(zip(labels, cells.values(), strict=True)))
            axes.tick_params(labelleft=column == 0)
        line, column = divmod(len(goals), columns)
        for half, (name, beside) in enumerate(sums):
            place = slice(2 * line + half, 2 * line + (half + 1 if len(sums) > 1 else 2))
            _draw_sum(figure.add_subplot(grid[place, column]), name, beside)
        draw_key(figure, _key(results))
    return figure


def _draw_goal(axes: Axes, goal: str, cells: Mapping[str, Beside]) -> None:
    """Draw one goal, a row for each tool by its name."""
    most = _most_tried(cells.values())
    _draw_rows(axes, cells, most)
    axes.set_title(f"goal {goal}")
    axes.set_xlabel(f"successes of {most}")
    axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))
    axes.set_xlim(-0.35, most + 0.35)


def _most_tried(cells: Iterable[Beside]) -> int:
    """Return out of how many the cells of a panel are: the paper's are of 4, though none be tried.

    Ours that are out of fewer say so.
    """
    return max(max(cell.tried, 0 if cell.paper is None else STARTS) for cell in cells)


def _draw_sum(axes: Axes, name: str, beside: Beside) -> None:
    """Draw one row over many trials."""
    _draw_rows(axes, {"": beside}, beside.tried)
    axes.set_title(name)
    axes.spines["left"].set_visible(False)
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
        if not beside.counts:
            axes.text(
                0.05, y, "not tried", color=FAINT, va="center", transform=axes.get_yaxis_transform()
            )
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
    known = [*beside.counts, *([] if beside.paper is None else [beside.paper])]
    low = min(*known, 0.75 * beside.tried)
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
