"""Verifications: the tries of a table's rows that updated its counters (§3.1, §8)."""

from collections.abc import Mapping
from dataclasses import dataclass

import sqlalchemy as sa

from affcli.core.records import StoredReplication
from affcli.core.specs import VerificationSpec
from affcli.core.trial import Truth
from affcli.core.verification import ReplicationRecord, Verdict
from affcli.store import reading, rows
from affcli.store.connection import Database, insert_many, insert_one
from affcli.store.counting import count_use
from affcli.store.learning import insert_tools
from affcli.store.tables import affordance, learning_run, replication, trial, verification


@dataclass(frozen=True, slots=True)
class Verifications:
    """Verifications, with the tries of each."""

    database: Database

    def begin(
        self,
        run_id: int,
        spec: VerificationSpec,
        versions: Mapping[str, str],
        now: str,
        calibration: str | None = None,
    ) -> int:
        """Return the id of a new verification without tries.

        What its table had been through is recorded with it: how often its rows had been used, and
        the latest trial.

        Args:
            run_id: the learning run whose table is tested.
            spec: what it is a function of, beside that table.
            versions: what it is made with.
            now: ISO text, UTC.
            calibration: of the camera it sees through, as JSON; None without one.
        """
        used = sa.select(sa.func.coalesce(sa.func.sum(affordance.c.times_used), 0))
        world = sa.select(learning_run.c.world).filter_by(id=run_id)
        with self.database.writing() as connection:
            insert_tools(connection, spec)
            row = {
                **rows.verification_row(run_id, spec, calibration),
                "world": connection.scalar(world),
                "uses_before": connection.scalar(used.filter_by(learning_run_id=run_id)) or 0,
                "after_trial": connection.scalar(sa.select(sa.func.max(trial.c.id))) or 0,
                "versions": rows.to_json(versions),
                "started_at": now,
            }
            return insert_one(connection, verification, row)

    def save(
        self,
        verification_id: int,
        record: ReplicationRecord,
        truth: Truth | None,
        affordance_id: int,
    ) -> None:
        """Save one try, and the counters it changed, in one transaction.

        Args:
            verification_id: the verification.
            record: what the robot did and saw.
            truth: where the attractor truly was; None in a world that does not tell.
            affordance_id: the row that was tried, in the store.

        Raises:
            DatabaseError: another process changed the row's counters meanwhile; nothing is saved.
        """
        row = rows.replication_row(verification_id, affordance_id, record, truth)
        with self.database.writing() as connection:
            count_use(connection, self.database.path, record, affordance_id, "tries")
            insert_many(connection, replication, [row])

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

    def end(
        self, verification_id: int, verdict: Verdict, decided_after: int | None, now: str
    ) -> None:
        """Save what a verification found.

        Args:
            verification_id: the verification.
            verdict: what the tries said in the end.
            decided_after: after how many tries there was a verdict for the first time.
            now: ISO text, UTC.
        """
        tries = sa.select(
            sa.func.count(), sa.func.coalesce(sa.func.max(replication.c.clock), 0.0)
        ).filter_by(verification_id=verification_id)
        with self.database.writing() as connection:
            count, clock = connection.execute(tries).one()
            found = {"verdict": verdict, "decided_after": decided_after, "finished_at": now}
            connection.execute(
                sa.update(verification)
                .filter_by(id=verification_id)
                .values(tries=count, robot_seconds=clock, **found)
            )
