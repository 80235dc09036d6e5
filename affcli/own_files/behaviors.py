"""A behavior of a person's own: segments of the wrist's motion, one after the other.

    [behavior]
    name = "shove"
    [[segment]]
    slide = [0, 4]
    [[segment]]
    turn = 30

A segment is one of ``slide = [dx, dy]`` (in, table frame), ``turn = degrees`` (counter-clockwise),
``carry = [x, y]`` or ``carry = [x, y, degrees]`` (lifted, to a place of the table), and ``wait =
seconds``.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from affcli.config import toml_file
from affcli.core.behavior import (
    GRASP,
    POSITION_WRIST,
    BehaviorCall,
    BehaviorName,
    composed_motion,
)
from affcli.core.behavior import ExploratoryBehavior as Behavior
from affcli.core.geometry import Pose
from affcli.core.motion import Carry, Segment, Slide, Turn, Wait
from affcli.errors import BadInputError, one_line
from affcli.own_files.words import (
    at,
    checked_name,
    head,
    listed,
    number,
    point,
    require_tables,
)

KINDS = ("slide", "turn", "carry", "wait")
MOST_SEGMENTS = 20
LONGEST_WAIT = 600.0
"""Seconds: an hour has room for six of them."""
LARGEST_TURN = 360.0


def behavior_from_file(path: Path) -> Behavior:
    """Return the behavior that a file describes.

    Raises:
        BadInputError: it cannot be read, or something in it is not as it must be; the message names
            the file and the place in it.
    """
    source = f"behavior {one_line(path)}"
    return behavior_of_tables(toml_file(path, source), source)


def behavior_of_tables(tables: Mapping[str, Any], source: str) -> Behavior:
    """Return the behavior that tables describe, as a file has them; see `behavior_from_file`."""
    with at(source):
        require_tables(tables, ("behavior", "segment"))
        told = head(tables, "behavior", ("name",))
        name = checked_name(told.get("name"), "behavior: name")
        if name in (GRASP, POSITION_WRIST):
            raise BadInputError(f"behavior: name: {name} is another one; give it another name")
        segments = tuple(_segment(one, place) for place, one in listed(tables, "segment", KINDS))
        if not 1 <= len(segments) <= MOST_SEGMENTS:
            raise BadInputError(
                f"{len(segments)} segments: write 1 to {MOST_SEGMENTS}, each under [[segment]]"
            )
        if all(isinstance(one, Wait) for one in segments):
            raise BadInputError("it only waits: let a segment slide, turn or carry the tool")
        return Behavior(BehaviorCall.of(BehaviorName(name), {}), segments)


def require_sound(behavior: Behavior) -> None:
    """Make sure that a behavior which somebody else made is as one of a file could be.

    Raises:
        BadInputError: a name or a segment that cannot be.
    """
    # One that is composed is named by its segments.
    named = "composed" if composed_motion(behavior.call) else behavior.call.name
    told = {"behavior": {"name": named}, "segment": [*map(_told, behavior.motion)]}
    behavior_of_tables(told, "it")


def _told(segment: Segment) -> dict[str, Any]:
    """Return a segment as a file has it."""
    match segment:
        case Slide(dx, dy):
            return {"slide": [dx, dy]}
        case Turn(degrees):
            return {"turn": degrees}
        case Carry(to):
            return {"carry": [to.x, to.y, math.degrees(to.angle)]}
        case Wait(seconds):
            return {"wait": seconds}


def _segment(told: Mapping[str, Any], place: str) -> Segment:
    """Return a segment, which is of one kind."""
    if len(told) != 1:
        raise BadInputError(f"{place}: give it one of {', '.join(KINDS)}")
    ((kind, value),) = told.items()
    where = f"{place}: {kind}"
    match kind:
        case "slide":
            return Slide(*point(value, where))
        case "turn":
            return Turn(number(value, where, -LARGEST_TURN, LARGEST_TURN, "degrees"))
        case "wait":
            return Wait(number(value, where, 0.0, LONGEST_WAIT, "s"))
    *to, angle = value if isinstance(value, list) and len(value) == 3 else [*_listed(value), 0.0]
    turned = math.radians(number(angle, f"{where}, the angle", -180.0, 180.0, "degrees"))
    return Carry(Pose(*point(to, where), turned))


def _listed(value: object) -> list[Any]:
    """Return what may be a place."""
    return value if isinstance(value, list) else []
