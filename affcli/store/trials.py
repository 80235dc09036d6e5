"""Testing trials and their steps (§7)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import sqlalchemy as sa

from affcli.core.affordance import PROBABILITY_THRESHOLD
from affcli.core.affordance_table import AffordanceTable
from affcli.core.records import StepScene, StoredStep, TrialInfo
from affcli.core.replay import Difference
from affcli.core.specs import Counters, LearningSpec, Protocol, TrialRecord
from affcli.core.trial import TrialEnd, TrialStep
from affcli.errors import UsageError
from affcli.store import reading, rows
from affcli.store.comparing import by_number, differences
from affcli.store.connection import Database, insert_many, insert_one, mappings, numbered
from affcli.store.keeping import require_kept, run_of
from affcli.store.learning import count_use, insert_tools, selected_runs
from affcli.store.packing import PackedTrial, pack_trial
from affcli.store.tables import (
    affordance,
    learning_run,
    replication,
    session,
    step,
    tool,
    trial,
    verification,
)


@dataclass(frozen=True, slots=True)
class Trials:
    """Testing trials, with the steps of each."""

    database: Database

    def save_all(
        self,
        session_id: int,
        run_id: int,
        trials: Sequence[TrialRecord],
        affordance_ids: Mapping[int, int],
    ) -> list[int]:
        """Save whole trials, with the stored counters that they changed, in one transaction.

        Args:
            session_id: the session they are part of.
            run_id: the learning run whose table they started from.
            trials: from beginning to end.
            affordance_ids: of each row of that table by its learning step.

        Returns:
            Their numbers in the store.
        """
        packed = [pack_trial(record) for record in trials]
        with self.database.writing() as connection:
            numbers = insert_trials(connection, session_id, run_id, packed, affordance_ids)
            for used in (r for r in trials if r.spec.counters is Counters.STORED):
                for one in (step.record for step in used.steps):
                    row_id = affordance_ids[one.row.step]
                    count_use(connection, self.database.path, one, row_id, "trials")
        return numbers

    def trial(self, trial_id: int) -> TrialInfo:
        """Return a testing trial.

        Raises:
            UsageError: there is none of that number; the message says which there are.
        """
        with self.database.reading() as connection:
            numbered(connection, sa.select(trial.c.id), trial, "trial", trial_id)
            return _infos(connection, trial.c.id == trial_id)[0]

    def trials(
        self, *, session_id: int | None = None, run_id: int | None = None, kind: str | None = None
    ) -> tuple[TrialInfo, ...]:
        """Return the trials of a session, of a learning run, of sessions of a kind, or all.

        Those that cannot be read are left out, and those that used a run which cannot be read.
        """
        named = ((trial.c.session_id, session_id), (trial.c.learning_run_id, run_id))
        chosen = [column == value for column, value in named if value is not None]
        if kind is not None:
            of_kind = sa.select(session.c.id).where(session.c.kind == kind)
            chosen.append(trial.c.session_id.in_(of_kind))
        with self.database.reading() as connection:
            learned = dict(self.database.readable(_learned, _used_runs(connection, *chosen)))
            found = [
                row for row in _found(connection, *chosen) if row["learning_run_id"] in learned
            ]
        return tuple(self.database.readable(lambda row: reading.trial(row, learned), found))

    def first_broken(self, session_id: int) -> TrialInfo | None:
        """Return the first trial of a session with a broken tool; None if it has none."""
        adapting = Protocol.TOOL_ADAPTATION.value
        of_session = sa.select(sa.func.min(trial.c.id)).where(
            trial.c.session_id == session_id, trial.c.protocol == adapting
        )
        with self.database.reading() as connection:
            found = _infos(connection, trial.c.id == of_session.scalar_subquery())
        return next(iter(found), None)

    def steps(self, trial_id: int) -> tuple[StoredStep, ...]:
        """Return the steps of a trial with the rows they tried."""
        require_kept(self.database, "steps", run_of(trial_id))
        return self._steps(step.c.trial_id == trial_id, f"trial {trial_id}")

    def steps_of_row(self, row_id: int) -> tuple[StoredStep, ...]:
        """Return the steps that tried a row of an affordance table, by trial and number."""
        return self._steps(step.c.affordance_id == row_id, f"a step that tried affordance {row_id}")

    def _steps(self, condition: sa.ColumnElement[bool], which: str) -> tuple[StoredStep, ...]:
        """Return the steps for which the condition holds, by trial and number."""
        chosen = sa.select(step).where(condition).order_by(step.c.trial_id, step.c.number)
        tried = sa.select(affordance).where(
            affordance.c.id.in_(sa.select(step.c.affordance_id).where(condition))
        )
        with self.database.reading() as connection:
            steps = mappings(connection, chosen)
            found = mappings(connection, tried)
        with reading.reading_what_was_written(which):
            made = {row["id"]: reading.affordance(row) for row in found}
            return tuple(
                reading.stored_step(
                    row,
                    replace(
                        made[row["affordance_id"]],
                        times_used=row["times_used_before"],
                        times_successful=row["times_successful_before"],
                    ),
                )
                for row in steps
            )

    def scene(self, trial_id: int, number: int) -> StepScene:
        """Return one step of a trial.

        Raises:
            UsageError: no such trial, or no such step in it, or its world does not tell where the
                attractor truly was.
        """
        info, steps = self.trial(trial_id), self.steps(trial_id)
        if not 1 <= number <= len(steps):
            known = f"it has steps 1 to {len(steps)}" if steps else "it has none"
            raise UsageError(f"no step {number} in trial {trial_id}; {known}")
        this, spec = steps[number - 1], info.spec
        if this.true_start is None or this.true_end is None:
            raise UsageError(f"trial {trial_id}: its world does not tell where the attractor was")
        return StepScene(
            *(f"Trial {trial_id}, step {number} of {len(steps)}", (trial_id, number)),
            learned=info.learned,
            tool=spec.tool,
            held=spec.held,
            goal=spec.task.goal,
            seed=spec.seed,
            robot=spec.robot,
            wrist_before=steps[number - 2].wrist_end if number > 1 else None,
            wrist_start=this.wrist_start,
            wrist_end=this.wrist_end,
            attractor_start=this.true_start,
            attractor_end=this.true_end,
            binding=this.row.binding,
            call=this.row.exploratory,
            blocked=this.status is None,
        )

    def table_before(self, trial_id: int) -> tuple[AffordanceTable, dict[int, int]]:
        """Return the affordance table that a trial which updates the stored counters began with.

        A row has been used once when it was made, and once in each step of such trials and each try
        of such verifications before. Of two that ran at the same time the one begun first is taken
        to have ended first.

        Returns:
            The table; and the id of each row in the store by its learning step.
        """
        t, s, v, tried = trial.c, step.c, verification.c, replication.c
        run = sa.select(t.learning_run_id).where(t.id == trial_id).scalar_subquery()
        uses = (
            sa.select(s.affordance_id, s.replicated)
            .select_from(step.join(trial, t.id == s.trial_id))
            .where(t.learning_run_id == run, t.id < trial_id, t.counters == Counters.STORED.value)
            .union_all(
                sa.select(tried.affordance_id, tried.replicated)
                .select_from(replication.join(verification, v.id == tried.verification_id))
                .where(v.learning_run_id == run, v.after_trial < trial_id)
            )
            .subquery()
        )
        sums = sa.select(
            uses.c.affordance_id, sa.func.count(), sa.func.sum(uses.c.replicated)
        ).group_by(uses.c.affordance_id)
        with self.database.reading() as connection:
            wanted = sa.select(affordance).where(affordance.c.learning_run_id == run)
            learned = mappings(connection, wanted)
            used = {row_id: (tries, good) for row_id, tries, good in connection.execute(sums)}
        uses_of = ((row, *used.get(row["id"], (0, 0))) for row in learned)
        table = reading.affordance_table(
            f"the affordance table before trial {trial_id}",
            (
                {**row, "times_used": 1 + n, "times_successful": 1 + good}
                for row, n, good in uses_of
            ),
            self.trial(trial_id).learned,
        )
        return table, {row["step"]: row["id"] for row in learned}

    def excluded_before(
        self, trial_id: int, threshold: float = PROBABILITY_THRESHOLD
    ) -> frozenset[int]:
        """Return the rows that a trial found excluded: their ids in the store.

        Empty for a trial that started from the table as learned.

        Args:
            trial_id: the trial.
            threshold: of its planner: rows of this replication probability or less are excluded.
        """
        counters = sa.select(trial.c.counters).where(trial.c.id == trial_id)
        with self.database.reading() as connection:
            if connection.scalar(counters) != Counters.STORED.value:
                return frozenset()
        table, ids = self.table_before(trial_id)
        probable = table.more_probable_than(threshold)
        return frozenset(
            ids[row.step] for row, kept in zip(table, probable, strict=True) if not kept
        )

    def differences(
        self,
        trial_id: int,
        steps: Sequence[TrialStep],
        end: TrialEnd | None,
        affordance_ids: Mapping[int, int],
    ) -> tuple[Difference, ...]:
        """Return where a trial that was done again differs from its record.

        Args:
            trial_id: the record.
            steps: what was done.
            end: how it ended; None when that is not to be compared.
            affordance_ids: of each row of the table by its learning step.
        """
        require_kept(self.database, "steps", run_of(trial_id))
        again = {
            one.record.number: rows.step_row(trial_id, affordance_ids[one.record.row.step], *one)
            for one in steps
        }
        with self.database.reading() as connection:
            wanted = sa.select(step).filter_by(trial_id=trial_id)
            kept = by_number(mappings(connection, wanted), "number")
            (ending,) = mappings(connection, sa.select(trial).filter_by(id=trial_id))
        ended = {} if end is None else rows.trial_end_row(end)
        return (
            *differences("step", kept, again),
            *(
                Difference(0, column, ending[column], value)
                for column, value in ended.items()
                if ending[column] != value
            ),
        )


def insert_trials(
    connection: sa.Connection,
    session_id: int,
    run_id: int,
    trials: Sequence[PackedTrial],
    affordance_ids: Mapping[int, int],
) -> list[int]:
    """Insert trials with their steps; return the trials' numbers."""
    insert_tools(connection, *trials)
    numbers: list[int] = []
    steps: list[rows.Row] = []
    for packed in trials:
        part_of = {"session_id": session_id, "learning_run_id": run_id}
        trial_id = insert_one(connection, trial, {**packed.row, **part_of})
        numbers.append(trial_id)
        steps += [
            (trial_id, affordance_ids[tried], *row)
            for tried, row in zip(packed.tried, packed.steps, strict=True)
        ]
    insert_many(connection, step, steps)
    return numbers


