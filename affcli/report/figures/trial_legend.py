"""What stands for what in a film strip: its colours, its two arrows, and the legend."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.legend_handler import HandlerBase
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrow, Rectangle
from matplotlib.transforms import Transform

from affcli.core.geometry import Point
from affcli.core.observation import Movement
from affcli.report.figures.canvas import BLUE, INK, ORANGE, PALE, VERMILION, WOOD
from affcli.report.film import FilmedTrial, Shown

BEFORE, AFTER, PATH = "#b4b4b4", "#6e6e6e", "#5a5a5a"
"""Outlines of the tool before and after a behavior; the attractor's path."""
DASHES = (0, (3, 2))
SMALL = 6.2
"""Size of the letters (pt): what fits over the narrowest panel."""


@dataclass(frozen=True, slots=True)
class Arrow:
    """How a movement is drawn.

    Args:
        color: of all of it.
        width: of the shaft (pt).
        zorder: what it is drawn over.
    """

    color: str
    width: float
    zorder: int

    def drawn(self, start: Point, movement: Movement, point: float) -> FancyArrow:
        """Return the arrow; a short one is smaller in all, so that its head is not all of it.

        Args:
            start: where it begins, in some frame.
            movement: where it leads.
            point: how long a typographic point is in that frame.
        """
        length = math.hypot(movement.dx, movement.dy)
        full = (2.0 + 2.2 * self.width) * point
        broad = min(full, 1.2 * length)
        return FancyArrow(
            start.x, start.y, movement.dx, movement.dy,
            width=min(self.width * point, 0.5 * broad), head_width=broad,
            head_length=min(full, 0.6 * length), length_includes_head=True,
            facecolor=self.color, edgecolor="white", linewidth=0.3, zorder=self.zorder,
        )  # fmt: skip


EXPECTED, SEEN = Arrow(BLUE, 2.6, 5), Arrow(INK, 0.9, 6)
"""Of two widths: one is seen beside the other where both are the same."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A line of the legend.

    Args:
        label: what it says.
        drawn: gives its picture, made for a box of this width and height (pt) at (0, 0).
    """

    label: str
    drawn: Callable[[float, float], list[Artist]]


def legend_entries(trial: FilmedTrial, shown: Shown) -> list[Entry]:
    """Return what the legend of these panels explains: what there is in them."""
    last = [take[-1] for take in shown.takes]
    entries = [Entry("attractor", _attractor)]
    if last:
        entries = [
            Entry("movement the row expects", lambda w, h: [_arrow(EXPECTED, w, h)]),
            Entry("movement seen", lambda w, h: [_arrow(SEEN, w, h)]),
            Entry("attractor before and after", _attractors),
            Entry("its path so far", _path),
            Entry("tool before and after", _tools),
        ]
    if trial.missing:
        entries.append(Entry("part that is missing", _missing))
    if any(step.blocked for step in last):
        entries.append(Entry("blocked: held over the table", _held))
    if any(step.lost for step in last):
        entries.append(Entry("row the broken tool has lost", _frame))
    return [*entries, Entry("goal region", _goal)]


class _Handler(HandlerBase):
    """Lets an entry draw its own picture."""

    def __init__(self, entry: Entry) -> None:
        super().__init__()
        self._entry = entry

    def create_artists(
        self,
        legend: Legend,
        orig_handle: Artist,
        xdescent: float,
        ydescent: float,
        width: float,
        height: float,
        fontsize: float,
        trans: Transform,
    ) -> Sequence[Artist]:
        """Return the picture at its place."""
        del legend, orig_handle, xdescent, ydescent, fontsize
        artists = self._entry.drawn(width, height)
        for artist in artists:
            artist.set_transform(trans)
        return artists


def draw_legend(
    figure: Figure,
    entries: Sequence[Entry],
    corner: Literal["upper left", "lower left"],
    at: tuple[float, float],
    across: int = 1,
) -> None:
    """Draw the legend with a corner at a place of the figure (shares of it)."""
    handles = [Line2D([], [], label=entry.label) for entry in entries]
    figure.legend(
        handles=handles,
        handler_map={h: _Handler(e) for h, e in zip(handles, entries, strict=True)},
        loc=corner,
        bbox_to_anchor=at,
        ncols=across,
        borderpad=0.0,
        borderaxespad=0.0,
        handlelength=2.6,
        handleheight=1.0,
        columnspacing=1.6,
        labelspacing=0.55,
        fontsize=SMALL,
    )


def _arrow(arrow: Arrow, width: float, height: float) -> Artist:
    """Return an arrow across the box."""
    return arrow.drawn(Point(0.0, height / 2), Movement(width, 0.0, 0.0), 1.0)


def _attractor(width: float, height: float) -> list[Artist]:
    """Return a disc."""
    middle = (width / 2, height / 2)
    return [Circle(middle, 0.6 * height, facecolor=ORANGE, edgecolor=INK, linewidth=0.8)]


def _attractors(width: float, height: float) -> list[Artist]:
    """Return a dashed circle, and a disc."""
    radius = 0.55 * height
    before = Circle((radius, height / 2), radius, facecolor="none", edgecolor=INK, linewidth=0.8)
    before.set_linestyle(DASHES)
    after = Circle((width - radius, height / 2), radius, facecolor=ORANGE, edgecolor=INK)
    after.set_linewidth(0.8)
    return [before, after]


def _path(width: float, height: float) -> list[Artist]:
    """Return a thin line."""
    return [Line2D([0.0, width], [height / 2] * 2, color=PATH, linewidth=0.6)]


def _bar(left: float, right: float, height: float, edge: str, fill: str = "none") -> Rectangle:
    """Return a piece of a tool."""
    return Rectangle(
        (left, 0.2 * height), right - left, 0.6 * height,
        facecolor=fill, edgecolor=edge, linewidth=0.7,
    )  # fmt: skip


def _tools(width: float, height: float) -> list[Artist]:
    """Return an outline, and a filled piece."""
    half = 0.42 * width
    return [
        _bar(0.0, half, height, BEFORE),
        _bar(width - half, width, height, AFTER, WOOD),
    ]


def _missing(width: float, height: float) -> list[Artist]:
    """Return a dashed outline."""
    bar = _bar(0.0, width, height, AFTER)
    bar.set_linestyle(DASHES)
    return [bar]


def _held(width: float, height: float) -> list[Artist]:
    """Return a dark outline."""
    return [_bar(0.0, width, height, AFTER)]


def _frame(width: float, height: float) -> list[Artist]:
    """Return a panel's frame."""
    frame = Rectangle((0.0, 0.0), width, height, facecolor="none", edgecolor=VERMILION)
    frame.set_linewidth(1.5)
    return [frame]


def _goal(width: float, height: float) -> list[Artist]:
    """Return a square."""
    del width
    square = Rectangle((0.0, 0.0), height, height, facecolor=PALE, edgecolor=INK)
    square.set_linewidth(0.7)
    return [square]
