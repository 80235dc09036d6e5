"""Single records by their numbers: a learning run, a row of its table, a trial."""

import json
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.affordance import Affordance
from affcli.core.observation import SENSOR_KINDS
from affcli.core.trial import Counters, Outcome, Protocol, Survivors, TrialSpec
from affcli.errors import UsageError
from affcli.store.connection import Connected
from affcli.store.learning import LearningRunInfo, info_from
from affcli.store.mapping import affordance_from, reading_what_was_written
from affcli.store.tables import affordance, learning_run, session, trial


@dataclass(frozen=True, slots=True)
class StoredRow:
    """A row of an affordance table, with its counters as they are now.

    Args:
        id: its number in the store.
        run_id: the learning run that made it.
        tool: the tool held then.
        row: what was learned.
    """

    id: int
    run_id: int
    tool: str
    row: Affordance


@dataclass(frozen=True, slots=True)
class TrialInfo:
    """What the store holds of a testing trial, but for its steps.

    Args:
        id: its number in the store.
        session_id, session_kind: the command it is part of.
        run_id: the learning run whose table it used.
        spec: what it is a function of, beside that table.
        settings: of the learning run, as canonical JSON; the sensor is that of `spec`.
        versions: what it was made with.
        outcome: how it ended; None while running or when interrupted.
        steps: how many steps were taken; None as `outcome`.
        robot_seconds: how long it took; None as `outcome`.
        last_survivors: rows left by each search at the query that found none, else None.
    """

    id: int
    session_id: int
    session_kind: str
    run_id: int
    spec: TrialSpec
    settings: str
    versions: dict[str, str]
    outcome: Outcome | None
    steps: int | None
    robot_seconds: float | None
    last_survivors: Survivors | None


class Records(Connected):
    """The part of the store that gives single records by their numbers."""

    def learning_run(self, run_id: int) -> LearningRunInfo:
        """Return a learning run, one of a reproduction too.

        Raises:
            UsageError: there is none of that number; the message says which there are.
        """
        return info_from(self._numbered(learning_run, "learning run", run_id))

    def affordance(self, row_id: int) -> StoredRow:
        """Return a row of an affordance table.

        Raises:
            UsageError: there is none of that number; the message says which there are.
        """
        return stored_row(self._numbered(affordance, "affordance", row_id))

    def affordances(self, run_id: int) -> tuple[StoredRow, ...]:
        """Return the rows of a learning run, oldest first."""
        wanted = sa.select(affordance).filter_by(learning_run_id=run_id)
        return tuple(map(stored_row, self.mappings(wanted.order_by(affordance.c.step))))

    def trial(self, trial_id: int) -> TrialInfo:
        """Return a testing trial.

        Raises:
            UsageError: there is none of that number; the message says which there are.
        """
        self._numbered(trial, "trial", trial_id)
        (found,) = self._trials(trial.c.id == trial_id)
        return found

    def trials(
        self, *, session_id: int | None = None, run_id: int | None = None
    ) -> tuple[TrialInfo, ...]:
        """Return testing trials, oldest first.

        Args:
            session_id: only those of this session.
            run_id: only those that used the table of this learning run.
        """
        conditions = []
        if session_id is not None:
            conditions.append(trial.c.session_id == session_id)
        if run_id is not None:
            conditions.append(trial.c.learning_run_id == run_id)
        return self._trials(*conditions)

    def _trials(self, *conditions: sa.ColumnElement[bool]) -> tuple[TrialInfo, ...]:
        """Return the trials for which all conditions hold."""
        about = (session.c.kind, session.c.versions, learning_run.c.settings)
        wanted = (
            sa.select(trial, *about)
            .select_from(
                # Outer: a trial whose session or learning run is gone is named, not left out.
                trial.outerjoin(session, session.c.id == trial.c.session_id).outerjoin(
                    learning_run, learning_run.c.id == trial.c.learning_run_id
                )
            )
            .where(*conditions)
            .order_by(trial.c.id)
        )
        return tuple(map(_trial_info, self.mappings(wanted)))

    def _numbered(self, table: sa.TableClause, what: str, number: int) -> sa.RowMapping:
        """Return the row of this number; UsageError that says which there are when it is not."""
        with self.reading() as connection:
            row = connection.execute(sa.select(table).filter_by(id=number)).mappings().first()
            last = connection.scalar(sa.select(sa.func.max(table.c.id)))
        if row is None:
            known = f"they are numbered 1 to {last}" if last else "there are none yet"
            raise UsageError(f"no {what} {number}; {known}")
        return row


def stored_row(row: sa.RowMapping) -> StoredRow:
    """Return a row of an affordance table from its columns."""
    with reading_what_was_written(f"affordance {row['id']}"):
        return StoredRow(
            row["id"], row["learning_run_id"], row["tool"], affordance_from(row, as_learned=False)
        )


def _trial_info(row: sa.RowMapping) -> TrialInfo:
    """Return a trial from its columns, those of its session and of its learning run."""
    with reading_what_was_written(f"trial {row['id']}"):
        if row["kind"] is None or row["settings"] is None:
            raise ValueError("its session or learning run is gone")
        return TrialInfo(
            id=row["id"],
            session_id=row["session_id"],
            session_kind=row["kind"],
            run_id=row["learning_run_id"],
            spec=TrialSpec(
                protocol=Protocol(row["protocol"]),
                counters=Counters(row["counters"]),
                sensor=SENSOR_KINDS[SENSOR_KINDS.index(row["sensor"])],
                **{name: row[name] for name in ("tool", "shape", "goal", "start", "seed", "robot")},
            ),
            settings=row["settings"],
            versions=json.loads(row["versions"]),
            outcome=None if row["outcome"] is None else Outcome(row["outcome"]),
            steps=row["steps"],
            robot_seconds=row["robot_seconds"],
            last_survivors=_last_survivors(row),
        )


def _last_survivors(row: Any) -> Survivors | None:
    """Return what each search left at the last query, None when it found a row."""
    left = [row[f"last_rows_{name}"] for name in Survivors._fields]
    return None if None in left else Survivors(*left)
