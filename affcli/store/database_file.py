"""Looking at a file before anything else: is it there, affcli's, sound, and of which schema?

Standard library only, so that ``affcli sql`` starts without SQLAlchemy.
"""

import os
import sqlite3
import stat
from collections.abc import Iterator
from contextlib import closing, contextmanager
from glob import escape
from pathlib import Path

from affcli.errors import DatabaseError, one_line
from affcli.store.columns import COLUMNS
from affcli.store.faults import REMEDIES, faults_named
from affcli.store.waiting import Waiting, connected

APPLICATION_ID = int.from_bytes(b"affc", "big")
"""``PRAGMA application_id`` of affcli's databases."""

REVISION = "0010"
"""The revision of ``migrations/`` that this code reads and writes."""

RELATIONS = frozenset({*COLUMNS, "affordance_table", "affordance_wide"})
"""The tables and views of that revision."""

CHECKED_UP_TO = 4 * 2**20
"""Bytes up to which the whole file is checked when it is opened, which takes some 15 ms a megabyte:
five tools and their trials. In a larger file a damaged page is found when it is read."""


def require_place(path: Path, *, create: bool, write: bool) -> None:
    """Refuse a path at which there can be no database, before SQLite touches it.

    Args:
        path: where the database is or will be.
        create: it may be missing.
        write: it will be written.

    Raises:
        DatabaseError: missing, no regular file, or not to be read or written.
    """
    shown = one_line(path)
    missing = False
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise DatabaseError(f"{shown}: not a file; name another with --db")
    except FileNotFoundError:
        missing = True
    except (OSError, ValueError) as error:
        raise DatabaseError(f"{shown}: {one_line(error)}; name another file with --db") from error
    if missing and not create:
        raise DatabaseError(
            f"{shown}: no database there; `affcli learn` makes one, or name another with --db"
        )
    folder = path.resolve().parent
    if not folder.is_dir():
        raise DatabaseError(f"{shown}: its folder does not exist; make it, or name another file")
    if not (missing or os.access(path, os.R_OK)):
        raise DatabaseError(f"{shown}: {REMEDIES[sqlite3.SQLITE_PERM]}")
    # SQLite makes its journal beside the file, so the folder counts too.
    writable = os.access(folder, os.W_OK) and (missing or os.access(path, os.W_OK))
    if write and not writable:
        raise DatabaseError(f"{shown}: {REMEDIES[sqlite3.SQLITE_READONLY]}")


@contextmanager
def opened(path: Path, mode: str, timeout: float) -> Iterator[Waiting]:
    """Open a SQLite file; what goes wrong with it in the block is a DatabaseError.

    Args:
        path: the file.
        mode: of SQLite's URIs: ``ro``, ``rw`` or ``rwc``.
        timeout: seconds to wait for a lock.
    """
    with faults_named(path):
        driver = connected(path, mode, timeout)
        if mode != "rwc" and _lacks_shared_memory(driver):
            driver.close()
            driver = connected(path, "ro&immutable=1", timeout)
        with closing(driver):
            yield driver


def _lacks_shared_memory(driver: Waiting) -> bool:
    """Tell whether this is a WAL database at rest in a folder that cannot be written.

    SQLite cannot make the file there that it shares with other processes; the database can still be
    read as one that does not change.
    """
    try:
        driver.execute("SELECT 1 FROM sqlite_master")
    except sqlite3.OperationalError as error:
        cannot = (sqlite3.SQLITE_READONLY_DIRECTORY, sqlite3.SQLITE_CANTOPEN)
        return error.sqlite_errorcode in cannot and not Path(f"{driver.path}-wal").exists()
    except sqlite3.DatabaseError:
        pass  # `look` says what it is
    return False


@contextmanager
def one_state(driver: Waiting) -> Iterator[None]:
    """Let everything that is read in a ``with`` block be of one state of an opened file.

    Raises:
        DatabaseError: not a database, damaged, locked too long.
    """
    driver.execute("BEGIN")
    try:
        # BEGIN takes no lock; the first read does.
        driver.execute("SELECT 1 FROM sqlite_master")
        yield
    finally:
        if driver.in_transaction:
            driver.execute("ROLLBACK")


def look(driver: Waiting) -> str | None:
    """Return the revision of an opened file, None when it is empty, after checking it is sound.

    Args:
        driver: the opened file; no transaction is open.

    Raises:
        DatabaseError: not a database, another program's, damaged, locked too long.
    """
    with one_state(driver):
        revision = stored_revision(driver)
        _require_sound(driver)
        return revision


def require_something(revision: str | None, path: Path) -> str:
    """Return the revision of a database in which there is something to read.

    Raises:
        DatabaseError: the file is empty.
    """
    if revision is None:
        raise DatabaseError(
            f"{one_line(path)}: an empty file; `affcli learn` makes a database of it"
        )
    return revision


def _require_sound(driver: Waiting) -> None:
    """Refuse a file that was cut off, or whose pages contradict one another."""
    path = driver.path
    size = path.stat().st_size
    pages, page = (driver.execute(f"PRAGMA page_{k}").fetchone()[0] for k in ("count", "size"))
    if size and not pages:  # SQLite takes a few bytes for an empty file and would overwrite them
        raise DatabaseError(f"{one_line(path)}: {REMEDIES[sqlite3.SQLITE_NOTADB]}")
    # The last pages of a WAL database may be in its journal still.
    whole = size >= pages * page or Path(f"{path}-wal").exists()
    if whole and size <= CHECKED_UP_TO:
        whole = driver.execute("PRAGMA quick_check(1)").fetchone()[0] == "ok"
    if not whole:
        raise DatabaseError(f"{one_line(path)}: {REMEDIES[sqlite3.SQLITE_CORRUPT]}")


def stored_revision(driver: Waiting) -> str | None:
    """Return the schema revision a database stands at; None when nothing is in it.

    A plain SELECT: importing Alembic to ask costs a quarter of a second.

    Raises:
        DatabaseError: another program's file, or one of affcli's that lost its revision.
    """
    path = driver.path
    application_id = driver.execute("PRAGMA application_id").fetchone()[0]
    names = {name for (name,) in driver.execute("SELECT name FROM sqlite_master")}
    if application_id == 0 and not names:
        return None
    if application_id != APPLICATION_ID:
        raise DatabaseError(
            f"{one_line(path)}: a SQLite database of another program; name another file with --db"
        )
    missing = "alembic_version"
    if missing in names:
        revisions = driver.execute("SELECT * FROM alembic_version").fetchall()
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
    raise DatabaseError(
        f"{stands}, this affcli knows {REVISION}: install a newer affcli{_or_its_copy(path)}"
    )


def _or_its_copy(path: Path) -> str:
    """Name the copy that the latest upgrade of a database made, where there is one, as a remedy."""
    copies = path.parent.glob(f"{escape(path.name)}.{'[0-9]' * len(REVISION)}*.backup")
    latest = max(copies, key=lambda copy: copy.stat().st_mtime, default=None)
    return "" if latest is None else f", or go on with {one_line(latest)}, from before the upgrade"


def is_older(revision: str) -> bool:
    """Tell whether `revision` comes before this code's; a text it does not know comes after."""
    return len(revision) == len(REVISION) and revision.isdecimal() and revision < REVISION
