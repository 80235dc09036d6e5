"""Rows and records chosen by what they are about: to be listed, or taken out whole."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import sqlalchemy as sa

from affcli.core.records import StoredRow
from affcli.core.row_filter import Cell, Column, Relation, RowFilter
from affcli.store.connection import Database
from affcli.store.keeping import require_kept
from affcli.store.reading import stored_row
from affcli.store.rows import params_to_json
from affcli.store.tables import affordance, behavior, learning_run, step, trial, wide

Made = TypeVar("Made")


@dataclass(frozen=True, slots=True)
class Selections:
    """What filters leave: rows to be listed, records to be taken out whole."""

    database: Database

    def rows(self, wanted: RowFilter) -> tuple[StoredRow, ...]:
        """Return the rows that the filter leaves, run by run, oldest first.

        Raises:
            UsageError: those of one of its learning runs were not kept.
        """
        require_kept(self.database, "rows", _learned_in(learning_run.c.id, wanted))
        ids = _rows(wanted).with_only_columns(wide.c.id)
        rows = (
            sa.select(affordance)
            .where(affordance.c.id.in_(ids))
            .order_by(affordance.c.learning_run_id, affordance.c.id)
        )
        return tuple(map(stored_row, self.database.mappings(rows)))

    def extract(
        self,
        what: Relation,
        wanted: RowFilter,
        write: Callable[[Sequence[Column], Iterator[tuple[Cell, ...]]], Made],
    ) -> Made:
        """Return what `write` makes of all columns of what the filter leaves.

        It is given the values one row after the other, as they stand in the database and of one
        state of it: there may be more than the memory holds.

        Args:
            what: of which view or table.
            wanted: for all but ``rows`` only its runs, tool and limit count.
            write: makes something of the columns and their values.

        Raises:
            UsageError: of one of its learning runs they were not kept.
        """
        require_kept(self.database, what, _learned_in(learning_run.c.id, wanted))
        statement, relation = _STATEMENTS[what](wanted), _RELATIONS[what]
        with self.database.reading() as connection:
            described = connection.exec_driver_sql(f"PRAGMA table_info({relation.name})").all()
            columns = [Column(name, _kind(declared)) for _, name, declared, *_ in described]
            return write(columns, (tuple(row) for row in connection.execute(statement)))


def _kind(declared: str) -> type[int] | type[float] | type[str]:
    """Return the kind of a column's values; what a view computes has no type and is a number."""
    return {"INTEGER": int, "TEXT": str}.get(declared, float)


def _rows(wanted: RowFilter) -> sa.Select[Any]:
    """Select the rows of the affordance tables."""
    c = wide.c
    statement = _whole(wide, wanted).where(_learned_in(c.run, wanted)).order_by(c.run, c.id)
    if wanted.behavior is not None:
        statement = statement.where(c.exploratory_behavior == wanted.behavior.name)
        if wanted.behavior.params:
            params = params_to_json(wanted.behavior)
            statement = statement.where(c.exploratory_params == params)
    for comparison, bound in wanted.probability:
        statement = statement.where(c.replication_probability.op(comparison)(bound))
    return statement


def _behaviors(wanted: RowFilter) -> sa.Select[Any]:
    """Select the exploratory behaviors of learning."""
    c = behavior.c
    made = _learned_in(c.learning_run_id, wanted)
    return _whole(behavior, wanted).where(made).order_by(c.learning_run_id, c.step)


def _trials(wanted: RowFilter) -> sa.Select[Any]:
    """Select the testing trials that used the tables."""
    c = trial.c
    return _whole(trial, wanted).where(_learned_in(c.learning_run_id, wanted)).order_by(c.id)


def _steps(wanted: RowFilter) -> sa.Select[Any]:
    """Select the steps of these trials."""
    c = step.c
    tried = sa.select(trial.c.id).where(_learned_in(trial.c.learning_run_id, wanted))
    return _whole(step, wanted).where(c.trial_id.in_(tried)).order_by(c.trial_id, c.number)


_STATEMENTS: dict[Relation, Callable[[RowFilter], sa.Select[Any]]] = {
    "rows": _rows,
    "behaviors": _behaviors,
    "trials": _trials,
    "steps": _steps,
}
_RELATIONS: dict[Relation, sa.TableClause] = {
    "rows": wide,
    "behaviors": behavior,
    "trials": trial,
    "steps": step,
}


def _whole(relation: sa.TableClause, wanted: RowFilter) -> sa.Select[Any]:
    """Select all columns, also those that a later schema adds, of so many rows as are wanted."""
    return sa.select(sa.text("*")).select_from(relation).limit(wanted.limit)


def _learned_in(column: sa.ColumnClause[Any], wanted: RowFilter) -> sa.ColumnElement[bool]:
    """Tell whether a column names one of the learning runs that are wanted."""
    runs = sa.select(learning_run.c.id)
    if wanted.runs is not None:
        runs = runs.where(learning_run.c.id.in_(wanted.runs))
    if wanted.tool is not None:
        runs = runs.where(learning_run.c.tool == wanted.tool)
    return column.in_(runs)
