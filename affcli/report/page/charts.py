"""How learning went, as the page draws it: rows made over robot time, a chart for each tool."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from affcli.analysis.curves import Curve, ToolCurves
from affcli.report.page.content import LearnedRows

WIDTH, HEIGHT = 100.0, 60.0
"""Of a chart, in its own units."""
MOST_TICKS = 5


@dataclass(frozen=True, slots=True)
class Chart:
    """The learning runs of one tool, in units of the chart, y upward.

    Args:
        tool: its name.
        across, up: ticks of the axes: where, and what stands there.
        lines: for each run whose it is, in words that go with it, and its course.
        band, mean: of all robots of a reproduction; empty without one.
    """

    tool: str
    across: Sequence[tuple[float, int]]
    up: Sequence[tuple[float, int]]
    lines: Sequence[tuple[str, str, str]]
    band: str
    mean: str


def charts(
    tools: Sequence[LearnedRows], curves: Mapping[int, Curve], bands: Mapping[str, ToolCurves]
) -> list[Chart]:
    """Return a chart for each tool, all with the same axes, in the order of the tools."""
    timed = [learned for learned in tools if learned.run.id in curves]
    minutes = max((curves[one.run.id].minutes[-1] for one in timed), default=1.0)
    rows = max((curves[one.run.id].rows[-1] for one in timed), default=1.0)
    rows = max(1.0, rows, *(max(band.rows.high) for band in bands.values()))

    def points(x: Iterable[float], y: Iterable[float]) -> str:
        scaled = zip(x, y, strict=True)
        return " ".join(f"{WIDTH * a / minutes:.1f},{HEIGHT * b / rows:.1f}" for a, b in scaled)

    made = []
    for tool in dict.fromkeys(one.run.spec.tool for one in timed):
        band = bands.get(tool)
        lines = []
        for one in timed:
            if one.run.spec.tool == tool:
                curve = curves[one.run.id]
                lines.append((one.robot, _words(one, curve), points(curve.minutes, curve.rows)))
        around = mean = ""
        if band is not None:
            low, high = (points(band.minutes, edge) for edge in (band.rows.low, band.rows.high))
            around = f"{high} {' '.join(reversed(low.split()))}"
            mean = points(band.minutes, band.rows.mean)
        across, up = _ticks(minutes, WIDTH), _ticks(rows, HEIGHT)
        made.append(Chart(tool, across, up, lines, around, mean))
    return made


def _words(learned: LearnedRows, curve: Curve) -> str:
    """Return how a run went: ``158 rows of 565 behaviors (28 %), half of them by minute 29``."""
    run = learned.run
    words = f"{run.rows} rows of {run.behaviors} behaviors"
    if not run.rows:
        return words
    half = next(
        minute
        for minute, rows in zip(curve.minutes, curve.rows, strict=True)
        if 2 * rows >= curve.rows[-1]
    )
    return f"{words} ({100 * run.rows / run.behaviors:.0f} %), half of them by minute {half:.0f}"


def _ticks(most: float, size: float) -> list[tuple[float, int]]:
    """Return whole numbers from 0 to `most`, 1, 2 or 5 times a power of ten apart, and where."""
    least = max(most / MOST_TICKS, 1.0)
    power = 10 ** math.floor(math.log10(least))
    apart = next(step * power for step in (1, 2, 5, 10) if step * power >= least)
    return [(size * tick / most, tick) for tick in range(0, math.floor(most) + 1, apart)]
