"""Replays as the page's script reads them: small numbers, and the reasons for each step."""

from collections.abc import Iterable
from typing import Any

from affcli.core.replay import Considered, Replay, ReplayedStep
from affcli.core.tool import Tool
from affcli.report.trials import distances

UNIT = 0.02
"""Inches, or radians, from one whole number to the next: less than a pixel on the page."""
ROUNDED = 2
"""Decimals of lengths that are shown (in)."""


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


def trial_data(replay: Replay) -> dict[str, Any]:
    """Return a trial as JSON types: which it is, its film, and why each step was taken."""
    scenes = [scene for one in replay.steps for scene in one.scenes] or [replay.opening]
    spec, goal, end = replay.spec, replay.opening.goal, replay.end
    return {
        "id": replay.trial_id,
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
    now, then, _ = distances(record, one.goal)
    return {
        "frames": len(one.scenes),
        "placed": one.placed,
        "left": list(record.survivors),
        "close": [_considered(each) for each in one.considered],
        "at": _rounded(record.start.object_x, record.start.object_y),
        "toGoal": round(now, ROUNDED),
        "expectedToGoal": round(then, ROUNDED),
        "expected": _rounded(record.expected.dx, record.expected.dy),
        "seen": _rounded(record.seen.dx, record.seen.dy),
        "replicated": record.replicated,
        "blocked": record.execution is None,
        "died": record.died,
        "lost": one.step.lost,
        "before": [record.row.times_successful, record.row.times_used],
        "after": [record.times_successful_after, record.times_used_after],
    }


def _considered(each: Considered) -> list[Any]:
    """Return a row that came close: number, behavior, two distances (in), two counters."""
    row = each.row
    return [
        each.id,
        str(row.exploratory),
        *_rounded(each.expected_distance, each.repositioning),
        row.times_successful,
        row.times_used,
    ]


def tool_data(tool: Tool, color: tuple[float, float, float]) -> dict[str, Any]:
    """Return a tool's parts (in, tool frame) and colour as JSON types."""
    return {
        "color": hex_color(color),
        "parts": {part.name: [list(v) for v in part.outline.vertices] for part in tool.parts},
    }


def hex_color(color: tuple[float, float, float]) -> str:
    """Return a colour as ``#28a046``."""
    return "#" + "".join(f"{round(part):02x}" for part in color)


def _rounded(*values: float) -> list[float]:
    """Return lengths as they are shown; adding 0 makes a -0.0 a plain 0."""
    return [round(value, ROUNDED) + 0.0 for value in values]
