"""Where everything stands as a trial begins (Fig. 8)."""

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle

from affcli.core.geometry import Pose
from affcli.core.task import Task
from affcli.core.tool import Tool
from affcli.core.workspace import Workspace
from affcli.report.figures.canvas import FAINT, INK, ONE_COLUMN, canvas
from affcli.report.figures.maps import fit_maps, map_panels
from affcli.report.figures.things import (
    draw_goal,
    draw_grasp,
    draw_parts,
    draw_puck,
    draw_table,
    goal_label,
)
from affcli.simulation.arm import Reach

MARGIN = 1.0
"""Room around all that is drawn (in of the table)."""
BASE_RADIUS = 1.6
"""Of the circle that stands for the arm's base (in). Choice: a sign, not its size."""
ASPECTS = 0.5, 1.5
"""The height of the map over its width lies between these."""


def workspace_figure(
    workspace: Workspace,
    tool: Tool,
    reach: Reach,
    tasks: Sequence[Task],
    width: float | None = None,
) -> Figure:
    """Return the table from above: goals, starts, the tool at its start, the bare arm's reach.

    The arm of the default settings reaches to 0.04 in from its middle: only the outer bound shows.

    Args:
        workspace: the sizes.
        tool: which lies at the centre of the table.
        reach: of the wrist, without a tool.
        tasks: whose goals and starts are drawn.
        width: in; that of a column if not given.
    """
    table, wrist = workspace.table, Pose(*workspace.wrist_start)
    goals = {task.goal.name: task.goal for task in tasks}
    starts = {task.start_name: task.start for task in tasks}
    with canvas(width or ONE_COLUMN) as figure:
        (axes,) = map_panels(figure, 1, 1)
        draw_table(axes, table)
        corners = [(-table.half_width, table.near), (table.half_width, table.far)]
        axes.update_datalim(corners)
        axes.text(table.half_width - 0.4, table.far - 0.4, "table", ha="right", va="top", zorder=6)
        for name, goal in goals.items():
            draw_goal(axes, goal, goal_label(name))
        draw_parts(axes, tool.parts, wrist)
        draw_grasp(axes, wrist)
        for name, place in starts.items():
            draw_puck(axes, place, workspace.puck.radius)
            axes.text(place.x, place.y, name, ha="center", va="center", zorder=6)
        _draw_arm(axes, reach)
        fit_maps(figure, [axes], room=MARGIN, aspects=ASPECTS)
    return figure


def _draw_arm(axes: Axes, reach: Reach) -> None:
    """Draw the arm's base and, dashed, the bounds of its reach without a tool."""
    half = math.degrees(reach.waist_max)
    # An inner bound of next to nothing would be a speck on the base.
    for radius in (r for r in (reach.inner, reach.outer) if r > BASE_RADIUS):
        axes.add_patch(
            Arc(
                (0.0, 0.0),
                2 * radius,
                2 * radius,
                theta1=90.0 - half,
                theta2=90.0 + half,
                edgecolor=INK,
                linewidth=0.9,
                linestyle=(0, (4, 2)),
                zorder=4,
            )
        )
    axes.add_patch(
        Circle((0.0, 0.0), BASE_RADIUS, facecolor=FAINT, edgecolor=INK, linewidth=0.7, zorder=3)
    )
    axes.text(0.0, BASE_RADIUS + 0.3, "arm base", ha="center", va="bottom", zorder=6)
    axes.text(reach.outer - 0.6, 0.0, "reach of the\nbare arm", ha="right", va="bottom", zorder=6)
