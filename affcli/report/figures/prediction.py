"""How well a table predicts as it grows: hits and false alarms, and how far off it is (§6.1)."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator

from affcli.analysis.prediction import Push, Score, scores
from affcli.analysis.statistics import exact_interval
from affcli.report.figures.canvas import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    TWO_COLUMNS,
    VERMILION,
    canvas,
)
from affcli.report.figures.key import draw_key
from affcli.report.prediction import PREDICTORS

CROWDED = 1.25
"""Two stages that differ by less than this factor share one number on the axis."""
NARROWEST = 1.8
"""Width of a panel (in)."""
THICK, THIN = 1.2, 0.5
"""Lines of medians, and of what 95 % stay below (points)."""
LOOKS = {"by_row": (BLUE, "o", "-"), "by_mean": (GREEN, "s", "--"), "as_wrist": (FAINT, "^", ":")}
"""Colour, mark and line of each predictor: told apart without colour too."""


def prediction_figure(pushes: Sequence[Push], width: float | None = None) -> Figure:
    """Draw shares and errors against the number of rows the table was learned from.

    Args:
        pushes: what was predicted, and what was seen.
        width: in; that of two columns if not given. In one the panels stand over one another.
    """
    growing, width = scores(pushes), width or TWO_COLUMNS
    rows, columns = (1, 3) if width >= 3 * NARROWEST else (3, 1)
    with canvas(width, 0.7 + 1.7 * rows) as figure:
        panels = figure.subplots(rows, columns, squeeze=False).flat
        shares, inches, degrees = panels
        _draw_shares(shares, growing)
        shares.set_title("hits and false alarms")
        _draw_errors(inches, growing, "inches", "error (in)")
        inches.set_title("displacement of the hits")
        _draw_errors(degrees, growing, "degrees", "error (deg)")
        degrees.set_title("direction of the hits")
        for axes in (shares, inches, degrees):
            _rows_axis(axes, growing)
            if rows > 1:
                axes.label_outer()
        draw_key(figure, _key(shares, inches))
    return figure


def _key(shares: Axes, errors: Axes) -> list[tuple[Any, str]]:
    """Return what stands for what: the shares, the predictors, and the two lines of each."""
    entries = [
        pair
        for axes in (shares, errors)
        for pair in zip(*axes.get_legend_handles_labels(), strict=True)
    ]
    thick, thin = (Line2D([], [], color=INK, linewidth=width) for width in (THICK, THIN))
    return [*entries, (thick, "median error"), (thin, "error that 95 % stay below")]


def _draw_shares(axes: Axes, growing: Sequence[Score]) -> None:
    """Draw hits and false alarms with their 95 % intervals."""
    rows = [score.rows for score in growing]
    for label, color, mark, counts in (
        ("hits", BLUE, "o", [(score.hits, score.moved) for score in growing]),
        ("false alarms", VERMILION, "s", [(s.false_alarms, s.still) for s in growing]),
    ):
        shares = [count / of if of else 0.0 for count, of in counts]
        bounds = [exact_interval(count, of) for count, of in counts]
        below = [share - low for share, (low, _) in zip(shares, bounds, strict=True)]
        above = [high - share for share, (_, high) in zip(shares, bounds, strict=True)]
        axes.errorbar(
            rows,
            shares,
            yerr=[below, above],
            color=color,
            marker=mark,
            markersize=3,
            capsize=1.5,
            elinewidth=0.7,
            label=label,
        )
    axes.set_ylim(-0.02, 1.02)
    axes.set_ylabel("share (95 % interval)")


def _draw_errors(axes: Axes, growing: Sequence[Score], kind: str, label: str) -> None:
    """Draw the median error of each predictor, and as thin lines what 95 % stay below."""
    for field, words in PREDICTORS.items():
        color, mark, line = LOOKS[field]
        for suffix, width, size, name in (("", THICK, 3.0, words), ("_95", THIN, 1.5, "_")):
            known = [
                (score.rows, value)
                for score in growing
                if (value := getattr(getattr(score, field), kind + suffix)) is not None
            ]
            axes.plot(
                [rows for rows, _ in known],
                [value for _, value in known],
                color=color,
                marker=mark,
                markersize=size,
                linestyle=line,
                linewidth=width,
                label=name,
            )
    # What is off by nothing lies on the axis.
    axes.set_yscale("log", nonpositive="clip")
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=9))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_ylabel(label)


def _rows_axis(axes: Axes, growing: Sequence[Score]) -> None:
    """Let the number of rows double from mark to mark."""
    rows = [score.rows for score in growing]
    # The whole table may have few rows more than the stage before it: one number is written there.
    wide = [more >= CROWDED * few for few, more in pairwise(rows)] + [True] * bool(rows)
    axes.set_xscale("log", base=2)
    axes.set_xticks(rows, [str(n) if w else "" for n, w in zip(rows, wide, strict=True)])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("rows learned")
