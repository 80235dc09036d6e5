"""Experiments by name, each with the sessions of its conditions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.identity import canonical_json
from affcli.core.names import one_of
from affcli.core.records import ExperimentInfo
from affcli.core.specs import Keep, SessionSpec
from affcli.errors import UsageError, one_line
from affcli.store import reading, rows
from affcli.store.connection import Database, insert_one, mappings, tuples
from affcli.store.tables import experiment, failed_robot, learning_run, session, trial

Conditions = Sequence[tuple[str, SessionSpec, Mapping[str, str]]]
"""The name, the session and the versions of each condition, in order."""


@dataclass(frozen=True, slots=True)
class Experiments:
    """Experiments by name."""

    database: Database

    def begin(
        self, name: str, key: str, definition: Mapping[str, Any], conditions: Conditions, now: str
    ) -> ExperimentInfo:
        """Return the experiment of a name, new or as far as it came.

        Of one of the same key that is there the question and how many robots there are to be are
        taken over. One of another key is replaced: none of its robots may be saved.

        Args:
            name: of the experiment.
            key: of all that its robots' lives are functions of.
            definition: as JSON types; kept with it.
            conditions: in order.
            now: ISO text, UTC.
        """
        versions = {package: one for _, _, own in conditions for package, one in own.items()}
        with self.database.writing() as connection:
            found = self.find(name)
            if found is not None and found.key != key:
                self._remove(connection, found)
                found = None
            if found is not None and found.definition == definition:
                return found
            row = {
                "name": name,
                "question": definition["experiment"]["question"],
                "definition": canonical_json(definition),
                "key": key,
                "versions": rows.to_json(versions),
                "status": "running",
                "started_at": now,
            }
            if found is None:
                number = insert_one(connection, experiment, row)
                for condition, spec, made_with in conditions:
                    part = {"experiment_id": number, "condition": condition}
                    insert_one(connection, session, rows.session_row(spec, made_with, now) | part)
            else:
                self._change(connection, found, row, conditions)
            return self.named(name)

    def _change(
        self,
        connection: sa.Connection,
        found: ExperimentInfo,
        row: Mapping[str, Any],
        conditions: Conditions,
    ) -> None:
        """Take over another question, or more robots."""
        more = any(
            one["robots"] != spec.robots
            for one, (_, spec, _) in zip(sessions_of(connection, found.id), conditions, strict=True)
        )
        again = {"status": "running", "finished_at": None} if more else {}
        connection.execute(
            sa.update(experiment)
            .filter_by(id=found.id)
            .values(question=row["question"], definition=row["definition"], **again)
        )
        for (_, number), (_, spec, _) in zip(found.conditions, conditions, strict=True):
            connection.execute(
                sa.update(session)
                .filter_by(id=number)
                .values(robots=spec.robots, key=spec.key, **again)
            )

    def _remove(self, connection: sa.Connection, found: ExperimentInfo) -> None:
        """Delete an experiment without robots; the database refuses to delete one that has some."""
        connection.execute(sa.delete(session).filter_by(experiment_id=found.id))
        connection.execute(sa.delete(experiment).filter_by(id=found.id))

    def find(self, name: str) -> ExperimentInfo | None:
        """Return the experiment of a name, None when there is none."""
        return next((one for one in self.all() if one.name == name), None)

    def named(self, name: str) -> ExperimentInfo:
        """Return the experiment of a name; UsageError when there is none, which says which are."""
        known = {one.name: one for one in self.all()}
        if not known:
            raise UsageError(
                f"no experiment {one_line(name, 60)!r}: there is none yet; run affcli experiment"
            )
        return known[one_of("experiment", name, known)]

    def all(self) -> tuple[ExperimentInfo, ...]:
        """Return the experiments that can be read, oldest first."""
        with self.database.reading() as connection:
            found = mappings(connection, sa.select(experiment).order_by(experiment.c.id))
            return tuple(
                self.database.readable(
                    lambda row: reading.experiment(row, sessions_of(connection, row["id"])), found
                )
            )

    def finish(self, experiment_id: int, now: str) -> None:
        """Mark an experiment and its sessions as done if all its robots are; see `settle`."""
        with self.database.writing() as connection:
            settle(connection, sessions_of(connection, experiment_id), now)

    def kept(self, experiment_id: int) -> Keep | None:
        """Return how much of its first robot's life was kept; None when it has no robot yet."""
        of_it = sa.select(session.c.id).filter_by(experiment_id=experiment_id)
        c = learning_run.c
        wanted = sa.select(c.kept).where(c.session_id.in_(of_it)).order_by(c.id).limit(1)
        with self.database.reading() as connection:
            found = connection.scalar(wanted)
        with reading.reading_what_was_written(f"experiment {experiment_id}"):
            return None if found is None else Keep(found)

    def learned(self) -> dict[str, int]:
        """Return how many learning runs the robots of each experiment made, oldest first."""
        runs = (
            sa.select(experiment.c.name, sa.func.count(learning_run.c.id))
            .select_from(
                experiment.join(session, session.c.experiment_id == experiment.c.id).join(
                    learning_run, learning_run.c.session_id == session.c.id
                )
            )
            .group_by(experiment.c.id)
            .order_by(experiment.c.id)
        )
        with self.database.reading() as connection:
            return dict(tuples(connection, runs))


def sessions_of(connection: sa.Connection, number: int) -> list[dict[str, Any]]:
    """Return the sessions of an experiment, in the order of its conditions."""
    wanted = sa.select(session).filter_by(experiment_id=number).order_by(session.c.id)
    return mappings(connection, wanted)


def settle(connection: sa.Connection, sessions: Sequence[Mapping[str, Any]], now: str) -> None:
    """Mark as done what has all its robots, alive or failed, and as running what has not.

    Args:
        connection: in a transaction, in which the robots are counted, too.
        sessions: the rows of all sessions of an experiment, or of a reproduction.
        now: ISO text, UTC.
    """
    first = sessions[0]["id"]
    robots = sa.union(
        *(sa.select(t.c.robot).where(t.c.session_id == first) for t in (trial, failed_robot))
    )
    count = connection.scalar(sa.select(sa.func.count()).select_from(robots.subquery()))
    state = (
        {"status": "done", "finished_at": now}
        if count == sessions[0]["robots"]
        else {"status": "running", "finished_at": None}
    )
    for table, which in (
        (session, session.c.id.in_([one["id"] for one in sessions])),
        (experiment, experiment.c.id == sessions[0]["experiment_id"]),
    ):
        other = table.c.status != state["status"]
        connection.execute(sa.update(table).where(which, other).values(state))
