"""What a tool affords, as arrows over its outline: a panel a behavior and distance (Fig. 6)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.core.tool import ToolPart
from affcli.errors import BadInputError
from affcli.report.fates import Fate, TableView
from affcli.report.figures.arrows import LOOKS, Arrow, ArrowKey, draw_arrows
from affcli.report.figures.canvas import FAINT, ONE_COLUMN, TWO_COLUMNS, canvas
from affcli.report.figures.things import draw_grasp, draw_parts, draw_puck
from affcli.report.figures.words import call_words, literal

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARGIN = 0.8
"""Room around all that is drawn (in of the table)."""
LEFT, BELOW, TITLE, GAP = 0.39, 0.34, 0.19, 0.08
"""Room (in of the page) beside a table for the numbers and words of y, below it for those of x,
above each panel for its title, and between panels."""
HEADING, KEY = 0.18, 0.22
"""Room (in of the page) for the heading of a table, and for the key."""
HIGHEST, LOWEST = 2.5, 0.4
"""The height of a panel over its width lies between these."""
NARROWEST = 0.5
"""A panel of less width (in of the page) shows nothing."""


@dataclass(frozen=True, slots=True)
class Extent:
    """The part of the wrist's frame that every panel shows (in)."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def aspect(self) -> float:
        """Height over width."""
        return (self.top - self.bottom) / (self.right - self.left)


@dataclass(frozen=True, slots=True)
class Layout:
    """Where the panels are: said outright, which is exact and takes half the time of a search.

    Args:
        width, height: of the figure (in of the page).
        panel: width and height of a panel.
        top: of the titles of the first panels.
    """

    width: float
    height: float
    panel: tuple[float, float]
    top: float

    @classmethod
    def of(
        cls, shape: tuple[int, int], tables: int, aspect: float, *, headed: bool, keyed: bool
    ) -> "Layout":
        """Lay out so many rows and columns of panels a table.

        Args:
            shape: rows and columns of one table's panels.
            tables: side by side.
            aspect: height over width of a panel.
            headed: the tables have headings.
            keyed: there is a key.

        Raises:
            BadInputError: there is no room for so many.
        """
        down, across = shape
        width = TWO_COLUMNS if across * tables > 2 else ONE_COLUMN
        inner = (width / tables - LEFT) / across - GAP
        if inner < NARROWEST:
            raise BadInputError(
                f"{across * tables} panels side by side: a page takes "
                f"{int(width / (NARROWEST + GAP))}; draw one run with fewer behaviors"
            )
        panel = (inner, inner * aspect)
        top = down * (panel[1] + TITLE + GAP) - GAP + BELOW + KEY * keyed
        return cls(width, top + HEADING * headed, panel, top)

    def place(self, table: float, row: int, column: int) -> tuple[float, float, float, float]:
        """Return left, bottom, width and height of a panel, as shares of the figure.

        Args:
            table: where its table begins, as a share of the width.
            row, column: of the panel.
        """
        across, up = self.panel
        left = table * self.width + LEFT + column * (across + GAP)
        bottom = self.top - (row + 1) * (up + TITLE + GAP) + GAP
        return left / self.width, bottom / self.height, across / self.width, up / self.height


def affordances_figure(
    calls: Sequence[BehaviorCall], views: Sequence[TableView], key: Mapping[Fate, str]
) -> "Figure":
    """Return the eight panels of one affordance table, or of two side by side.

    Each arrow starts where the attractor was as seen from the wrist just before the exploratory
    behavior, and shows the movement on the table (camera coordinates) that the row expects. All
    panels have the same axes.

    Args:
        calls: the exploratory behaviors with their distances; rows of others get panels too.
        views: one table or two.
        key: what each fate is called below the panels, where more than one occurs.
    """
    groups = _groups([*calls, *(row.exploratory for view in views for row, _ in view.rows)])
    # One table has a column a behavior; two, which must share the width, a row a behavior.
    panels = {
        (j, i) if len(views) == 1 else (i, j): call
        for i, group in enumerate(groups)
        for j, call in enumerate(group)
    }
    shape = (1 + max(row for row, _ in panels), 1 + max(column for _, column in panels))
    extent = _extent(views)
    kinds = _kinds(views, key)
    layout = Layout.of(
        shape,
        len(views),
        extent.aspect,
        headed=any(view.heading for view in views),
        keyed=len(kinds) > 1,
    )
    with canvas(layout.width, layout.height) as figure:
        figure.set_layout_engine("none")
        for number, view in enumerate(views):
            begins = number / len(views)
            middle = begins + 0.5 * (1.0 / len(views) + LEFT / layout.width)
            figure.text(
                *(middle, 1.0 - 0.03 / layout.height, view.heading),
                ha="center",
                va="top",
                fontsize=9.0,
                **literal(),
            )
            for (row, column), call in panels.items():
                axes = figure.add_axes(layout.place(begins, row, column))
                _draw_panel(axes, view, call, extent)
                _label(axes, layout.panel, left=column == 0, last=(row + 1, column) not in panels)
                if row == column == 0:
                    _draw_scale(axes, view, extent)
        if len(kinds) > 1:
            _draw_key(figure, kinds, key)
    return figure


