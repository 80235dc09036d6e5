"""Where everything stands as a trial begins (Fig. 8)."""

import math
from typing import TYPE_CHECKING

from matplotlib.patches import Arc, Circle, Rectangle

from affcli.core.task import goal_regions, start_positions
from affcli.core.tool import Tool
from affcli.core.workspace import Workspace
from affcli.report.figures.canvas import FAINT, INK, ONE_COLUMN, ORANGE, as_map, canvas
from affcli.report.figures.things import draw_goal, draw_grasp, draw_parts
from affcli.simulation.arm import Reach

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARGIN = 1.0
"""Room around all that is drawn (in of the table)."""
BASE_RADIUS = 1.6
"""Of the circle that stands for the arm's base (in). Choice: a sign, not its size."""
HIGHEST, LOWEST = 5.0, 2.0
"""The figure's height lies between these (in of the page)."""


def workspace_figure(workspace: Workspace, tool: Tool, reach: Reach) -> "Figure":
    """Return the table from above: goals, starts, the tool at its start, the bare arm's reach.

    The arm of the default settings reaches to 0.04 in from its middle: only the outer bound shows.

    Args:
        workspace: the sizes.
        tool: which lies at the centre of the table.
        reach: of the wrist, without a tool.
    """
    left, bottom, right, top = _bounds(workspace, tool, reach)
    across = ONE_COLUMN - 0.45
    height = min(max(across * (top - bottom) / (right - left) + 0.4, LOWEST), HIGHEST)
    with canvas(ONE_COLUMN, height) as figure:
        figure.set_layout_engine("constrained", w_pad=0.02, h_pad=0.02)
        axes = figure.subplots()
        _draw_table(axes, workspace)
        for number, goal in goal_regions(workspace.layout).items():
            draw_goal(axes, goal)
            corner = (goal.center.x - goal.half_width, goal.center.y + goal.half_width)
            axes.annotate(
                f"G{number}",
                corner,
                xytext=(1.2, -1.5),
                textcoords="offset points",
                ha="left",
                va="top",
                fontsize=6.2,
                zorder=6,
            )
        draw_parts(axes, tool.parts, workspace.wrist_start)
        draw_grasp(axes, workspace.wrist_start)
        _draw_starts(axes, workspace)
        _draw_arm(axes, reach)
        as_map(axes)
        axes.set_xlim(left, right)
        axes.set_ylim(bottom, top)
    return figure


def _bounds(workspace: Workspace, tool: Tool, reach: Reach) -> tuple[float, float, float, float]:
    """Return left, bottom, right and top of what holds everything (in, table frame)."""
    table, start = workspace.table, workspace.wrist_start
    goals = goal_regions(workspace.layout).values()
    points: list[tuple[float, float]] = [
        (table.half_width, table.far),
        (-table.half_width, table.near),
        (reach.outer, reach.outer),
        (-reach.outer, -BASE_RADIUS),
        *((x + start.x, y + start.y) for outline in tool.outlines for x, y in outline.vertices),
        *(
            (goal.center.x + side * goal.half_width, goal.center.y + side * goal.half_width)
            for goal in goals
            for side in (-1, 1)
        ),
    ]
    xs, ys = zip(*points, strict=True)
    return min(xs) - MARGIN, min(ys) - MARGIN, max(xs) + MARGIN, max(ys) + MARGIN


def _draw_table(axes: "Axes", workspace: Workspace) -> None:
    """Draw the edge of the table."""
    table = workspace.table
    axes.add_patch(
        Rectangle(
            (-table.half_width, table.near),
            2 * table.half_width,
            table.far - table.near,
            facecolor="none",
            edgecolor=INK,
            linewidth=1.0,
            zorder=1.0,
        )
    )
    axes.text(table.half_width - 0.4, table.far - 0.4, "table", ha="right", va="top", zorder=6)


def _draw_starts(axes: "Axes", workspace: Workspace) -> None:
    """Draw the attractor at each of its starts, with the number of the start."""
    for number, place in start_positions(workspace.layout).items():
        axes.add_patch(
            Circle(
                place,
                workspace.puck.radius,
                facecolor=ORANGE,
                edgecolor=INK,
                linewidth=0.7,
                zorder=3,
            )
        )
        axes.text(*place, str(number), ha="center", va="center", zorder=6)


def _draw_arm(axes: "Axes", reach: Reach) -> None:
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
