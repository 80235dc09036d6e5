"""A measure of conditions against robot time, rows or a swept setting, with 95 % bands."""

from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from affcli.analysis.courses import Line
from affcli.report.figures.canvas import INK, ONE_COLUMN, PALE, canvas
from affcli.report.figures.key import draw_key
from affcli.report.figures.learning import COLORS, DASHES

BAND = 0.2
"""How dense a band is, from 0 to 1."""
LOGARITHMIC = 8.0
"""A swept setting whose largest value is so many times its smallest has a logarithmic axis."""


def curve_figure(lines: Sequence[Line], x: str, y: str, width: float | None = None) -> Figure:
    """Draw lines, each with the 95 % interval of the mean: a panel for each measure.

    Args:
        lines: courses of one condition each; or points of one condition each.
        x, y: words of the axes.
        width: in; that of a column if not given.
    """
    panels = list(dict.fromkeys(line.panel for line in lines))
    with canvas(width or ONE_COLUMN, 0.7 + 1.75 * len(panels)) as figure:
        grid = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for axes, panel in zip(grid, panels, strict=True):
            own = [line for line in lines if line.panel == panel]
            for number, line in enumerate(own):
                _draw(axes, line, number)
            axes.set_title(panel, loc="left")
            axes.set_ylabel(y)
            axes.grid(axis="y", color=PALE, linewidth=0.5)
            axes.set_axisbelow(True)
        grid[-1].set_xlabel(x)
        draw_key(figure, _key(lines))
    return figure


def _draw(axes: Axes, line: Line, number: int) -> None:
    """Draw one line; points of a sweep with bars, a course with a band."""
    xs, means = [point.x for point in line.points], [point.mean for point in line.points]
    color, dash = COLORS[number % len(COLORS)], DASHES[number % len(DASHES)]
    known = [(point.x, *point.interval) for point in line.points if point.interval]
    if line.name:
        axes.plot(xs, means, color=color, linestyle=dash, linewidth=1.1)
        if known:
            at, lows, highs = zip(*known, strict=True)
            axes.fill_between(at, lows, highs, color=color, alpha=BAND, linewidth=0.0)
        axes.set_ylim(bottom=0.0)
        axes.set_xlim(left=0.0)
        return
    axes.plot(xs, means, color=INK, marker="o", markersize=3.0, linewidth=0.8)
    for x, low, high in known:
        axes.plot([x, x], [low, high], color=INK, linewidth=0.9, marker="_", markersize=4.0)
    if xs[0] > 0.0 and xs[-1] > LOGARITHMIC * xs[0]:
        axes.set_xscale("log")
    axes.set_xticks(xs, [f"{x:.4g}" for x in xs])
    axes.minorticks_off()


def _key(lines: Sequence[Line]) -> list[tuple[Artist, str]]:
    """Return what stands for what."""
    named = [line for line in lines if line.name]
    entries: list[tuple[Artist, str]] = [
        (
            Line2D([], [], color=COLORS[n % len(COLORS)], linestyle=DASHES[n % len(DASHES)]),
            line.name,
        )
        for n, line in enumerate(named)
    ]
    bars = any(point.interval for line in lines for point in line.points)
    if named and bars:
        entries.append((Patch(color=INK, alpha=BAND, linewidth=0.0), "95 % interval of the mean"))
    elif bars:
        label = "mean of the robots with its 95 % interval"
        entries.append((Line2D([], [], color=INK, marker="o", markersize=3.0), label))
    else:
        entries.append(
            (Line2D([], [], color=INK, marker="o", markersize=3.0), "mean of the robots")
        )
    return entries
