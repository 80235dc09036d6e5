"""One row of an affordance table, as the paper's table shows one (Fig. 5)."""

from collections.abc import Iterable

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from affcli.core.affordance import Affordance
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.report.figures.arrows import Look, draw_arrows
from affcli.report.figures.canvas import FAINT, INK, TWO_COLUMNS, canvas
from affcli.report.figures.maps import fit_maps, map_panels
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
    "Grasping behavior\nand its parameters",
    "Exploratory behavior\nand its parameters",
    r"$O_\mathrm{start}$",
    r"$O_\mathrm{end}$",
    "Replication\nprobability",
)
MARGIN = 1.0
"""Room around what is drawn (in of the table)."""
ASPECTS = 0.8, 2.0
"""The height of a cell over its width lies between these."""
MOVED = Look(INK, width=1.1, level=7.0)
PROBABILITY = r"$\dfrac{\mathrm{times\ successful}}{\mathrm{times\ used}}$"


def row_figure(view: RowView) -> Figure:
    """Return one row: grasp, behavior, what was seen before and after, probability.

    Tool and attractor are drawn where the observations put them, from where the wrist was at the
    start; the wrist is at the attractor less its place from the wrist, and turned as it was when
    the exploratory behavior began. All drawings have one scale.
    """
    row = view.row
    with canvas(TWO_COLUMNS) as figure:
        cells = map_panels(figure, len(HEADINGS), len(HEADINGS), labels=("", ""))
        for axes, heading in zip(cells, HEADINGS, strict=True):
            axes.set_title(heading, parse_math=True)
            axes.tick_params(length=0.0, labelleft=False, labelbottom=False)
            axes.spines["left"].set(visible=axes is not cells[0], color=FAINT, linewidth=0.4)
            axes.spines["bottom"].set_visible(False)
            axes.spines["top"].set(visible=True, linewidth=0.5)
        grasping, behavior, before, after, probability = cells
        _draw_tool(grasping, view, Pose(0.0, 0.0))
        _write_below(grasping, call_words(row.binding), "the cross is the grasp point")
        _write(behavior, behavior_words(row.exploratory), parameter_words(row.exploratory))
        if row.truncated:
            _write_below(behavior, "cut short: it met the", "edge of the reach")
        _draw_tool(before, view, Pose(0.0, 0.0, row.wrist_angle))
        draw_puck(before, row.start.wrist_to_object, view.puck_radius)
        _write_below(before, *_places(row.start))
        _draw_end(after, view)
        _write_probability(probability, row)
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
    wrist, moved = _wrist(row.start), _wrist(row.end)
    began, x, y = row.start.wrist_to_object, *row.end.object_position
    ended = Point(x - wrist.x, y - wrist.y)
    draw_parts(axes, view.tool.parts, Pose(0.0, 0.0, row.wrist_angle), missing=True)
    draw_puck(axes, began, view.puck_radius, before=True)
    _draw_tool(axes, view, Pose(moved.x - wrist.x, moved.y - wrist.y, row.wrist_angle))
    draw_puck(axes, ended, view.puck_radius)
    draw_arrows(axes, [(began, ended)], MOVED, head=1.2)
    length = row.expected_movement.distance
    _write_below(axes, *_places(row.end), f"detected movement {length:.1f} in")


def _write_probability(axes: Axes, row: Affordance) -> None:
    """Write the replication probability as the paper does, and as numbers."""
    counts = f"{row.times_successful} / {row.times_used}"
    axes.text(
        0.5, 0.6, PROBABILITY, transform=axes.transAxes, ha="center", fontsize=8.0, parse_math=True
    )  # fmt: skip
    _write(axes, "", "", "", f"= {counts} = {row.replication_probability:.2f}")
    if 2 * row.times_successful <= row.times_used:
        _write_below(axes, "excluded: not", "greater than 1/2")


def _write(axes: Axes, *lines: str) -> None:
    """Write lines into the middle of a cell."""
    words = "\n".join(lines)
    axes.text(0.5, 0.55, words, transform=axes.transAxes, ha="center", va="center", fontsize=8.0)


def _write_below(axes: Axes, *lines: str) -> None:
    """Write lines below a cell's drawing."""
    axes.set_xlabel("\n".join(lines), fontsize=6.5)


def _places(seen: Observation) -> Iterable[str]:
    """Return what the robot keeps of an observation: coordinates (in, table frame)."""
    for what, place in (("attractor", seen.object_position), ("wrist", _wrist(seen))):
        # Adding zero takes the sign from what rounds to zero.
        yield f"{what} ({round(place.x, 1) + 0.0:.1f}, {round(place.y, 1) + 0.0:.1f})"
