"""A tool that a person drew: a TOML file, checked before anything is made of it.

    [tool]
    name = "rake"
    color = [110, 200, 60]
    [[part]]
    name = "handle"
    outline = [[-0.4, 0], [0.4, 0], [0.4, 13], [-0.4, 13]]

Each part is a polygon in inches, x to the right and y along the handle, away from the robot; or
``outline`` stands under ``[tool]`` and is the whole tool. The wrist is at x = 0, as far above the
lower end of the tool as the grasp says. A table ``[broken]`` with ``loses = ["handle"]`` says which
parts break off when it breaks. The tool is stored by value: a file that is changed later
changes no run.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from affcli.config import toml_file
from affcli.core.geometry import Point
from affcli.core.tool import MOST_CORNERS, Color, Tool, ToolName, ToolPart
from affcli.errors import BadInputError, one_line
from affcli.own_files.words import (
    are_numbers,
    at,
    checked_name,
    head,
    listed,
    point,
    require_tables,
)
from affcli.simulation.outlines import convex_parts


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
    with at(source):
        return _tool(tables)


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
    if tool.loses:
        with at("loses"):
            tool.without(tool.loses)


def _tool(tables: Mapping[str, Any]) -> Tool:
    """Return the tool that tables describe; the message says at which place something is wrong."""
    require_tables(tables, ("tool", "part", "broken"))
    told = head(tables, "tool", ("name", "color", "outline"))
    name, color = checked_name(told.get("name"), "tool: name"), _color(told.get("color"))
    whole = Tool(ToolName(name), color, _parts(told, tables))
    return replace(whole, loses=_loses(whole, tables)) if "broken" in tables else whole


def _loses(whole: Tool, tables: Mapping[str, Any]) -> tuple[str, ...]:
    """Return which parts break off, by name."""
    lost = head(tables, "broken", ("loses",)).get("loses")
    if not isinstance(lost, list) or not lost or not all(isinstance(one, str) for one in lost):
        raise BadInputError('broken: loses: must be names of parts in a list, ["left tine"]')
    with at("broken: loses"):
        whole.without(lost)
    return tuple(dict.fromkeys(lost))


def _parts(told: Mapping[str, Any], tables: Mapping[str, Any]) -> tuple[ToolPart, ...]:
    """Return the convex parts: of the one outline under [tool], or of each [[part]]."""
    drawn = [
        (place, checked_name(one.get("name"), f"{place}: name"), one.get("outline"))
        for place, one in listed(tables, "part", ("name", "outline"))
    ]
    if ("outline" in told) == bool(drawn):
        raise BadInputError("give either an outline under [tool], or parts, each under [[part]]")
    if "outline" in told:
        drawn = [("tool", "outline", told["outline"])]
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


def _color(value: object) -> Color:
    """Return a colour of three numbers."""
    if not isinstance(value, list) or len(value) != 3 or not are_numbers(value, 0.0, 255.0):
        said = "" if value is None else f" = {one_line(value, 60)}"
        raise BadInputError(f"tool: color{said}: must be [red, green, blue], each 0 to 255")
    red, green, blue = map(float, value)
    return Color((red, green, blue))


def _corners(value: object, place: str) -> list[Point]:
    """Return the corners of a polygon."""
    if not isinstance(value, list):
        raise BadInputError(f"{place}: must be a list of corners, [[x, y], [x, y], ...] in inches")
    return [point(corner, f"{place}, corner {n}") for n, corner in enumerate(value, 1)]
