"""The tools to scale, with the names of their parts, and one that broke (Figs. 1 and 9)."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from affcli.analysis.paper import in_papers_order
from affcli.core.geometry import Point
from affcli.core.tool import PUCK_COLOR, Color, Tool, ToolPart
from affcli.report.figures.canvas import INK, SMALL, TWO_COLUMNS, canvas, wrapped
from affcli.report.figures.maps import columns_for, fit_maps, map_panels
from affcli.report.figures.things import draw_length, draw_parts, draw_puck, round_length
from affcli.report.figures.words import shown, tool_words

NARROWEST = 0.85
"""Width of a panel (in)."""
MARGIN = 0.8
"""Around all that is drawn in a panel (in of the table)."""
ASPECTS = 0.5, 2.5
"""The height of a panel over its width lies between these."""


def tools_figure(
    tools: Sequence[Tool],
    broken: tuple[Tool, Tool] | None,
    puck_radius: float,
    width: float | None = None,
) -> Figure:
    """Return the attractor and all tools side by side, and one that broke.

    All to scale. Each part is named on the first tool that has it.

    Args:
        tools: the paper's stand in its order, then the others.
        broken: a tool as it was, and the shape that is left of it, which keeps its colour (§7.2);
            None to draw none.
        puck_radius: of the attractor (in).
        width: in; that of two columns if not given.
    """
    width, tools = width or TWO_COLUMNS, in_papers_order(tools, lambda tool: tool.name)
    with canvas(width) as figure:
        count = len(tools) + (1 if broken is None else 2)
        columns = columns_for(count, int(width / NARROWEST))
        things = map_panels(figure, count, columns, ("", ""))
        attractor, *panels = things
        _draw_attractor(attractor, puck_radius)
        named: set[str] = set()
        for axes, tool in zip(panels, tools, strict=False):  # the last is of the broken one
            axes.set_xlabel(wrapped(tool_words(tool.name), 7.0, width / columns - 0.1))
            draw_parts(axes, tool.parts, fill=_paint(tool.color), edge=INK)
            _mark_grasp_point(axes, "" if named else "grasp point")
            for part in (part for part in tool.parts if part.name not in named):
                _name_part(axes, part, part.name)
                named.add(part.name)
        if broken is not None:
            _draw_broken(panels[-1], *broken, width / columns - 0.1)
        for axes in things:
            axes.spines[:].set_visible(False)
            axes.tick_params(length=0.0, labelleft=False, labelbottom=False)
        fit_maps(figure, things, room=MARGIN, aspects=ASPECTS)
    return figure


def _draw_broken(axes: Axes, whole: Tool, left: Tool, room: float) -> None:
    """Draw what is left of a tool, in its colour, and where the lost parts were."""
    lost = whole.parts_missing_in(left)
    broke = f"{tool_words(whole.name)} that broke: the shape of the {tool_words(left.name)}"
    axes.set_xlabel(wrapped(broke, 7.0, room))
    draw_parts(axes, left.parts, fill=_paint(whole.color), edge=INK)
    draw_parts(axes, lost, edge=INK, missing=True)
    _mark_grasp_point(axes, "")
    _name_part(axes, lost[-1], "lost")


def _draw_attractor(axes: Axes, radius: float) -> None:
    """Draw the attractor, and over it how long some inches are."""
    axes.set_xlabel("attractor")
    draw_puck(axes, Point(0.0, radius), radius, color=_paint(PUCK_COLOR))
    draw_length(axes, Point(0.0, 3.0 * radius), round_length(4.0 * radius))


def _mark_grasp_point(axes: Axes, name: str) -> None:
    """Mark where the tool is grasped, on a tool of any colour."""
    axes.plot([0.0], [0.0], "o", markersize=3.0, color="white", markeredgecolor=INK, zorder=6)
    axes.annotate(
        name, (0.0, 0.0), (5.0, 0.0), textcoords="offset points", va="center", fontsize=SMALL
    )


def _name_part(axes: Axes, part: ToolPart, name: str) -> None:
    """Write the name of a part where there is room: above bars, below hooks, beside handles."""
    left, bottom, right, top = part.outline.bounds
    place, away = (0.5 * (left + right), bottom), (0.0, -2.0)
    ha, va = "center", "top"
    if left <= 0.0 <= right:
        place, away = (right, 0.5 * (bottom + top)), (2.5, 0.0)
        ha, va = "left", "center"
    elif right - left > top - bottom:
        place, away, va = (place[0], top), (0.0, 2.0), "bottom"
    axes.annotate(
        shown(name), place, away, textcoords="offset points", ha=ha, va=va, fontsize=SMALL
    )


def _paint(color: Color) -> str:
    """Return a colour of 0 to 255 as matplotlib takes it."""
    return "#" + "".join(f"{round(value):02x}" for value in color)
