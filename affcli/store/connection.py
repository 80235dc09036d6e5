"""Transactions on one SQLite connection: they wait for locks, and commit whole or not at all."""

import sqlite3
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar

import sqlalchemy as sa
from sqlalchemy.dialects import sqlite

from affcli.errors import DatabaseError, UsageError, one_line
from affcli.store.columns import COLUMNS, JSON_COLUMNS
from affcli.store.faults import faults_named
from affcli.store.reading import UnreadableError
from affcli.store.waiting import Waiting

Record = TypeVar("Record")
LARGEST = 1e9
"""No length, angle or time of this laboratory is larger; ten thousand hours are 3.6e7 s."""


class Database:
    """The connection that all parts of a store share, and its transactions.

    Args:
        connection: SQLAlchemy's, around `driver`.
        driver: the connection of sqlite3: BEGIN and COMMIT are said here alone.
    """

    def __init__(self, connection: sa.Connection, driver: Waiting) -> None:
        self._connection = connection
        self._driver = driver
        self.left_out: dict[str, None] = {}
        """What was said of records that lists left out, in order, each once."""

    @property
    def path(self) -> Path:
        """The file."""
        return self._driver.path

    @contextmanager
    def reading(self) -> Iterator[sa.Connection]:
        """Give a connection that sees one state of the database throughout.

        Raises:
            DatabaseError: locked too long, or damaged.
        """
        with self._transaction("BEGIN") as connection:
            # BEGIN takes no lock; the first read does.
            self._say("SELECT 1 FROM sqlite_master")
            yield connection

    def mappings(self, wanted: sa.Select[Any]) -> list[dict[str, Any]]:
        """Return all rows of one query, each by the names of its columns.

        Raises:
            DatabaseError: locked too long, or damaged.
        """
        with self.reading() as connection:
            return mappings(connection, wanted)

    def readable(
        self, read: Callable[[Mapping[str, Any]], Record], rows: Iterable[Mapping[str, Any]]
    ) -> Iterator[Record]:
        """Yield the records of a list; one that cannot be read is left out, and named."""
        for row in rows:
            try:
                yield read(row)
            except UnreadableError as error:
                self.left_out[str(error)] = None

    @contextmanager
    def writing(self) -> Iterator[sa.Connection]:
        """Give a connection whose changes are all saved on leaving, or none.

        BEGIN IMMEDIATE: a transaction that begins reading and then wants to write does not wait for
        another writer but fails at once.

        Raises:
            DatabaseError: locked too long, read-only, disk full, damaged.
        """
        with self._transaction("BEGIN IMMEDIATE") as connection:
            yield connection

    @contextmanager
    def _transaction(self, begin: str) -> Iterator[sa.Connection]:
        """Begin, and at the end commit; roll back whatever goes wrong, ctrl-C too.

        Within a transaction that is open already it is a part of that one.
        """
        if self._is_within():
            yield self._connection
            return
        with faults_named(self.path):
            try:
                self._say(begin)
                yield self._connection
                # While others read nobody can commit; the transaction stays open meanwhile.
                self._say("COMMIT")
            finally:
                # A signal that interrupts a statement makes SQLAlchemy close the connection.
                with suppress(sqlite3.Error):
                    if self._is_within():
                        self._driver.execute("ROLLBACK")

    def _is_within(self) -> bool:
        """Tell whether a transaction is open now."""
        return self._driver.in_transaction

    def _say(self, statement: str) -> None:
        """Execute a statement."""
        # Through SQLAlchemy, so that Alembic sees that a transaction has begun and begins none.
        self._connection.exec_driver_sql(statement).close()


def insert_many(
    connection: sa.Connection, table: sa.TableClause, rows: Sequence[tuple[object, ...]]
) -> None:
    """Insert rows given as tuples in the order of `columns.COLUMNS`.

    The driver runs the statement itself: 3.2 times as fast as handing SQLAlchemy the rows (3,500
    behaviors: 15 ms against 48 ms).
    """
    if rows:
        columns = COLUMNS[table.name]
        statement = sa.insert(table).compile(dialect=sqlite.dialect(), column_keys=columns)
        connection.exec_driver_sql(str(statement), list(rows))


def insert_one(
    connection: sa.Connection, table: sa.TableClause, values: Mapping[str, object]
) -> int:
    """Insert one row by the names of its columns; return the id it was given."""
    # By `values`, a name that the table lacks is an error; as parameters it would be left out.
    return int(connection.execute(sa.insert(table).values(dict(values))).lastrowid)


def mappings(connection: sa.Connection, wanted: sa.Select[Any]) -> list[dict[str, Any]]:
    """Return all rows of one query as `tuples` does, each by the names of its columns."""
    names, rows = _checked_rows(connection, wanted)
    return [dict(zip(names, row, strict=True)) for row in rows]


def tuples(connection: sa.Connection, wanted: sa.Select[Any]) -> list[tuple[Any, ...]]:
    """Return all rows of one query.

    Text that is more than text on a terminal or a page is escaped.

    Raises:
        DatabaseError: a number is none that a robot has to do with.
    """
    return list(_checked_rows(connection, wanted)[1])


def _checked_rows(
    connection: sa.Connection, wanted: sa.Select[Any]
) -> tuple[list[str], Iterator[tuple[Any, ...]]]:
    """Return the names of the columns, and the rows one by one."""
    result = connection.execute(wanted)
    names = list(result.keys())
    # All at once: a statement that a check leaves half read would keep its lock.
    return names, (tuple(map(_checked, names, row)) for row in result.all())


def _checked(name: str, value: Any) -> Any:
    """Return a stored value: names are printable, numbers finite and no larger than `LARGEST`."""
    if isinstance(value, float) and not -LARGEST <= value <= LARGEST:
        raise DatabaseError(
            f"a record's {name} is {value:g}, a value that affcli did not write; restore a copy of "
            "the database"
        )
    if isinstance(value, str) and not value.isprintable() and name not in JSON_COLUMNS:
        return one_line(value, sys.maxsize)
    return value


def numbered(
    connection: sa.Connection, wanted: sa.Select[Any], table: sa.TableClause, what: str, number: int
) -> dict[str, Any]:
    """Return the row of a table that has this number.

    Args:
        connection: in a transaction.
        wanted: selects rows of the table.
        table: the table.
        what: one of its rows is, for the message.
        number: its id.

    Raises:
        UsageError: there is none of that number; the message says which there are.
    """
    found = mappings(connection, wanted.where(table.c.id == number))
    if not found:
        # The last id that was given: none is given twice.
        given = sa.text("SELECT CAST(seq AS INTEGER) FROM sqlite_sequence WHERE name = :name")
        last = connection.scalar(given, {"name": table.name}) or 0
        known = f"they are numbered 1 to {last}" if last else "there are none yet"
        known = "it was deleted" if number <= last else known
        raise UsageError(f"no {what} {number}; {known}")
    return found[0]
