"""A replay on the terminal, one screen a moment; and as JSON types."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from affcli.core.geometry import Point
from affcli.core.replay import Difference, Replay, ReplayedBehavior, ReplayedStep
from affcli.core.scene import Scene
from affcli.core.task import goal_regions
from affcli.core.trial import TrialSpec
from affcli.core.workspace import Workspace
from affcli.report.table_map import View, table_map
from affcli.report.trials import movement_in_words, step_lines

WIDE, MAP_WIDTH, MAP_ROWS = 72, 42, 18
"""From so many columns on the words stand beside the map; the map's largest size in letters."""
MOST_CLOSE = 2
"""Rows shown of those that search 4 might have chosen instead."""
MOST_DIFFERENCES = 5


class Screen:
    """One moment of a replay as a page that fits into a terminal.

    Args:
        workspace: where it takes place.
        columns: how wide the terminal is.
        braille: it can show braille letters.
    """

    def __init__(self, workspace: Workspace, columns: int, *, braille: bool) -> None:
        self._workspace = workspace
        self._wide = columns >= WIDE
        self._view = View.of(workspace, min(columns - 1, MAP_WIDTH), MAP_ROWS)
        self._braille = braille

    def page(
        self, title: str, phase: Text, scene: Scene, path: list[Point], words: Sequence[str]
    ) -> RenderableType:
        """Return a title, what is going on, the table, and what there is to say.

        Args:
            title: which trial and step.
            phase: what the robot is doing.
            scene: what is on the table.
            path: where the attractor has been.
            words: one paragraph each.
        """
        drawn = table_map(scene, self._workspace, path, self._view, braille=self._braille)
        text = Group(*(Text(line) for line in words))
        body: RenderableType = Group(drawn, text)
        if self._wide:
            grid = Table.grid(padding=(0, 2, 0, 0), pad_edge=False)
            grid.add_column(width=self._view.columns)
            grid.add_column()
            grid.add_row(drawn, text)
            body = grid
        return Group(Text(title, style="bold"), phase, body)


CHOOSING, PLACING, EXPLORING, COMPARING = range(4)
PHASES = ("choose a row", "position wrist", "behavior", "compare")
"""Of a step of the procedure (Fig. 7), by the numbers above."""


def phase_line(now: int, behavior: str) -> Text:
    """Return the steps of the procedure (Fig. 7) with the present one marked."""
    words = [*PHASES[:2], behavior, PHASES[3]]
    line = Text()
    for number, word in enumerate(words):
        if number:
            line.append(" > ", style="dim")
        here = number == now
        line.append(f"[{word}]" if here else word, style="bold" if here else "dim")
    return line


def step_title(replay: Replay, number: int) -> str:
    """Return which trial, and which of its steps."""
    return f"Trial {replay.trial_id}: {_which(replay.spec)}; step {number} of {len(replay.steps)}"


def _which(spec: TrialSpec) -> str:
    """Return in words which trial it is."""
    truly = "" if spec.shape == spec.tool else f", truly {spec.shape}"
    return f"{spec.tool}{truly}, goal {spec.goal}, start {spec.start}"


def step_words(replay: Replay, step: ReplayedStep) -> list[str]:
    """Return why a row was chosen in a step, what came close, and what came of it."""
    record = step.step.record
    chosen = step.considered[0]
    words = [f"row {chosen.id}: {record.row.exploratory}", ""]
    words += step_lines(record, step.goal)
    for other in step.considered[1 : 1 + MOST_CLOSE]:
        words.append(
            f"came close: row {other.id}, {other.row.exploratory}, wrist {other.repositioning:.1f} "
            f"in away, should end {other.expected_distance:.1f} in from the goal's centre"
        )
    if step.step.lost:
        words.append(f"truly lost: the {replay.spec.shape} cannot do it")
    return words


def trial_pages(replay: Replay, number: int, screen: "Screen") -> Iterator[RenderableType]:
    """Yield one step of a trial, a page for each frame; the last one when it has been judged.

    Args:
        replay: the trial.
        number: of the step, counting from 1.
        screen: draws the pages.
    """
    one = replay.steps[number - 1]
    behavior = str(one.step.record.row.exploratory)
    title, words = step_title(replay, number), step_words(replay, one)
    # One place for each frame so far: a path.
    path = [s.attractor.point for done in replay.steps[: number - 1] for s in done.scenes]
    for frame, scene in enumerate(one.scenes):
        path.append(scene.attractor.point)
        phase = PLACING if frame < one.placed else EXPLORING
        yield screen.page(title, phase_line(phase, behavior), scene, path, words)
    yield screen.page(title, phase_line(COMPARING, behavior), one.scenes[-1], path, words)


