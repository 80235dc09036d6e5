"""Tools by their parts, and how one is held (§4, §5.1, Fig. 1).

Tool frame: origin at the paper's grasp point, y along the handle away from the robot, x to the
right. Hand frame: origin at the wrist, y where the wrist points. A tool that is held is its parts
in the hand frame; on the table it is these turned by the wrist's angle and moved to the wrist.
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, NamedTuple, NewType

from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.identity import key_of
from affcli.core.names import one_of
from affcli.errors import BadInputError, UsageError, one_line

ToolName = NewType("ToolName", str)

MOST_CORNERS = 1000
"""Of a tool that is read; the paper's have some 20. The physics looks at all of them."""


class Color(tuple[float, float, float]):
    """Red, green and blue, each 0 to 255."""

    __slots__ = ()


PUCK_COLOR = Color((240.0, 120.0, 20.0))
"""The attractor is an orange hockey puck (§4)."""


@dataclass(frozen=True, slots=True)
class ToolPart:
    """A named convex part of a tool (handle, left bar, right bar, left hook, right hook)."""

    name: str
    outline: ConvexPolygon


class Hold(NamedTuple):
    """How a tool is held: where and at which angle it was grasped (§5.1).

    Args:
        grasp_point: along the handle from its lower end (in).
        angle: by how much the tool is turned in the hand (rad, counter-clockwise).
    """

    grasp_point: float
    angle: float = 0.0


@dataclass(frozen=True, slots=True)
class Tool:
    """A rigid tool of one colour.

    The robot knows it by its colour alone (§7.2); the parts are for the physics and the pictures.

    Args:
        name: of the tool.
        color: of all its parts.
        parts: in the tool frame, or in the hand frame of one that is held; none when a record
            names a tool whose shape is not known.
        loses: what breaks off when nothing else is said (§7.2), as in `without`; empty if that is
            not known.

    Attributes:
        outlines: the convex parts (in).
    """

    name: ToolName
    color: Color
    parts: tuple[ToolPart, ...]
    loses: tuple[str, ...] = ()
    outlines: tuple[ConvexPolygon, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "outlines", tuple(part.outline for part in self.parts))

    def painted(self, color: Color) -> "Tool":
        """Return this shape in another colour: how §7.2 simulates a tool that broke."""
        return replace(self, color=color)

    def held(self, hold: Hold) -> "Tool":
        """Return the tool with its parts in the hand frame; itself for the paper's own grasp.

        The tool frame's origin lies as far above the handle's lower end as the parts reach below
        it, so that is where the wrist is when the grasp point is the paper's.
        """
        shift = -min(outline.bounds[1] for outline in self.outlines) - hold.grasp_point
        if shift == 0.0 and hold.angle == 0.0:
            return self
        parts = tuple(
            ToolPart(part.name, part.outline.moved(0.0, shift).turned(hold.angle))
            for part in self.parts
        )
        return replace(self, parts=parts)

    def without(self, lost: Sequence[str]) -> "Tool":
        """Return what is left when parts break off.

        Args:
            lost: their names; of a part that was cut into convex ones, ``tine`` for ``tine 1`` and
                so on.

        Raises:
            UsageError: it has no such part, or nothing would be left.
        """
        whole = {part.name: re.sub(r" [0-9]+$", "", part.name) for part in self.parts}
        for name in lost:
            one_of(f"part of the {self.name}", name, dict.fromkeys([*whole, *whole.values()]))
        left = tuple(p for p in self.parts if not {p.name, whole[p.name]} & set(lost))
        if not left:
            raise UsageError(f"nothing would be left of the {self.name}; leave a part on it")
        name = ToolName(f"{self.name} without {', '.join(lost)}")
        return replace(self, name=name, parts=left, loses=())

    def parts_missing_in(self, other: "Tool") -> tuple[ToolPart, ...]:
        """Return the parts this tool has and `other` lacks, by name."""
        kept = {part.name for part in other.parts}
        return tuple(part for part in self.parts if part.name not in kept)

    def canonical(self) -> dict[str, Any]:
        """Return the tool by value as JSON types; without `loses` where that is not known."""
        return {
            "name": self.name,
            "color": list(self.color),
            "parts": [[p.name, [list(v) for v in p.outline.vertices]] for p in self.parts],
            **({"loses": list(self.loses)} if self.loses else {}),
        }

    @property
    def key(self) -> str:
        """The key of the tool's value: equal for the same name, colour and outlines."""
        return key_of(self.canonical())


def known_hold(binding: BehaviorCall) -> Hold | None:
    """Return how a grasp holds the tool; None for a binding of which this affcli does not know."""
    if binding.name != GRASP or "grasp_point" not in dict(binding.params):
        return None
    return Hold(binding["grasp_point"], math.radians(binding.get("angle", 0.0)))


def hold_of(binding: BehaviorCall) -> Hold:
    """Return how a binding holds the tool; BadInputError where this affcli does not know."""
    hold = known_hold(binding)
    if hold is None:
        raise BadInputError(
            f"{one_line(binding, 80)}: this affcli does not know where that binding holds the "
            "tool; install what made the record"
        )
    return hold


def tool_from_canonical(value: Any) -> Tool:
    """Return the tool that `Tool.canonical` wrote.

    Raises:
        ValueError, KeyError, TypeError: it is anything else.
    """
    red, green, blue = map(float, value["color"])
    if sum(len(vertices) for _, vertices in value["parts"]) > MOST_CORNERS:
        raise ValueError(f"a tool of more than {MOST_CORNERS} corners")
    parts = tuple(
        ToolPart(str(name), ConvexPolygon(tuple(Point(float(x), float(y)) for x, y in vertices)))
        for name, vertices in value["parts"]
    )
    loses = tuple(map(str, value.get("loses", ())))
    return Tool(ToolName(str(value["name"])), Color((red, green, blue)), parts, loses)


def unknown_tool(name: str) -> Tool:
    """Return a tool of which only the name is known: it has no parts, and nothing can draw it."""
    return Tool(ToolName(name), Color((128.0, 128.0, 128.0)), ())


@lru_cache(maxsize=256)
def turned_outlines(outlines: tuple[ConvexPolygon, ...], angle: float) -> tuple[ConvexPolygon, ...]:
    """Return the outlines turned about the wrist (rad); themselves for an angle of 0."""
    return tuple(outline.turned(angle) for outline in outlines) if angle else outlines


def placed_parts(parts: tuple[ToolPart, ...], wrist: Pose) -> tuple[ToolPart, ...]:
    """Return parts in the hand frame as they lie on the table at a wrist pose (table frame)."""
    return tuple(ToolPart(part.name, part.outline.placed(wrist)) for part in parts)


def middle_x(parts: tuple[ToolPart, ...]) -> float:
    """Return x of the middle of some parts (in); 0 for none."""
    middles = [0.5 * (p.outline.bounds[0] + p.outline.bounds[2]) for p in parts]
    return sum(middles) / len(middles) if middles else 0.0
