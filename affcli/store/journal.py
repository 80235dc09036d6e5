"""Which journal a database keeps: what the linked SQLite can be trusted with."""

import sqlite3
from contextlib import suppress
from typing import Literal

from affcli.store.waiting import Waiting

Version = tuple[int, int, int]

WAL_MENDED: tuple[tuple[Version, Version], ...] = (
    ((3, 44, 6), (3, 45, 0)),
    ((3, 50, 7), (3, 51, 0)),
    ((3, 51, 3), (4, 0, 0)),
)
"""From, and before which version: two writers can corrupt a WAL database in all the others."""


def journal_mode_for(version: tuple[int, ...]) -> Literal["wal", "delete"]:
    """Return the journal mode to use with a version of SQLite: WAL where its fault is repaired."""
    return "wal" if any(low <= version < high for low, high in WAL_MENDED) else "delete"


def set_journal_mode(driver: Waiting) -> None:
    """Put the database into the journal mode that suits the linked SQLite.

    It needs the file to itself; while another process uses it the mode stays, until the next time.
    """
    wanted = journal_mode_for(sqlite3.sqlite_version_info)
    if driver.execute("PRAGMA journal_mode").fetchone()[0] != wanted:
        with suppress(sqlite3.OperationalError):
            # One that does not wait.
            driver.cursor(sqlite3.Cursor).execute(f"PRAGMA journal_mode = {wanted}")
