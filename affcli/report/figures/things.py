"""Tools, pucks and arrows as figures draw them: to scale, in inches of the axes' own frame."""

from collections.abc import Iterable

from matplotlib.axes import Axes
from matplotlib.patches import Circle, FancyArrowPatch, Polygon, Rectangle

from affcli.core.geometry import Point
from affcli.core.task import GoalRegion
from affcli.core.tool import ToolPart
from affcli.report.figures.canvas import FAINT, INK, ORANGE, PALE, WOOD


def draw_parts(
    axes: Axes,
    parts: Iterable[ToolPart],
    at: Point = Point(0.0, 0.0),
    *,
    fill: str = WOOD,
    edge: str = FAINT,
    missing: bool = False,
    alpha: float = 1.0,
) -> None:
    """Draw parts of a tool with its grasp point at `at`.

    Args:
        axes: where.
        parts: in the tool frame (in).
        at: the grasp point in the axes' frame (in).
        fill, edge: colours.
        missing: as what is gone: dashed outlines with nothing in them.
        alpha: 0 to 1.
    """
    for part in parts:
        outline = [(x + at.x, y + at.y) for x, y in part.outline.vertices]
        axes.add_patch(
            Polygon(
                outline,
                closed=True,
                facecolor="none" if missing else fill,
                edgecolor=edge,
                linestyle=(0, (3, 2)) if missing else "-",
                linewidth=0.7,
                alpha=alpha,
                zorder=2,
            )
        )


def draw_grasp(axes: Axes, at: Point = Point(0.0, 0.0)) -> None:
    """Mark the grasp point, which is the wrist."""
    axes.plot([at.x], [at.y], marker="+", markersize=5, markeredgewidth=0.9, color=INK, zorder=6)


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
    """Draw a goal region, with a label in its corner."""
    half = goal.half_width
    x, y = goal.center
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
    if label:
        axes.text(x - half + 0.25, y + half - 0.25, label, ha="left", va="top", zorder=6)


def draw_arrow(
    axes: Axes,
    start: Point,
    end: Point,
    *,
    color: str = INK,
    width: float = 0.8,
    dashed: bool = False,
) -> None:
    """Draw a movement from `start` to `end`, in the axes' frame."""
    axes.add_patch(
        FancyArrowPatch(
            start,
            end,
            arrowstyle="-|>,head_length=2.2,head_width=1.1",
            shrinkA=0,
            shrinkB=0,
            linewidth=width,
            linestyle=(0, (2.5, 1.5)) if dashed else "-",
            color=color,
            zorder=5,
        )
    )
