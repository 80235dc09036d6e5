"""How long an inch is: a bar of a round length, where a figure has no axes."""

import math
from typing import TYPE_CHECKING

from affcli.core.geometry import Point
from affcli.report.figures.canvas import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def round_length(most: float) -> float:
    """Return the longest of 1, 2, 5, 10, 20, 50, ... (and 0.5, 0.2, ...) up to `most`."""
    # One power less: the logarithm of 999999.9999999999 is rounded up to 6.
    power = 10.0 ** (math.floor(math.log10(most)) - 1)
    return max(f * power for f in (1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if f * power <= most)


def draw_length(axes: "Axes", middle: Point, inches: float, unit: float) -> None:
    """Draw a bar with its length above it.

    Args:
        axes: where.
        middle: of the bar, in the axes' frame.
        inches: its length in what the figure shows.
        unit: how long such an inch is in the axes' frame.
    """
    half = 0.5 * inches * unit
    axes.plot([middle.x - half, middle.x + half], [middle.y, middle.y], color=INK, linewidth=1.0)
    axes.annotate(
        f"{inches:g} in",
        middle,
        xytext=(0.0, 2.0),
        textcoords="offset points",
        ha="center",
        va="bottom",
        fontsize=6.5,
    )
