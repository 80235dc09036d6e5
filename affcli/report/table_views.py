"""Affordance tables and rows as the figures show them: arrows over tools (Figs. 5 and 6)."""

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from affcli.analysis.inventions import tried_in_passing
from affcli.analysis.regions import parts_at
from affcli.analysis.row_status import RowStatus, around_trial, compared, current
from affcli.core.affordance import PROBABILITY_THRESHOLD, Affordance
from affcli.core.behavior import BehaviorCall, motion_of
from affcli.core.geometry import Pose
from affcli.core.motion import turned_by
from affcli.core.records import LearningRunInfo, StoredRow, StoredStep, TrialInfo
from affcli.core.tool import Tool, ToolPart, known_hold
from affcli.report.captions import Words, joined, run_caption, trial_seed
from affcli.report.figures.words import broken_words, tool_words
from affcli.report.words import call_words, many, unknown_shapes
from affcli.simulation.arm import free_turn


@dataclass(frozen=True, slots=True)
class TableView:
    """An affordance table as a figure shows it: arrows over a tool.

    Args:
        heading: what stands over it; may be empty.
        parts: of the tool, as it is held (in, hand frame); none when its shape, or how it is held,
            is not known.
        missing: parts that the tool has lost.
        puck_radius: of the attractor (in).
        rows: the rows, each with its status.
        regrasped: parts and missing parts of each further binding behavior by which rows were made.
    """

    heading: str
    parts: Sequence[ToolPart]
    missing: Sequence[ToolPart]
    puck_radius: float
    rows: Sequence[tuple[Affordance, RowStatus]]
    regrasped: Mapping[BehaviorCall, tuple[Sequence[ToolPart], Sequence[ToolPart]]] = field(
        default_factory=dict
    )

    def count(self, status: RowStatus) -> int:
        """Return how many of its rows have this status."""
        return sum(its is status for _, its in self.rows)


@dataclass(frozen=True, slots=True)
class RowView:
    """One row as a figure shows it: with what the robot held and what that pushed.

    Args:
        row: the row, with its counters as they are now.
        tool: the tool it was learned with, as it was held (in, hand frame); without parts when its
            shape, or how it was held, is not known.
        puck_radius: of the attractor (in).
        turned: by how much the behavior turned the wrist (rad).
    """

    row: Affordance
    tool: Tool
    puck_radius: float
    turned: float = 0.0


@dataclass(frozen=True, slots=True)
class ShownTables:
    """One affordance table, or two side by side.

    Args:
        words: what is said of them.
        calls: the exploratory behaviors, each with its parameters.
        views: the tables.
        key: what each status of a row means here.
    """

    words: Words
    calls: Sequence[BehaviorCall]
    views: Sequence[TableView]
    key: Mapping[RowStatus, str]


ORIGIN = "all arrows from one origin, for the log does not say where the tool was"
EXCLUDED = "excluded: replication probability 1/2 or below"


def run_shown(run: LearningRunInfo, rows: Sequence[Affordance], puck_radius: float) -> ShownTables:
    """Return the table of a learning run as it is now: excluded rows are told apart."""
    view = _view("", run, run.spec.held, None, puck_radius, rows, current(rows))
    origin = "" if all(map(Affordance.is_placed, rows)) else ORIGIN
    left_out = view.count(RowStatus.EXCLUDED)
    counted = many(len(rows), "row") + (f", {left_out} of them excluded" if left_out else "")
    title = f"What the {tool_words(run.spec.tool)} affords"
    key = {RowStatus.LIVE: "live row of the affordance table", RowStatus.EXCLUDED: EXCLUDED}
    in_passing = len(rows) - len(view.rows)
    told = f"{in_passing} of behaviors composed in passing are not drawn" if in_passing else ""
    return _shown(title, joined(counted, told, origin), (run,), [view], key, run.spec.held)


def runs_compared(
    runs: tuple[LearningRunInfo, LearningRunInfo],
    rows: tuple[Sequence[Affordance], Sequence[Affordance]],
    radii: tuple[float, float],
) -> ShownTables:
    """Return the tables of two learning runs: what both have, and what only one of them has."""
    one, other = runs
    held = one.spec.held, other.spec.held
    statuses = compared(*rows)
    before = _view(_heading(one), one, held[0], None, radii[0], rows[0], statuses[0])
    after = _view(_heading(other), other, held[1], held[0], radii[1], rows[1], statuses[1])
    title = f"What runs {one.id} and {other.id} have in common"
    counted = (
        f"{before.count(RowStatus.KEPT)} of {many(len(rows[0]), 'row')} kept, "
        f"{before.count(RowStatus.LOST)} lost, {after.count(RowStatus.WON)} of "
        f"{many(len(rows[1]), 'row')} won"
    )
    key = {
        RowStatus.KEPT: "in both runs",
        RowStatus.LOST: f"lost: only in run {one.id}",
        RowStatus.WON: f"won: only in run {other.id}",
        RowStatus.EXCLUDED: "excluded",
    }
    return _shown(title, counted, (one, other), (before, after), key, *held)