def behavior_pages(
    run: str, behavior: ReplayedBehavior, screen: "Screen"
) -> Iterator[RenderableType]:
    """Yield one behavior of a learning run, a page for each frame.

    Args:
        run: which, for the title.
        behavior: what was done.
        screen: draws the pages.
    """
    title = f"{run}: behavior {behavior.record.step}"
    words = behavior_words(behavior)
    path: list[Point] = []
    for scene in behavior.scenes:
        path.append(scene.attractor.point)
        yield screen.page(title, Text(), scene, path, words)


def closing_words(replay: Replay) -> str:
    """Return how a trial ended, and whether the replay equals its record."""
    ended = "was interrupted" if replay.end is None else f"ended: {replay.end.outcome}"
    same = verdict(len(replay.steps), replay.differences)
    return f"trial {replay.trial_id} {ended}; {same}"


def verdict(count: int, differences: Sequence[Difference], noun: str = "step") -> str:
    """Return in words whether so many steps, done again, equal their record."""
    if not differences:
        return f"the replay equals the record in all {count} {noun}s"
    shown = [
        f"{f'{noun} {number}' if number else 'the end'} ({', '.join(d.column for d in some)})"
        for number, some in groupby(differences, key=lambda d: d.number)
    ]
    more = f" and {len(shown) - MOST_DIFFERENCES} more" if len(shown) > MOST_DIFFERENCES else ""
    return f"the replay DIFFERS from the record in {', '.join(shown[:MOST_DIFFERENCES])}{more}"


def behavior_words(behavior: ReplayedBehavior) -> list[str]:
    """Return what a babbled behavior did."""
    record = behavior.record
    seen = record.affordance
    effect = "no movement detected: no row"
    if seen is not None:
        effect = f"moved {movement_in_words(seen.expected_movement)}: a row"
    x, y = record.start.wrist_to_object
    return [
        str(record.execution.call),
        "",
        f"attractor at ({x:.1f}, {y:.1f}) from the wrist",
        effect,
        *([f"put back by hand {record.resets} times before"] if record.resets else []),
    ]


def replay_json(replay: Replay) -> dict[str, Any]:
    """Return a replay as JSON types: what each step weighed, did and saw, and the differences."""
    spec = replay.spec
    goal = goal_regions(replay.workspace.layout)[spec.goal]
    return {
        "trial": replay.trial_id,
        "run": replay.run_id,
        "tool": spec.tool,
        "shape": spec.shape,
        "goal": spec.goal,
        "start": spec.start,
        "goal_center": list(goal.center),
        "outcome": None if replay.end is None else replay.end.outcome.value,
        "steps": [_step_json(one) for one in replay.steps],
        **differences_json(replay.differences),
    }


def _step_json(one: ReplayedStep) -> dict[str, Any]:
    """Return one step as JSON types."""
    record, truth = one.step.record, one.step.truth
    return {
        "step": record.number,
        "row": one.considered[0].id,
        "behavior": str(record.row.exploratory),
        "rows_left": record.survivors._asdict(),
        "considered": [
            {
                "row": each.id,
                "behavior": str(each.row.exploratory),
                "expected_distance_to_goal": each.expected_distance,
                "repositioning": each.repositioning,
                "times_successful": each.row.times_successful,
                "times_used": each.row.times_used,
            }
            for each in one.considered
        ],
        "expected": [record.expected.dx, record.expected.dy],
        "seen": [record.seen.dx, record.seen.dy],
        "replicated": record.replicated,
        "lost": one.step.lost,
        "true_start": list(truth.start),
        "true_end": list(truth.end),
        "frames": len(one.scenes),
    }


def differences_json(differences: Sequence[Difference]) -> dict[str, Any]:
    """Return whether a replay equals its record, and where not."""
    return {"equal": not differences, "differences": [d._asdict() for d in differences]}
