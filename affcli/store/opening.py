"""Opening a database: look first, migrate what is new, refuse what is not ours."""

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import sqlalchemy as sa

from affcli.errors import DatabaseError, one_line
from affcli.store.copying import backup_name, copy_of
from affcli.store.database_file import look, opened, require_place, require_something
from affcli.store.faults import PRIMARY, faults_named, result_code
from affcli.store.identity import REVISION, is_older, require_current, stored_revision
from affcli.store.journal import set_journal_mode
from affcli.store.migrate import run_migrations
from affcli.store.patience import PATIENCE, patiently
from affcli.store.repository import Store

OF_THE_STATEMENT = frozenset({sqlite3.SQLITE_ERROR, sqlite3.SQLITE_CONSTRAINT})
"""Result codes by which a migration says that it does not fit what it found."""


@contextmanager
def open_store(
    path: Path, *, create: bool, write: bool, timeout: float = PATIENCE
) -> Iterator[Store]:
    """Open a database for the length of a ``with`` block.

    Args:
        path: the SQLite file.
        create: make the file, or the schema in an empty one, when it is not there.
        write: it will be written; without it every write is refused.
        timeout: seconds to wait for a lock that another process holds.

    Raises:
        DatabaseError: missing, unreadable, damaged, another program's, of another schema, locked.
    """
    require_place(path, create=create, write=write or create)
    with opened(path, "rwc" if create else "rw", timeout) as driver:
        revision = look(driver, path, timeout)
        if revision is not None or not create:
            require_current(require_something(revision, path), path)
        with _engine(driver).connect() as connection:
            store = Store(connection, driver, path, timeout)
            _wait_for_disk(driver)
            if revision is None:
                _migrate(store, driver)
            _prepare(driver, path, timeout, write=write or create)
            yield store


def upgrade(
    path: Path,
    *,
    timeout: float = PATIENCE,
    copied: Callable[[Path], None] | None = None,
) -> tuple[str, str]:
    """Bring an existing database to the schema of this affcli, in one transaction.

    A copy of the database as it was is made first, beside it, and stays there.

    Args:
        path: the SQLite file.
        timeout: seconds to wait for a lock that another process holds.
        copied: told where the copy is, before anything is changed.

    Returns:
        The revisions before and after; equal when there was nothing to do.

    Raises:
        DatabaseError: as `open_store`; a newer schema is left as it is. Or a migration failed; the
            database is as it was.
    """
    require_place(path, create=False, write=True)
    with opened(path, "rw", timeout) as driver:
        before = require_something(look(driver, path, timeout), path)
        if is_older(before):
            _wait_for_disk(driver)
            with _engine(driver).connect() as connection:
                _migrate(Store(connection, driver, path, timeout), driver, copied)
        else:
            require_current(before, path)
        return before, REVISION


def _migrate(
    store: Store, driver: sqlite3.Connection, copied: Callable[[Path], None] | None = None
) -> None:
    """Run the migrations that are missing, unless another process has just done so.

    What is in the database already is copied first: under the write lock, for the copy of a second
    process that upgrades it too would be of the new schema.
    """
    with store.writing() as connection:
        revision = stored_revision(driver, store.path)
        if revision is None:
            run_migrations(connection)
        elif is_older(revision):
            copy = _copy_before(revision, store.path)
            if copied is not None:
                copied(copy)
            with _failure_named(store.path, revision, copy):
                run_migrations(connection)
        else:
            require_current(revision, store.path)


def _copy_before(revision: str, path: Path) -> Path:
    """Copy a database that this process alone may write; return where the copy is."""
    copy = backup_name(path, revision)
    # Through a connection of its own: SQLite copies nothing from one that is about to write.
    with opened(path, "rw", PATIENCE) as reader:
        copy_of(reader, path, copy, PATIENCE)
    return copy


@contextmanager
def _failure_named(path: Path, revision: str, copy: Path) -> Iterator[None]:
    """Say in one line that a migration stumbled over what stands in the database."""
    try:
        yield
    except sa.exc.DBAPIError as error:
        if result_code(error) & PRIMARY not in OF_THE_STATEMENT:
            raise
        raise DatabaseError(
            f"{one_line(path)}: could not be brought from revision {revision} to {REVISION}: "
            f"{one_line(error.orig)}; it is as it was, and {one_line(copy)} is a copy; was "
            "something added to it that is not affcli's? Take that out, then try again"
        ) from error


def _engine(driver: sqlite3.Connection) -> sa.Engine:
    """Return an engine whose one connection is `driver`."""
    # Transactions are ended where they are begun, so nothing is left to reset: and after ctrl-C the
    # driver may be closed already.
    return sa.create_engine(
        "sqlite://", creator=lambda: driver, poolclass=sa.StaticPool, pool_reset_on_return=None
    )


def _wait_for_disk(driver: sqlite3.Connection) -> None:
    """Let a commit return when all of it is on the disk, the end of its journal too."""
    # FULL would leave out the folder: after a power cut the journal could be there again, and would
    # take back what was said to be saved.
    driver.execute("PRAGMA synchronous = EXTRA")


def _prepare(driver: sqlite3.Connection, path: Path, timeout: float, *, write: bool) -> None:
    """Set what SQLite keeps for a connection, and the journal that suits its version."""
    driver.execute("PRAGMA foreign_keys = ON")
    if write:
        with faults_named(path, timeout):
            patiently(lambda: set_journal_mode(driver), timeout)
    else:
        driver.execute("PRAGMA query_only = ON")
