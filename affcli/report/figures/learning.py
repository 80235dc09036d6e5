"""How learning went: rows made, and the share of behaviors with an effect, over robot time."""

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from affcli.analysis.curves import Curve, ToolCurves
from affcli.report.figure_titles import run_name
from affcli.report.figures.canvas import (
    BLUE,
    GREEN,
    INK,
    ONE_COLUMN,
    PURPLE,
    SKY,
    TWO_COLUMNS,
    VERMILION,
    canvas,
)
from affcli.report.figures.key import draw_key
from affcli.report.figures.maps import columns_for
from affcli.report.figures.words import tool_words
from affcli.report.words import spread_words

DASHES: tuple[Any, ...] = (
    "-",
    (0, (5, 1.5)),
    (0, (1, 1)),
    (0, (5, 1.2, 1, 1.2)),
    (0, (2.2, 1.2)),
    (0, (7, 1.2, 1, 1.2, 1, 1.2)),
)
COLORS = (BLUE, VERMILION, GREEN, PURPLE, INK, SKY)
MARKERS = ("", "o")
MOST_CURVES = len(COLORS) * len(MARKERS)
"""More than these nobody tells apart."""
MOST_BESIDE = 5
"""Tools in a row of the page."""
NAMES = ("rows made", "share of behaviors\nwith an effect so far")
SHADE = "#bcd9ea"
"""Of the bands: `SKY`, paler."""


def curves_figure(curves: Sequence[Curve]) -> Figure:
    """Return learning runs as lines: rows made above, the share of effects below.

    Args:
        curves: at most `MOST_CURVES`.
    """
    down = -(-len(curves) // 2)
    with canvas(ONE_COLUMN, 2.9 + 0.14 * down) as figure:
        above, below = figure.subplots(2, 1, sharex=True)
        lines = []
        for number, curve in enumerate(curves):
            look = _look(number, curve)
            lines += above.plot(curve.minutes, curve.rows, **look)
            below.plot(curve.minutes, curve.share, **look)
        _finish(above, below)
        above.set_ylabel(NAMES[0])
        below.set_ylabel(NAMES[1])
        entries = [(line, run_name(curve.run)) for line, curve in zip(lines, curves, strict=True)]
        draw_key(figure, entries, "outside upper center")
    return figure


def bands_figure(tools: Sequence[ToolCurves]) -> Figure:
    """Return many robots' learning: a column for each tool, mean and central 95 % of the robots."""
    columns = columns_for(len(tools), MOST_BESIDE)
    rows = 2 * math.ceil(len(tools) / columns)
    robots = max(tool.robots for tool in tools)
    with canvas(TWO_COLUMNS if columns > 2 else ONE_COLUMN, 0.3 + 1.35 * rows) as figure:
        grid = figure.subplots(rows, columns, sharex=True, squeeze=False)
        # The first of each two rows shows the rows made, the second the share of effects.
        pairs = [pair for upper in range(0, rows, 2) for pair in grid[upper : upper + 2].T]
        for number, (pair, tool) in enumerate(zip(pairs, tools, strict=False)):
            for one, first, band in zip(pair, pairs[0], (tool.rows, tool.share), strict=True):
                one.fill_between(
                    tool.minutes, band.low, band.high, facecolor=SHADE, edgecolor="none"
                )
                one.plot(tool.minutes, band.mean, color=BLUE, linewidth=1.1)
                one.tick_params(labelleft=number % columns == 0)
                if one is not first:
                    one.sharey(first)
            pair[0].set_title(tool_words(tool.tool))
            pair[1].tick_params(labelbottom=True)
            if number % columns == 0:
                for one, name in zip(pair, NAMES, strict=True):
                    one.set_ylabel(name)
        for axes in (one for pair in pairs[len(tools) :] for one in pair):
            axes.remove()
        for pair in pairs[: len(tools)]:
            _finish(*pair)
        mean = Line2D([], [], color=BLUE, linewidth=1.1), f"mean of {robots} robots"
        draw_key(figure, [mean, (Patch(facecolor=SHADE), f"{spread_words(robots)} of the robots")])
    return figure


def _look(number: int, curve: Curve) -> dict[str, Any]:
    """Return how the line of a number looks: no two alike, in grey too."""
    styles = len(COLORS)
    return {
        "color": COLORS[number % styles],
        "linestyle": DASHES[number % styles],
        "marker": MARKERS[number // styles],
        "markersize": 2.5,
        "markevery": max(1, len(curve.minutes) // 8),
    }


def _finish(above: Axes, below: Axes) -> None:
    """Set the limits of two axes, one above the other, and name the time."""
    above.set_ylim(bottom=0.0)
    below.set_ylim(0.0, None)
    below.set_xlim(left=0.0)
    below.set_xlabel("robot time (min)")
