"""What a person's file is, before anything is done with it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from affcli import registry
from affcli.config import Settings, load_settings, toml_file
from affcli.core.behavior import ExecutionStatus, ExploratoryBehavior
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point
from affcli.core.identity import shown
from affcli.core.motion import motion_json
from affcli.core.task import Task
from affcli.core.tool import Tool, hold_of
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError, one_line
from affcli.lab.definition import experiment_file
from affcli.lab.run_parts import RunParts, beyond_the_box, world_of
from affcli.logs.mapping import map_of_tables
from affcli.perception.palette import table_palette
from affcli.report.words import many

TRIED_WITH = "t-hook"
"""In the hand while a behavior is tried."""
UNTOLD = "not said: [broken] loses = [...]"
"""What a tool's file says of what breaks off when it says nothing."""


@dataclass(frozen=True, slots=True)
class Checked:
    """A file that was read whole and is as it must be.

    Args:
        kind: ``tool``, ``behavior``, ``tasks``, ``experiment``, ``map of a log`` or ``settings``.
        name: of what it describes.
        facts: what it says, in words, by what that is.
        drawn: what it describes, where that can be drawn: a tool as it is held, a behavior, tasks.
    """

    kind: str
    name: str
    facts: Mapping[str, str] = field(default_factory=dict)
    drawn: Tool | ExploratoryBehavior | tuple[Task, ...] | None = None


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
    if {"tool", "part", "broken"} & tables.keys():
        return _tool(path, settings)
    if {"behavior", "segment"} & tables.keys():
        return _behavior(path, settings)
    if {"task", "goal", "start"} & tables.keys():
        return _tasks(path, settings.workspace)
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
        "broken": f"loses {', '.join(tool.loses)}" if tool.loses else UNTOLD,
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


def _behavior(path: Path, settings: Settings) -> Checked:
    """Return what a file says of a behavior, and what comes of it from the table's centre."""
    parts = RunParts.chosen(settings, repertoire=[str(path.absolute())])
    (behavior,) = parts.repertoire
    spec = parts.spec(TRIED_WITH, 0, 0, 1.0)
    setting = world_of(spec).learning(spec)
    setting.robot.execute(setting.binding, None)
    tried = setting.robot.execute(behavior.call, setting.sensor.observe())
    came = f"takes {tried.duration:.1f} s of the robot's time"
    if tried.status is ExecutionStatus.TRUNCATED:
        came = f"meets the edge of the arm's reach after {tried.duration:.1f} s and ends there"
    (x, y, _), (end_x, end_y, _) = tried.wrist_start, tried.wrist_end
    facts = {
        "segments": "; ".join(_segment_words(*one) for one in motion_json(behavior.motion)),
        "begun at the table's centre": came,
        "the wrist ends": f"{end_x - x:.1f} in to the right, {end_y - y:.1f} in away",
    }
    return Checked("behavior", behavior.call.name, facts, behavior)


def _segment_words(kind: str, *numbers: float) -> str:
    """Return a segment as a file has it."""
    return f"{kind} {', '.join(f'{one:g}' for one in numbers)}"


def _tasks(path: Path, workspace: Workspace) -> Checked:
    """Return what a file says of tasks, and whether the paper's tools reach their places."""
    tasks = registry.own_tasks(path)
    goals = {f"goal {task.goal.name}": task.goal.center for task in tasks}
    starts = {f"start {task.start_name}": task.start for task in tasks}
    counts = f"{many(len(goals), 'goal')}, each from {many(len(starts), 'start')}"
    facts = {
        "tasks": f"{len(tasks)}: {counts}",
        "goals": _places_words(goals),
        "starts": _places_words(starts),
        "reach": beyond_reach(tasks, workspace)
        or "each place is within reach of one of the paper's tools",
    }
    return Checked("tasks", tasks[0].task_set, facts, tasks)


def _places_words(places: Mapping[str, Point]) -> str:
    """Return places with their names."""
    named = {name.partition(" ")[2]: at for name, at in places.items()}
    return "; ".join(f"{name} at ({at.x:g}, {at.y:g})" for name, at in named.items())


def beyond_reach(tasks: Sequence[Task], workspace: Workspace) -> str:
    """Return in words which goals (their middles) and starts lie off the table, or out of reach of
    all the paper's tools; empty when none does.
    """
    from affcli.simulation.arm import reach_at
    from affcli.simulation.reach_of_tool import touchable
    from affcli.simulation.tools.paper import paper_tools

    top, arm = workspace.table, workspace.arm
    reach, depth = reach_at(arm, arm.flange_height), workspace.puck.radius - MOVEMENT_THRESHOLD
    tools = paper_tools(workspace.tools).values()
    places = {f"goal {task.goal.name}": task.goal.center for task in tasks}
    places |= {f"start {task.start_name}": task.start for task in tasks}
    off, far = [], []
    for name, at in places.items():
        if abs(at.x) > top.half_width or not top.near <= at.y <= top.far:
            off.append(name)
        elif not any(touchable(tool.outlines, reach, at, depth) for tool in tools):
            far.append(name)
    said = ((off, "off the table"), (far, "out of reach of the paper's tools"))
    return "; ".join(f"{what}: {', '.join(names)}" for names, what in said if names)
