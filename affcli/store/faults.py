"""What can go wrong with a database through no bug, as one line that says what to do."""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from affcli.bounded import LARGEST_VALUE
from affcli.errors import DatabaseError, one_line
from affcli.store.waiting import DAMAGED, PRIMARY

INTERRUPTED_WRITE = (
    "was left in the middle of a write and you may not set it right; let somebody open it who may "
    "write there"
)

CLASH = (
    "its records contradict one another, which affcli did not write; `affcli db check` may show "
    "where; restore a copy of the file"
)
DELETED = (
    "what a record belongs to is not there, perhaps it was deleted meanwhile; run the command again"
)

REMEDIES = {
    sqlite3.SQLITE_READONLY_ROLLBACK: INTERRUPTED_WRITE,
    sqlite3.SQLITE_READONLY_RECOVERY: INTERRUPTED_WRITE,
    sqlite3.SQLITE_READONLY: "cannot be written, the file or its folder is read-only; "
    "allow yourself to write there, or name another file with --db",
    sqlite3.SQLITE_PERM: "access is denied; allow yourself to read and write the file",
    sqlite3.SQLITE_CANTOPEN: "cannot be opened; look whether its folder exists and whether you "
    "may write in it",
    sqlite3.SQLITE_FULL: "the disk is full; what was saved before is kept; make room, then run "
    "the command again",
    sqlite3.SQLITE_IOERR: "the disk refused to read or write; what was saved before is kept; look "
    "at free space, quotas and the disk's health, then run the command again",
    sqlite3.SQLITE_CORRUPT: DAMAGED,
    sqlite3.SQLITE_TOOBIG: f"holds a value of more than {LARGEST_VALUE} bytes, which affcli did "
    "not write; restore a copy of the file",
    sqlite3.SQLITE_NOTADB: "not a SQLite database; name another file with --db",
    sqlite3.SQLITE_CONSTRAINT_UNIQUE: CLASH,
    sqlite3.SQLITE_CONSTRAINT_PRIMARYKEY: CLASH,
    sqlite3.SQLITE_CONSTRAINT_FOREIGNKEY: DELETED,
    sqlite3.SQLITE_NOLFS: "too large for this file system; move it to another",
}
"""By SQLite's result code. What is not listed is a bug and keeps its traceback."""

NO_TEXT = "Could not decode to UTF-8"
"""What Python's driver says, without a code, of text that is not in UTF-8."""

CHANGED = ("no such column: ", "has no column named ", "foreign key mismatch")
"""What SQLite says, with the code of any mistake, of a table that was changed."""


def result_code(error: BaseException) -> int:
    """Return SQLite's result code of an error of sqlite3 or SQLAlchemy, 0 of all others."""
    cause = getattr(error, "orig", None) or error
    return int(getattr(cause, "sqlite_errorcode", 0))


@contextmanager
def faults_named(path: Path) -> Iterator[None]:
    """Turn what SQLite reports about a file or the disk into a DatabaseError."""
    try:
        yield
    except Exception as error:
        code, said = result_code(error), str(getattr(error, "orig", error))
        if said.startswith(NO_TEXT):
            raise DatabaseError(
                f"{one_line(path)}: holds text that is none and that affcli did not write; restore "
                "a copy of the file"
            ) from error
        if code and any(words in said for words in CHANGED):
            raise DatabaseError(
                f"{one_line(path)}: damaged, {said}; restore a copy of the file"
            ) from error
        remedy = REMEDIES.get(code) or REMEDIES.get(code & PRIMARY)
        if remedy in (CLASH, DELETED):
            remedy = f"{one_line(said)}: {remedy}"
        if remedy is not None:
            raise DatabaseError(f"{one_line(path)}: {remedy}") from error
        raise
