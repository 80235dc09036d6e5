"""Replays as the page's script reads them: small numbers, and the reasons for each step."""

from collections.abc import Iterable
from typing import Any

from affcli.core.observation import Movement
from affcli.core.records import LearningRunInfo
from affcli.core.replay import Considered, Replay, ReplayedStep
from affcli.core.specs import TrialSpec
from affcli.core.tool import Tool, ToolPart, hold_of
from affcli.core.workspace import Workspace
from affcli.errors import one_line
from affcli.report.page.drawings import outline
from affcli.report.trials import distances
from affcli.report.words import call_words, movement_words, reason_words

UNIT = 0.02
"""Inches, or radians, from one whole number to the next: less than a pixel on the page."""
AROUND = 2.0
"""Inches shown around the table: a puck that leaves it is still seen."""
ROUNDED = 2
"""Decimals of lengths that are drawn (in)."""


def packed(values: Iterable[float]) -> str:
    """Return numbers as text: whole multiples of `UNIT`, each as its difference from the last.

    Differences have commas between them; a run of n zeros, n more than 1, is written ``~n``.
    """
    words: list[str] = []
    last = zeros = 0
    for value in values:
        now = round(value / UNIT)
        if now == last:
            zeros += 1
            continue
        words += _zeros(zeros)
        words.append(str(now - last))
        last, zeros = now, 0
    return ",".join(words + _zeros(zeros))


def _zeros(count: int) -> list[str]:
    """Return so many zeros as words."""
    return [f"~{count}"] if count > 1 else ["0"] * count


def trial_data(replay: Replay, run: LearningRunInfo, world: int) -> dict[str, Any]:
    """Return a trial as JSON types: which it is, its film, and why each step was taken.

    Args:
        replay: the trial.
        run: the learning run whose table it used.
        world: in which of the page's worlds it took place.
    """
    scenes = [scene for one in replay.steps for scene in one.scenes] or [replay.opening]
    spec, goal, end = replay.spec, replay.opening.goal, replay.end
    tools = list(dict.fromkeys(scene.tool for scene in scenes))
    failure = "" if end is None else end.failure
    left = None if end is None or failure else end.last_reasons
    return {
        "id": replay.trial_id,
        "world": world,
        **which(spec),
        "region": None if goal is None else outline(goal.outline().vertices),
        "outcome": "interrupted" if end is None else end.outcome.value,
        "left": None if left is None else [reason_words(reason) for reason in left],
        "failure": failure or None,
        "equal": not replay.differences,
        "steps": [_step(one) for one in replay.steps],
        "color": hex_color(run.spec.held.color),
        "held": [_held(tool, replay, run) for tool in tools],
        "film": {
            "wx": packed(s.wrist.x for s in scenes),
            "wy": packed(s.wrist.y for s in scenes),
            "wa": packed(s.wrist.angle for s in scenes),
            "lift": packed(s.lift for s in scenes),
            "held": packed(UNIT * tools.index(s.tool) for s in scenes),
            "x": packed(s.attractor.x for s in scenes),
            "y": packed(s.attractor.y for s in scenes),
            "a": packed(s.attractor.angle for s in scenes),
        },
    }


def which(spec: TrialSpec) -> dict[str, str]:
    """Return the names that tell a trial from others."""
    names = {
        "tool": spec.tool,
        "shape": spec.shape,
        "planner": str(spec.planner),
        "tasks": spec.task_set,
        "goal": spec.goal,
        "start": spec.start,
        "sensor": spec.sensor,
    }
    return {name: one_line(text, 60) for name, text in names.items()}


def _step(one: ReplayedStep) -> dict[str, Any]:
    """Return one step as JSON types."""
    record = one.step.record
    row = record.row
    return {
        "reasons": [reason.json() for reason in record.reasons],
        "distance_to_goal": _rounded(distances(record, one.goal)[0])[0],
        "replicated": record.replicated,
        "excluded": record.died,
        "frames": len(one.scenes),
        "placed": one.placed,
        "close": [_considered(each) for each in one.considered],
        "at": _rounded(record.start.object_x, record.start.object_y),
        "expected": _moved(record.expected),
        "seen": _moved(record.seen),
        "blocked": record.execution is None,
        "hold": call_words(row.binding) if record.regrasped else None,
        "lost": one.step.lost,
        "before": [row.times_successful, row.times_used],
        "after": [record.times_successful_after, record.times_used_after],
    }


def _considered(each: Considered) -> list[Any]:
    """Return a row that came close: number, behavior, two distances (in), probability."""
    row = each.row
    return [
        each.id,
        call_words(row.exploratory),
        f"{each.expected_distance:.1f}",
        f"{each.repositioning:.1f}",
        f"{row.times_successful}/{row.times_used}",
    ]


def _moved(movement: Movement) -> list[Any]:
    """Return a movement along x and y (in) and in words, as the terminal has them."""
    return [*_rounded(movement.dx, movement.dy), movement_words(movement)]


def world_data(workspace: Workspace) -> dict[str, Any]:
    """Return the table and the puck as JSON types (in)."""
    table = workspace.table
    half, near = table.half_width + AROUND, min(table.near, 4.0) - 1.0
    return {
        "puck": workspace.puck.radius,
        "table": {
            "left": -table.half_width,
            "right": table.half_width,
            "near": table.near,
            "far": table.far,
        },
        "view": [-half, near, 2.0 * half, table.far + AROUND - near],
    }


def _held(tool: Tool, replay: Replay, run: LearningRunInfo) -> dict[str, Any]:
    """Return outlines around the wrist (in): of a tool in a scene, and of what it lacks.

    Args:
        tool: as it was held in a scene.
        replay: the trial.
        run: what was learned, with the tool that the robot believes to hold.
    """
    rows = (one.step.record.row for one in replay.steps)
    bindings = dict.fromkeys([run.spec.binding, *(row.binding for row in rows)])
    missing: tuple[ToolPart, ...] = ()
    for binding in bindings:
        hold = hold_of(binding)
        if replay.spec.held.held(hold).outlines == tool.outlines:
            missing = run.spec.held.held(hold).parts_missing_in(tool)
    return {
        "parts": [outline(part.outline.vertices) for part in tool.parts],
        "missing": [outline(part.outline.vertices) for part in missing],
    }


def hex_color(color: tuple[float, float, float]) -> str:
    """Return a colour as ``#28a046``."""
    return "#" + "".join(f"{round(part):02x}" for part in color)


def _rounded(*values: float) -> list[float]:
    """Return lengths as they are shown; adding 0 makes a -0.0 a plain 0."""
    return [round(value, ROUNDED) + 0.0 for value in values]
