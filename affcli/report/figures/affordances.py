"""What a tool affords, as arrows over its outline: a panel a behavior and distance (Fig. 6)."""

import math
from collections.abc import Mapping, Sequence
from itertools import zip_longest
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from affcli.analysis.paper import in_papers_order
from affcli.analysis.row_status import RowStatus
from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.report.figures.arrows import LOOKS, Arrow, draw_arrows
from affcli.report.figures.canvas import FAINT, ONE_COLUMN, SMALL, TWO_COLUMNS, canvas, wrapped
from affcli.report.figures.key import draw_key
from affcli.report.figures.maps import columns_for, fit_maps, map_panels
from affcli.report.figures.things import draw_grasp, draw_parts, draw_puck
from affcli.report.figures.words import call_words
from affcli.report.table_views import TableView

MARGIN = 0.8
"""Room around all that is drawn (in of the table)."""
ASPECTS = 0.4, 2.5
"""The height of a panel over its width lies between these."""
TITLES = 7.0
"""Size of the letters over a panel (points)."""
HEAD = 0.8
"""Length of the heads of arrows (in of the table)."""
ENOUGH = 1.4
"""Width that a panel should have (in)."""
LEAST = 0.8
"""Width that it has at least (in): where more than `MOST_ROWS` would not fit a page, or where
several tables stand over one another."""
MOST_ROWS = 4
MOST_BESIDE = 5
"""Where so many behaviors fit beside one another they all stand so."""


class _Panel(NamedTuple):
    """What the rows of one panel share: their behavior, the wrist's angle before it (deg), and the
    binding behavior by which the tool was held, where it is not the view's own.
    """

    call: BehaviorCall
    turn: int
    held: BehaviorCall | None = None


def affordances_figure(
    calls: Sequence[BehaviorCall],
    views: Sequence[TableView],
    key: Mapping[RowStatus, str],
    width: float | None = None,
) -> Figure:
    """Return the panels of one affordance table, or of several side by side.

    Each arrow starts where the attractor was as seen from the wrist just before the exploratory
    behavior, and shows the movement on the table (camera coordinates) that the row expects. All
    panels have the same axes.

    Args:
        calls: the exploratory behaviors with their parameters; rows of others get panels too.
        views: the tables.
        key: what each status is called below the panels, where more than one occurs.
        width: in; what suits it if not given.
    """
    groups = _groups(calls, [_panel_of(row, view) for view in views for row, _ in view.rows])
    beside = 1 if width is not None and width < len(views) * 2 * ENOUGH else len(views)
    most = int((width or TWO_COLUMNS) / ENOUGH) // beside
    if beside < len(views) or sum(map(len, groups)) > most * MOST_ROWS:
        most = int((width or TWO_COLUMNS) / LEAST) // beside
    shown, columns = _arranged(groups, max(most, 1))
    width = width or (TWO_COLUMNS if columns * len(views) > 2 else ONE_COLUMN)
    down = len(views) // beside
    kinds = [status for status in key if any(view.count(status) for view in views)]
    with canvas(width) as figure:
        room = (width - 0.6) / (columns * beside) - 0.05
        grid = figure.add_gridspec(down, beside)
        pages = [figure.add_subfigure(grid[number]) for number in range(len(views))]
        panels = [
            axes
            for page, view in zip(pages, views, strict=True)
            for axes in _draw_table(page, view, shown, columns, room)
        ]
        if len(kinds) > 1:
            draw_key(figure, [(LOOKS[status], key[status]) for status in kinds])
        # As much to the left as to the right: the wrist stays in the middle.
        half = max(abs(x) for axes in panels for x in axes.dataLim.intervalx)
        panels[0].update_datalim([(-half, 0.0), (half, 0.0)])
        fit_maps(figure, panels, room=MARGIN, aspects=ASPECTS, pages=down)
    return figure


def _panel_of(row: Affordance, view: TableView) -> _Panel:
    """Return the panel that a row is drawn in."""
    held = row.binding if row.binding in view.regrasped else None
    return _Panel(row.exploratory, row.wrist_degrees, held)


