"""Replays as the page's script reads them: small numbers, and the reasons for each step."""

from collections.abc import Iterable
from typing import Any

from affcli.core.observation import Movement
from affcli.core.replay import Considered, Replay, ReplayedStep
from affcli.core.tool import Tool, paper_tools
from affcli.core.workspace import Workspace
from affcli.report.trials import distances, movement_in_words

UNIT = 0.02
"""Inches, or radians, from one whole number to the next: less than a pixel on the page."""
AROUND = 2.0
"""Inches shown around the table: a puck that leaves it is still seen."""
ROUNDED = 2
"""Decimals of lengths that are drawn (in)."""
UNSEEN = 0.05
"""Inches below which a movement would be shown as 0.0: the noise of a puck that stays."""


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


def trial_data(replay: Replay, world: int) -> dict[str, Any]:
    """Return a trial as JSON types: which it is, its film, and why each step was taken.

    Args:
        replay: the trial.
        world: in which of the page's worlds it took place.
    """
    scenes = [scene for one in replay.steps for scene in one.scenes] or [replay.opening]
    spec, goal, end = replay.spec, replay.opening.goal, replay.end
    return {
        "id": replay.trial_id,
        "world": world,
        "tool": spec.tool,
        "shape": spec.shape,
        "goal": spec.goal,
        "start": spec.start,
        "region": None if goal is None else [*goal.center, goal.half_width],
        "outcome": "interrupted" if end is None else end.outcome.value,
        "left": None if end is None or end.last_survivors is None else list(end.last_survivors),
        "equal": not replay.differences,
        "steps": [_step(one) for one in replay.steps],
        "film": {
            "wx": packed(s.wrist.x for s in scenes),
            "wy": packed(s.wrist.y for s in scenes),
            "lift": packed(s.lift for s in scenes),
            "x": packed(s.attractor.x for s in scenes),
            "y": packed(s.attractor.y for s in scenes),
            "a": packed(s.attractor.angle for s in scenes),
        },
    }


def _step(one: ReplayedStep) -> dict[str, Any]:
    """Return one step as JSON types."""
    record = one.step.record
    now, _, _ = distances(record, one.goal)
    return {
        "frames": len(one.scenes),
        "placed": one.placed,
        "left": list(record.survivors),
        "close": [_considered(each) for each in one.considered],
        "at": _rounded(record.start.object_x, record.start.object_y),
        "toGoal": f"{now:.1f}",
        "expected": _moved(record.expected),
        "seen": _moved(record.seen),
        "replicated": record.replicated,
        "blocked": record.execution is None,
        "died": record.died,
        "lost": one.step.lost,
        "before": [record.row.times_successful, record.row.times_used],
        "after": [record.times_successful_after, record.times_used_after],
    }


def _considered(each: Considered) -> list[Any]:
    """Return a row that came close: number, behavior, two distances (in), probability."""
    row = each.row
    return [
        each.id,
        str(row.exploratory),
        f"{each.expected_distance:.1f}",
        f"{each.repositioning:.1f}",
        f"{row.times_successful}/{row.times_used}",
    ]


def _moved(movement: Movement) -> list[Any]:
    """Return a movement along x and y (in) and in words, as the terminal has them."""
    words = movement_in_words(movement) if movement.distance >= UNSEEN else "none"
    return [*_rounded(movement.dx, movement.dy), words]


def world_data(workspace: Workspace) -> dict[str, Any]:
    """Return the table, the puck and the tools as JSON types (in)."""
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
        "tools": {name: _tool(tool) for name, tool in paper_tools(workspace.tools).items()},
    }


def _tool(tool: Tool) -> dict[str, Any]:
    """Return a tool's parts (in, tool frame) and colour as JSON types."""
    return {
        "color": hex_color(tool.color),
        "parts": {part.name: [list(v) for v in part.outline.vertices] for part in tool.parts},
    }


def hex_color(color: tuple[float, float, float]) -> str:
    """Return a colour as ``#28a046``."""
    return "#" + "".join(f"{round(part):02x}" for part in color)


def _rounded(*values: float) -> list[float]:
    """Return lengths as they are shown; adding 0 makes a -0.0 a plain 0."""
    return [round(value, ROUNDED) + 0.0 for value in values]
