"""How learning went: rows made, and the share of behaviors with an effect, over robot time."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from affcli.report.curves import Curve, ToolCurves
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
from affcli.report.figures.words import literal, shown, tool_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
WHOLE_RANGE = 39
"""Of so many robots or fewer the central 95 % is all of them."""
NAMES = ("rows made", "share of behaviors\nwith an effect so far")
SHADE = "#bcd9ea"
"""Of the bands: `SKY`, paler."""


def curves_figure(curves: Sequence[Curve]) -> "Figure":
    """Return learning runs as lines: rows made above, the share of effects below.

    Args:
        curves: at most `MOST_CURVES`.
    """
    down = -(-len(curves) // 2)
    with canvas(ONE_COLUMN, 2.9 + 0.14 * down) as figure:
        figure.set_layout_engine("constrained", w_pad=0.02, h_pad=0.03)
        above, below = figure.subplots(2, 1, sharex=True)
        lines = []
        for number, curve in enumerate(curves):
            look = _look(number, curve)
            lines += above.plot(curve.minutes, curve.rows, **look)
            below.plot(curve.minutes, curve.share, **look)
        _finish(above, below)
        above.set_ylabel(NAMES[0])
        below.set_ylabel(NAMES[1])
        legend = figure.legend(
            lines,
            [shown(curve.name) for curve in curves],
            loc="outside upper center",
            ncols=2,
            handlelength=3.2,
        )
        for text in legend.get_texts():
            text.set(**literal())
    return figure


def bands_figure(tools: Sequence[ToolCurves]) -> "Figure":
    """Return many robots' learning: a column a tool, mean and central 95 % of the robots."""
    width = TWO_COLUMNS if len(tools) > 2 else ONE_COLUMN
    with canvas(width, 3.0) as figure:
        figure.set_layout_engine("constrained", w_pad=0.02, h_pad=0.03, wspace=0.0)
        axes = figure.subplots(2, len(tools), sharex=True, sharey="row", squeeze=False)
        for column, tool in zip(axes.T, tools, strict=True):
            for one, band in zip(column, (tool.rows, tool.share), strict=True):
                one.fill_between(
                    tool.minutes, band.low, band.high, facecolor=SHADE, edgecolor="none"
                )
                one.plot(tool.minutes, band.mean, color=BLUE, linewidth=1.1)
            column[0].set_title(tool_words(tool.tool), **literal())
        for column in axes.T:
            _finish(*column)
        for one, name in zip(axes[:, 0], NAMES, strict=True):
            one.set_ylabel(name)
        robots = max(tool.robots for tool in tools)
        spread = "range" if robots <= WHOLE_RANGE else "central 95 %"
        figure.legend(
            [Line2D([], [], color=BLUE, linewidth=1.1), Patch(facecolor=SHADE)],
            [f"mean of {robots} robots", f"{spread} of the robots"],
            loc="outside lower center",
            ncols=2,
        )
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


def _finish(above: "Axes", below: "Axes") -> None:
    """Set the limits of two axes, one above the other, and name the time."""
    above.set_ylim(bottom=0.0)
    below.set_ylim(0.0, None)
    below.set_xlim(left=0.0)
    below.set_xlabel("robot time (min)")
