"""One row of an affordance table, as the paper's table shows one (Fig. 5)."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from affcli.core.affordance import Affordance
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.report.figures.arrows import Look, draw_arrows
from affcli.report.figures.canvas import FAINT, INK, TWO_COLUMNS, canvas, wrapped
from affcli.report.figures.maps import columns_for, fit_maps, map_panels
from affcli.report.figures.things import (
    draw_grasp,
    draw_length,
    draw_parts,
    draw_puck,
    round_length,
)
from affcli.report.figures.words import behavior_words, call_words
from affcli.report.table_views import RowView
from affcli.report.words import parameter_words

HEADINGS = (
    "Grasping behavior and its parameters",
    "Exploratory behavior and its parameters",
    r"$O_\mathrm{start}$ (in)",
    r"$O_\mathrm{end}$ (in)",
    "Replication probability",
)
NARROWEST = 1.1
"""Width of a cell (in)."""
MARGIN = 1.0
"""Room around what is drawn (in of the table)."""
ASPECTS = 0.8, 2.0
"""The height of a cell over its width lies between these."""
MOVED = Look(INK, width=1.1, level=7.0)


def row_figure(view: RowView, width: float | None = None) -> Figure:
    """Return one row: grasp, behavior, what was seen before and after, probability.

    Tool and attractor are drawn where the observations put them, from where the wrist was at the
    start; the wrist is at the attractor less its place from the wrist, and turned as it was when
    the exploratory behavior began and ended. All drawings have one scale.

    Args:
        view: the row.
        width: in; that of two columns if not given. In one the cells stand in two lines.
    """
    row, width = view.row, width or TWO_COLUMNS
    with canvas(width) as figure:
        columns = columns_for(len(HEADINGS), max(1, int(width / NARROWEST)))
        write = _Pen(width / columns - 0.12)
        cells = map_panels(figure, len(HEADINGS), columns, labels=("", ""))
        for number, (axes, heading) in enumerate(zip(cells, HEADINGS, strict=True)):
            write.over(axes, heading)
            axes.tick_params(length=0.0, labelleft=False, labelbottom=False)
            axes.spines["left"].set(visible=number % columns > 0, color=FAINT, linewidth=0.4)
            axes.spines["bottom"].set_visible(False)
            axes.spines["top"].set(visible=True, linewidth=0.5)
        grasping, behavior, before, after, probability = cells
        _draw_tool(grasping, view, Pose(0.0, 0.0))
        cross = "the cross is the grasp point" if row.is_placed() else "where is not known"
        write.below(grasping, call_words(row.binding), cross)
        write.into(behavior, behavior_words(row.exploratory), parameter_words(row.exploratory))
        if row.truncated:
            write.below(behavior, "cut short: it met the edge of the reach")
        if row.is_placed():
            _draw_tool(before, view, Pose(0.0, 0.0, row.wrist_angle))
        draw_puck(before, row.drawn_at, view.puck_radius)
        write.below(before, *_places(row.start))
        _draw_end(after, view)
        length = row.expected_movement.distance
        write.below(after, *_places(row.end), f"detected movement {length:.1f} in")
        write.into(probability, *_probability(row))
        draw_length(behavior, Point(0.0, 0.0), round_length(4.0 * view.puck_radius))
        fit_maps(figure, cells, room=MARGIN, aspects=ASPECTS)
        for y, thick in ((0.999, 0.9), (0.001, 0.9)):
            figure.add_artist(Line2D([0.0, 1.0], [y, y], color=INK, linewidth=thick))
    return figure


def _wrist(seen: Observation) -> Point:
    """Return where the wrist was by an observation (in, table frame)."""
    x, y = seen.object_position
    return Point(x - seen.wrist_to_object_x, y - seen.wrist_to_object_y)


def _draw_tool(axes: Axes, view: RowView, wrist: Pose) -> None:
    """Draw the tool with its grasp point at the wrist."""
    draw_parts(axes, view.tool.parts, wrist)
    draw_grasp(axes, wrist)


def _draw_end(axes: Axes, view: RowView) -> None:
    """Draw where tool and attractor came from and went to, and the detected movement."""
    row = view.row
    began, movement = row.drawn_at, row.expected_movement
    ended = Point(began.x + movement.dx, began.y + movement.dy)
    draw_puck(axes, began, view.puck_radius, before=True)
    moved = Point(*(b - a for a, b in zip(_wrist(row.start), _wrist(row.end), strict=True)))
    if not math.isnan(moved.x + moved.y):
        draw_parts(axes, view.tool.parts, Pose(0.0, 0.0, row.wrist_angle), missing=True)
        _draw_tool(axes, view, Pose(*moved, row.wrist_angle + view.turned))
    draw_puck(axes, ended, view.puck_radius)
    draw_arrows(axes, [(began, ended)], MOVED, head=1.2)


def _probability(row: Affordance) -> Iterable[str]:
    """Return the replication probability as the paper writes it, and as numbers."""
    counts = f"{row.times_successful} / {row.times_used}"
    yield "times successful / times used"
    yield f"= {counts} = {row.replication_probability:.2f}"
    if 2 * row.times_successful <= row.times_used:
        yield "excluded: not greater than 1/2"


class _Pen(NamedTuple):
    """Writes into the cells, which are so wide (in)."""

    room: float

    def over(self, axes: Axes, words: str) -> None:
        """Write the heading of a cell; what is small in a formula is still large enough."""
        formula = "$" in words
        lines = words if formula else wrapped(words, 7.0, self.room)
        axes.set_title(lines, parse_math=formula, fontsize=9.0 if formula else 7.0)

    def into(self, axes: Axes, *lines: str) -> None:
        """Write lines into the middle of a cell."""
        words = wrapped("\n".join(lines), 8.0, self.room)
        axes.text(0.5, 0.55, words, transform=axes.transAxes, ha="center", va="center", fontsize=8)

    def below(self, axes: Axes, *lines: str) -> None:
        """Write lines below a cell's drawing."""
        axes.set_xlabel(wrapped("\n".join(lines), 6.5, self.room), fontsize=6.5)


def _places(seen: Observation) -> Iterable[str]:
    """Return what the robot keeps of an observation: coordinates (in, table frame)."""
    for what, place in (("attractor", seen.object_position), ("wrist", _wrist(seen))):
        if math.isnan(place.x + place.y):
            continue
        # Adding zero takes the sign from what rounds to zero.
        yield f"{what} ({round(place.x, 1) + 0.0:.1f}, {round(place.y, 1) + 0.0:.1f})"
