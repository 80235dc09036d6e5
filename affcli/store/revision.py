"""What makes a SQLite file one of affcli's, and which schema it has."""

import sqlite3
from pathlib import Path

from affcli.errors import DatabaseError, one_line
from affcli.store.columns import COLUMNS

APPLICATION_ID = int.from_bytes(b"affc", "big")
"""``PRAGMA application_id`` of affcli's databases."""

REVISION = "0004"
"""The revision of ``migrations/`` that this code reads and writes."""

RELATIONS = frozenset({*COLUMNS, "affordance_table", "affordance_wide"})
"""The tables and views of that revision."""


def stored_revision(connection: sqlite3.Connection, path: Path) -> str | None:
    """Return the schema revision a database stands at; None when nothing is in it.

    A plain SELECT: importing Alembic to ask costs a quarter of a second.

    Raises:
        DatabaseError: another program's file, or one of affcli's that lost its revision.
    """
    application_id = connection.execute("PRAGMA application_id").fetchone()[0]
    names = {name for (name,) in connection.execute("SELECT name FROM sqlite_master")}
    if application_id == 0 and not names:
        return None
    if application_id != APPLICATION_ID:
        raise DatabaseError(
            f"{one_line(path)}: a SQLite database of another program; name another file with --db"
        )
    missing = "alembic_version"
    if missing in names:
        revisions = connection.execute("SELECT * FROM alembic_version").fetchall()
        if len(revisions) == 1:
            revision = str(revisions[0][0])
            missing = min(RELATIONS - names, default="") if revision == REVISION else ""
            if not missing:
                return revision
    raise DatabaseError(
        f"{one_line(path)}: damaged, its {missing} is missing; restore a copy of the file"
    )


def require_current(revision: str, path: Path) -> None:
    """Refuse a schema that this code does not read and write.

    Raises:
        DatabaseError: naming both revisions and what to do.
    """
    if revision == REVISION:
        return
    stands = f"{one_line(path)}: its schema is at revision {one_line(revision)}"
    if is_older(revision):
        raise DatabaseError(f"{stands}, this affcli needs {REVISION}: run `affcli db upgrade`")
    raise DatabaseError(f"{stands}, this affcli knows {REVISION}: install a newer affcli")


def is_older(revision: str) -> bool:
    """Tell whether `revision` comes before this code's; a text it does not know comes after."""
    return len(revision) == len(REVISION) and revision.isdecimal() and revision < REVISION
