"""A measure of conditions against robot time, rows or a swept setting, with 95 % bands."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from affcli.analysis.courses import Line
from affcli.errors import UsageError
from affcli.report.figures.canvas import INK, ONE_COLUMN, PALE, canvas
from affcli.report.figures.key import draw_key
from affcli.report.figures.learning import COLORS, DASHES

BAND = 0.2
"""How dense a band is, from 0 to 1."""
MARKS = ("o", "s", "^", "D", "v", "P", "X", "*")
"""Of conditions that are told apart."""
MOST_NAMES = len(MARKS)
"""More lines nobody tells apart."""
MOST_MARKS = 12
"""On a line that is followed over time."""
LOGARITHMIC = 8.0
"""A swept setting whose largest value is so many times its smallest has a logarithmic axis."""


def require_few(lines: Sequence[Line]) -> None:
    """Make sure that lines can be told apart; UsageError otherwise."""
    if len({line.name for line in lines}) > MOST_NAMES:
        raise UsageError(f"{MOST_NAMES} conditions fit; name fewer with --session")


def curve_figure(lines: Sequence[Line], x: str, y: str, width: float | None = None) -> Figure:
    """Draw lines, each with the 95 % interval of the mean: a panel for each measure.

    Args:
        lines: courses of one condition each; or points of one each, joined along a setting.
        x, y: words of the axes.
        width: in; that of a column if not given.
    """
    panels = list(dict.fromkeys(line.panel for line in lines))
    names = list(dict.fromkeys(line.name for line in lines))
    with canvas(width or ONE_COLUMN, 0.7 + 1.75 * len(panels)) as figure:
        grid = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for axes, panel in zip(grid, panels, strict=True):
            own = [line for line in lines if line.panel == panel]
            for line in own:
                draw = _draw_course if line.course else _draw_sweep
                draw(axes, line, _look(line, names))
            _scale(axes, own)
            axes.yaxis.set_major_locator(MaxNLocator(steps=[1, 2, 5, 10]))
            axes.set_title(panel, loc="left")
            axes.set_ylabel(y)
            axes.grid(axis="y", color=PALE, linewidth=0.5)
            axes.set_axisbelow(True)
        grid[-1].set_xlabel(x)
        draw_key(figure, _key(lines, names))
    return figure


def _look(line: Line, names: Sequence[str]) -> dict[str, Any]:
    """Return how a line is drawn: told apart without colour too."""
    if not line.name:
        return {"color": INK, "marker": "o", "markersize": 3.0, "linewidth": 0.8}
    number = names.index(line.name)
    color = COLORS[number % len(COLORS)]
    if line.course:
        look = {"color": color, "linestyle": DASHES[number % len(DASHES)], "linewidth": 1.1}
        mark = {"marker": MARKS[number % len(MARKS)], "markersize": 3.5} if _is_marked(line) else {}
        return look | mark
    joined = {"linewidth": 0.8, "linestyle": "-" if len(line.points) > 1 else "none"}
    return {"color": color, "marker": MARKS[number % len(MARKS)], "markersize": 3.5, **joined}


def _is_marked(line: Line) -> bool:
    """Tell whether the points of a line are so few that each of them has a mark."""
    return not line.course or len(line.points) <= MOST_MARKS


def _draw_course(axes: Axes, line: Line, look: Mapping[str, Any]) -> None:
    """Draw the course of a condition with a band."""
    axes.plot([point.x for point in line.points], [point.mean for point in line.points], **look)
    known = [(point.x, *point.interval) for point in line.points if point.interval]
    if known:
        at, lows, highs = zip(*known, strict=True)
        axes.fill_between(at, lows, highs, color=look["color"], alpha=BAND, linewidth=0.0)


def _draw_sweep(axes: Axes, line: Line, look: Mapping[str, Any]) -> None:
    """Draw points of conditions with bars."""
    axes.plot([point.x for point in line.points], [point.mean for point in line.points], **look)
    bar: dict[str, Any] = {"color": look["color"], "linewidth": 0.9, "marker": "_"}
    for point in line.points:
        if point.interval:
            axes.plot([point.x, point.x], point.interval, markersize=4.0, **bar)


def _scale(axes: Axes, lines: Sequence[Line]) -> None:
    """Begin time at 0, and what is followed over it; tick where lines have marks."""
    if any(line.course for line in lines):
        # Room for the marks of what is highest.
        axes.set_ylim(0.0, 1.05 * axes.get_ylim()[1])
    if not all(map(_is_marked, lines)):
        axes.set_xlim(left=0.0)
    elif any(len(line.points) > 1 or not line.name for line in lines):
        xs = sorted({point.x for line in lines for point in line.points})
        if xs[0] > 0.0 and xs[-1] > LOGARITHMIC * xs[0]:
            axes.set_xscale("log")
        axes.set_xticks(xs, [f"{x:.4g}" for x in xs])
        axes.minorticks_off()


def _key(lines: Sequence[Line], names: Sequence[str]) -> list[tuple[Artist, str]]:
    """Return what stands for what."""
    first = {line.name: line for line in reversed(lines) if line.name}
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **_look(first[name], names)), name) for name in names if name
    ]
    bars = any(point.interval for line in lines for point in line.points)
    if any(line.course for line in lines):
        if bars:
            band = Patch(color=INK, alpha=BAND, linewidth=0.0)
            entries.append((band, "95 % interval of the mean"))
    else:
        dot: dict[str, Any] = {"color": INK, "marker": "o", "markersize": 3.0}
        if first:
            dot |= {"marker": "|" if bars else "", "linestyle": "none", "markersize": 6.0}
        label = "mean of the robots" + " with its 95 % interval" * bars
        entries.append((Line2D([], [], **dot), label))
    return entries
