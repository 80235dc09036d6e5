"""What stands in a database file, for `affcli db info` and messages."""

import sqlite3
from dataclasses import dataclass
from pathlib import Path

from affcli.store.database_file import (
    look,
    one_state,
    opened,
    require_place,
    require_something,
)
from affcli.store.lock_retry import LONGEST_WAIT
from affcli.store.revision import REVISION


@dataclass(frozen=True, slots=True)
class DatabaseInfo:
    """A database file at a glance.

    Args:
        path: the file.
        bytes: its size.
        revision: of its schema.
        code_revision: the schema this affcli reads and writes.
        journal_mode: ``delete`` or ``wal``.
        sqlite_version: of the linked library.
        counts: records by what they are, empty when the schema is another: sessions, learning
            runs, behaviors, affordances, trials, steps, verifications, tries of these.
    """

    path: Path
    bytes: int
    revision: str
    code_revision: str
    journal_mode: str
    sqlite_version: str
    counts: dict[str, int]


COUNTS = {
    "sessions": "SELECT count(*) FROM session",
    "learning runs": "SELECT count(*) FROM learning_run",
    "behaviors": "SELECT coalesce(sum(behaviors), 0) FROM learning_run",
    "affordances": "SELECT coalesce(sum(rows), 0) FROM learning_run",
    "trials": "SELECT count(*) FROM trial",
    "steps": "SELECT coalesce(sum(steps), 0) FROM trial",
    "verifications": "SELECT count(*) FROM verification",
    "replications": "SELECT coalesce(sum(tries), 0) FROM verification",
}
"""Sums of what runs and trials say: counting millions of behaviors would read the whole file."""


def database_info(path: Path, *, timeout: float = LONGEST_WAIT) -> DatabaseInfo:
    """Look at a database of any schema revision.

    Raises:
        DatabaseError: missing, empty, unreadable, damaged, another program's, locked.
    """
    require_place(path, create=False, write=False)
    with opened(path, "rw", timeout) as driver:
        revision = require_something(look(driver, path, timeout), path)
        with one_state(driver, path, timeout):
            known = revision == REVISION
            return DatabaseInfo(
                path=path,
                bytes=path.stat().st_size,
                revision=revision,
                code_revision=REVISION,
                journal_mode=driver.execute("PRAGMA journal_mode").fetchone()[0],
                sqlite_version=sqlite3.sqlite_version,
                counts={
                    what: driver.execute(query).fetchone()[0]
                    for what, query in (COUNTS.items() if known else ())
                },
            )
