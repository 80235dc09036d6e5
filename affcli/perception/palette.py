"""The colour classes: what is colour-coded on the table, and how pixels are told apart (§4)."""

import colorsys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from affcli.core.tool import PUCK_COLOR, Color
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError, one_line

WRIST_COLOR = Color((225.0, 50.0, 150.0))
"""The robot's wrist is colour-coded (§4). Choice: pink."""
GOAL_COLOR = Color((0.0, 105.0, 115.0))
"""The goal region is a dark square (§7.1). Choice: a dark teal."""
MARKER_COLOR = Color((200.0, 40.0, 40.0))
"""The 36 markers are uniformly coloured (§4). Choice: red."""

LEAST_SATURATION = 0.35
"""A pixel less saturated than this has no colour: table, wood, shadow, cardboard."""
LEAST_VALUE = 0.2
"""A pixel darker than this has no colour that can be trusted."""
WIDEST_HUE = 25.0
"""A pixel belongs to the class whose hue is nearest, if it is within this many degrees."""
CLOSEST_HUES = 12.0
"""Two classes must lie at least this many degrees apart."""


class Role(StrEnum):
    """What a colour is the colour of."""

    OBJECT = "object"
    WRIST = "wrist"
    GOAL = "goal"
    TOOL = "tool"


@dataclass(frozen=True, slots=True)
class ColorClass:
    """One colour and what has it.

    Args:
        name: of what has it: puck, wrist, goal, t-hook.
        color: red, green, blue, 0 to 255.
        role: what that is.
        height: of the middle of what is seen of it over the table (in).
    """

    name: str
    color: Color
    role: Role
    height: float = 0.0

    @property
    def hue(self) -> float:
        """Where the colour lies on the colour circle, in degrees: 0 red, 120 green, 240 blue."""
        return 360.0 * colorsys.rgb_to_hsv(*(c / 255.0 for c in self.color))[0]


def palette(classes: Iterable[ColorClass], source: str = "colors") -> tuple[ColorClass, ...]:
    """Return the classes after making sure that pixels can be told apart by hue.

    Hue does not change with the brightness of the light; that is why the classes are told by it.

    Args:
        classes: what has which colour.
        source: where they come from, for the message.

    Raises:
        BadInputError: a colour that is grey or dark, or two whose hues lie too close.
    """
    checked: list[ColorClass] = []
    for one in classes:
        _, saturation, value = colorsys.rgb_to_hsv(*(c / 255.0 for c in one.color))
        shown = f"{one_line(one.name)} ({', '.join(f'{c:g}' for c in one.color)})"
        if saturation < LEAST_SATURATION + 0.1 or value < LEAST_VALUE + 0.1:
            raise BadInputError(
                f"{source}: {shown} is too grey or too dark to be told from the table; paint it in "
                "a strong colour"
            )
        for other in checked:
            if hue_distance(one.hue, other.hue) < CLOSEST_HUES:
                raise BadInputError(
                    f"{source}: {shown} and {one_line(other.name)} differ by less than "
                    f"{CLOSEST_HUES:g} degrees of hue; paint one of them in another colour"
                )
        checked.append(one)
    return tuple(checked)


def hue_distance(a: float, b: float) -> float:
    """Return the distance of two hues on the colour circle, 0 to 180 degrees."""
    return abs((a - b + 180.0) % 360.0 - 180.0)


def class_of_hue(classes: Sequence[ColorClass], hue: float) -> int | None:
    """Return the position of the class whose hue is nearest, None when none is near enough."""
    distances = [hue_distance(hue, one.hue) for one in classes]
    nearest = min(range(len(classes)), key=distances.__getitem__, default=None)
    return None if nearest is None or distances[nearest] > WIDEST_HUE else nearest


def table_palette(workspace: Workspace, tools: Mapping[str, Color]) -> tuple[ColorClass, ...]:
    """Return the colours of the simulated table: puck, wrist, goal, and the tools.

    Args:
        workspace: how high things are.
        tools: the colour of each tool that may be on it, by name.

    Raises:
        BadInputError: a tool's colour cannot be told from another.
    """
    tops = workspace.tools.thickness
    return palette(
        (
            ColorClass("puck", PUCK_COLOR, Role.OBJECT, 0.5 * workspace.puck.height),
            ColorClass("wrist", WRIST_COLOR, Role.WRIST, workspace.arm.flange_height),
            ColorClass("goal", GOAL_COLOR, Role.GOAL),
            *(ColorClass(name, color, Role.TOOL, tops) for name, color in tools.items()),
        )
    )
