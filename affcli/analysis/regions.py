"""Which part of the tool the attractor was nearest to when a row was made (§6.1)."""

from functools import lru_cache

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.core.tool import Tool, ToolPart, known_hold, placed_parts

UNKNOWN = "-"
"""The region of a row whose tool is known by its name alone."""


def region_of(tool: Tool, row: Affordance) -> str:
    """Return the name of the part nearest to the attractor at O^s; of equal ones the first.

    Args:
        tool: as it was learned, in the tool frame.
        row: made with it; its binding and its wrist's angle say how it lay.
    """
    return region_at(tool, row.binding, row.wrist_angle, row.start.wrist_to_object)


def region_at(tool: Tool, binding: BehaviorCall, angle: float, at: Point) -> str:
    """Return the name of the part nearest to a place; `UNKNOWN` when the shape is not known.

    Args:
        tool, binding, angle: as in `parts_at`.
        at: as seen from the wrist (in).
    """
    placed = parts_at(tool, binding, angle)
    nearest = min(placed, key=lambda part: part.outline.distance(at), default=None)
    return UNKNOWN if nearest is None else nearest.name


@lru_cache(maxsize=256)
def parts_at(tool: Tool, binding: BehaviorCall, angle: float) -> tuple[ToolPart, ...]:
    """Return a tool's parts as seen from the wrist, in the table's axes (in).

    Args:
        tool: in the tool frame.
        binding: how it is held.
        angle: of the wrist (rad).

    Returns:
        As many parts as the tool has: none when its shape, or how it was held, is not known.
    """
    hold = known_hold(binding)
    if not tool.parts or hold is None:
        return ()
    return placed_parts(tool.held(hold).parts, Pose(0.0, 0.0, angle))
