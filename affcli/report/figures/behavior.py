"""What an exploratory behavior does with the wrist, and with the tool in the hand."""

from collections.abc import Sequence
from itertools import pairwise

from matplotlib.figure import Figure

from affcli.core.geometry import Pose
from affcli.core.motion import Carry, Motion, Slide, poses
from affcli.core.tool import Tool
from affcli.core.workspace import TableSurface
from affcli.report.figures.arrows import Arrow, Look, draw_arrows
from affcli.report.figures.canvas import BLUE, FAINT, ONE_COLUMN, VERMILION, canvas
from affcli.report.figures.maps import fit_maps, map_panels
from affcli.report.figures.things import draw_grasp, draw_parts, draw_table

MARGIN = 1.0
"""Room around all that is drawn (in of the table)."""
ASPECTS = 0.5, 1.5
HEAD = 0.9
"""Length of an arrow's head (in of the table)."""
SLID, CARRIED = Look(BLUE, width=1.2), Look(VERMILION, (2.0, 1.2), width=1.2)


def behavior_figure(motion: Motion, tool: Tool, start: Pose, table: TableSurface) -> Figure:
    """Return the table from above: the tool before and after each segment, dashed before the last,
    and the way of the wrist; where it is carried, the arrow is dashed.

    Args:
        motion: of the behavior.
        tool: in the hand.
        start: where the wrist is when it begins (in, rad, table frame).
        table: the table.
    """
    *before, last = poses(motion, start)
    with canvas(ONE_COLUMN) as figure:
        (axes,) = map_panels(figure, 1, 1)
        draw_table(axes, table, edge=FAINT)
        for wrist in dict.fromkeys(before):
            draw_parts(axes, tool.parts, wrist, missing=True)
            draw_grasp(axes, wrist)
        draw_parts(axes, tool.parts, last)
        draw_grasp(axes, last)
        for kind, look in ((Slide, SLID), (Carry, CARRIED)):
            draw_arrows(axes, _ways(motion, [*before, last], kind), look, HEAD)
        fit_maps(figure, [axes], room=MARGIN, aspects=ASPECTS)
    return figure


def _ways(motion: Motion, wrists: Sequence[Pose], kind: type) -> list[Arrow]:
    """Return from where to where the wrist goes in the segments of a kind."""
    ways = zip(motion, pairwise(wrists), strict=True)
    return [
        (a.point, b.point)
        for segment, (a, b) in ways
        if isinstance(segment, kind) and a.point != b.point
    ]
