"""Counts and sums, made by the database in one pass however many robots there are."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.affordance import PROBABILITY_THRESHOLD
from affcli.core.effects import Effect, Way
from affcli.core.results import (
    BehaviorGroup,
    Cell,
    InvalidTrials,
    LearningInterval,
    StepSums,
    SuccessCount,
    TrialGroup,
    VerificationResult,
)
from affcli.core.specs import Protocol
from affcli.core.trial import DIVERGED, Outcome, is_counted
from affcli.store.connection import Database, tuples
from affcli.store.keeping import require_kept
from affcli.store.learning import used_in
from affcli.store.reading import behavior_call, reading_what_was_written, reasons
from affcli.store.tables import (
    affordance,
    behavior,
    learning_run,
    replication,
    step,
    trial,
    verification,
)

COUNTED = [outcome.value for outcome in Outcome if is_counted(outcome)]
"""How trials end that count."""
ROBOTS_IN_A_LIST, ROBOTS_WITH_MANY = 1_000, 10
"""So many robots are one value of a row, far from what it may have (affcli.bounded): where all is
told apart, so that a robot has one trial of a cell; and where it may have a thousand."""


@dataclass(frozen=True, slots=True)
class Results:
    """What reports read beside single records."""

    database: Database

    def behavior_groups(self, run_id: int) -> tuple[BehaviorGroup, ...]:
        """Return what each behavior and parameter gave in a learning run, by name and parameter."""
        require_kept(self.database, "behaviors", learning_run.c.id == run_id)
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

    def effects(self, run_id: int, way: Way, inches: float) -> tuple[Effect, ...]:
        """Return how often each behavior moved the attractor a way by more than so many inches."""
        require_kept(self.database, "behaviors", learning_run.c.id == run_id)
        b, a, along = behavior.c, affordance.c, way.direction
        far = along.x * (b.end_object_x - b.start_object_x) + along.y * (
            b.end_object_y - b.start_object_y
        )
        alive = a.times_successful > PROBABILITY_THRESHOLD * a.times_used
        made_here = sa.and_(a.learning_run_id == b.learning_run_id, a.step == b.step)
        wanted = (
            sa.select(
                b.exploratory_behavior,
                b.exploratory_params,
                sa.func.count(),
                sa.func.sum(sa.case((far > inches, 1), else_=0)),
                sa.func.count(a.id),
                sa.func.sum(sa.case((alive, 1), else_=0)),
            )
            .select_from(behavior.outerjoin(affordance, made_here))
            .where(b.learning_run_id == run_id)
            .group_by(b.exploratory_behavior, b.exploratory_params)
            .order_by(b.exploratory_behavior, b.exploratory_params)
        )
        rows = self._all(wanted)
        with reading_what_was_written(f"learning run {run_id}"):
            return tuple(Effect(behavior_call(n, p), *rest) for n, p, *rest in rows)

    def success_counts(self, session_id: int) -> tuple[SuccessCount, ...]:
        """Return the successes of a session by robot, protocol, tool, shape, goal and planner.

        One pass over the trials in the database, however many robots there are.
        """
        t = trial.c
        cell = (t.robot, t.protocol, t.tool, t.shape, t.task_set, t.goal, t.planner)
        wanted = (
            sa.select(
                *cell,
                sa.func.count(),
                sa.func.sum(sa.case((t.outcome == Outcome.SOLVED.value, 1), else_=0)),
            )
            .where(t.session_id == session_id, t.outcome.in_(COUNTED))
            .group_by(*cell)
            .order_by(*cell)
        )
        with reading_what_was_written(f"a trial of session {session_id}"):
            return tuple(SuccessCount(r, Protocol(p), *rest) for r, p, *rest in self._all(wanted))

    def solved_by_cell(
        self, session_id: int, by: Sequence[str]
    ) -> dict[Cell, dict[int, tuple[int, int]]]:
        """Return for each cell by robot how many trials of a session ended and were solved.

        One pass over its trials in the database, however many robots there are; in the order in
        which they were tried first.

        Args:
            session_id: the session.
            by: fields of `Cell` beside protocol and task set that tell trials apart.
        """
        t = trial.c
        names = ["protocol", "task_set", *by]
        columns = [t[name] for name in names]
        # Robots in lists: a row a robot and cell would take three times as long.
        one_each = {"tool", "shape", "goal", "start"} <= set(by)
        robots_in = ROBOTS_IN_A_LIST if one_each else ROBOTS_WITH_MANY
        block = sa.cast(t.robot / sa.literal_column(str(robots_in)), sa.Integer)
        was_solved = sa.cast(t.outcome == Outcome.SOLVED.value, sa.Integer)
        lists = [sa.func.group_concat(one) for one in (t.robot, was_solved)]
        wanted = (
            sa.select(sa.func.min(t.id), *lists, *columns)
            .where(t.session_id == session_id, t.outcome.in_(COUNTED))
            .group_by(block, *columns)
        )
        cells: dict[Cell, dict[int, tuple[int, int]]] = {}
        firsts: dict[Cell, int] = {}
        for first, robots, solved, *row in self._all(wanted):
            cell = Cell(**dict(zip(names, row, strict=True)))
            own = cells.setdefault(cell, {})
            for robot, flag in zip(robots.split(","), solved.split(","), strict=True):
                number = int(robot)
                before = own.get(number, (0, 0))
                own[number] = before[0] + 1, before[1] + (flag == "1")
            firsts[cell] = min(first, firsts.get(cell, first))
        return {
            cell: dict(sorted(cells[cell].items()))
            for cell in sorted(cells, key=firsts.__getitem__)
        }

    def means_of_trials(
        self, session_id: int, measure: str, tools: Sequence[str] = ()
    ) -> dict[Cell, dict[int, float]]:
        """Return for each protocol and task set of a session by robot the mean of a measure.

        Args:
            session_id: the session.
            measure: ``steps`` or ``seconds`` of its solved trials, or ``error``: how far a step of
                all that count left the attractor from where its row said (in).
            tools: only of trials with these; all if empty.

        Raises:
            UsageError: the steps, which tell of the error, were not kept.
        """
        t, s = trial.c, step.c
        cell = (t.protocol, t.task_set, t.robot)
        if measure == "error":
            require_kept(self.database, "steps", used_in(session_id))
            dx, dy = s.seen_dx - s.expected_dx, s.seen_dy - s.expected_dy
            found = (
                sa.select(*cell, sa.func.avg(sa.func.sqrt(dx * dx + dy * dy)))
                .select_from(trial.join(step, s.trial_id == t.id))
                .where(t.outcome.in_(COUNTED))
            )
        else:
            value = {"steps": t.steps, "seconds": t.robot_seconds}[measure]
            found = sa.select(*cell, sa.func.avg(value)).where(t.outcome == Outcome.SOLVED.value)
        wanted = (
            found.where(t.session_id == session_id, t.tool.in_(tools) if tools else sa.true())
            .group_by(*cell)
            .order_by(sa.func.min(t.id))
        )
        means: dict[Cell, dict[int, float]] = {}
        for protocol, task_set, robot, mean in self._all(wanted):
            means.setdefault(Cell(protocol, task_set), {})[robot] = mean
        return means

    def outcome_counts(self, session_ids: Iterable[int]) -> dict[Outcome, int]:
        """Return how the trials of some sessions ended, counted by kind of end."""
        t = trial.c
        wanted = (
            sa.select(t.outcome, sa.func.count())
            .where(t.session_id.in_(list(session_ids)), t.outcome.is_not(None))
            .group_by(t.outcome)
        )
        with reading_what_was_written("a trial"):
            return {Outcome(outcome): count for outcome, count in self._all(wanted)}

    def invalid(self, session_id: int) -> InvalidTrials:
        """Return how many trials of a session count for nothing, and why the first of them does."""
        t = trial.c
        # SQLite takes what stands beside a minimum from the row that has it.
        wanted = sa.select(sa.func.count(), sa.func.min(t.id), t.last_reasons).where(
            t.session_id == session_id, t.outcome == Outcome.INVALID.value
        )
        ((trials, first, told),) = self._all(wanted)
        if not trials:
            return InvalidTrials()
        with reading_what_was_written(f"trial {first}"):
            said = reasons(told) if told else ()
        return InvalidTrials(trials, said[0].name if said else DIVERGED)

    def losses(self, session_id: int, protocol: Protocol) -> tuple[int, int]:
        """Return what a session's trials of a protocol that count made of the rows they tried.

        Returns:
            How many tries were of rows whose affordance was truly lost; and how many rows fell to
            a probability of 1/2 or less in some trial.
        """
        require_kept(self.database, "steps", used_in(session_id))
        s, t = step.c, trial.c
        excluded = sa.case((s.died == 1, s.affordance_id)).distinct()
        wanted = (
            sa.select(sa.func.coalesce(sa.func.sum(s.lost), 0), sa.func.count(excluded))
            .select_from(trial.join(step, s.trial_id == t.id))
            .where(t.session_id == session_id, t.protocol == protocol.value)
            .where(t.outcome.in_(COUNTED))
        )
        ((lost, rows),) = self._all(wanted)
        return lost, rows

    def verifications(self, run_ids: Iterable[int]) -> tuple[VerificationResult, ...]:
        """Return what the verifications of learning runs found, oldest first."""
        v, r, run = verification.c, replication.c, learning_run.c
        failed = sa.and_(r.live == 1, r.replicated == 0)
        borrowed = sa.and_(r.live == 1, affordance.c.step <= 0)
        wanted = (
            sa.select(
                *(v.id, v.learning_run_id, run.tool, v.shape, v.sensor, v.verdict),
                sa.func.coalesce(sa.func.sum(r.live), 0),
                sa.func.count(sa.case((failed, 1))),
                *(v.decided_after, v.robot_seconds),
                sa.func.count(sa.case((borrowed, 1))),
                sa.func.count(sa.case((sa.and_(borrowed, failed), 1))),
            )
            .select_from(
                verification.join(learning_run, run.id == v.learning_run_id)
                .outerjoin(replication, r.verification_id == v.id)
                .outerjoin(affordance, affordance.c.id == r.affordance_id)
            )
            .where(v.learning_run_id.in_(list(run_ids)))
            .group_by(v.id)
            .order_by(v.id)
        )
        return tuple(VerificationResult(*row) for row in self._all(wanted))

    def learning_intervals(
        self, seconds: float, session_id: int | None = None
    ) -> dict[int, list[LearningInterval]]:
        """Return what learning runs did in intervals of robot time, by run, each in order.

        One pass over the behaviors in the database, however many robots there are. Intervals in
        which nothing ended are left out, and so are runs of a log that does not say times.

        Args:
            seconds: length of an interval.
            session_id: the runs that its robots used; None for those that stand for themselves.

        Raises:
            UnreadableError: a behavior of a simulated run has no time.
        """
        require_kept(self.database, "behaviors", used_in(session_id))
        b, run = behavior.c, learning_run.c
        runs = sa.select(run.id).where(used_in(session_id), run.robot_seconds.is_not(None))
        number = sa.cast(b.clock / seconds, sa.Integer)
        wanted = (
            sa.select(b.learning_run_id, number, sa.func.count(), sa.func.sum(b.change_detected))
            .where(b.learning_run_id.in_(runs))
            .group_by(b.learning_run_id, number)
            .order_by(b.learning_run_id, number)
        )
        by_run: dict[int, list[LearningInterval]] = {}
        for run_id, at, *counts in self._all(wanted):
            with reading_what_was_written(f"learning run {run_id}"):
                by_run.setdefault(run_id, []).append(LearningInterval(run_id, int(at), *counts))
        return by_run

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
        require_kept(self.database, "steps", used_in(session_id))
        t, s, a = trial.c, step.c, affordance.c
        these = sa.and_(
            t.session_id == session_id,
            t.tool == tool,
            t.shape == shape,
            t.outcome.in_(COUNTED),
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
        with self.database.reading():
            return tuple(_groups(self._all(counts), self._all(sums)))

    def _all(self, wanted: sa.Select[Any]) -> list[tuple[Any, ...]]:
        """Return all rows of a query."""
        with self.database.reading() as connection:
            return tuples(connection, wanted)


def _groups(
    groups: Iterable[tuple[Any, ...]], steps: Iterable[tuple[Any, ...]]
) -> Iterator[TrialGroup]:
    """Yield the groups with their steps; one without any has none."""
    of: dict[int, list[StepSums]] = {}
    for key, *sums in steps:
        of.setdefault(key, []).append(StepSums(*sums))
    for key, trials, with_rows in groups:
        yield TrialGroup(key, trials, with_rows, tuple(of.get(key, ())))
