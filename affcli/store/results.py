"""What reports read: sums made by the database, returned as small records."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import sqlalchemy as sa

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.core.observation import Movement
from affcli.core.trial import Outcome, Protocol, Survivors
from affcli.store.connection import Connected
from affcli.store.mapping import affordance_from, behavior_call, reading_what_was_written
from affcli.store.tables import affordance, behavior, session, step, trial


@dataclass(frozen=True, slots=True)
class BehaviorGroup:
    """What one exploratory behavior with one value of its parameter gave in a learning run.

    Args:
        call: the behavior and its parameter.
        tried: how often it was executed.
        rows: how often it moved the attractor, which makes a row.
        mean_movement: mean distance of these movements (in); None without rows.
        mean_dx, mean_dy: mean movement (in, table frame); None without rows.
    """

    call: BehaviorCall
    tried: int
    rows: int
    mean_movement: float | None
    mean_dx: float | None
    mean_dy: float | None


@dataclass(frozen=True, slots=True)
class TrialResult:
    """How one testing trial ended.

    Args:
        id: its number in the store.
        session_kind, session_id: the command it is part of.
        run_id: the learning run whose table it used.
        robot, protocol, tool, shape, goal, start: which trial.
        sensor: through what the robot saw.
        outcome: how it ended.
        steps: how many steps it took.
        robot_seconds: how long it took.
    """

    id: int
    session_kind: str
    session_id: int
    run_id: int
    robot: int
    protocol: Protocol
    tool: str
    shape: str
    goal: int
    start: int
    sensor: str
    outcome: Outcome
    steps: int
    robot_seconds: float


@dataclass(frozen=True, slots=True)
class SuccessCount:
    """Successes of one robot with one tool and one goal, over the starts.

    Args:
        session_id: the command they are part of.
        robot, protocol, tool, shape, goal: which trials.
        trials: how many ended; invalid ones are left out.
        solved: how many of them were solved.
    """

    session_id: int
    robot: int
    protocol: Protocol
    tool: str
    shape: str
    goal: int
    trials: int
    solved: int


@dataclass(frozen=True, slots=True)
class OutcomeCount:
    """How many trials of a protocol ended in one way."""

    protocol: Protocol
    outcome: Outcome
    trials: int


@dataclass(frozen=True, slots=True)
class StoredStep:
    """One step of a trial with the row it tried.

    Args:
        trial_id, number: which step.
        clock: robot seconds when it ended.
        survivors: rows left by each search.
        affordance_id: the row tried, in the store.
        row: the row tried, with its counters before the step.
        placing_status: of the position wrist.
        status: of the exploratory behavior; None when lowering the tool was blocked.
        wrist_start, wrist_end: before and after the exploratory behavior; when the tool could not
            be lowered, before and after it was carried there (in, table frame).
        seen_start, seen_end: where the attractor was seen (in, table frame).
        true_start, true_end: where it truly was.
        expected, seen: movements (in, table frame); dz is not kept.
        seen_distance: of the movement seen, dz included (in).
        replicated: whether it counts as a success of the row.
        died: the step took the row out of further consideration.
        lost: whether the row was truly lost when the tool broke; None for a whole tool.
        times_used_after, times_successful_after: the row's counters after the step.
    """

    trial_id: int
    number: int
    clock: float
    survivors: Survivors
    affordance_id: int
    row: Affordance
    placing_status: str
    status: str | None
    wrist_start: Point
    wrist_end: Point
    seen_start: Point
    seen_end: Point
    true_start: Point
    true_end: Point
    expected: Movement
    seen: Movement
    seen_distance: float
    replicated: bool
    died: bool
    lost: bool | None
    times_used_after: int
    times_successful_after: int


@dataclass(frozen=True, slots=True)
class RowUse:
    """What the trials of a session made of one affordance, over all of them.

    Args:
        affordance_id: the row.
        robot: whose row it is.
        step: of the learning run that made it.
        exploratory: its behavior.
        offset: where the attractor was as seen from the wrist when it was made (in).
        lost: whether it was truly lost when the tool broke; None for a whole tool.
        trials: in how many trials it was tried.
        tries, successes: how often it was tried, and replicated.
        deaths: in how many trials it died.
    """

    affordance_id: int
    robot: int
    step: int
    exploratory: BehaviorCall
    offset: Point
    lost: bool | None
    trials: int
    tries: int
    successes: int
    deaths: int


class Results(Connected):
    """The part of the store that reports read."""

    def behavior_groups(self, run_id: int) -> tuple[BehaviorGroup, ...]:
        """Return what each behavior and parameter gave in a learning run, by name and parameter."""
        b, a = behavior.c, affordance.c
        made_here = sa.and_(a.learning_run_id == b.learning_run_id, a.step == b.step)
        wanted = (
            sa.select(
                b.exploratory_behavior,
                b.exploratory_params,
                sa.func.count(),
                sa.func.count(a.id),
                sa.func.avg(a.movement),
                sa.func.avg(a.end_object_x - a.start_object_x),
                sa.func.avg(a.end_object_y - a.start_object_y),
            )
            .select_from(behavior.outerjoin(affordance, made_here))
            .where(b.learning_run_id == run_id)
            .group_by(b.exploratory_behavior, b.exploratory_params)
            .order_by(b.exploratory_behavior, b.exploratory_params)
        )
        rows = self._all(wanted)
        with reading_what_was_written(f"learning run {run_id}"):
            return tuple(BehaviorGroup(behavior_call(n, p), *rest) for n, p, *rest in rows)

    def outcomes(
        self, *, session_id: int | None = None, kind: str | None = None, tool: str | None = None
    ) -> tuple[TrialResult, ...]:
        """Return the trials that ended, oldest first.

        Args:
            session_id: only those of this session.
            kind: only those of sessions of this kind.
            tool: only those of this tool.
        """
        t, s = trial.c, session.c
        which = (t.session_id, t.robot, t.protocol, t.tool, t.shape, t.goal, t.start, t.sensor)
        ending = (t.outcome, t.steps, t.robot_seconds)
        run, of = t.learning_run_id.label("run_id"), s.kind.label("session_kind")
        wanted = (
            sa.select(t.id, of, run, *which, *ending)
            .select_from(trial.join(session, s.id == t.session_id))
            .where(t.outcome.is_not(None))
            .order_by(t.id)
        )
        for column, value in ((t.session_id, session_id), (s.kind, kind), (t.tool, tool)):
            if value is not None:
                wanted = wanted.where(column == value)
        with reading_what_was_written("a trial"):
            return tuple(map(_trial_result, self.mappings(wanted)))

    def success_counts(self, session_id: int) -> tuple[SuccessCount, ...]:
        """Return the successes of a session by robot, protocol, tool, shape and goal.

        One pass over the trials in the database, however many robots there are.
        """
        t = trial.c
        cell = (t.robot, t.protocol, t.tool, t.shape, t.goal)
        wanted = (
            sa.select(
                t.session_id,
                *cell,
                sa.func.count(),
                sa.func.sum(sa.case((t.outcome == Outcome.SOLVED.value, 1), else_=0)),
            )
            .where(t.session_id == session_id, t.outcome.is_not(None))
            .where(t.outcome != Outcome.INVALID.value)
            .group_by(t.session_id, *cell)
            .order_by(*cell)
        )
        with reading_what_was_written(f"a trial of session {session_id}"):
            return tuple(
                SuccessCount(s, r, Protocol(p), *rest) for s, r, p, *rest in self._all(wanted)
            )

    def outcome_counts(self, session_ids: Iterable[int]) -> tuple[OutcomeCount, ...]:
        """Return how the trials of some sessions ended, counted by protocol and kind of end."""
        t = trial.c
        wanted = (
            sa.select(t.protocol, t.outcome, sa.func.count())
            .where(t.session_id.in_(list(session_ids)), t.outcome.is_not(None))
            .group_by(t.protocol, t.outcome)
            .order_by(t.protocol, t.outcome)
        )
        with reading_what_was_written("a trial"):
            return tuple(OutcomeCount(Protocol(p), Outcome(o), n) for p, o, n in self._all(wanted))

    def trial_steps(self, trial_id: int) -> tuple[StoredStep, ...]:
        """Return the steps of a trial with the rows they tried."""
        return self._steps(step.c.trial_id == trial_id, f"trial {trial_id}")

    def row_steps(self, row_id: int) -> tuple[StoredStep, ...]:
        """Return the steps that tried a row of an affordance table, by trial and number."""
        return self._steps(step.c.affordance_id == row_id, f"a step that tried affordance {row_id}")

    def _steps(self, condition: sa.ColumnElement[bool], which: str) -> tuple[StoredStep, ...]:
        """Return the steps for which the condition holds, by trial and number."""
        # Both tables say where the attractor was: those of the step get a prefix.
        own = [column.label(f"step_{column.name}") for column in step.columns]
        wanted = (
            sa.select(*own, affordance)
            .select_from(step.join(affordance, affordance.c.id == step.c.affordance_id))
            .where(condition)
            .order_by(step.c.trial_id, step.c.number)
        )
        with reading_what_was_written(which):
            return tuple(map(_stored_step, self.mappings(wanted)))

    def row_uses(
        self, session_id: int, protocol: Protocol = Protocol.TOOL_ADAPTATION
    ) -> tuple[RowUse, ...]:
        """Return what the trials of a session made of each row that they tried.

        Args:
            session_id: the session.
            protocol: which of its trials.
        """
        t, s, a = trial.c, step.c, affordance.c
        row = (
            *(a.id, t.robot, a.step, a.exploratory_behavior, a.exploratory_params),
            *(a.start_wrist_to_object_x, a.start_wrist_to_object_y),
        )
        used = (
            sa.func.max(s.lost).label("lost"),
            sa.func.count(s.trial_id.distinct()).label("trials"),
            sa.func.count().label("tries"),
            sa.func.sum(s.replicated).label("successes"),
            sa.func.sum(s.died).label("deaths"),
        )
        all_three = trial.join(step, s.trial_id == t.id).join(affordance, a.id == s.affordance_id)
        wanted = (
            sa.select(*row, *used)
            .select_from(all_three)
            .where(t.session_id == session_id, t.protocol == protocol.value)
            .group_by(*row)
            .order_by(t.robot, a.id)
        )
        with reading_what_was_written(f"a step of session {session_id}"):
            return tuple(map(_row_use, self.mappings(wanted)))

    def _all(self, wanted: sa.Select[Any]) -> list[tuple[Any, ...]]:
        """Return all rows of a query."""
        with self.reading() as connection:
            return [tuple(row) for row in connection.execute(wanted)]


def _trial_result(row: sa.RowMapping) -> TrialResult:
    """Return a trial's result from its columns."""
    protocol, outcome = Protocol(row["protocol"]), Outcome(row["outcome"])
    return TrialResult(**{**row, "protocol": protocol, "outcome": outcome})


