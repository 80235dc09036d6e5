"""How robots adapt to a broken tool, step by step (§7.2)."""

from collections.abc import Iterable
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator, PercentFormatter

from affcli.analysis.adaptation import AdaptationCourse, MeanProbability, Share
from affcli.report.figures.canvas import BLUE, FAINT, ONE_COLUMN, VERMILION, canvas
from affcli.report.figures.key import draw_key
from affcli.report.figures.words import tool_words

HEIGHT = 3.9
"""Of the figure (in)."""
BAND = 0.22
"""How dense the band of an interval is, from 0 to 1."""
BROKEN: dict[str, Any] = {"color": VERMILION}
WHOLE: dict[str, Any] = {"color": BLUE, "linestyle": (0, (4, 2))}


def adaptation_figure(course: AdaptationCourse, width: float | None = None) -> Figure:
    """Draw the course of the adaptation: trials still running, vain tries, probabilities.

    Args:
        course: of which session.
        width: in; that of a column if not given.
    """
    with canvas(width or ONE_COLUMN, HEIGHT) as figure:
        running, tries, probability = figure.subplots(
            3, 1, sharex=True, height_ratios=(0.45, 1.0, 1.0)
        )
        _draw_running(running, course)
        _draw_tries(tries, course)
        _draw_probabilities(probability, course)
        probability.set_xlabel("step of the trial")
        probability.set_xlim(-0.5, course.shares[-1].number + 0.5)
        probability.xaxis.set_major_locator(MaxNLocator(7, integer=True, steps=[1, 2, 5, 10]))
        draw_key(figure, _key(course))
    return figure


def _draw_running(axes: Axes, course: AdaptationCourse) -> None:
    """Draw how many trials take each step."""
    numbers = [share.number for share in course.shares]
    axes.bar(numbers, [share.trials for share in course.shares], width=1.0, color=FAINT)
    axes.set_ylim(0, course.trials)
    axes.set_yticks([0, course.trials])
    axes.set_title("trials still running", loc="left")


def _draw_tries(axes: Axes, course: AdaptationCourse) -> None:
    """Draw the share of tries on lost affordances."""
    _draw_band(axes, course.shares, VERMILION)
    numbers = [share.number for share in course.shares]
    axes.plot(numbers, [s.share for s in course.shares], **BROKEN, marker=".", markersize=3.0)
    axes.set_ylim(-0.03, 1.03)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    axes.set_title("of these, tries on lost affordances", loc="left")


def _draw_probabilities(axes: Axes, course: AdaptationCourse) -> None:
    """Draw the mean probability on the missing side, broken and whole."""
    axes.set_title("mean replication probability, rows on the missing side", loc="left")
    for means, look in ((course.whole, WHOLE), (course.broken, BROKEN)):
        _draw_band(axes, means, look["color"])
        axes.plot([m.number for m in means], [m.mean for m in means], **look)
    if not course.broken:
        axes.set_yticks([])
        axes.text(
            0.5, 0.5, "no rows lie on a missing side", transform=axes.transAxes, ha="center"
        )  # fmt: skip


def _draw_band(axes: Axes, points: Iterable[Share | MeanProbability], color: str) -> None:
    """Draw a band over the intervals that there are."""
    bands = [(point.number, *point.interval) for point in points if point.interval]
    if bands:
        numbers, low, high = zip(*bands, strict=True)
        axes.fill_between(numbers, low, high, color=color, alpha=BAND, linewidth=0.0)


def _key(course: AdaptationCourse) -> list[tuple[Artist, str]]:
    """Return what stands for what, of all that is drawn."""
    entries: list[tuple[Artist, str]] = [(Line2D([], [], **BROKEN), "broken tool")]
    if course.whole:
        entries.append((Line2D([], [], **WHOLE), f"whole {tool_words(course.tool)}"))
    if any(share.interval for share in course.shares):
        band = Patch(color=VERMILION, alpha=BAND, linewidth=0.0)
        entries.append((band, "95 % interval"))
    return entries
