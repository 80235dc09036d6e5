"""A testing trial as a film strip shows it: its steps, and which of them get a panel (§7)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.core.records import StoredStep
from affcli.core.task import GoalRegion
from affcli.core.tool import ToolPart
from affcli.core.workspace import TableSurface
from affcli.errors import one_line
from affcli.report.words import call_words

COLUMNS = 4
"""Panels in a row: narrower ones leave no room for what stands over them."""
MOST_PANELS = 12
"""Of a trial of which no steps are named: three rows."""
MOST_NAMED = 16
"""Steps that can be asked for at once: they fill a page."""
LONGEST_BEHAVIOR = 32
"""Letters of a behavior's name and distance; those of affcli have 32 at most."""


class Held(NamedTuple):
    """A tool as it is held (hand frame).

    Args:
        parts: of the shape that was held.
        missing: parts that the robot believed to hold as well.
    """

    parts: tuple[ToolPart, ...]
    missing: tuple[ToolPart, ...]


@dataclass(frozen=True, slots=True)
class FilmedTrial:
    """A trial, as a film strip shows it.

    Args:
        title, caption: which trial, in words, and whose.
        ending: how it ended, in a word or three; None when it has not.
        parts: of the shape that was held (hand frame); none when it is not known how it was held.
        missing: parts that the robot believed to hold as well (hand frame).
        regrasped: the same, of each further binding behavior by which it was held in some step.
        goal: the goal region.
        wrist, puck: where they were at the start (in, rad, table frame).
        puck_radius: in.
        table: its sizes.
        steps: all there are.
    """

    title: str
    caption: str
    ending: str | None
    parts: tuple[ToolPart, ...]
    missing: tuple[ToolPart, ...]
    goal: GoalRegion
    wrist: Pose
    puck: Point
    puck_radius: float
    table: TableSurface
    steps: tuple[StoredStep, ...]
    regrasped: Mapping[BehaviorCall, Held] = field(default_factory=dict)

    def held(self, step: StoredStep | None = None) -> Held:
        """Return what was held in a step, and what it lacked; without a step, at the start."""
        at_start = Held(self.parts, self.missing)
        return at_start if step is None else self.regrasped.get(step.row.binding, at_start)

    @property
    def course(self) -> str:
        """How it ended and after how many steps, in words."""
        steps = f"{len(self.steps)} step{'s' if len(self.steps) != 1 else ''}"
        return f"not ended, {steps} so far" if self.ending is None else f"{self.ending}, {steps}"


@dataclass(frozen=True, slots=True)
class Shown:
    """What of a trial gets a panel.

    Args:
        start: the table as the trial begins has one.
        takes: what each further panel shows: one step; or several in a row that did the same in
            vain, of which it shows the last.
        left_out: steps among the wanted ones that are in no panel.
    """

    start: bool
    takes: tuple[tuple[StoredStep, ...], ...]
    left_out: tuple[StoredStep, ...] = ()

    @property
    def panels(self) -> int:
        """How many panels there are."""
        return len(self.takes) + self.start

    @property
    def last(self) -> int:
        """The number of the last step shown; 0 when none is."""
        return self.takes[-1][-1].number if self.takes else 0

    @property
    def note(self) -> str:
        """What was left out, in words; empty if nothing."""
        if not self.left_out:
            return ""
        vain = sum(not step.replicated for step in self.left_out)
        return f"left out: {len(self.left_out)} steps, of which {vain} not replicated"


def shown_of(steps: Sequence[StoredStep], wanted: tuple[int, int] | None) -> Shown:
    """Choose what gets a panel.

    Choice: steps that are named have one each. Of a whole trial, steps in a row that tried the same
    row while the attractor stayed where it was share one; and when that leaves more than
    `MOST_PANELS`, so many of them are shown, evenly spread, the first and the last among them. The
    start has a panel where that does not begin another row of panels.

    Args:
        steps: of the trial, in order.
        wanted: numbers of the first and last step to show; None for the whole trial.
    """
    if wanted is not None:
        first, last = wanted
        return Shown(start=False, takes=tuple((s,) for s in steps if first <= s.number <= last))
    takes = _takes(steps)
    if len(takes) <= MOST_PANELS:
        return Shown(start=not takes or len(takes) % COLUMNS != 0, takes=takes)
    gaps = MOST_PANELS - 1
    kept = {round(i * (len(takes) - 1) / gaps) for i in range(MOST_PANELS)}
    return Shown(
        start=False,
        takes=tuple(take for i, take in enumerate(takes) if i in kept),
        left_out=tuple(step for i, take in enumerate(takes) if i not in kept for step in take),
    )


def _takes(steps: Sequence[StoredStep]) -> tuple[tuple[StoredStep, ...], ...]:
    """Return the steps, those together that did the same in vain one after the other."""
    takes: list[tuple[StoredStep, ...]] = []
    for step in steps:
        before = takes[-1][-1] if takes else step
        still = not (before.moved or step.moved)
        if takes and still and _tried(before) == _tried(step):
            takes[-1] += (step,)
        else:
            takes.append((step,))
    return tuple(takes)


def _tried(step: StoredStep) -> tuple[int, bool]:
    """Return which row a step tried, and whether the tool could not be lowered."""
    return step.affordance_id, step.blocked


def take_title(take: Sequence[StoredStep]) -> str:
    """Return what stands over a panel: ``2-7  slide arm left 2, row 519``; and the grasp, where the
    tool was taken anew.
    """
    first, last = take[0], take[-1]
    numbers = str(last.number) if first is last else f"{first.number}-{last.number}"
    plain = call_words(last.row.exploratory).encode("ascii", "backslashreplace").decode()
    taken = f", {one_line(call_words(last.row.binding), 32)}" if first.regrasped else ""
    return f"{numbers}  {one_line(plain, LONGEST_BEHAVIOR)}, row {last.affordance_id}{taken}"


def take_verdict(take: Sequence[StoredStep]) -> str:
    """Return what came of a panel's steps: ``not replicated: 1/2, excluded``."""
    last = take[-1]
    came_of_it = "replicated" if last.replicated else "not replicated"
    if last.blocked:
        came_of_it = "blocked"
    times = f" {len(take)} times" if len(take) > 1 else ""
    ending = ", excluded" if last.died else ""
    return f"{came_of_it}{times}: {last.times_successful_after}/{last.times_used_after}{ending}"
