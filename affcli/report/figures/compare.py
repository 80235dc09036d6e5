"""Differences between conditions with their intervals: all trials, then cell by cell."""

from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from affcli.analysis.paired import Comparison, Difference
from affcli.analysis.paper import in_papers_order
from affcli.core.results import Cell
from affcli.report.figures.canvas import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    ONE_COLUMN,
    PALE,
    PURPLE,
    TWO_COLUMNS,
    VERMILION,
    canvas,
)
from affcli.report.figures.key import draw_key
from affcli.report.figures.words import tool_words
from affcli.report.paired import whole_words
from affcli.report.words import in_order

LOOKS = ((INK, "o"), (VERMILION, "s"), (BLUE, "^"), (GREEN, "D"), (PURPLE, "v"))
"""Colour and mark of each condition: told apart without colour too."""
MOST_CONDITIONS = len(LOOKS)
ROW = 0.17
"""Height of a row of one condition (in)."""


def compare_figure(result: Comparison, width: float | None = None) -> Figure:
    """Draw differences, a row a cell: filled where significant; a line is the 95 % interval.

    Args:
        result: of at most `MOST_CONDITIONS` beside the first.
        width: in; what suits it if not given.
    """
    several = len(result.others)
    parts = [
        [one for one in result.totals if one.cell == cell]
        for cell in dict.fromkeys(one.cell for one in result.totals)
    ]
    parts += [list(result.cells)] if result.cells else []
    rows = [len(_rows(part)) for part in parts]
    height = 0.75 + 0.45 * len(parts) + ROW * (0.6 + 0.4 * several) * sum(rows)
    width = width or (ONE_COLUMN if several == 1 else TWO_COLUMNS)
    with canvas(width, height) as figure:
        panels = figure.subplots(
            len(parts), 1, height_ratios=[n + 1.2 for n in rows], squeeze=False
        )
        names = [other.name for other in result.others]
        for axes, part in zip(panels[:, 0], parts, strict=True):
            _draw(axes, part, names)
        panels[-1, 0].set_xlabel(_change_words(result))
        draw_key(figure, _key(result, names))
    return figure


def _rows(part: Sequence[Difference]) -> list[Cell]:
    """Return the cells of a panel: by protocol, tool in the paper's order, goal and start."""
    cells = list(dict.fromkeys(one.cell for one in part))
    protocols = list(dict.fromkeys(cell.protocol for cell in cells))
    goals, starts = in_order(c.goal for c in cells), in_order(c.start for c in cells)
    cells.sort(key=lambda cell: (goals.index(cell.goal), starts.index(cell.start)))
    tools = in_papers_order(cells, lambda cell: cell.tool)
    return sorted(tools, key=lambda cell: protocols.index(cell.protocol))


def _cell_words(cell: Cell) -> str:
    """Return a cell in one line, with its tools as all figures spell them."""
    return whole_words(cell._replace(tool=tool_words(cell.tool), shape=tool_words(cell.shape)))


def _draw(axes: Axes, part: Sequence[Difference], names: Sequence[str]) -> None:
    """Draw the rows of one panel, the first on top."""
    cells = _rows(part)
    axes.axvline(0.0, color=FAINT, linewidth=0.6, zorder=1)
    axes.grid(axis="x", color=PALE, linewidth=0.5)
    axes.set_axisbelow(True)
    alone = len({one.trials for one in part}) == 1
    axes.set_yticks(
        range(len(cells)),
        [
            _cell_words(cell) + (f", of {part[0].trials:g}" if len(cells) == 1 else "")
            for cell in cells
        ],
    )
    axes.tick_params(axis="y", length=0.0)
    axes.set_ylim(len(cells) - 0.4, -0.6)
    if len(cells) > 1 and alone:
        axes.set_title(f"cells of {part[0].trials:g} trials", loc="left")
    for one in part:
        number = names.index(one.condition)
        color, mark = LOOKS[number % len(LOOKS)]
        y = cells.index(one.cell) + 0.7 * ((number + 0.5) / len(names) - 0.5)
        if one.interval is not None:
            axes.plot(one.interval, [y, y], color=color, linewidth=0.9, zorder=3)
        fill = color if one.significant else "white"
        axes.plot([one.mean], [y], marker=mark, markersize=3.4, color=color,
                  markerfacecolor=fill, markeredgewidth=0.8, zorder=4)  # fmt: skip
    reach = 1.12 * max(abs(x) for one in part for x in (one.mean, *(one.interval or ())))
    axes.set_xlim(-max(reach, 0.1), max(reach, 0.1))


def _change_words(result: Comparison) -> str:
    """Return what is drawn."""
    other = result.others[0].name if len(result.others) == 1 else "each condition"
    return f"solved by a robot: {other} minus {result.against.name}"


def _key(result: Comparison, names: Sequence[str]) -> list[tuple[Artist, str]]:
    """Return what stands for what, of all that is drawn."""
    drawn = [*result.totals, *result.cells]
    dot: dict[str, Any] = {"markersize": 3.4, "linestyle": "none", "markeredgewidth": 0.8}
    entries: list[tuple[Artist, str]] = []
    if len(names) > 1:
        entries += [
            (Line2D([], [], color=color, marker=mark, markerfacecolor="white", **dot), name)
            for name, (color, mark) in zip(names, LOOKS, strict=False)
        ]
    hollow = Line2D([], [], color=INK, marker="o", markerfacecolor="white", **dot)
    entries.append((hollow, "mean difference, not significant"))
    if any(one.significant for one in drawn):
        entries.append((Line2D([], [], color=INK, marker="o", **dot), "significant, corrected"))
    if any(one.interval for one in drawn):
        entries.append(
            (Line2D([], [], color=INK, linewidth=0.9), "95 % interval, where it has one")
        )
    return entries
