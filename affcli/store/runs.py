"""Learning runs as a person keeps them: with a note, with all that used them, and deleted."""

from dataclasses import dataclass

import sqlalchemy as sa

from affcli.core.records import Belongings
from affcli.errors import UsageError, one_line
from affcli.store.connection import Database, numbered, tuples
from affcli.store.tables import (
    affordance,
    behavior,
    experiment,
    learning_run,
    replication,
    session,
    step,
    tool,
    trial,
    verification,
)


@dataclass(frozen=True, slots=True)
class Runs:
    """What is kept of learning runs beside what they learned."""

    database: Database

    def note(self, run_id: int, text: str | None) -> None:
        """Set the note of a learning run, or take it away with None or an empty text.

        Raises:
            UsageError: there is no such run.
        """
        with self.database.writing() as connection:
            _require(connection, run_id)
            found = sa.update(learning_run).filter_by(id=run_id)
            connection.execute(found.values(note=text or None))

    def uses(self) -> dict[int, tuple[int, int]]:
        """Return how many trials and verifications used each run that was used at all."""
        with self.database.reading() as connection:
            trials, verifications = (
                dict(
                    tuples(
                        connection,
                        sa.select(table.c.learning_run_id, sa.func.count()).group_by(
                            table.c.learning_run_id
                        ),
                    )
                )
                for table in (trial, verification)
            )
        used = trials.keys() | verifications.keys()
        return {run: (trials.get(run, 0), verifications.get(run, 0)) for run in used}

    def belongings(self, run_id: int) -> Belongings:
        """Return what would be deleted with a learning run.

        Raises:
            UsageError: there is no such run.
        """
        with self.database.reading() as connection:
            _require(connection, run_id)
            return Belongings(*(_count(connection, *one) for one in _belonging(run_id)))

    def delete(self, run_id: int) -> Belongings:
        """Delete a learning run and all that belongs to it, in one transaction.

        What other runs learned and did stays as it is, and is replayed equal: their trials started
        from tables of their own, and no id is given twice. A session that is left without trials
        goes too, as do tools that no record names any more.

        Returns:
            What was deleted with it.

        Raises:
            UsageError: there is no such run, or it is a part of a reproduction or an experiment, of
                whose robots none may be missing.
        """
        with self.database.writing() as connection:
            part_of = _require(connection, run_id)
            if part_of is not None:
                which = _session_words(connection, part_of)
                raise UsageError(
                    f"run {run_id} is part of {which}, which is kept whole; one that is not wanted "
                    "any more goes with its file"
                )
            used = sa.select(trial.c.session_id).where(trial.c.learning_run_id == run_id)
            sessions = set(connection.scalars(used.distinct()))
            deleted = [
                connection.execute(sa.delete(table).where(condition)).rowcount
                for table, condition in reversed(_belonging(run_id))
            ]
            connection.execute(sa.delete(learning_run).filter_by(id=run_id))
            left = sa.select(trial.c.session_id)
            connection.execute(
                sa.delete(session).where(session.c.id.in_(sessions), session.c.id.not_in(left))
            )
            named = sa.union(
                *(
                    sa.select(column).where(column.is_not(None))
                    for column in (
                        *(learning_run.c.tool_key, trial.c.shape_key),
                        verification.c.shape_key,
                    )
                )
            )
            connection.execute(sa.delete(tool).where(tool.c.key.not_in(named)))
            return Belongings(*reversed(deleted))


def _belonging(run_id: int) -> list[tuple[sa.TableClause, sa.ColumnElement[bool]]]:
    """Return what belongs to a run, in the order of `Belongings`: what refers stands behind."""
    trials = sa.select(trial.c.id).where(trial.c.learning_run_id == run_id)
    verifications = sa.select(verification.c.id).where(verification.c.learning_run_id == run_id)
    return [
        (behavior, behavior.c.learning_run_id == run_id),
        (affordance, affordance.c.learning_run_id == run_id),
        (trial, trial.c.learning_run_id == run_id),
        (step, step.c.trial_id.in_(trials)),
        (verification, verification.c.learning_run_id == run_id),
        (replication, replication.c.verification_id.in_(verifications)),
    ]


def _count(
    connection: sa.Connection, table: sa.TableClause, condition: sa.ColumnElement[bool]
) -> int:
    """Return how many rows of a table there are for which the condition holds."""
    counted = sa.select(sa.func.count()).select_from(table).where(condition)
    return int(connection.scalar(counted) or 0)


def _require(connection: sa.Connection, run_id: int) -> int | None:
    """Return the session that a run is part of; UsageError when there is no such run."""
    wanted = sa.select(learning_run.c.session_id)
    part_of = numbered(connection, wanted, learning_run, "learning run", run_id)["session_id"]
    return None if part_of is None else int(part_of)


def _session_words(connection: sa.Connection, number: int) -> str:
    """Return of what a session is, which has runs of its own: a reproduction, or an experiment."""
    names = sa.select(experiment.c.name).where(
        experiment.c.id == session.c.experiment_id, session.c.id == number
    )
    name = connection.scalar(names)
    return f"reproduction {number}" if name is None else f"experiment {one_line(name)}"