def trial_shown(
    trial: TrialInfo,
    run: LearningRunInfo,
    stored: Sequence[StoredRow],
    steps: Sequence[StoredStep],
    excluded_before: Collection[int],
    threshold: float,
    puck_radius: float,
) -> ShownTables:
    """Return the table that a trial started from, and what it left of it.

    Args:
        trial: which.
        run: the learning run whose table it used.
        stored: all its rows.
        steps: those of the trial.
        excluded_before: the rows that were excluded before it.
        threshold: of its planner: a row of this replication probability or below is excluded.
        puck_radius: of the attractor (in).
    """
    tried = {step.affordance_id for step in steps}
    died = {step.affordance_id for step in steps if step.died}
    # A row that was tried had not been excluded, whatever another process did meanwhile.
    statuses = around_trial([row.id for row in stored], set(excluded_before) - tried, died)
    rows = [row.row for row in stored]
    tool, left = run.spec.held, trial.spec.held
    broke = trial.spec.shape != trial.spec.tool
    shape = f": the shape of the {tool_words(left.name)}" if broke else ""
    before = _view(f"Before trial {trial.id}", run, tool, None, puck_radius, rows, statuses[0])
    after = _view(f"After trial {trial.id}{shape}", run, left, tool, puck_radius, rows, statuses[1])
    so_far = "" if trial.outcome else f"unfinished, {many(len(steps), 'step')} so far"
    title = f"Trial {trial.id}: what the {broken_words(tool.name, trial.spec.shape)} unlearned"
    rows_left = f"{after.count(RowStatus.KEPT)} rows kept, {after.count(RowStatus.LOST)} lost"
    counted = joined(rows_left, so_far, f"trial: {trial_seed(trial.spec)}")
    limit = "1/2" if threshold == PROBABILITY_THRESHOLD else f"{threshold:g}"
    key = {
        RowStatus.KEPT: "kept",
        RowStatus.LOST: f"lost: its probability fell to {limit} or below in the trial",
        RowStatus.EXCLUDED: "excluded before the trial",
    }
    return _shown(title, counted, (run,), (before, after), key, tool, left)


def row_shown(stored: StoredRow, run: LearningRunInfo, puck_radius: float) -> tuple[Words, RowView]:
    """Return a row of an affordance table with what is said of it."""
    row, tool = stored.row, run.spec.held
    left_out = _left_out([run], tool)
    title = f"Row {stored.id} of the {tool_words(tool.name)}'s affordance table"
    words = Words(title, joined(run_caption(run), *left_out))
    hold = known_hold(row.binding)
    held = replace(tool, parts=()) if hold is None else tool.held(hold) if tool.parts else tool
    return words, RowView(row, held, puck_radius, _turned(row, run))


def _turned(row: Affordance, run: LearningRunInfo) -> float:
    """Return by how much the behavior of a row turned the wrist (rad), at most to the roll's limit
    where it was cut short.
    """
    angle = turned_by(motion_of(row.exploratory, run.spec.repertoire) or ())[-1]
    if not row.truncated or not row.is_placed():
        return angle
    free = free_turn(Pose(*row.start.wrist, row.wrist_angle), angle)
    return math.copysign(min(abs(angle), free), angle)


def _shown(
    title: str,
    counted: str,
    runs: Sequence[LearningRunInfo],
    views: Sequence[TableView],
    key: Mapping[RowStatus, str],
    *tools: Tool,
) -> ShownTables:
    """Return tables with a caption that names what is not drawn; the first run's behaviors."""
    calls = [one.call for one in runs[0].spec.repertoire]
    left_out = _left_out(runs, *tools)
    words = Words(title, joined(counted, run_caption(*runs), *left_out))
    return ShownTables(words, calls, views, key)


def _left_out(runs: Sequence[LearningRunInfo], *tools: Tool) -> tuple[str, ...]:
    """Return the lines that say what is not drawn, and why."""
    if all(run.spec.logged for run in runs):
        return ("no tool is drawn, for a log does not say what it looked like",)
    holds = _unknown_holds(one for run in runs for one in run.spec.bindings)
    return unknown_shapes(tools), holds


def _unknown_holds(bindings: Iterable[BehaviorCall]) -> str:
    """Return the line that says which bindings leave a tool out of drawings; empty if none does."""
    names = sorted({call_words(binding) for binding in bindings if known_hold(binding) is None})
    if not names:
        return ""
    return f"tool not drawn, for this affcli does not know where it is held: {', '.join(names)}"


def _view(
    heading: str,
    run: LearningRunInfo,
    tool: Tool,
    was: Tool | None,
    puck_radius: float,
    rows: Sequence[Affordance],
    statuses: Sequence[RowStatus],
) -> TableView:
    """Return a table over a tool; with `was`, what that had and the tool lacks is missing."""
    binding = run.spec.binding
    passing = tried_in_passing(run.spec.repertoire, rows)
    told = zip(rows, statuses, strict=True)
    shown = [(row, its) for row, its in told if row.exploratory not in passing]

    def held(binding: BehaviorCall) -> tuple[Sequence[ToolPart], Sequence[ToolPart]]:
        parts = parts_at(tool, binding, 0.0)
        kept = {part.name for part in parts}
        before = () if was is None or not tool.parts else parts_at(was, binding, 0.0)
        return parts, [part for part in before if part.name not in kept]

    others = dict.fromkeys(row.binding for row, _ in shown if row.binding != binding)
    regrasped = {one: held(one) for one in others}
    return TableView(heading, *held(binding), puck_radius, shown, regrasped)


def _heading(run: LearningRunInfo) -> str:
    """Return what stands over the table of one of several runs."""
    return f"Run {run.id}: {tool_words(run.spec.tool)}"