def _row_use(row: sa.RowMapping) -> RowUse:
    """Return a row's use from its columns and sums."""
    return RowUse(
        affordance_id=row["id"],
        exploratory=behavior_call(row["exploratory_behavior"], row["exploratory_params"]),
        offset=Point(row["start_wrist_to_object_x"], row["start_wrist_to_object_y"]),
        lost=_lost(row["lost"]),
        **{n: row[n] for n in ("robot", "step", "trials", "tries", "successes", "deaths")},
    )


def _stored_step(row: sa.RowMapping) -> StoredStep:
    """Return a step from its columns (``step_...``) and those of the row it tried."""
    tried = replace(
        affordance_from(row, as_learned=False),
        times_used=row["step_times_used_before"],
        times_successful=row["step_times_successful_before"],
    )
    return StoredStep(
        survivors=Survivors(*(row[f"step_rows_{name}"] for name in Survivors._fields)),
        row=tried,
        wrist_start=_point(row, "wrist_start"),
        wrist_end=_point(row, "wrist_end"),
        seen_start=_point(row, "start_object"),
        seen_end=_point(row, "end_object"),
        true_start=_point(row, "true_start"),
        true_end=_point(row, "true_end"),
        expected=Movement(row["step_expected_dx"], row["step_expected_dy"], 0.0),
        seen=Movement(row["step_seen_dx"], row["step_seen_dy"], 0.0),
        replicated=bool(row["step_replicated"]),
        died=bool(row["step_died"]),
        lost=_lost(row["step_lost"]),
        **{
            name: row[f"step_{name}"]
            for name in (
                *("trial_id", "number", "clock", "affordance_id", "placing_status", "status"),
                *("seen_distance", "times_used_after", "times_successful_after"),
            )
        },
    )


def _lost(stored: int | None) -> bool | None:
    """Return whether a row was truly lost; None for a whole tool."""
    return None if stored is None else bool(stored)


def _point(row: sa.RowMapping, name: str) -> Point:
    """Return a place from two columns of a step."""
    return Point(row[f"step_{name}_x"], row[f"step_{name}_y"])
