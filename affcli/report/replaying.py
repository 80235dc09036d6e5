"""A replay on the terminal, one frame a moment; and as JSON types."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from textwrap import fill
from typing import Any

from rich.console import Console, ConsoleOptions, RenderableType
from rich.table import Table
from rich.text import Text

from affcli.analysis.paper import PLANNER
from affcli.core.choice import plan_followed
from affcli.core.geometry import Point
from affcli.core.replay import Difference, Replay, ReplayedBehavior, ReplayedStep
from affcli.core.scene import Scene
from affcli.core.workspace import Workspace
from affcli.report.table_map import View, table_map
from affcli.report.trials import step_json, step_lines
from affcli.report.words import call_words, movement_words, planner_words, trial_words

WIDE, WORDS = 72, 36
"""From so many columns on the words stand beside the map, and have so many at least."""
MAP_WIDTH, MAP_ROWS = 42, 18
"""Of the map in letters on a terminal of 80 x 24; on a larger one it grows with both."""
BESIDE_THE_MAP = 6
"""Lines of a terminal beside those of the map: title, phase, what is asked."""
GAP = 2
"""Columns between the map and the words."""
MOST_CLOSE = 2
"""Rows shown of those that search 4 might have chosen instead."""
MOST_DIFFERENCES = 5
MOST_NUMBERS = 10
"""Trials named that cannot be replayed for one reason."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One moment of a replay; drawn when it is shown, for in a fast film most frames never are.

    Args:
        title: which trial and step.
        phase: what the robot is doing.
        scene: what is on the table.
        path: where the attractor has been (in, table frame).
        words: what there is to say, one paragraph each.
        workspace: where it takes place.
        braille: the terminal can show braille letters.
        ahead: where the plan that is followed should leave the attractor (in, table frame).
    """

    title: str
    phase: Text
    scene: Scene
    path: Sequence[Point]
    words: Sequence[str]
    workspace: Workspace
    braille: bool
    ahead: Sequence[Point] = ()

    def __rich_console__(
        self, console: Console, options: ConsoleOptions
    ) -> Iterator[RenderableType]:
        """Yield the title, what is going on, the table, and the words beside it or below."""
        columns = options.max_width
        across = min(columns - 1, max(MAP_WIDTH, columns - WORDS - GAP))
        down = round(across * MAP_ROWS / MAP_WIDTH)
        if console.is_terminal:
            down = min(down, console.height - BESIDE_THE_MAP)
        view = View.of(self.workspace, across, max(MAP_ROWS, down))
        drawn = table_map(
            *(self.scene, self.workspace, self.path, view),
            braille=self.braille,
            ahead=self.ahead,
        )
        width = columns - (view.columns + GAP if columns >= WIDE else 0)
        # Further lines of a paragraph are indented, so that it is seen where the next begins.
        words = "\n".join(
            fill(paragraph, width, subsequent_indent="  ", break_on_hyphens=False)
            for paragraph in self.words
        )
        yield Text(self.title, style="bold")
        yield self.phase
        if columns < WIDE:
            yield drawn
            yield Text(words)
        else:
            grid = Table.grid(padding=(0, GAP, 0, 0), pad_edge=False)
            grid.add_column(width=view.columns)
            grid.add_row(drawn, Text(words))
            yield grid


def phase_line(now: int, behavior: str) -> Text:
    """Return the steps of the procedure (Fig. 7) with the one of this number marked."""
    line = Text()
    for number, word in enumerate(("choose a row", "position wrist", behavior, "compare")):
        line.append(" > " if number else "", style="dim")
        here = number == now
        line.append(f"[{word}]" if here else word, style="bold" if here else "dim")
    return line


def step_title(replay: Replay, number: int) -> str:
    """Return which trial, and which of its steps."""
    return (
        f"Trial {replay.trial_id}, step {number} of {len(replay.steps)}: {trial_words(replay.spec)}"
    )


def step_words(replay: Replay, step: ReplayedStep) -> tuple[list[str], list[str]]:
    """Return why a row was chosen in a step and which were next best; and what came of it."""
    chosen, *others = step.considered
    *why, happened, probability = step_lines(step.step.record, replay.spec.task.goal)
    planner = replay.spec.planner
    by = [] if str(planner) == PLANNER else [f"planner: {planner_words(planner)}"]
    why = [f"row {chosen.id}: {call_words(chosen.row.exploratory)}", *by, "", *why]
    for other in others[:MOST_CLOSE]:
        why.append(
            f"next best: row {other.id}, {call_words(other.row.exploratory)}: "
            f"{other.repositioning:.1f} in; {other.expected_distance:.1f} in from the centre"
        )
    lost = [f"truly lost: the {replay.spec.shape} cannot do it"] if step.step.lost else []
    return why, [happened, probability, *lost]


def trial_frames(replay: Replay, number: int, *, braille: bool) -> Iterator[Frame]:
    """Yield one step of a trial, frame by frame; the last one when it has been judged.

    Args:
        replay: the trial.
        number: of the step, counting from 1.
        braille: the terminal can show braille letters.
    """
    one, workspace = replay.steps[number - 1], replay.workspace
    behavior = call_words(one.step.record.row.exploratory)
    title, (why, outcome) = step_title(replay, number), step_words(replay, one)
    path = [s.attractor.point for done in replay.steps[:number] for s in done.scenes]
    began = len(path) - len(one.scenes)
    ahead = [Point(move.x, move.y) for move in plan_followed(one.step.record.reasons)]
    for frame, scene in enumerate(one.scenes):
        phase = phase_line(0 if frame == 0 else 1 if frame < one.placed else 2, behavior)
        so_far = path[: began + frame + 1]
        yield Frame(title, phase, scene, so_far, why, workspace, braille, ahead)
    words, phase = [*why, *outcome], phase_line(3, behavior)
    yield Frame(title, phase, one.scenes[-1], path, words, workspace, braille, ahead)


def opening_frame(replay: Replay, *, braille: bool) -> Frame:
    """Return the table of a trial that has no steps."""
    title = f"Trial {replay.trial_id}, no steps: {trial_words(replay.spec)}"
    return Frame(title, Text(), replay.opening, (), (), replay.workspace, braille)


def behavior_frames(
    run: str, behavior: ReplayedBehavior, workspace: Workspace, *, braille: bool
) -> Iterator[Frame]:
    """Yield one behavior of a learning run, frame by frame.

    Args:
        run: which, for the title.
        behavior: what was done.
        workspace: where.
        braille: the terminal can show braille letters.
    """
    title = f"{run}: behavior {behavior.record.step}"
    words = behavior_words(behavior)
    path = [scene.attractor.point for scene in behavior.scenes]
    for number, scene in enumerate(behavior.scenes, 1):
        yield Frame(title, Text(), scene, path[:number], words, workspace, braille)


def closing_words(replay: Replay) -> str:
    """Return how a trial ended, and whether the replay equals its record."""
    ended = "was interrupted" if replay.end is None else f"ended: {replay.end.outcome}"
    same = verdict(len(replay.steps), replay.differences)
    return f"trial {replay.trial_id} {ended}; {same}"


def verdict(
    count: int, differences: Sequence[Difference], noun: str = "step", of: int | None = None
) -> str:
    """Return in words whether so many steps, done again, equal their record.

    Args:
        count: how many were done.
        differences: what came out otherwise.
        noun: what they are.
        of: how many the record holds; None for `count`.
    """
    if differences:
        return _differing_in(
            differences, lambda number: f"{noun} {number}" if number else "the end"
        )
    return f"the replay equals the record, {_counted(count, noun, of)}"


def run_verdict(
    count: int, differences: Sequence[Difference], of: int, borrowed: int | None = 0
) -> str:
    """Return in words whether a learning run, done again, equals its record.

    Args:
        count: how many behaviors were done.
        differences: what came out otherwise, borrowed rows by their steps, which are 0 or less.
        of: how many behaviors the record holds.
        borrowed: how many rows were borrowed again; None where that could not be.
    """
    unchecked = (
        ""
        if borrowed is not None
        else ("; what it borrowed was not checked, for a run that lent it is not there any more")
    )
    if differences:
        return _differing_in(differences, _of_a_run) + unchecked
    rows = f"{_counted(borrowed, 'borrowed row', None)}, " if borrowed else ""
    return f"the replay equals the record, {rows}{_counted(count, 'behavior', of)}{unchecked}"


def _of_a_run(number: int) -> str:
    """Return what has a number in a learning run."""
    return f"behavior {number}" if number > 0 else f"borrowed row {number}"


def _counted(count: int, noun: str, of: int | None) -> str:
    """Return in words how many were done of how many; None for all."""
    which = "all" if of in {None, count} else "the first"
    known = {0: f"no {noun}s", 1: f"{'its' if which == 'all' else which} one {noun}"}
    return known.get(count, f"{which} {count} {noun}s")


def _differing_in(differences: Sequence[Difference], named: Callable[[int], str]) -> str:
    """Return in words where a replay differs; `named` says what has a number."""
    shown = [
        f"{named(number)} ({_at_most(map(_differing, some), 3)})"
        for number, some in groupby(differences, key=lambda d: d.number)
    ]
    return f"the replay DIFFERS from the record in {_at_most(shown, MOST_DIFFERENCES)}"


def by_reason(not_replayed: Mapping[int, str]) -> dict[str, list[int]]:
    """Return for each reason the trials that cannot be replayed for it.

    Args:
        not_replayed: the reason of each trial, by its number, which the reason may begin with.
    """
    grouped: dict[str, list[int]] = {}
    for number, reason in not_replayed.items():
        grouped.setdefault(reason.removeprefix(f"trial {number}: "), []).append(number)
    return grouped


def all_words(equal: int, replayed: int, not_replayed: Mapping[int, str]) -> list[str]:
    """Return what is said of a replay of all trials, last how many equal their record; one line
    where none could be done.

    Args:
        equal: how many do.
        replayed: how many were done again.
        not_replayed: as in `by_reason`.
    """
    same = f"{equal} of {replayed}{' replayed' * bool(not_replayed)} trials equal their record"
    same += " in every step"
    if not not_replayed:
        return [same]
    same += f"; {len(not_replayed)} could not be replayed"
    grouped = by_reason(not_replayed)
    if len(grouped) == 1 and not replayed:
        return [f"{same}: {next(iter(grouped))}"]
    named = [
        (f"trial{'s' * (len(numbers) > 1)} {_at_most(map(str, numbers), MOST_NUMBERS)}", reason)
        for reason, numbers in grouped.items()
    ]
    if not replayed:
        return [f"{same}: {_at_most((f'{reason} ({which})' for which, reason in named), 3)}"]
    return [*(f"{which} could not be replayed: {reason}" for which, reason in named), same]


def _differing(difference: Difference) -> str:
    """Return in words what differs."""
    if difference.column != "number":
        return difference.column
    return "not in the record" if difference.stored is None else "not done again"


def _at_most(words: Iterable[str], most: int) -> str:
    """Return so many of some words, and how many more there are."""
    words = list(words)
    more = f" and {len(words) - most} more" if len(words) > most else ""
    return ", ".join(words[:most]) + more


def behavior_words(behavior: ReplayedBehavior) -> list[str]:
    """Return what a babbled behavior did."""
    record = behavior.record
    seen = record.affordance
    effect = "no movement detected: no row"
    if seen is not None:
        effect = f"moved {movement_words(seen.expected_movement)}: a row"
    x, y = record.start.wrist_to_object
    return [
        call_words(record.execution.call),
        "",
        f"attractor at ({x:.1f}, {y:.1f}) from the wrist",
        effect,
        *([f"put back by hand {record.resets} times before"] if record.resets else []),
    ]


def replay_json(replay: Replay, numbers: Sequence[int]) -> dict[str, Any]:
    """Return a replay as JSON types: what each step weighed, did and saw, and the differences.

    Args:
        replay: the trial.
        numbers: of the steps that are wanted; the differences are those of all.
    """
    spec = replay.spec
    return {
        "trial": replay.trial_id,
        "run": replay.run_id,
        "tool": spec.tool,
        "shape": spec.shape,
        "goal": spec.goal,
        "start": spec.start,
        "planner": str(spec.planner),
        "goal_center": list(spec.task.goal.center),
        "outcome": None if replay.end is None else replay.end.outcome.value,
        "steps": [_step_json(replay.steps[number - 1]) for number in numbers],
        **differences_json(replay.differences),
    }


def _step_json(one: ReplayedStep) -> dict[str, Any]:
    """Return one step as JSON types."""
    record, truth = one.step.record, one.step.truth
    return {
        **step_json(one.considered[0].id, record, one.goal),
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
        "lost": one.step.lost,
        "true_start": None if truth is None else list(truth.start),
        "true_end": None if truth is None else list(truth.end),
        "frames": len(one.scenes),
    }


def differences_json(differences: Sequence[Difference]) -> dict[str, Any]:
    """Return whether a replay equals its record, and where not."""
    return {"equal": not differences, "differences": [d._asdict() for d in differences]}
