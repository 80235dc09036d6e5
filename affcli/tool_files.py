"""A tool that a person drew: a TOML file, checked before anything is made of it.

    [tool]
    name = "rake"
    color = [110, 200, 60]
    [[part]]
    name = "handle"
    outline = [[-0.4, 0], [0.4, 0], [0.4, 13], [-0.4, 13]]

Each part is a polygon in inches, x to the right and y along the handle, away from the robot; or
``outline`` stands under ``[tool]`` and is the whole tool. The wrist is at x = 0, as far above the
lower end of the tool as the grasp says. The tool is stored by value: a file that is changed later
changes no run.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from affcli.config import toml_file
from affcli.core.geometry import Point
from affcli.core.names import one_of
from affcli.core.tool import MOST_CORNERS, Color, Tool, ToolName, ToolPart
from affcli.errors import BadInputError, UsageError, one_line
from affcli.simulation.outlines import convex_parts

LONGEST_NAME = 40
"""Letters of a name, of a tool or of a part."""
NOT_IN_NAMES = "/\\:,=@"
"""What means something else in an option, or in a path."""
LARGEST = 40.0
"""No corner lies farther from the origin, to either side (in): the table is 32 by 20."""


def tool_from_file(path: Path) -> Tool:
    """Return the tool that a file describes, in the tool frame.

    Raises:
        BadInputError: it cannot be read, or something in it is not as it must be; the message names
            the file and the place in it.
    """
    source = f"tool {one_line(path)}"
    return tool_of_tables(toml_file(path, source), source)


def tool_of_tables(tables: Mapping[str, Any], source: str) -> Tool:
    """Return the tool that tables describe, as a file has them; see `tool_from_file`."""
    try:
        return _tool(tables)
    except (BadInputError, UsageError) as error:
        raise BadInputError(f"{source}: {error}") from error


def require_sound(tool: Tool) -> None:
    """Make sure that a tool which somebody else made is as one of a file would be.

    Raises:
        BadInputError: a name, a colour or an outline that cannot be.
    """
    checked_name(tool.name, "name")
    _color(list(tool.color))
    if not tool.parts or sum(len(part.outline.vertices) for part in tool.parts) > MOST_CORNERS:
        raise BadInputError(f"no parts, or more than {MOST_CORNERS} corners")
    for part in tool.parts:
        corners = _corners([list(corner) for corner in part.outline.vertices], part.name)
        if len(_cut(checked_name(part.name, "part"), corners, part.name)) > 1:
            raise BadInputError(f"{part.name}: it bends inwards")


def _tool(tables: Mapping[str, Any]) -> Tool:
    """Return the tool that tables describe; the message says at which place something is wrong."""
    for table in tables:
        one_of("table", table, ("tool", "part"))
    head = tables.get("tool")
    if not isinstance(head, dict):
        raise BadInputError("it needs a table [tool] with name and color")
    for key in head:
        one_of("key of tool", key, ("name", "color", "outline"))
    name, color = checked_name(head.get("name"), "tool: name"), _color(head.get("color"))
    return Tool(ToolName(name), color, _parts(head, tables.get("part", [])))


def _parts(head: Mapping[str, Any], listed: Any) -> tuple[ToolPart, ...]:
    """Return the convex parts: of the one outline under [tool], or of each [[part]]."""
    if not isinstance(listed, list) or not all(isinstance(one, dict) for one in listed):
        raise BadInputError("part: write each part under [[part]], with name and outline")
    if ("outline" in head) == bool(listed):
        raise BadInputError("give either an outline under [tool], or parts, each under [[part]]")
    drawn = [("tool", "outline", head["outline"])] if "outline" in head else []
    for number, one in enumerate(listed, 1):
        place = f"part {number}"
        for key in one:
            one_of(f"key of {place}", key, ("name", "outline"))
        drawn.append((place, checked_name(one.get("name"), f"{place}: name"), one.get("outline")))
    names = [name for _, name, _ in drawn]
    if len(set(names)) < len(names):
        raise BadInputError("two parts have one name: a tool breaks by the names of its parts")
    parts: list[ToolPart] = []
    for place, name, outline in drawn:
        parts += _cut(name, _corners(outline, f"{place}: outline"), f"{place}: outline")
    if sum(len(part.outline.vertices) for part in parts) > MOST_CORNERS:
        raise BadInputError(f"more than {MOST_CORNERS} corners: draw it with fewer")
    return tuple(parts)


def _cut(name: str, corners: list[Point], place: str) -> list[ToolPart]:
    """Return a polygon as convex parts: of its name, and numbered where they are several."""
    try:
        found = convex_parts(corners)
    except ValueError as error:
        raise BadInputError(f"{place}: {error}") from error
    if len(found) == 1:
        return [ToolPart(name, found[0])]
    return [ToolPart(f"{name} {number}", part) for number, part in enumerate(found, 1)]


def checked_name(value: object, place: str) -> str:
    """Return a name that can be said in an option and shown on a terminal; else BadInputError."""
    if (
        not isinstance(value, str)
        or not 1 <= len(value) <= LONGEST_NAME
        or not value.isprintable()
        or value != value.strip()
        or value.startswith("-")
        or set(value) & set(NOT_IN_NAMES)
    ):
        said = "" if value is None else f" = {one_line(value, 60)}"
        raise BadInputError(
            f"{place}{said}: must be a word of 1 to {LONGEST_NAME} letters without any of "
            f"{' '.join(NOT_IN_NAMES)}"
        )
    return value


def _color(value: object) -> Color:
    """Return a colour of three numbers."""
    if not isinstance(value, list) or len(value) != 3 or not _are_numbers(value, 0.0, 255.0):
        said = "" if value is None else f" = {one_line(value, 60)}"
        raise BadInputError(f"tool: color{said}: must be [red, green, blue], each 0 to 255")
    red, green, blue = map(float, value)
    return Color((red, green, blue))


def _are_numbers(values: list[Any], least: float, largest: float) -> bool:
    """Tell whether values of TOML are numbers within limits: no nan, nor of a thousand digits."""
    return all(
        isinstance(value, int | float) and not isinstance(value, bool) and least <= value <= largest
        for value in values
    )


def _corners(value: object, place: str) -> list[Point]:
    """Return the corners of a polygon."""
    if not isinstance(value, list):
        raise BadInputError(f"{place}: must be a list of corners, [[x, y], [x, y], ...] in inches")
    corners = []
    for number, corner in enumerate(value, 1):
        if not isinstance(corner, list) or len(corner) != 2:
            raise BadInputError(f"{place}, corner {number}: must be [x, y] in inches")
        if not _are_numbers(corner, -LARGEST, LARGEST):
            raise BadInputError(
                f"{place}, corner {number}: {one_line(corner, 60)}: each must be a number in "
                f"-{LARGEST:g} to {LARGEST:g} in"
            )
        corners.append(Point(*map(float, corner)))
    return corners
