"""The five tools of the paper (§4, Figs. 1 and 9)."""

from functools import partial

from affcli.core.geometry import ConvexPolygon
from affcli.core.part import Part
from affcli.core.tool import Color, Tool, ToolName, ToolPart
from affcli.core.workspace import ToolGeometry

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
    return {name: paper_tool(name, geometry) for name in TOOL_PARTS}


def paper_tool(name: ToolName, geometry: ToolGeometry) -> Tool:
    """Return one of the five tools; KeyError for another name."""
    outlines = tool_outlines(geometry)
    parts = tuple(ToolPart(part, outlines[part]) for part in TOOL_PARTS[name])
    return Tool(name, TOOL_COLORS[name], parts)


PARTS = tuple(
    Part(
        kind="tools",
        name=name,
        summary=f"{name}: {', '.join(parts)}",
        source="Stoytchev 2008, §4",
        build=partial(paper_tool, name),
    )
    for name, parts in TOOL_PARTS.items()
)