def _draw_panel(axes: "Axes", view: TableView, call: BehaviorCall, extent: Extent) -> None:
    """Draw the rows of one behavior and distance over the tool."""
    axes.set_title(call_words(call), y=1.0, pad=3.0, **literal())
    draw_parts(axes, view.parts)
    draw_parts(axes, view.missing, missing=True)
    draw_grasp(axes)
    its_rows = [(row, fate) for row, fate in view.rows if row.exploratory == call]
    for fate in Fate:
        arrows = [_arrow(row) for row, its in its_rows if its is fate]
        draw_arrows(axes, arrows, LOOKS[fate], head=0.034 * (extent.right - extent.left))
    axes.text(
        *(0.97, 0.03, _counts([fate for _, fate in its_rows])),
        transform=axes.transAxes,
        ha="right",
        va="bottom",
        fontsize=6.5,
        **literal(),
    )
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(extent.left, extent.right)
    axes.set_ylim(extent.bottom, extent.top)
    axes.set_xticks(_ticks(extent.left, extent.right))
    axes.set_yticks(_ticks(extent.bottom, extent.top))


def _draw_scale(axes: "Axes", view: TableView, extent: Extent) -> None:
    """Draw the attractor in a corner, to scale: an arrow begins at its middle."""
    middle = Point(
        extent.left + MARGIN + view.puck_radius, extent.bottom + MARGIN + view.puck_radius
    )
    draw_puck(axes, middle, view.puck_radius, before=True, color=FAINT)
    above = middle.y + view.puck_radius + 0.3
    axes.text(middle.x, above, "puck", ha="center", va="bottom", fontsize=6.0)


def _ticks(low: float, high: float) -> list[float]:
    """Return round numbers within bounds, once for all panels."""
    return [
        float(tick)
        for tick in MaxNLocator(5, steps=(1, 2, 5, 10)).tick_values(low, high)
        if low <= tick <= high
    ]


def _label(axes: "Axes", panel: tuple[float, float], *, left: bool, last: bool) -> None:
    """Write numbers and words at the left of the first panels and below the last ones.

    Args:
        axes: a panel.
        panel: its width and height (in of the page).
        left: it is one of the first.
        last: it is one of the last.
    """
    axes.tick_params(labelleft=left, labelbottom=last)
    if left:
        axes.set_ylabel("y from the wrist (in)")
        # However wide the numbers are: at the edge of the table's room.
        axes.yaxis.set_label_coords((0.13 - LEFT) / panel[0], 0.5)
    if last:
        axes.set_xlabel("x from the wrist (in)")
        axes.xaxis.set_label_coords(0.5, (0.13 - BELOW) / panel[1])


def _draw_key(figure: "Figure", kinds: Sequence[Fate], key: Mapping[Fate, str]) -> None:
    """Say below the panels what the arrows are."""
    handles = [Line2D([], []) for _ in kinds]
    figure.legend(
        handles,
        [key[fate] for fate in kinds],
        handler_map={
            handle: ArrowKey(LOOKS[fate]) for handle, fate in zip(handles, kinds, strict=True)
        },
        loc="lower center",
        borderaxespad=0.1,
        ncols=len(kinds),
        handlelength=2.4,
    )


def _kinds(views: Sequence[TableView], key: Mapping[Fate, str]) -> list[Fate]:
    """Return the fates that occur, of those that the key names."""
    return [fate for fate in key if any(view.count(fate) for view in views)]


def _arrow(row: Affordance) -> Arrow:
    """Return a row's movement as an arrow in the wrist's frame."""
    start, moved = row.start.wrist_to_object, row.expected_movement
    return start, Point(start.x + moved.dx, start.y + moved.dy)


def _extent(views: Sequence[TableView]) -> Extent:
    """Return what holds all tools and all arrows."""
    parts: list[ToolPart] = [part for v in views for part in (*v.parts, *v.missing)]
    points = [corner for part in parts for corner in part.outline.vertices]
    points += [end for view in views for row, _ in view.rows for end in _arrow(row)]
    points.append(Point(0.0, 0.0))
    xs, ys = zip(*points, strict=True)
    low, high = min(ys) - MARGIN, max(ys) + MARGIN
    # As much to the left as to the right: the wrist stays in the middle. However odd a tool is, a
    # panel is neither a slit nor a pole.
    half = max(max(map(abs, xs)) + MARGIN, 0.5 * (high - low) / HIGHEST)
    middle, up = 0.5 * (low + high), max(0.5 * (high - low), LOWEST * half)
    return Extent(-half, middle - up, half, middle + up)


def _groups(calls: Sequence[BehaviorCall]) -> list[list[BehaviorCall]]:
    """Return the calls without repeats, one list a behavior."""
    groups: dict[str, list[BehaviorCall]] = {}
    for call in dict.fromkeys(calls):
        groups.setdefault(call.name, []).append(call)
    return list(groups.values())


def _counts(fates: Sequence[Fate]) -> str:
    """Return how many rows a panel has, one line a fate where there are several."""
    counts = {fate: fates.count(fate) for fate in Fate if fate in fates}
    if set(counts) <= {Fate.ROW}:
        rows = len(fates)
        return f"{rows or 'no'} row{'' if rows == 1 else 's'}"
    return "\n".join(f"{count} {fate.value}" for fate, count in counts.items())
