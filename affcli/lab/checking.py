"""What a person's file is, before anything is done with it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from affcli.config import Settings, load_settings, toml_file
from affcli.core.identity import shown
from affcli.core.tool import Tool, hold_of
from affcli.errors import BadInputError, one_line
from affcli.lab.definition import experiment_file
from affcli.lab.run_parts import RunParts, beyond_the_box
from affcli.logs.mapping import map_of_tables
from affcli.perception.palette import table_palette


@dataclass(frozen=True, slots=True)
class Checked:
    """A file that was read whole and is as it must be.

    Args:
        kind: ``tool``, ``experiment``, ``map of a log`` or ``settings``.
        name: of what it describes.
        facts: what it says, in words, by what that is.
        tool: what it describes, if that is a tool, as it is held.
    """

    kind: str
    name: str
    facts: Mapping[str, str] = field(default_factory=dict)
    tool: Tool | None = None


def checked(path: Path, settings: Settings) -> Checked:
    """Return what a TOML file is.

    Args:
        path: the file.
        settings: the sizes that a tool is held against.

    Raises:
        BadInputError: it cannot be read, or something in it is not as it must be; the message names
            the file and the place in it.
    """
    tables = toml_file(path, one_line(path))
    if "tool" in tables or "part" in tables:
        return _tool(path, settings)
    if "log" in tables and "columns" in tables:
        return _map(path, tables)
    if "experiment" in tables:
        made = experiment_file(path)
        named = [condition.name for condition in made.conditions]
        facts = {
            "question": made.question or "none",
            "robots": f"{made.robots}, seed {made.seed}",
            "conditions": ", ".join(named),
        }
        return Checked("experiment", made.name, facts)
    differing = load_settings(path).differing()
    return Checked("settings", path.stem, {key: shown(one) for key, one in differing.items()})


def _map(path: Path, tables: Mapping[str, Any]) -> Checked:
    """Return what a map of a log says."""
    made = map_of_tables(tables, f"map {one_line(path)}")
    columns = {**made.columns, **made.parameters}
    facts = {
        "source": made.source,
        "licence": made.licence or "not known",
        "citation": made.citation or "not known",
        "columns": ", ".join(f"{name} {where}" for name, where in columns.items()),
        "constants": ", ".join(f"{k} {v}" for k, v in made.constants.items()) or "none",
        "one unit of length": f"{made.length:.4g} in",
    }
    return Checked("map of a log", path.stem, facts)


def _tool(path: Path, settings: Settings) -> Checked:
    """Return what a file says of a tool, and whether babbling and a camera can do with it."""
    spec = RunParts.chosen(settings).spec(str(path.absolute()), 0, 0, 1.0)
    tool = spec.held
    boxes = [part.outline.bounds for part in tool.parts]
    left, near, right, far = (
        f(side) for f, side in zip((min, min, max, max), zip(*boxes, strict=True), strict=True)
    )
    facts = {
        "color": ", ".join(f"{shade:g}" for shade in tool.color),
        "size": f"{right - left:g} in wide, {far - near:g} in long",
        "parts": ", ".join(part.name for part in tool.parts),
        "area": f"{sum(part.outline.area for part in tool.parts):.4g} square inches",
        "held": f"{settings.workspace.tools.handle_below_grasp:g} in above its lower end, at x = 0",
        "babbling": beyond_the_box(spec) or "brings the attractor to all sides of it",
        "a camera": _seen(tool, settings),
    }
    return Checked("tool", tool.name, facts, tool.held(hold_of(spec.binding)))


def _seen(tool: Tool, settings: Settings) -> str:
    """Return whether a camera tells the tool from what else has a colour."""
    try:
        table_palette(settings.workspace, {tool.name: tool.color})
    except BadInputError as error:
        return f"would not do: {error}"
    return "tells it from the rest by its color"
