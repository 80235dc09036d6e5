"""Tools, attractor, goals and table as figures draw them: to scale, in inches."""

import math
from collections.abc import Iterable

from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon, Rectangle

from affcli.core.geometry import Point, Pose
from affcli.core.task import GoalRegion
from affcli.core.tool import ToolPart
from affcli.core.workspace import TableSurface
from affcli.report.figures.canvas import FAINT, INK, ORANGE, PALE, WOOD


def draw_parts(
    axes: Axes,
    parts: Iterable[ToolPart],
    wrist: Pose = Pose(0.0, 0.0),
    *,
    fill: str = WOOD,
    edge: str = FAINT,
    missing: bool = False,
) -> None:
    """Draw parts of a tool that is held at the wrist.

    Args:
        axes: where.
        parts: in the tool frame (in).
        wrist: in the axes' frame (in, rad).
        fill, edge: colours.
        missing: as what is gone: dashed outlines with nothing in them.
    """
    for part in parts:
        axes.add_patch(
            Polygon(
                part.outline.placed(wrist).vertices,
                closed=True,
                facecolor="none" if missing else fill,
                edgecolor=edge,
                linestyle=(0, (3, 2)) if missing else "-",
                linewidth=0.7,
                zorder=2,
            )
        )


def draw_grasp(axes: Axes, wrist: Pose = Pose(0.0, 0.0)) -> None:
    """Mark the grasp point, which is the wrist."""
    axes.plot(
        [wrist.x], [wrist.y], marker="+", markersize=5, markeredgewidth=0.9, color=INK, zorder=6
    )


def draw_puck(
    axes: Axes, at: Point, radius: float, *, before: bool = False, color: str = ORANGE
) -> None:
    """Draw the attractor; where it was `before` only as an outline."""
    axes.add_patch(
        Circle(
            at,
            radius,
            facecolor="none" if before else color,
            edgecolor=color if before else INK,
            linestyle=(0, (3, 2)) if before else "-",
            linewidth=0.8,
            zorder=3,
        )
    )


def draw_goal(axes: Axes, goal: GoalRegion, label: str = "") -> None:
    """Draw a goal region, with a label in its upper left corner."""
    half, (x, y) = goal.half_width, goal.center
    axes.add_patch(
        Rectangle(
            (x - half, y - half),
            2 * half,
            2 * half,
            facecolor=PALE,
            edgecolor=INK,
            linewidth=0.7,
            zorder=1,
        )
    )
    axes.annotate(
        label,
        (x - half, y + half),
        (1.2, -1.5),
        textcoords="offset points",
        ha="left",
        va="top",
        fontsize=6.2,
        zorder=6,
    )


def draw_table(axes: Axes, table: TableSurface, fill: str = "none", edge: str = INK) -> None:
    """Draw the table, which does not count as a thing that a figure must show all of."""
    corner, width = (-table.half_width, table.near), 2 * table.half_width
    axes.add_artist(
        Rectangle(
            corner,
            width,
            table.far - table.near,
            facecolor=fill,
            edgecolor=edge,
            linewidth=0.8,
            zorder=0,
        )
    )


def draw_length(axes: Axes, middle: Point, length: float) -> None:
    """Draw a bar of a length (in) with its middle at a place, and write the length over it."""
    left, right = middle.x - 0.5 * length, middle.x + 0.5 * length
    axes.plot([left, right], [middle.y, middle.y], color=INK, solid_capstyle="butt")
    axes.annotate(
        f"{length:g} in",
        middle,
        (0.0, 2.0),
        textcoords="offset points",
        ha="center",
        va="bottom",
        fontsize=6.5,
    )


def round_length(most: float) -> float:
    """Return the longest of 1, 2, 5, 10, 20, 50, ... (and 0.5, 0.2, ...) up to `most`."""
    # One power less: the logarithm of 999999.9999999999 is rounded up to 6.
    power = 10.0 ** (math.floor(math.log10(most)) - 1)
    return max(f * power for f in (1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if f * power <= most)


def goal_label(name: str) -> str:
    """Return what a goal is called in a figure: ``G1`` for the paper's goal 1, else its name."""
    return f"G{name}" if name.isdecimal() else name
