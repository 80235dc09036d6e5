"""Does what is done again equal its record? Column by column, to the bit."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import sqlalchemy as sa

from affcli.core.affordance_table import AffordanceTable
from affcli.core.replay import Difference
from affcli.core.trial import BabblingRecord, Counters, Survivors, TrialEnd, TrialStep, Truth
from affcli.store.connection import Connected
from affcli.store.mapping import (
    affordance_from,
    affordance_row,
    behavior_row,
    reading_what_was_written,
    step_row,
    trial_end_columns,
)
from affcli.store.rows import AFFORDANCE_COLUMNS
from affcli.store.tables import affordance, behavior, replication, step, trial, verification

COUNTERS = frozenset({"times_used", "times_successful"})
"""Trials change them after a row is made."""
LAST_ROWS = tuple(f"last_rows_{name}" for name in Survivors._fields)
"""Of a trial; empty but for one that found no row."""


class Comparing(Connected):
    """The part of the store that holds what is done again against the record."""

    def table_before(self, trial_id: int) -> tuple[AffordanceTable, dict[int, int]]:
        """Return the affordance table that a trial which updates the stored counters began with.

        A row has been used once when it was made, and once in each step of such trials and each try
        of such verifications before. Of two that ran at the same time the one begun first is taken
        to have ended first.

        Returns:
            The table; and the id of each row in the store by its learning step.
        """
        t, s, a, v, tried = trial.c, step.c, affordance.c, verification.c, replication.c
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
        with self.reading() as connection:
            rows = connection.execute(sa.select(affordance).where(a.learning_run_id == run))
            learned = rows.mappings().all()
            used = {row_id: (tries, good) for row_id, tries, good in connection.execute(sums)}
        with reading_what_was_written(f"the affordance table before trial {trial_id}"):
            rows_then = []
            for row in learned:
                tries, good = used.get(row["id"], (0, 0))
                counters = {"times_used": 1 + tries, "times_successful": 1 + good}
                rows_then.append(affordance_from({**row, **counters}, as_learned=False))
            table = AffordanceTable(rows_then)
        return table, {row["step"]: row["id"] for row in learned}

    def trial_differences(
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
        again = {
            one.record.number: step_row(trial_id, affordance_ids[one.record.row.step], *one)
            for one in steps
        }
        with self.reading() as connection:
            wanted = sa.select(step).filter_by(trial_id=trial_id).order_by(step.c.number)
            stored = {row["number"]: row for row in connection.execute(wanted).mappings()}
            ending = connection.execute(sa.select(trial).filter_by(id=trial_id)).mappings().one()
        found = list(_differences(stored, again))
        if end is not None:
            ended = dict.fromkeys(LAST_ROWS) | trial_end_columns(end)
            found += [
                Difference(0, column, ending[column], value)
                for column, value in ended.items()
                if ending[column] != value
            ]
        return tuple(found)

    def behavior_differences(
        self, run_id: int, tool: str, steps: Sequence[tuple[BabblingRecord, Truth]]
    ) -> tuple[Difference, ...]:
        """Return where behaviors of a learning run that were done again differ from their record.

        The rows they made are compared too, but for the counters, which trials change.

        Args:
            run_id: the record.
            tool: the tool held.
            steps: what was done: behaviors that follow one another.
        """
        if not steps:
            return ()
        first, last = steps[0][0].step, steps[-1][0].step
        again = {record.step: behavior_row(run_id, record, truth) for record, truth in steps}
        made = {
            record.step: affordance_row(run_id, tool, record.affordance)
            for record, _ in steps
            if record.affordance is not None
        }
        with self.reading() as connection:
            stored, rows = (
                {
                    row["step"]: row
                    for row in connection.execute(
                        sa.select(table)
                        .filter_by(learning_run_id=run_id)
                        .where(table.c.step.between(first, last))
                    ).mappings()
                }
                for table in (behavior, affordance)
            )
        found = list(_differences(stored, again))
        for number in sorted(rows.keys() | made.keys()):
            values = dict(zip(AFFORDANCE_COLUMNS, made.get(number, ()), strict=False))
            for column in AFFORDANCE_COLUMNS:
                kept = rows[number][column] if number in rows else None
                if column not in COUNTERS and kept != values.get(column):
                    found.append(Difference(number, column, kept, values.get(column)))
        return tuple(found)


def _differences(stored: Mapping[int, Any], again: Mapping[int, Any]) -> Iterator[Difference]:
    """Yield where rows differ, by number and column."""
    for number in sorted(stored.keys() | again.keys()):
        if number not in stored or number not in again:
            yield Difference(
                number, "number", *(number if number in x else None for x in (stored, again))
            )
            continue
        for column, value in again[number]._asdict().items():
            if stored[number][column] != value:
                yield Difference(number, column, stored[number][column], value)
