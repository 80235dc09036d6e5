"""The tools to scale, with the names of their parts, and one that broke (Figs. 1 and 9)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from affcli.core.geometry import Point
from affcli.core.tool import PUCK_COLOR, Color, Tool, ToolPart
from affcli.report.figures.canvas import INK, TWO_COLUMNS, canvas
from affcli.report.figures.scale import draw_length, round_length
from affcli.report.figures.things import draw_parts, draw_puck
from affcli.report.figures.words import literal, shown, tool_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

NARROWEST = 0.07
"""A thing takes at least this share of the figure's width, for the words beside it."""
GAP = 0.04
"""Between two things, as a share of the figure's width."""
WORDS = 0.17
"""Height of a line of words (in of the page)."""
HIGHEST = 6.0
"""The figure is at most so high (in of the page)."""


@dataclass(frozen=True, slots=True)
class Thing:
    """One thing of the row, with what it takes of the width.

    Args:
        name: what stands below it.
        tool: what it is; None for the attractor.
        lost: parts that broke off.
        left, right: how far it goes to both sides of its middle line (in of the table).
    """

    name: str
    tool: Tool | None
    lost: tuple[ToolPart, ...]
    left: float
    right: float


def tools_figure(tools: Sequence[Tool], broken: tuple[Tool, Tool], puck_radius: float) -> "Figure":
    """Return the attractor and all tools side by side, and one that broke.

    All to scale. Each part is named on the first tool that has it.

    Args:
        tools: in the order in which they stand.
        broken: a tool as it was, and the shape that is left of it, which keeps its colour (§7.2).
        puck_radius: of the attractor (in).
    """
    whole, left = broken
    lost = whole.parts_missing_in(left)
    things = [Thing("attractor", None, (), puck_radius, puck_radius)]
    things += [_thing(tool_words(tool.name), tool) for tool in tools]
    things.append(
        _thing(
            f"{tool_words(whole.name)} that broke:\nthe shape of the {tool_words(left.name)}",
            left.painted(whole.color),
            lost,
        )
    )
    scale = _scale(things)
    ys = [y for thing in things for part in _parts(thing) for _, y in part.outline.vertices]
    low, high = min(ys), max(ys)
    height = min((high - low) / scale + 3.9 * WORDS, HIGHEST)
    with canvas(TWO_COLUMNS, height) as figure:
        figure.set_layout_engine("none")
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_axis_off()
        axes.set_aspect("equal", adjustable="box")
        axes.set_xlim(0.0, TWO_COLUMNS * scale)
        bottom = low - 2.5 * WORDS * scale
        axes.set_ylim(bottom, bottom + height * scale)
        _draw_things(axes, things, scale, low, puck_radius)
    return figure


def _draw_things(
    axes: "Axes", things: Sequence[Thing], scale: float, low: float, puck_radius: float
) -> None:
    """Draw the things one beside the other, their grasp points on one line."""
    named: set[str] = set()
    at = 0.5 * GAP * TWO_COLUMNS * scale
    for thing in things:
        middle = at + thing.left
        at += _width(thing, scale) + GAP * TWO_COLUMNS * scale
        name_at = middle + 0.5 * (thing.right - thing.left)
        below = low - 0.6 * WORDS * scale
        axes.text(name_at, below, thing.name, ha="center", va="top", **literal())
        if thing.tool is None:
            at_rest = Point(middle, low + puck_radius)
            draw_puck(axes, at_rest, puck_radius, color=_paint(PUCK_COLOR))
            above = Point(middle, low + 2 * puck_radius + WORDS * scale)
            draw_length(axes, above, round_length(NARROWEST * TWO_COLUMNS * scale), 1.0)
            continue
        place = Point(middle, 0.0)
        draw_parts(axes, thing.tool.parts, place, fill=_paint(thing.tool.color), edge=INK)
        draw_parts(axes, thing.lost, place, edge=INK, missing=True)
        _draw_grasp_point(axes, place, "" if named else "grasp point", scale)
        for part in thing.tool.parts:
            if part.name not in named:
                _name_part(axes, part, middle, scale, part.name)
                named.add(part.name)
        if thing.lost:
            _name_part(axes, thing.lost[-1], middle, scale, "lost")


def _draw_grasp_point(axes: "Axes", at: Point, name: str, scale: float) -> None:
    """Mark where the tool is grasped, on a tool of any colour."""
    axes.plot(
        *([at.x], [at.y]),
        marker="o",
        markersize=3.0,
        markerfacecolor="white",
        markeredgecolor=INK,
        markeredgewidth=0.6,
        zorder=6,
    )
    x = at.x + 0.5 * WORDS * scale
    axes.text(x, at.y, name, ha="left", va="center", fontsize=6.5)


def _name_part(axes: "Axes", part: ToolPart, middle: float, scale: float, name: str) -> None:
    """Write the name of a part where there is room: above bars, below hooks, beside handles."""
    left, bottom, right, top = part.outline.bounds
    x, y = middle + 0.5 * (left + right), 0.5 * (bottom + top)
    ha, va = "center", "center"
    if left <= 0.0 <= right:
        x, ha = middle + right + 0.3 * WORDS * scale, "left"
    elif right - left > top - bottom:
        y, va = top + 0.25 * WORDS * scale, "bottom"
    else:
        y, va = bottom - 0.25 * WORDS * scale, "top"
    axes.text(x, y, shown(name), ha=ha, va=va, fontsize=6.5, **literal())


def _thing(name: str, tool: Tool, lost: tuple[ToolPart, ...] = ()) -> Thing:
    """Return a tool as a thing of the row."""
    xs = [x for part in (*tool.parts, *lost) for x, _ in part.outline.vertices]
    return Thing(name, tool, lost, -min(xs), max(xs))


def _parts(thing: Thing) -> tuple[ToolPart, ...]:
    """Return all parts of a thing."""
    return (*(thing.tool.parts if thing.tool else ()), *thing.lost)


def _scale(things: Sequence[Thing]) -> float:
    """Return the inches of the table to one of the page at which all things fit beside another."""
    room = TWO_COLUMNS * (1.0 - GAP * len(things))
    least = NARROWEST * TWO_COLUMNS
    # The narrow ones take their least, so that the others must share what is left.
    wide = [thing.left + thing.right for thing in things]
    scale = sum(wide) / room
    for _ in wide:
        narrow = [w for w in wide if w / scale < least]
        scale = sum(w for w in wide if w / scale >= least) / (room - least * len(narrow))
    return scale


def _width(thing: Thing, scale: float) -> float:
    """Return how much of the width a thing takes (in of the table)."""
    return max(thing.left + thing.right, NARROWEST * TWO_COLUMNS * scale)


def _paint(color: Color) -> str:
    """Return a colour of 0 to 255 as matplotlib takes it."""
    return "#" + "".join(f"{round(value):02x}" for value in color)
