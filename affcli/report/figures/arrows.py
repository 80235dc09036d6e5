"""Movements as arrows whose heads are never longer than they are themselves; and their key."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.legend_handler import HandlerBase
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from affcli.core.geometry import Point
from affcli.report.fates import Fate
from affcli.report.figures.canvas import BLUE, FAINT, GREEN, VERMILION

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.legend import Legend
    from matplotlib.transforms import Transform

Arrow = tuple[Point, Point]
"""Start and end (in, the axes' frame)."""

HEAD_ASPECT = 0.7
"""Width of a head over its length."""
LARGEST_HEAD = 0.55
"""A head is at most this share of its arrow."""


@dataclass(frozen=True, slots=True)
class Look:
    """How arrows of one kind look: by colour, and without colours by dashes and heads.

    Args:
        color: of all of it.
        dashes: on and off in points; none for a solid line.
        hollow: the head is an outline.
        width: of the line (points).
        level: arrows of a higher level lie over those of a lower.
    """

    color: str
    dashes: tuple[float, ...] = ()
    hollow: bool = False
    width: float = 0.8
    level: float = 5.0

    @property
    def line(self) -> Any:
        """The line's style as matplotlib takes it."""
        return (0, self.dashes) if self.dashes else "-"


LOOKS: Mapping[Fate, Look] = {
    Fate.ROW: Look(BLUE),
    Fate.KEPT: Look(BLUE),
    Fate.LOST: Look(VERMILION, (2.0, 1.2), hollow=True, width=0.9, level=6.0),
    Fate.WON: Look(GREEN, (0.9, 0.9), hollow=True, width=1.0, level=6.0),
    Fate.EXCLUDED: Look(FAINT, (2.0, 1.2), hollow=True, width=0.7, level=4.0),
}


def draw_arrows(axes: "Axes", arrows: Sequence[Arrow], look: Look, head: float) -> None:
    """Draw arrows, as one artist for all lines and one for all heads.

    Args:
        axes: where.
        arrows: from where to where.
        look: how.
        head: length of a head (in); shorter where the arrow is short.
    """
    if not arrows:
        return
    shafts, heads = [], []
    for start, end in arrows:
        shaft, tip = _parts(start, end, head)
        shafts.append(shaft)
        heads.append(tip)
    axes.add_collection(
        LineCollection(
            shafts,
            colors=look.color,
            linewidths=look.width,
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


class ArrowKey(HandlerBase):
    """Draws an arrow in a legend, whatever artist it stands for.

    Args:
        look: of the arrow.
    """

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look

    def create_artists(
        self,
        legend: "Legend",
        orig_handle: "Artist",
        xdescent: float,
        ydescent: float,
        width: float,
        height: float,
        fontsize: float,
        trans: "Transform",
    ) -> Sequence["Artist"]:
        """Return the line and the head, in the legend's own frame."""
        del legend, orig_handle, fontsize
        look = self._look
        middle = 0.5 * height - ydescent
        shaft, tip = _parts(Point(-xdescent, middle), Point(width - xdescent, middle), 5.0)
        line = Line2D(
            *zip(*shaft, strict=True),
            color=look.color,
            linewidth=look.width,
            linestyle=look.line,
            dash_capstyle="butt",
            solid_capstyle="butt",
            transform=trans,
        )
        face = "white" if look.hollow else look.color
        pointed = Polygon(
            tip, closed=True, facecolor=face, edgecolor=look.color, linewidth=0.5, transform=trans
        )
        return [line, pointed]


def _parts(start: Point, end: Point, head: float) -> tuple[list[Point], list[Point]]:
    """Return the line of an arrow, up to its head, and the three corners of the head."""
    dx, dy = end.x - start.x, end.y - start.y
    length = math.hypot(dx, dy)
    if length == 0.0:
        return [start, end], [end, end, end]
    ux, uy = dx / length, dy / length
    size = min(head, LARGEST_HEAD * length)
    side = 0.5 * HEAD_ASPECT * size
    neck = Point(end.x - size * ux, end.y - size * uy)
    corners = [end, Point(neck.x - side * uy, neck.y + side * ux)]
    corners.append(Point(neck.x + side * uy, neck.y - side * ux))
    return [start, neck], corners