def _groups(calls: Sequence[BehaviorCall], of_rows: Sequence[_Panel]) -> list[list[_Panel]]:
    """Return the panels without repeats, one list for each behavior, in the order of Fig. 6.

    A call without rows has a panel too, with the tool as it is grasped.
    """
    panels: dict[BehaviorCall, set[_Panel]] = {call: set() for call in calls}
    for panel in of_rows:
        panels.setdefault(panel.call, set()).add(panel)
    groups: dict[str, list[_Panel]] = {}
    for call, its in panels.items():
        in_order = sorted(its or {_Panel(call, 0)}, key=lambda one: (str(one.held or ""), one.turn))
        groups.setdefault(call.name, []).extend(in_order)
    return in_papers_order(groups.values(), lambda panels: panels[0].call.name)


def _arranged(groups: Sequence[Sequence[_Panel]], most: int) -> tuple[list[_Panel], int]:
    """Return the panels in their order, row by row, and how many stand in a row.

    Each behavior has a column where so many fit, or where that leaves few rows; else a row.
    """
    longest = max(map(len, groups))
    if longest <= most < len(groups) and most < MOST_BESIDE:
        return [panel for group in groups for panel in group], longest
    by_parameter = [panel for panels in zip_longest(*groups) for panel in panels if panel]
    return by_parameter, columns_for(len(groups), most)


def _draw_table(
    page: FigureBase, view: TableView, shown: Sequence[_Panel], columns: int, room: float
) -> list[Axes]:
    """Draw one table in so many columns of panels; return the panels."""
    placed = not view.rows or any(row.is_placed() for row, _ in view.rows)
    whence = "from the wrist" if placed else "moved"
    labels = f"x {whence} (in)", f"y {whence} (in)"
    panels = map_panels(page, len(shown), columns, labels)
    for axes, panel in zip(panels, shown, strict=True):
        _draw_panel(axes, view, panel, room)
    if view.heading:
        page.suptitle(wrapped(view.heading, 8.0, columns * room), fontsize=8.0)
    if placed:
        _draw_scale(panels[0], view)
    return panels


def _draw_scale(axes: Axes, view: TableView) -> None:
    """Draw the attractor beside the grasp point, to scale: an arrow begins at its middle."""
    corners = [c for part in (*view.parts, *view.missing) for c in part.outline.vertices]
    radius = view.puck_radius
    left, bottom = (min((c[i] for c in corners), default=0.0) for i in (0, 1))
    place = Point(left - 2 * radius, bottom + radius)
    draw_puck(axes, place, radius, before=True, color=FAINT)
    axes.text(place.x - radius, place.y + 1.2 * radius, "puck", va="bottom", fontsize=SMALL)


def _draw_panel(axes: Axes, view: TableView, panel: _Panel, room: float) -> None:
    """Draw the rows of one panel over the tool, which turns with the wrist."""
    wrist = Pose(0.0, 0.0, math.radians(panel.turn))
    parts, missing = view.parts, view.missing
    if panel.held is not None:
        parts, missing = view.regrasped.get(panel.held, ((), ()))
    draw_parts(axes, parts, wrist)
    draw_parts(axes, missing, wrist, missing=True)
    draw_grasp(axes)
    its_rows = [(row, status) for row, status in view.rows if _panel_of(row, view) == panel]
    for status in RowStatus:
        arrows = [_arrow(row) for row, its in its_rows if its is status]
        draw_arrows(axes, arrows, LOOKS[status], HEAD)
    turned = [f"wrist at {panel.turn} deg"] if panel.turn else []
    turned += [call_words(panel.held)] if panel.held else []
    counts = _counts([status for _, status in its_rows])
    lines = "\n".join([call_words(panel.call), *turned, counts])
    axes.set_title(wrapped(lines, TITLES, room), fontsize=TITLES)


def _arrow(row: Affordance) -> Arrow:
    """Return a row's movement as an arrow in the wrist's frame."""
    start, moved = row.drawn_at, row.expected_movement
    return start, Point(start.x + moved.dx, start.y + moved.dy)


def _counts(statuses: Sequence[RowStatus]) -> str:
    """Return how many rows a panel has, of each status where there are several."""
    counts = {status: statuses.count(status) for status in RowStatus if status in statuses}
    if set(counts) <= {RowStatus.LIVE}:
        rows = len(statuses)
        return f"{rows or 'no'} row{'' if rows == 1 else 's'}"
    return ", ".join(f"{count} {status.value}" for status, count in counts.items())
