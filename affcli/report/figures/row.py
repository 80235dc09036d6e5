"""One row of an affordance table, as the paper's table shows one (Fig. 5)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from affcli.core.affordance import Affordance
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.report.fates import RowView
from affcli.report.figures.arrows import Look, draw_arrows
from affcli.report.figures.canvas import FAINT, INK, TWO_COLUMNS, canvas
from affcli.report.figures.scale import draw_length, round_length
from affcli.report.figures.things import draw_grasp, draw_parts, draw_puck
from affcli.report.figures.words import behavior_words, call_words, literal, parameter_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMNS = (
    ("Grasping behavior\nand its parameters", 1.3),
    ("Exploratory behavior\nand its parameters", 1.4),
    (r"$O_\mathrm{start}$", 1.65),
    (r"$O_\mathrm{end}$", 1.65),
    ("Replication\nprobability", 1.1),
)
"""Headings, and widths of the cells (in of the page): together two columns of a journal."""
HEADING, DRAWN, WRITTEN = 0.4, 1.85, 0.5
"""Heights (in of the page) of the headings, of the drawings and of the words below these."""
MARGIN = 1.0
"""Room around what is drawn (in of the table)."""
MOVED = Look(INK, width=1.1, level=7.0)
Cell = tuple[float, float, float, float]
"""Left, bottom, width and height (in of the page)."""


def row_figure(view: RowView) -> "Figure":
    """Return one row: grasp, behavior, what was seen before and after, probability.

    Tool and attractor are drawn where the observations put them: the wrist at the attractor less
    its place from the wrist. All drawings have one scale.
    """
    row = view.row
    with canvas(TWO_COLUMNS, HEADING + DRAWN + WRITTEN) as figure:
        figure.set_layout_engine("none")
        lefts = [sum(width for _, width in COLUMNS[:i]) for i in range(len(COLUMNS))]
        cells = [
            (left, 0.0, width, DRAWN + WRITTEN)
            for left, (_, width) in zip(lefts, COLUMNS, strict=True)
        ]
        page = _draw_rules(figure, cells)
        seen = [_outline(view, [row.start, row.end]), _outline(view, [])]
        scale = max(
            _needed(points, cell) for points, cell in zip(seen, (cells[2], cells[0]), strict=True)
        )
        grasping = _map(figure, cells[0], seen[1], scale)
        _draw_tool(grasping, view, Point(0.0, 0.0))
        _write(page, cells[0], call_words(row.binding), "+ grasp point")
        _write_behavior(page, cells[1], row)
        _draw_scale(page, cells[1], scale)
        before = _map(figure, cells[2], seen[0], scale)
        _draw_tool(before, view, wrist_of(row.start))
        draw_puck(before, row.start.object_position, view.puck_radius)
        _write(page, cells[2], *_places(row.start))
        _draw_end(_map(figure, cells[3], seen[0], scale), view)
        _write(page, cells[3], *_places(row.end))
        _write_movement(page, cells[3], row)
        _write_probability(page, cells[4], row)
    return figure


def wrist_of(seen: Observation) -> Point:
    """Return where the wrist was by an observation (in, table frame)."""
    return Point(seen.object_x - seen.wrist_to_object_x, seen.object_y - seen.wrist_to_object_y)


def _draw_rules(figure: "Figure", cells: Sequence[Cell]) -> "Axes":
    """Draw the lines of the table and its headings; return axes in inches of the page."""
    page = figure.add_axes((0.0, 0.0, 1.0, 1.0), zorder=-1.0)
    page.set_axis_off()
    width, height = figure.get_size_inches()
    page.set_xlim(0.0, width)
    page.set_ylim(0.0, height)
    top, middle = height - 0.01, height - HEADING
    for y, thick in ((top, 0.9), (middle, 0.5), (0.01, 0.9)):
        page.plot([0.0, width], [y, y], color=INK, linewidth=thick)
    for left, *_ in cells[1:]:
        page.plot([left, left], [0.01, top], color=FAINT, linewidth=0.4)
    for (left, _, across, _), (heading, _) in zip(cells, COLUMNS, strict=True):
        x, y = left + 0.5 * across, middle + 0.5 * HEADING
        page.text(x, y, heading, ha="center", va="center", fontsize=7.5)
    return page


def _map(figure: "Figure", cell: Cell, points: Sequence[Point], scale: float) -> "Axes":
    """Return axes in the drawn part of a cell, `scale` inches of the table to one of the page."""
    left, bottom, width, _ = cell
    across, up = figure.get_size_inches()
    rectangle = (left / across, (bottom + WRITTEN) / up, width / across, DRAWN / up)
    axes = figure.add_axes(rectangle)
    axes.set_axis_off()
    xs, ys = zip(*points, strict=True)
    x, y = 0.5 * (min(xs) + max(xs)), 0.5 * (min(ys) + max(ys))
    axes.set_xlim(x - 0.5 * width * scale, x + 0.5 * width * scale)
    axes.set_ylim(y - 0.5 * DRAWN * scale, y + 0.5 * DRAWN * scale)
    axes.set_aspect("equal", adjustable="box")
    return axes


def _outline(view: RowView, observations: Sequence[Observation]) -> list[Point]:
    """Return points on the edge of all that is seen; without observations of the tool alone."""
    corners = [corner for part in view.tool.parts for corner in part.outline.vertices]
    if not observations:
        return corners
    points = []
    for seen in observations:
        wrist, puck, radius = wrist_of(seen), seen.object_position, view.puck_radius
        points += [Point(wrist.x + x, wrist.y + y) for x, y in corners]
        points += [Point(puck.x + side, puck.y + side) for side in (-radius, radius)]
    return points


def _needed(points: Sequence[Point], cell: Cell) -> float:
    """Return the inches of the table to one of the page at which points just fit into a cell."""
    xs, ys = [point.x for point in points], [point.y for point in points]
    return max((max(xs) - min(xs) + 2 * MARGIN) / cell[2], (max(ys) - min(ys) + MARGIN) / DRAWN)


def _draw_tool(axes: "Axes", view: RowView, wrist: Point) -> None:
    """Draw the tool with its grasp point at the wrist."""
    draw_parts(axes, view.tool.parts, wrist)
    draw_grasp(axes, wrist)


def _draw_end(axes: "Axes", view: RowView) -> None:
    """Draw where tool and attractor came to, whence they came, and the detected movement."""
    start, end = view.row.start, view.row.end
    draw_parts(axes, view.tool.parts, wrist_of(start), missing=True)
    draw_puck(axes, start.object_position, view.puck_radius, before=True)
    _draw_tool(axes, view, wrist_of(end))
    draw_puck(axes, end.object_position, view.puck_radius)
    draw_arrows(axes, [(start.object_position, end.object_position)], MOVED, head=1.2)


def _write_behavior(page: "Axes", cell: Cell, row: Affordance) -> None:
    """Say which exploratory behavior it was."""
    x, y = cell[0] + 0.5 * cell[2], WRITTEN + 0.5 * DRAWN
    _text(page, x, y + 0.12, behavior_words(row.exploratory), fontsize=8.5)
    _text(page, x, y - 0.06, parameter_words(row.exploratory), fontsize=8.5)
    if row.truncated:
        _write(page, cell, "cut short: it met the", "edge of the reach")


def _draw_scale(page: "Axes", cell: Cell, scale: float) -> None:
    """Draw how long some inches are in the drawings, below the behavior."""
    place = Point(cell[0] + 0.5 * cell[2], WRITTEN + 0.1)
    draw_length(page, place, round_length(0.6 * cell[2] * scale), 1.0 / scale)


def _write_movement(page: "Axes", cell: Cell, row: Affordance) -> None:
    """Name the arrow of the detected movement, with its length."""
    left, y = cell[0] + 0.07, 0.1
    draw_arrows(page, [(Point(left, y), Point(left + 0.2, y))], MOVED, head=0.08)
    words = f"detected movement {row.expected_movement.distance:.1f} in"
    page.text(left + 0.24, y, words, ha="left", va="center", fontsize=6.5)


def _write_probability(page: "Axes", cell: Cell, row: Affordance) -> None:
    """Write the replication probability as the paper does, and as numbers."""
    x, y = cell[0] + 0.5 * cell[2], WRITTEN + 0.5 * DRAWN + 0.2
    page.plot([cell[0] + 0.1, cell[0] + cell[2] - 0.1], [y, y], color=INK, linewidth=0.6)
    _text(page, x, y + 0.1, "times successful")
    _text(page, x, y - 0.1, "times used")
    counts = f"{row.times_successful} / {row.times_used}"
    _text(page, x, y - 0.38, f"= {counts} = {row.replication_probability:.2f}", fontsize=7.5)
    if 2 * row.times_successful <= row.times_used:
        _write(page, cell, "excluded: not", "greater than 1/2")


def _write(page: "Axes", cell: Cell, *lines: str) -> None:
    """Write lines into the lower part of a cell."""
    for number, line in enumerate(lines):
        _text(page, cell[0] + 0.5 * cell[2], 0.39 - 0.13 * number, line, fontsize=6.5)


def _text(page: "Axes", x: float, y: float, text: str, fontsize: float = 7.0) -> None:
    """Write one line in the middle of a place of the page."""
    page.text(x, y, text, ha="center", va="center", fontsize=fontsize, **literal())


def _places(seen: Observation) -> list[str]:
    """Return what the robot keeps of an observation: coordinates (in, table frame)."""
    places = (("attractor", seen.object_position), ("wrist", wrist_of(seen)))
    return [f"{what} ({_tenths(place.x)}, {_tenths(place.y)})" for what, place in places]


def _tenths(length: float) -> str:
    """Return a length with one decimal; what rounds to zero has no sign."""
    return f"{round(length, 1) + 0.0:.1f}"
