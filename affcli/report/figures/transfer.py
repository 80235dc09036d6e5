"""What a run borrowed: the lenders' rows over their tools, and the borrowed ones over the new (§8).

The tools are drawn as the camera sees them, for that is all that the robot has of them.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from affcli.core.affordance import Affordance
from affcli.core.geometry import Point
from affcli.core.mask import SCALE, Mask
from affcli.report.figures.arrows import Arrow, Look, draw_arrows
from affcli.report.figures.canvas import (
    BLUE,
    FAINT,
    GREEN,
    TWO_COLUMNS,
    VERMILION,
    WOOD,
    canvas,
    wrapped,
)
from affcli.report.figures.key import draw_key
from affcli.report.figures.maps import columns_for, fit_maps, map_panels
from affcli.report.figures.things import draw_grasp
from affcli.report.transferring import Kind, LentTable

LOOKS = {
    Kind.LEFT: Look(FAINT, width=0.5, level=4.0),
    Kind.SAME: Look(BLUE),
    Kind.SHIFTED: Look(GREEN, (0.9, 0.9), hollow=True, width=0.9, level=6.0),
    Kind.MIRRORED: Look(VERMILION, (2.0, 1.2), hollow=True, width=0.9, level=6.0),
}
NARROWEST = 1.1
"""Width of a panel (in)."""
MARGIN = 0.8
"""Room around what is drawn (in of the table)."""
ASPECTS = 0.5, 2.5
"""The height of a panel over its width lies between these."""
HEAD = 0.8
"""Length of the heads of arrows (in of the table)."""


def transfer_figure(tables: Sequence[LentTable], width: float | None = None) -> Figure:
    """Return a panel for each lender, and one for the new tool, which comes last.

    An arrow starts where the attractor was as seen from the wrist, and shows how it moved.

    Args:
        tables: what was lent, and what it became.
        width: in; that of two columns if not given.
    """
    width = width or TWO_COLUMNS
    with canvas(width) as figure:
        columns = columns_for(len(tables), max(1, int(width / NARROWEST)))
        panels = map_panels(
            figure, len(tables), columns, ("x from the wrist (in)", "y from the wrist (in)")
        )
        room = (width - 0.6) / columns - 0.05
        for axes, table in zip(panels, tables, strict=True):
            _draw_mask(axes, table.mask)
            draw_grasp(axes)
            for kind in Kind:
                arrows = [_arrow(row) for row, its in table.rows if its is kind]
                draw_arrows(axes, arrows, LOOKS[kind], HEAD)
            axes.set_title(wrapped(table.heading, 7.0, room), fontsize=7.0)
        there = {kind for table in tables for _, kind in table.rows}
        draw_key(figure, [(LOOKS[kind], kind.value) for kind in Kind if kind in there])
        fit_maps(figure, panels, room=MARGIN, aspects=ASPECTS)
    return figure


def _draw_mask(axes: Axes, mask: Mask) -> None:
    """Draw what a camera saw of a tool."""
    left, near = mask.column * SCALE, mask.row * SCALE
    right, far = left + mask.columns * SCALE, near + mask.rows * SCALE
    covered = np.ma.masked_equal(mask.grid.T.astype(float), 0.0)
    axes.imshow(
        covered,
        extent=(left, right, near, far),
        origin="lower",
        cmap=ListedColormap([WOOD]),
        interpolation="nearest",
        zorder=2,
    )
    axes.update_datalim([(left, near), (right, far)])


def _arrow(row: Affordance) -> Arrow:
    """Return a row's movement as an arrow in the wrist's frame."""
    start, moved = row.drawn_at, row.expected_movement
    return start, Point(start.x + moved.dx, start.y + moved.dy)
