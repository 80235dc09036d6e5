"""Verifications: the tries of a table's rows that updated its counters (§3.1, §8)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sqlalchemy as sa

from affcli.core.records import StoredReplication
from affcli.core.specs import VerificationSpec
from affcli.core.trial import Truth
from affcli.core.verification import Evidence, ReplicationRecord, decided_after
from affcli.store import reading, rows
from affcli.store.connection import Database, insert_many, insert_one
from affcli.store.learning import count_use, insert_tools
from affcli.store.tables import affordance, learning_run, replication, trial, verification

Try = tuple[ReplicationRecord, Truth | None, int]
"""What the robot did and saw, where the attractor truly was where the world can tell, and the row
that was tried, in the store."""


@dataclass(frozen=True, slots=True)
class Verifications:
    """Verifications, with the tries of each."""

    database: Database

    def save(
        self,
        run_id: int,
        spec: VerificationSpec,
        tries: Sequence[Try],
        versions: Mapping[str, str],
        started_at: str,
        finished_at: str,
        calibration: str | None = None,
    ) -> int:
        """Save a whole verification, with the counters that it changed, in one transaction.

        What its table had been through is recorded with it: how often its rows had been used, and
        the latest trial.

        Args:
            run_id: the learning run whose table was tested.
            spec: what it is a function of, beside that table.
            tries: what was done, in order.
            versions: what it was made with.
            started_at, finished_at: ISO text, UTC.
            calibration: of the camera it saw through, as JSON; None without one.

        Returns:
            Its number in the store.

        Raises:
            DatabaseError: another process changed a row's counters meanwhile; nothing is saved.
        """
        used = sa.select(sa.func.coalesce(sa.func.sum(affordance.c.times_used), 0))
        world = sa.select(learning_run.c.world).filter_by(id=run_id)
        records = [record for record, _, _ in tries]
        with self.database.writing() as connection:
            insert_tools(connection, spec)
            row = {
                **rows.verification_row(run_id, spec, calibration),
                "world": connection.scalar(world),
                "uses_before": connection.scalar(used.filter_by(learning_run_id=run_id)) or 0,
                "after_trial": connection.scalar(sa.select(sa.func.max(trial.c.id))) or 0,
                "versions": rows.to_json(versions),
                "started_at": started_at,
                "finished_at": finished_at,
                "tries": len(records),
                "robot_seconds": records[-1].clock if records else 0.0,
                "verdict": Evidence.of(records).verdict,
                "decided_after": decided_after(records),
            }
            number = insert_one(connection, verification, row)
            for record, _, row_id in tries:
                count_use(connection, self.database.path, record, row_id, "verifications")
            done = [
                rows.replication_row(number, row_id, one, truth) for one, truth, row_id in tries
            ]
            insert_many(connection, replication, done)
        return number

    def of_row(self, row_id: int) -> tuple[StoredReplication, ...]:
        """Return the tries of a row in stored verifications, oldest first."""
        r, v = replication.c, verification.c
        wanted = (
            sa.select(replication, v.shape)
            .select_from(replication.join(verification, v.id == r.verification_id))
            .where(r.affordance_id == row_id)
            .order_by(r.verification_id, r.number)
        )
        return tuple(map(reading.stored_replication, self.database.mappings(wanted)))
