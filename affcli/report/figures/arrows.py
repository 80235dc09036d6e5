"""Movements as arrows whose heads are never longer than they are themselves; and their key."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.legend import Legend
from matplotlib.legend_handler import HandlerBase
from matplotlib.patches import Polygon
from matplotlib.transforms import Transform

from affcli.analysis.row_status import RowStatus
from affcli.core.geometry import Point
from affcli.report.figures.canvas import BLUE, FAINT, GREEN, VERMILION

Arrow = tuple[Point, Point]
"""Start and end (in, the axes' frame)."""

LARGEST_HEAD = 0.55
"""A head is at most this share of its arrow."""
THINNEST = 0.8
"""The line of a short arrow is no thinner than this (points), if it is not thin anyway."""


@dataclass(frozen=True, slots=True)
class Look:
    """How arrows of one kind look: by colour, and without colours by dashes and heads.

    Args:
        color: of all of it.
        dashes: on and off in points; none for a solid line.
        hollow: the head is an outline.
        width: of the line (points).
        broad: width of a head over its length.
        level: arrows of a higher level lie over those of a lower.
    """

    color: str
    dashes: tuple[float, ...] = ()
    hollow: bool = False
    width: float = 0.8
    broad: float = 0.7
    level: float = 5.0

    @property
    def line(self) -> Any:
        """The line's style as matplotlib takes it."""
        return (0, self.dashes) if self.dashes else "-"


LOOKS: Mapping[RowStatus, Look] = {
    RowStatus.LIVE: Look(BLUE),
    RowStatus.KEPT: Look(BLUE),
    RowStatus.LOST: Look(VERMILION, (2.0, 1.2), hollow=True, width=0.9, level=6.0),
    RowStatus.WON: Look(GREEN, (0.9, 0.9), hollow=True, width=1.0, level=6.0),
    RowStatus.EXCLUDED: Look(FAINT, (2.0, 1.2), hollow=True, width=0.7, level=4.0),
}


def draw_arrows(axes: Axes, arrows: Sequence[Arrow], look: Look, head: float) -> None:
    """Draw arrows, as one artist for all lines and one for all heads.

    Args:
        axes: where.
        arrows: from where to where.
        look: how.
        head: length of a head (in); shorter, and the line thinner, where the arrow is short.
    """
    if not arrows:
        return
    sizes = [min(head, LARGEST_HEAD * math.dist(*arrow)) for arrow in arrows]
    drawn = [_parts(arrow, size, look.broad) for arrow, size in zip(arrows, sizes, strict=True)]
    shafts, heads = zip(*drawn, strict=True)
    axes.add_collection(
        LineCollection(
            shafts,
            colors=look.color,
            linewidths=[max(min(look.width, THINNEST), look.width * s / head) for s in sizes],
            linestyles=[look.line],
            capstyle="butt",
            zorder=look.level,
        ),
        autolim=False,
    )
    axes.add_collection(
        PolyCollection(
            heads,
            facecolors="white" if look.hollow else look.color,
            edgecolors=look.color,
            linewidths=0.5,
            joinstyle="miter",
            zorder=look.level + 0.1,
        ),
        autolim=False,
    )
    axes.update_datalim([end for arrow in arrows for end in arrow])


class ArrowKey(HandlerBase):
    """Draws an arrow in a legend, for its look."""

    def create_artists(
        self,
        legend: Legend,
        orig_handle: Any,
        xdescent: float,
        ydescent: float,
        width: float,
        height: float,
        fontsize: float,
        trans: Transform,
    ) -> Sequence[Artist]:
        """Return the line and the head, in the legend's own frame."""
        del legend, fontsize
        look: Look = orig_handle
        middle = 0.5 * height - ydescent
        ends = Point(-xdescent, middle), Point(width - xdescent, middle)
        shaft, tip = _parts(ends, max(5.0, 2.8 * look.width), look.broad)
        line = LineCollection(
            [shaft],
            colors=look.color,
            linewidths=look.width,
            linestyles=[look.line],
            capstyle="butt",
            transform=trans,
        )
        face = "white" if look.hollow else look.color
        pointed = Polygon(
            tip, closed=True, facecolor=face, edgecolor=look.color, linewidth=0.5, transform=trans
        )
        return [line, pointed]


def _parts(arrow: Arrow, head: float, broad: float) -> tuple[list[Point], list[Point]]:
    """Return the line of an arrow, up to its head, and the three corners of the head."""
    start, end = arrow
    length = math.dist(start, end) or 1.0
    ux, uy = (end.x - start.x) / length, (end.y - start.y) / length
    side = 0.5 * broad * head
    neck = Point(end.x - head * ux, end.y - head * uy)
    left = Point(neck.x - side * uy, neck.y + side * ux)
    right = Point(neck.x + side * uy, neck.y - side * ux)
    return [start, neck], [end, left, right]
