"""Sessions: commands that produced trials; those of experiments, with the lives of their robots."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.records import FailedRobot, SessionInfo
from affcli.core.specs import REPRODUCE, RobotRecord, SessionSpec
from affcli.store import reading, rows
from affcli.store.connection import Database, insert_many, insert_one, mappings, numbered
from affcli.store.experiments import settle
from affcli.store.inventions import Inventions
from affcli.store.learning import insert_run
from affcli.store.packing import PackedRobot, pack_robot
from affcli.store.tables import affordance, behavior, borrowed, failed_robot, mask, session, trial
from affcli.store.trials import insert_trials


@dataclass(frozen=True, slots=True)
class Sessions:
    """Sessions, and the robots of reproductions and experiments."""

    database: Database

    def begin(self, spec: SessionSpec, versions: Mapping[str, str], now: str) -> int:
        """Return the id of a new session; of a reproduction begun before, that of the old one.

        Args:
            spec: what it is a function of.
            versions: what it is made with.
            now: ISO text, UTC.
        """
        with self.database.writing() as connection:
            if spec.kind == REPRODUCE:
                found = connection.execute(_like(spec)).first()
                if found is not None:
                    return int(found.id)
            return insert_one(connection, session, rows.session_row(spec, versions, now))

    def all(self, *kinds: str) -> tuple[SessionInfo, ...]:
        """Return the sessions that can be read, all or of some kinds, oldest first."""
        wanted = sa.select(session).order_by(session.c.id)
        if kinds:
            wanted = wanted.where(session.c.kind.in_(kinds))
        return tuple(self.database.readable(reading.session, self.database.mappings(wanted)))

    def one(self, number: int) -> SessionInfo:
        """Return a session.

        Raises:
            UsageError: there is none of that number; the message says which there are.
        """
        with self.database.reading() as connection:
            found = numbered(connection, sa.select(session), session, "session", number)
        return reading.session(found)

    def finish(self, session_id: int, now: str) -> None:
        """Mark a session as done; one that was done before stays as it is."""
        with self.database.writing() as connection:
            connection.execute(
                sa.update(session)
                .filter_by(id=session_id, status="running")
                .values(status="done", finished_at=now)
            )

    def settle(self, session_id: int, now: str) -> None:
        """Mark a reproduction as done if all its robots are; see `affcli.store.experiments`."""
        with self.database.writing() as connection:
            wanted = sa.select(session).filter_by(id=session_id)
            settle(connection, mappings(connection, wanted), now)

    def saved_robots(self, session_id: int) -> frozenset[int]:
        """Return the numbers of the robots that a session has saved already."""
        wanted = sa.select(trial.c.robot).distinct().where(trial.c.session_id == session_id)
        with self.database.reading() as connection:
            return frozenset(connection.scalars(wanted))

    def failed_robots(self, session_id: int) -> tuple[FailedRobot, ...]:
        """Return the robots of a session that failed; of an experiment's all that did in it."""
        first = sa.select(sa.func.min(session.c.id)).where(
            session.c.experiment_id
            == sa.select(session.c.experiment_id).filter_by(id=session_id).scalar_subquery()
        )
        owner = sa.func.coalesce(first.scalar_subquery(), session_id)
        wanted = sa.select(failed_robot).where(failed_robot.c.session_id == owner)
        return tuple(
            FailedRobot(*(row[name] for name in ("robot", "kind", "message", "tries", "traceback")))
            for row in self.database.mappings(wanted.order_by(failed_robot.c.robot))
        )

    def save_failure(self, session_id: int, failed: FailedRobot, now: str) -> None:
        """Note that a robot failed, in the place of an earlier note; not if it lives by now.

        Args:
            session_id: of the first condition.
            failed: who, and what went wrong.
            now: ISO text, UTC.
        """
        with self.database.writing() as connection:
            forget_failure(connection, session_id, failed.robot)
            is_there = sa.select(trial.c.id).filter_by(session_id=session_id, robot=failed.robot)
            if connection.execute(is_there.limit(1)).first() is None:
                row = {**asdict(failed), "session_id": session_id, "failed_at": now}
                connection.execute(sa.insert(failed_robot).values(row))

    def save_robot(
        self,
        sessions: Mapping[int, Mapping[str, str]],
        robot: RobotRecord | PackedRobot,
        now: str,
    ) -> bool:
        """Save the whole life of one robot in one transaction.

        A learning run that several conditions used is kept once, with the first of them.

        Args:
            sessions: those of the conditions, in their order, each with what it was made with.
            robot: its learning runs and its trials; packed when another process lived them.
            now: ISO text, UTC.

        Returns:
            False when this robot was saved before; nothing is written then.
        """
        packed = robot if isinstance(robot, PackedRobot) else pack_robot(robot)
        ids = tuple(sessions)
        with self.database.writing() as connection:
            is_there = sa.select(trial.c.id).filter_by(session_id=ids[0], robot=packed.robot)
            if connection.execute(is_there.limit(1)).first() is not None:
                return False
            forget_failure(connection, ids[0], packed.robot)
            for run in packed.runs:
                owner = ids[min(run.trials)]
                row = {
                    **rows.learning_run_row(run.spec, sessions[owner], now, owner),
                    "status": "done",
                    "finished_at": now,
                    "calibration": run.calibration,
                    "kept": run.kept.value,
                    **run.sums,
                }
                run_id = insert_run(connection, row, run.spec)
                insert_many(connection, behavior, [(run_id, *one) for one in run.behaviors])
                insert_many(connection, affordance, [(run_id, *one) for one in run.affordances])
                insert_many(connection, borrowed, [(run_id, *one) for one in run.borrowed])
                insert_many(connection, mask, [(run_id, *one) for one in run.mask])
                Inventions(self.database).save(run_id, run.inventions)
                rows_of = _affordance_ids(connection, run_id)
                for condition, trials in run.trials.items():
                    insert_trials(connection, ids[condition], run_id, trials, rows_of)
            return True


def forget_failure(connection: sa.Connection, session_id: int, robot: int) -> None:
    """Delete the note that a robot failed, if there is one."""
    connection.execute(sa.delete(failed_robot).filter_by(session_id=session_id, robot=robot))


def _affordance_ids(connection: sa.Connection, run_id: int) -> dict[int, int]:
    """Return the ids of a run's affordances by learning step."""
    columns = sa.select(affordance.c.step, affordance.c.id).filter_by(learning_run_id=run_id)
    return {row.step: row.id for row in connection.execute(columns)}


def _like(spec: SessionSpec) -> sa.Select[Any]:
    """Select the sessions of a spec, latest first."""
    same = sa.select(session).filter_by(kind=spec.kind, key=spec.key)
    return same.order_by(session.c.id.desc())
