"""Verifications in the store: the tries of a table's rows that updated its counters (§3.1, §8)."""

from collections.abc import Mapping

import sqlalchemy as sa

from affcli.core.observation import Movement
from affcli.core.trial import Truth
from affcli.core.verification import ReplicationRecord, Tried, Verdict, VerificationSpec
from affcli.store.connection import Connected, insert_one
from affcli.store.counting import count_use
from affcli.store.mapping import reading_what_was_written, replication_row, to_json
from affcli.store.rows import VerificationRow
from affcli.store.tables import affordance, replication, trial, verification


class Verifications(Connected):
    """The part of the store that keeps verifications and their tries."""

    def begin_verification(
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
        with self.writing() as connection:
            row = VerificationRow(
                learning_run_id=run_id,
                shape=spec.shape,
                seed=spec.seed,
                sensor=spec.sensor,
                calibration=calibration,
                tries_wanted=spec.tries,
                until_verdict=spec.until_verdict,
                uses_before=connection.scalar(used.filter_by(learning_run_id=run_id)) or 0,
                after_trial=connection.scalar(sa.select(sa.func.max(trial.c.id))) or 0,
                versions=to_json(versions),
                started_at=now,
            )
            return insert_one(connection, verification, row)

    def save_replication(
        self, verification_id: int, record: ReplicationRecord, truth: Truth, affordance_id: int
    ) -> None:
        """Save one try, and the counters it changed, in one transaction.

        Args:
            verification_id: the verification.
            record: what the robot did and saw.
            truth: where the attractor truly was.
            affordance_id: the row that was tried, in the store.

        Raises:
            DatabaseError: another process changed the row's counters meanwhile; nothing is saved.
        """
        row = replication_row(verification_id, affordance_id, record, truth)
        with self.writing() as connection:
            count_use(connection, self.path, record, affordance_id, "tries")
            insert_one(connection, replication, row)

    def row_tries(self, row_id: int) -> tuple[Tried, ...]:
        """Return the tries of a row in stored verifications, oldest first."""
        r, v = replication.c, verification.c
        wanted = (
            sa.select(replication, v.shape)
            .select_from(replication.join(verification, v.id == r.verification_id))
            .where(r.affordance_id == row_id)
            .order_by(r.verification_id, r.number)
        )
        with reading_what_was_written(f"a try of affordance {row_id}"):
            return tuple(map(_tried, self.mappings(wanted)))

    def end_verification(
        self,
        verification_id: int,
        verdict: Verdict,
        decided_after: int | None,
        now: str,
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
        with self.writing() as connection:
            count, clock = connection.execute(tries).one()
            connection.execute(
                sa.update(verification)
                .filter_by(id=verification_id)
                .values(
                    verdict=verdict,
                    tries=count,
                    decided_after=decided_after,
                    robot_seconds=clock,
                    finished_at=now,
                )
            )


def _tried(row: sa.RowMapping) -> Tried:
    """Return a try from its columns and the shape that was held."""
    return Tried(
        verification=row["verification_id"],
        number=row["number"],
        shape=row["shape"],
        expected=Movement(row["expected_dx"], row["expected_dy"], 0.0),
        seen=Movement(row["seen_dx"], row["seen_dy"], 0.0),
        replicated=bool(row["replicated"]),
        blocked=row["status"] is None,
        died=bool(row["died"]),
        before=(row["times_successful_before"], row["times_used_before"]),
        after=(row["times_successful_after"], row["times_used_after"]),
    )
