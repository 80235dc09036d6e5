"""Experiments by name, each with the sessions of its conditions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.identity import canonical_json
from affcli.core.names import one_of
from affcli.core.records import ExperimentInfo
from affcli.core.specs import SessionSpec
from affcli.errors import UsageError, one_line
from affcli.store import reading, rows
from affcli.store.connection import Database, insert_one, mappings
from affcli.store.tables import experiment, session

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

        Of one that is there only what is not part of its key is taken over: the question, and how
        many robots there are to be.

        Args:
            name: of the experiment.
            key: of all that its robots' lives are functions of.
            definition: as JSON types; kept with it.
            conditions: in order.
            now: ISO text, UTC.

        Returns:
            The stored one, which may have another key: then nothing was written.
        """
        versions = {package: one for _, _, own in conditions for package, one in own.items()}
        with self.database.writing() as connection:
            found = self.find(name)
            if found is not None and (found.key != key or found.definition == definition):
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
        """Return the experiments, oldest first."""
        with self.database.reading() as connection:
            found = mappings(connection, sa.select(experiment).order_by(experiment.c.id))
            return tuple(
                reading.experiment(row, sessions_of(connection, row["id"])) for row in found
            )

    def finish(self, experiment_id: int, now: str) -> None:
        """Mark an experiment and its sessions as done; what was done before stays as it is."""
        with self.database.writing() as connection:
            for table, condition in (
                (experiment, experiment.c.id == experiment_id),
                (session, session.c.experiment_id == experiment_id),
            ):
                connection.execute(
                    sa.update(table)
                    .where(condition, table.c.status == "running")
                    .values(status="done", finished_at=now)
                )


def sessions_of(connection: sa.Connection, number: int) -> list[dict[str, Any]]:
    """Return the sessions of an experiment, in the order of its conditions."""
    wanted = sa.select(session).filter_by(experiment_id=number).order_by(session.c.id)
    return mappings(connection, wanted)
