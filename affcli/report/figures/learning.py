"""How learning went: rows made, and the share of behaviors with an effect, over robot time."""

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from affcli.analysis.curves import Curve, ToolCurves
from affcli.analysis.paper import in_papers_order
from affcli.analysis.statistics import FEWEST
from affcli.report.captions import run_name
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
    wrapped,
)
from affcli.report.figures.key import draw_key
from affcli.report.figures.maps import columns_for
from affcli.report.figures.words import tool_words
from affcli.report.words import many, spread_words

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
NAMES = ("rows made", "share of behaviors\nwith an effect so far")
NARROWEST = 1.1
"""Width of a panel (in)."""
ROBOTS: dict[str, Any] = {"facecolor": "#d6e8f3", "edgecolor": "none"}
CERTAIN: dict[str, Any] = {"facecolor": "#6fb1d8", "edgecolor": "none"}
MEAN: dict[str, Any] = {"color": "#00476f", "linewidth": 0.9}
"""Three shades of blue, which are three of grey too."""


def curves_figure(curves: Sequence[Curve], width: float | None = None) -> Figure:
    """Return learning runs as lines: rows made above, the share of effects below.

    Args:
        curves: at most `MOST_CURVES`; they are drawn in the paper's order of their tools.
        width: in; that of a column if not given.
    """
    width = width or ONE_COLUMN
    ordered = in_papers_order(curves, lambda curve: curve.run.spec.tool)
    names = [wrapped(run_name(curve.run), 6.5, width - 0.6) for curve in ordered]
    with canvas(width, 2.9) as figure:
        above, below = figure.subplots(2, 1, sharex=True)
        lines = []
        for number, curve in enumerate(ordered):
            look = _look(number, curve)
            lines += above.plot(curve.minutes, curve.rows, **look)
            below.plot(curve.minutes, curve.share, **look)
        _finish(above, below)
        above.set_ylabel(NAMES[0])
        below.set_ylabel(NAMES[1])
        if len(lines) > 1:
            key = draw_key(figure, list(zip(lines, names, strict=True)))
            figure.set_figheight(2.9 + key.get_window_extent().height / figure.dpi)
    return figure


def bands_figure(kinds: Sequence[ToolCurves], width: float | None = None) -> Figure:
    """Return many robots' learning: a column for each tool, or each kind of run.

    Args:
        kinds: the paper's tools stand in its order.
        width: in; what suits it if not given.
    """
    columns = columns_for(len(kinds), int((width or TWO_COLUMNS) / NARROWEST))
    width = width or (TWO_COLUMNS if columns > 2 else ONE_COLUMN)
    rows = 2 * math.ceil(len(kinds) / columns)
    ordered = in_papers_order(kinds, lambda kind: kind.tool)
    with canvas(width, 0.3 + 1.35 * rows) as figure:
        grid = figure.subplots(rows, columns, sharex=True, squeeze=False)
        # The first of each two rows shows the rows made, the second the share of effects.
        pairs = [pair for upper in range(0, rows, 2) for pair in grid[upper : upper + 2].T]
        for number, (pair, kind) in enumerate(zip(pairs, ordered, strict=False)):
            for one, first, band in zip(pair, pairs[0], (kind.rows, kind.share), strict=True):
                one.fill_between(kind.minutes, band.low, band.high, **ROBOTS)
                one.fill_between(kind.minutes, band.mean_low, band.mean_high, **CERTAIN)
                one.plot(kind.minutes, band.mean, **MEAN)
                one.tick_params(labelleft=number % columns == 0)
                if one is not first:
                    one.sharey(first)
            name = tool_words(kind.tool)
            if len({one.robots for one in kinds}) > 1:
                name += f" ({many(kind.robots, 'robot')})"
            pair[0].set_title(wrapped(name, 7.0, (width - 0.5) / columns - 0.05), fontsize=7.0)
            pair[1].tick_params(labelbottom=True)
            if number % columns == 0:
                for one, label in zip(pair, NAMES, strict=True):
                    one.set_ylabel(label)
        for axes in (one for pair in pairs[len(kinds) :] for one in pair):
            axes.remove()
        for pair in pairs[: len(kinds)]:
            _finish(*pair)
        draw_key(figure, _bands_key(kinds))
    return figure


def _bands_key(kinds: Sequence[ToolCurves]) -> list[tuple[Artist, str]]:
    """Return what stands for what, of all that is drawn."""
    entries: list[tuple[Artist, str]] = [(Line2D([], [], **MEAN), "mean of the robots")]
    if any(kind.robots >= FEWEST for kind in kinds):
        entries.append((Patch(**CERTAIN), "95 % interval of the mean"))
    spread = spread_words(max(kind.robots for kind in kinds))
    return [*entries, (Patch(**ROBOTS), f"{spread} of the robots")]


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
