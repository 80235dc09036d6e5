"""How learning went, as the page draws it: rows made over robot time, a chart for each tool."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from affcli.analysis.curves import Curve, ToolCurves
from affcli.report.page.content import LearnedRows

WIDTH, HEIGHT = 100.0, 60.0
"""Of a chart, in its own units."""
MOST_TICKS = 5


def charts(
    tools: Sequence[LearnedRows], curves: Mapping[int, Curve], bands: Mapping[str, ToolCurves]
) -> list[dict[str, Any]]:
    """Return a chart for each tool, all with the same axes, in the order of the tools.

    Its lines are in units of the chart, y upward: for each run whose it is, how it went in words,
    and its course; then the mean and the spread of all robots (see `spread_words`), empty without
    a reproduction.
    """
    timed = [(one, curves[one.run.id]) for one in tools if one.run.id in curves]
    minutes = max((curve.minutes[-1] for curve in curves.values()), default=1.0)
    highest = [max(band.rows.high) for band in bands.values()]
    rows = max([1.0, *highest, *(curve.rows[-1] for curve in curves.values())])

    def points(x: Iterable[float], y: Iterable[float]) -> str:
        scaled = zip(x, y, strict=True)
        return " ".join(f"{WIDTH * a / minutes:.1f},{HEIGHT * b / rows:.1f}" for a, b in scaled)

    made = []
    for tool in dict.fromkeys(one.run.spec.tool for one, _ in timed):
        band = bands.get(tool)
        low = high = mean = ""
        if band is not None:
            edges = (band.rows.low, band.rows.high, band.rows.mean)
            low, high, mean = (points(band.minutes, edge) for edge in edges)
        made.append(
            {
                "tool": tool,
                "across": _ticks(minutes, WIDTH),
                "up": _ticks(rows, HEIGHT),
                "lines": [
                    (one.robot, _words(one, curve), points(curve.minutes, curve.rows))
                    for one, curve in timed
                    if one.run.spec.tool == tool
                ],
                "band": f"{high} {' '.join(reversed(low.split()))}".strip(),
                "mean": mean,
            }
        )
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