def _infos(connection: sa.Connection, *conditions: sa.ColumnElement[bool]) -> tuple[TrialInfo, ...]:
    """Return the trials for which all conditions hold, oldest first."""
    learned = dict(map(_learned, _used_runs(connection, *conditions)))
    return tuple(reading.trial(row, learned) for row in _found(connection, *conditions))


def _learned(row: reading.Columns) -> tuple[int, LearningSpec]:
    """Return what a learning run is a function of, by its number."""
    return row["id"], reading.learning_run(row).spec


def _used_runs(
    connection: sa.Connection, *conditions: sa.ColumnElement[bool]
) -> list[dict[str, Any]]:
    """Return the rows of the learning runs whose tables were used in some trials."""
    used = sa.select(trial.c.learning_run_id).where(*conditions)
    return mappings(connection, selected_runs().where(learning_run.c.id.in_(used)))


def _found(connection: sa.Connection, *conditions: sa.ColumnElement[bool]) -> list[dict[str, Any]]:
    """Return the rows of some trials, oldest first."""
    wanted = (
        sa.select(trial, session.c.versions, tool.c.definition)
        .select_from(
            trial.join(session, session.c.id == trial.c.session_id).outerjoin(
                tool, tool.c.key == trial.c.shape_key
            )
        )
        .where(*conditions)
        .order_by(trial.c.id)
    )
    return mappings(connection, wanted)
