"""Counts and sums, made by the database in one pass however many robots there are."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.geometry import Point
from affcli.core.results import (
    BehaviorGroup,
    LearningInterval,
    OutcomeCount,
    RowUse,
    StepSums,
    SuccessCount,
    TrialGroup,
    TrialResult,
)
from affcli.core.specs import Protocol
from affcli.core.trial import Outcome
from affcli.store.connection import Database, tuples
from affcli.store.reading import behavior_call, reading_what_was_written
from affcli.store.tables import affordance, behavior, learning_run, session, step, trial


@dataclass(frozen=True, slots=True)
class Results:
    """What reports read beside single records."""

    database: Database

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

    def trials(
        self, *, session_id: int | None = None, kind: str | None = None, tool: str | None = None
    ) -> tuple[TrialResult, ...]:
        """Return the trials that ended, oldest first.

        Args:
            session_id: only those of this session.
            kind: only those of sessions of this kind.
            tool: only those of this tool.
        """
        t, s = trial.c, session.c
        which = (
            *(t.session_id, t.robot, t.protocol, t.tool, t.shape),
            *(t.task_set, t.goal, t.start, t.planner, t.sensor),
        )
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
            return tuple(map(_trial_result, self.database.mappings(wanted)))

    def success_counts(self, session_id: int) -> tuple[SuccessCount, ...]:
        """Return the successes of a session by robot, protocol, tool, shape, goal and planner.

        One pass over the trials in the database, however many robots there are.
        """
        t = trial.c
        cell = (t.robot, t.protocol, t.tool, t.shape, t.task_set, t.goal, t.planner)
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
            return tuple(map(_row_use, self.database.mappings(wanted)))

    def learning_intervals(
        self,
        seconds: float,
        *,
        run_ids: Iterable[int] = (),
        session_id: int | None = None,
        tools: Iterable[str] = (),
    ) -> tuple[LearningInterval, ...]:
        """Return what learning runs did in intervals of robot time, by run and interval.

        One pass over the behaviors in the database, however many robots there are. Intervals in
        which nothing ended are left out.

        Args:
            seconds: length of an interval.
            run_ids: these runs.
            session_id: or all runs of this reproduction.
            tools: of those only the runs with these tools; with all if empty.
        """
        b, run = behavior.c, learning_run.c
        number = sa.cast(b.clock / seconds, sa.Integer)
        wanted = sa.select(
            b.learning_run_id, number, sa.func.count(), sa.func.sum(b.change_detected)
        )
        if session_id is None:
            wanted = wanted.where(b.learning_run_id.in_(list(run_ids)))
        else:
            of_session = sa.select(run.id).where(run.session_id == session_id)
            if names := list(tools):
                of_session = of_session.where(run.tool.in_(names))
            wanted = wanted.where(b.learning_run_id.in_(of_session))
        wanted = wanted.group_by(b.learning_run_id, number).order_by(b.learning_run_id, number)
        with self.database.reading() as connection:
            rows = tuples(connection, wanted)
        with reading_what_was_written("a behavior"):
            return tuple(LearningInterval(*map(int, row)) for row in rows)

    def broken_tools(self, session_id: int) -> tuple[tuple[str, str], ...]:
        """Return what was believed to be held and what was held in trials with a broken tool."""
        t = trial.c
        wanted = (
            sa.select(t.tool, t.shape)
            .where(t.session_id == session_id, t.protocol == Protocol.TOOL_ADAPTATION.value)
            .distinct()
            .order_by(t.tool, t.shape)
        )
        with self.database.reading() as connection:
            return tuple((tool, shape) for tool, shape in tuples(connection, wanted))

    def trial_groups(
        self, session_id: int, tool: str, shape: str, side: float, *, by_robot: bool
    ) -> tuple[TrialGroup, ...]:
        """Return the trials of a tool in a session, summed by step number.

        A row lies on the side when the attractor did, as seen from the wrist in its O^s. The mean
        is over all rows of the table that do, tried or not.

        Args:
            session_id: the session.
            tool: what the robot believes to hold.
            shape: what it holds: the same, or what is left of it.
            side: x of a place on the side (in, tool frame); 0 for none, which no row lies on.
            by_robot: sum over the trials of each robot; else each trial stands for itself.
        """
        t, s, a = trial.c, step.c, affordance.c
        these = sa.and_(
            t.session_id == session_id,
            t.tool == tool,
            t.shape == shape,
            t.outcome.is_not(None),
            t.outcome != Outcome.INVALID.value,
        )
        key = t.robot if by_robot else t.id
        on_side = a.start_wrist_to_object_x * side > 0.0
        sides = (
            sa.select(a.learning_run_id.label("run"), sa.func.count().label("rows"))
            .where(on_side, a.learning_run_id.in_(sa.select(t.learning_run_id).where(these)))
            .group_by(a.learning_run_id)
            .subquery()
        )
        beside = trial.outerjoin(sides, sides.c.run == t.learning_run_id)
        counts = (
            sa.select(key, sa.func.count(), sa.func.count(sides.c.rows))
            .select_from(beside)
            .where(these)
            .group_by(key)
            .order_by(key)
        )
        after = sa.cast(s.times_successful_after, sa.REAL) / s.times_used_after
        before = sa.cast(s.times_successful_before, sa.REAL) / s.times_used_before
        change = sa.case((on_side, (after - before) / sides.c.rows), else_=0.0)
        sums = (
            sa.select(
                key,
                s.number,
                sa.func.count(),
                sa.func.sum(sa.func.coalesce(s.lost, 0)),
                sa.func.sum(change),
            )
            .select_from(
                beside.join(step, s.trial_id == t.id).join(affordance, a.id == s.affordance_id)
            )
            .where(these)
            .group_by(key, s.number)
            .order_by(key, s.number)
        )
        with self.database.reading() as connection:
            groups = tuples(connection, counts)
            steps = tuples(connection, sums)
        return tuple(_groups(groups, steps))

    def _all(self, wanted: sa.Select[Any]) -> list[tuple[Any, ...]]:
        """Return all rows of a query."""
        with self.database.reading() as connection:
            return tuples(connection, wanted)


def _trial_result(row: dict[str, Any]) -> TrialResult:
    """Return a trial's result from its columns."""
    protocol, outcome = Protocol(row["protocol"]), Outcome(row["outcome"])
    return TrialResult(**{**row, "protocol": protocol, "outcome": outcome})


def _row_use(row: dict[str, Any]) -> RowUse:
    """Return a row's use from its columns and sums."""
    return RowUse(
        affordance_id=row["id"],
        exploratory=behavior_call(row["exploratory_behavior"], row["exploratory_params"]),
        offset=Point(row["start_wrist_to_object_x"], row["start_wrist_to_object_y"]),
        lost=_lost(row["lost"]),
        **{n: row[n] for n in ("robot", "step", "trials", "tries", "successes", "deaths")},
    )


def _lost(stored: int | None) -> bool | None:
    """Return whether a row was truly lost; None for a whole tool."""
    return None if stored is None else bool(stored)


def _groups(
    groups: Iterable[tuple[Any, ...]], steps: Iterable[tuple[Any, ...]]
) -> Iterator[TrialGroup]:
    """Yield the groups with their steps; one without any has none."""
    of: dict[int, list[StepSums]] = {}
    for key, *sums in steps:
        of.setdefault(key, []).append(StepSums(*sums))
    for key, trials, with_rows in groups:
        yield TrialGroup(key, trials, with_rows, tuple(of.get(key, ())))
