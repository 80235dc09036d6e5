"""The five tools of the paper, by their parts (§4, Figs. 1 and 9).

Tool frame: origin at the grasp point, y along the handle away from the robot, x to the right. The
tool keeps its orientation in the table frame: a tool at wrist (x, y) is its parts moved by (x, y).
"""

from dataclasses import dataclass, field, replace
from typing import NewType

from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.workspace import ToolGeometry

ToolName = NewType("ToolName", str)


class Color(tuple[float, float, float]):
    """Red, green and blue, each 0 to 255."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class ToolPart:
    """A named convex part of a tool (handle, left bar, right bar, left hook, right hook)."""

    name: str
    outline: ConvexPolygon


@dataclass(frozen=True, slots=True)
class Tool:
    """A rigid tool of one colour.

    The robot knows it by its colour alone (§7.2); the parts are for the physics and the pictures.

    Attributes:
        outlines: the convex parts in the tool frame (in).
    """

    name: ToolName
    color: Color
    parts: tuple[ToolPart, ...]
    grasp_point: Point = Point(0.0, 0.0)
    outlines: tuple[ConvexPolygon, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "outlines", tuple(part.outline for part in self.parts))

    def painted(self, color: Color) -> "Tool":
        """Return this shape in another colour: how §7.2 simulates a tool that broke."""
        return replace(self, color=color)

    def part_nearest(self, point: Point) -> ToolPart:
        """Return the part nearest to `point` (in, tool frame); of equally near ones the first."""
        return min(self.parts, key=lambda part: part.outline.distance(point))

    def parts_missing_in(self, other: "Tool") -> tuple[ToolPart, ...]:
        """Return the parts this tool has and `other` lacks, by name."""
        kept = {part.name for part in other.parts}
        return tuple(part for part in self.parts if part.name not in kept)


TOOL_PARTS: dict[ToolName, tuple[str, ...]] = {
    ToolName("stick"): ("handle",),
    ToolName("l-stick"): ("handle", "left bar"),
    ToolName("l-hook"): ("handle", "left bar", "left hook"),
    ToolName("t-stick"): ("handle", "left bar", "right bar"),
    ToolName("t-hook"): ("handle", "left bar", "right bar", "left hook", "right hook"),
}
"""Which parts each tool has. Choice: a single bar or hook is on the left, so that a T-hook which
lost its right bar and right hook is the L-hook (Fig. 9: the upper right sections differ)."""

TOOL_COLORS: dict[ToolName, Color] = {
    ToolName("stick"): Color((200.0, 40.0, 40.0)),
    ToolName("l-stick"): Color((40.0, 90.0, 200.0)),
    ToolName("l-hook"): Color((150.0, 60.0, 190.0)),
    ToolName("t-stick"): Color((230.0, 210.0, 40.0)),
    ToolName("t-hook"): Color((40.0, 160.0, 70.0)),
}
"""Each tool has one colour (§4); the paper does not say which. All lie over 100 apart in RGB."""

PUCK_COLOR = Color((240.0, 120.0, 20.0))
"""The attractor is an orange hockey puck (§4)."""


def tool_outlines(geometry: ToolGeometry) -> dict[str, ConvexPolygon]:
    """Return the outline of every part a tool can have, in the tool frame (in)."""
    half = geometry.part_width / 2.0
    far = geometry.handle_length
    bar_near = far - geometry.part_width
    hook_near = far - geometry.hook_length
    reach = geometry.bar_reach
    inner = reach - geometry.part_width
    box = ConvexPolygon.box
    return {
        "handle": box(-half, -geometry.handle_below_grasp, half, far),
        "left bar": box(-reach, bar_near, -half, far),
        "right bar": box(half, bar_near, reach, far),
        "left hook": box(-reach, hook_near, -inner, bar_near),
        "right hook": box(inner, hook_near, reach, bar_near),
    }


def paper_tools(geometry: ToolGeometry) -> dict[ToolName, Tool]:
    """Return the five tools of §4, in the order of the results table of §7.1."""
    outlines = tool_outlines(geometry)
    return {
        name: Tool(name, TOOL_COLORS[name], tuple(ToolPart(p, outlines[p]) for p in parts))
        for name, parts in TOOL_PARTS.items()
    }
