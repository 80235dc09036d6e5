"""How well a table predicts as it grows: hits and false alarms, and how far off it is (§6.1)."""

from collections.abc import Sequence
from itertools import pairwise

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from affcli.analysis.prediction import Push, Score, scores
from affcli.analysis.statistics import exact_interval
from affcli.report.figures.canvas import (
    BLUE,
    FAINT,
    GREEN,
    TWO_COLUMNS,
    VERMILION,
    canvas,
)
from affcli.report.figures.key import draw_key
from affcli.report.prediction import PREDICTORS

CROWDED = 1.25
"""Two stages that differ by less than this factor share one number on the axis."""
HEIGHT = 2.5
"""Of the figure (in)."""
LOOKS = {"by_row": (BLUE, "o", "-"), "by_mean": (GREEN, "s", "--"), "as_wrist": (FAINT, "^", ":")}
"""Colour, mark and line of each predictor: told apart without colour too."""


def prediction_figure(title: str, pushes: Sequence[Push]) -> Figure:
    """Draw shares and errors against the number of rows the table was learned from.

    Args:
        title: whose table.
        pushes: what was predicted, and what was seen.
    """
    growing = scores(pushes)
    with canvas(TWO_COLUMNS, HEIGHT) as figure:
        left, middle, right = figure.subplots(1, 3)
        _draw_shares(left, growing)
        _draw_errors(middle, growing, "inches", "error of displacement (in)")
        _draw_errors(right, growing, "degrees", "error of direction (degrees)")
        for axes in (left, middle, right):
            _rows_axis(axes, growing)
        moved = sum(push.moved for push in pushes)
        left.set_title(f"{title}: {len(pushes)} pushes, {moved} moved", loc="left")
        middle.set_title("of the hits; thick: median; thin: 95 % lie below", loc="left")
        lines, words = middle.get_legend_handles_labels()
        draw_key(figure, list(zip(lines, words, strict=True)))
    return figure


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
    axes.set_ylabel("share of pushes (95 % interval)")
    axes.legend(loc="upper left")


def _draw_errors(axes: Axes, growing: Sequence[Score], kind: str, label: str) -> None:
    """Draw the median error of each predictor, and as thin lines what 95 % stay below."""
    for field, words in PREDICTORS.items():
        color, mark, line = LOOKS[field]
        for suffix, width, size, name in (("", 1.0, 3.0, words), ("_95", 0.5, 1.5, "_")):
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
    axes.set_ylim(bottom=0.0)
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
