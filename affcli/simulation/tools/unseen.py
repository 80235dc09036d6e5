"""Tools that the paper does not have: nothing of affcli was tuned on them (§8).

What a robot knows of the paper's tools it may carry over to these. Their sizes are those of the
paper's tools, and follow the same settings.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

from affcli.core.geometry import ConvexPolygon
from affcli.core.part import Part
from affcli.core.tool import Color, Tool, ToolName, ToolPart
from affcli.core.workspace import ToolGeometry
from affcli.simulation.tools.paper import TOOL_PARTS, tool_outlines

T_HOOK = TOOL_PARTS[ToolName("t-hook")]
LONGER = 3.0
"""By how much the longer handle is longer than the paper's (in)."""
WIDER = 2.0
"""By how much each bar of the wide hook is longer than the paper's (in)."""
FORK = 3.2
"""From the fork's middle line to the outer edge of a tine (in)."""
INNER_TINE = 2.6
"""From the rake's middle line to the outer edge of an inner tine (in)."""
TINE = 3.0
"""A tine's length along the handle, bar and all (in)."""


def mirrored_hook(geometry: ToolGeometry) -> tuple[ToolPart, ...]:
    """Return the parts of an L-hook with its bar and hook on the right."""
    return _of_paper(geometry, ("handle", "right bar", "right hook"))


def longer_handle(geometry: ToolGeometry) -> tuple[ToolPart, ...]:
    """Return the parts of a T-hook with a longer handle."""
    return _of_paper(replace(geometry, handle_length=geometry.handle_length + LONGER), T_HOOK)


def wide_hook(geometry: ToolGeometry) -> tuple[ToolPart, ...]:
    """Return the parts of a T-hook with longer bars."""
    return _of_paper(replace(geometry, bar_reach=geometry.bar_reach + WIDER), T_HOOK)


def garden_rake(geometry: ToolGeometry) -> tuple[ToolPart, ...]:
    """Return the parts of a T-stick with four tines that point at the robot."""
    far, width = geometry.handle_length, geometry.part_width
    tines = []
    for where, outer in (("outer", geometry.bar_reach), ("inner", INNER_TINE)):
        inner = outer - width
        for side, left, right in (("left", -outer, -inner), ("right", inner, outer)):
            outline = ConvexPolygon.box(left, far - TINE, right, far - width)
            tines.append(ToolPart(f"{side} {where} tine", outline))
    return (*_of_paper(geometry, ("handle", "left bar", "right bar")), *tines)


def fork(geometry: ToolGeometry) -> tuple[ToolPart, ...]:
    """Return the parts of a handle whose two tines point away from the robot."""
    far, width, half = geometry.handle_length, geometry.part_width, geometry.part_width / 2.0
    near = far - geometry.hook_length + width
    box = ConvexPolygon.box
    return (
        ToolPart("handle", box(-half, -geometry.handle_below_grasp, half, near)),
        ToolPart("bar", box(-FORK, near - width, FORK, near)),
        ToolPart("left tine", box(-FORK, near, width - FORK, far)),
        ToolPart("right tine", box(FORK - width, near, FORK, far)),
    )


def _of_paper(geometry: ToolGeometry, names: Sequence[str]) -> tuple[ToolPart, ...]:
    """Return parts of the paper's tools in other sizes."""
    outlines = tool_outlines(geometry)
    return tuple(ToolPart(name, outlines[name]) for name in names)


def _tool(
    name: str, color: Color, make: Callable[[ToolGeometry], tuple[ToolPart, ...]]
) -> Callable[[ToolGeometry], Tool]:
    """Return what makes a tool in the sizes of settings."""
    return lambda geometry: Tool(ToolName(name), color, make(geometry))


PARTS = tuple(
    Part("tools", name, f"not the paper's: {what}", "affcli", _tool(name, Color(color), make))
    for name, what, color, make in (
        ("mirrored-hook", "an l-hook, mirrored", (215.0, 60.0, 205.0), mirrored_hook),
        ("garden-rake", "a t-stick with four tines", (90.0, 180.0, 235.0), garden_rake),
        ("fork", "two tines that point away", (90.0, 70.0, 255.0), fork),
        ("longer-handle", "a t-hook, 3 in longer", (20.0, 220.0, 150.0), longer_handle),
        ("wide-hook", "a t-hook, 4 in wider", (70.0, 110.0, 20.0), wide_hook),
    )
)
