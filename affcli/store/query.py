"""One SELECT that a person wrote, run so that it can neither change nor hang anything."""

import sqlite3
import time
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path
from typing import NoReturn

from affcli.bounded import LARGEST_VALUE
from affcli.core.row_filter import Cell
from affcli.errors import BadInputError, one_line
from affcli.store.database_file import (
    look,
    opened,
    require_current,
    require_place,
    require_something,
)
from affcli.store.faults import result_code
from affcli.store.waiting import LONGEST_WAIT, PRIMARY, Waiting

MAX_ROWS = 10_000
MAX_SECONDS = 2.0
LARGEST_RESULT = 64_000_000
"""Bytes of text and blobs in the whole result."""
OPCODES_BETWEEN_LOOKS = 100
"""How many steps of SQLite's machine pass between two looks at the clock."""

LIMITS = {
    sqlite3.SQLITE_LIMIT_SQL_LENGTH: 100_000,
    sqlite3.SQLITE_LIMIT_LIKE_PATTERN_LENGTH: 500,
    sqlite3.SQLITE_LIMIT_EXPR_DEPTH: 200,
    sqlite3.SQLITE_LIMIT_COMPOUND_SELECT: 100,
    sqlite3.SQLITE_LIMIT_COLUMN: 1_000,
    sqlite3.SQLITE_LIMIT_ATTACHED: 0,
}

ALLOWED = frozenset(
    {
        sqlite3.SQLITE_SELECT,
        sqlite3.SQLITE_READ,
        sqlite3.SQLITE_FUNCTION,
        sqlite3.SQLITE_RECURSIVE,
    }
)
"""All that a query may do. To open the file read-only would not be enough: ATTACH and VACUUM INTO
would still write others; and after a kill it must first be set right from its journal."""

FORBIDDEN_FUNCTIONS = frozenset({"load_extension", "fts3_tokenizer", "readfile", "writefile"})

MENDED = {
    sqlite3.SQLITE_ERROR: "{error}",
    sqlite3.SQLITE_AUTH: "{error}; only SELECT is allowed, the database is opened to be read",
    sqlite3.SQLITE_INTERRUPT: "stopped after {seconds} s; ask for less (where, limit)",
    sqlite3.SQLITE_TOOBIG: f"a value of more than {LARGEST_VALUE} bytes; ask for less",
}
"""What is said of what a person can mend, by SQLite's result code."""


@dataclass(frozen=True, slots=True)
class QueryResult:
    """What a query gave.

    Args:
        columns: their names.
        rows: their values.
        truncated: there were more rows than were asked for, or than fit.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    truncated: bool

    @property
    def names(self) -> list[str]:
        """The names of the columns, a repeated one with its number: a, a 2, a 3."""
        names: list[str] = []
        for column in self.columns:
            numbered = (f"{column} {number}" for number in count(2))
            names.append(next(name for name in chain([column], numbered) if name not in names))
        return names


def run_sql(
    path: Path,
    text: str,
    *,
    max_seconds: float = MAX_SECONDS,
    max_rows: int = MAX_ROWS,
    timeout: float = LONGEST_WAIT,
) -> QueryResult:
    """Run one SELECT.

    Args:
        path: the database.
        text: one statement.
        max_seconds: it is stopped after these.
        max_rows: no more rows are returned.
        timeout: seconds to wait for a lock that another process holds.

    Raises:
        BadInputError: not one SELECT; an error in it; too long, too large.
        DatabaseError: the database cannot be read.
    """
    require_place(path, create=False, write=False)
    with opened(path, "rw", timeout) as driver:
        require_current(require_something(look(driver), path), path)
        # Waits for a lock now, outside the time of the query; ends when the file is closed.
        driver.execute("BEGIN")
        driver.execute("SELECT 1 FROM sqlite_master")
        _confine(driver)
        return _run(driver, text, max_seconds, max_rows)


def _confine(driver: Waiting) -> None:
    """Let the connection do nothing from now on but read values of a limited size."""
    driver.execute("PRAGMA query_only = ON")
    driver.execute("PRAGMA trusted_schema = OFF")
    for limit, value in LIMITS.items():
        driver.setlimit(limit, value)
    driver.text_factory = lambda raw: raw.decode("utf-8", "replace")
    driver.set_authorizer(_judge)


def _judge(action: int, _: str | None, function: str | None, *__: str | None) -> int:
    """Allow reading; deny the rest."""
    if action not in ALLOWED:
        return sqlite3.SQLITE_DENY
    if action == sqlite3.SQLITE_FUNCTION and function in FORBIDDEN_FUNCTIONS:
        return sqlite3.SQLITE_DENY
    return sqlite3.SQLITE_OK


def _run(driver: Waiting, text: str, max_seconds: float, max_rows: int) -> QueryResult:
    """Run the statement until it ends, or time, rows or bytes are used up."""
    deadline = time.monotonic() + max_seconds
    driver.set_progress_handler(lambda: time.monotonic() > deadline, OPCODES_BETWEEN_LOOKS)
    rows: list[tuple[Cell, ...]] = []
    size = 0
    try:
        cursor = driver.execute(text)
        if cursor.description is None:
            raise BadInputError("nothing to run; give one SELECT")
        for row in cursor:
            size += sum(len(value) for value in row if isinstance(value, (str, bytes)))
            if len(rows) == max_rows or size > LARGEST_RESULT:
                break
            rows.append(row)
        else:
            row = None
        cursor.close()
    except (sqlite3.Error, sqlite3.Warning, ValueError) as error:
        _explain(error, max_seconds)
    columns = tuple(column[0] for column in cursor.description)
    return QueryResult(columns, tuple(rows), truncated=row is not None)


def _explain(error: Exception, max_seconds: float) -> NoReturn:
    """Raise what a person can put right as BadInputError; the database's faults as they are."""
    code = result_code(error) & PRIMARY
    if not code:  # from Python's driver: two statements, a NUL, half a character
        raise BadInputError(f"sql: {one_line(error)}; give one SELECT") from error
    remedy = MENDED.get(code)
    if remedy is None:
        raise error
    words = remedy.format(error=one_line(error), seconds=f"{max_seconds:g}")
    raise BadInputError(f"sql: {words}") from error
