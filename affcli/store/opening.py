"""Opening a database: look first, migrate what is new, refuse what is not ours."""

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import sqlalchemy as sa

from affcli.store.copying import backup_name, copy_of
from affcli.store.database_file import look, opened, require_place, require_something
from affcli.store.faults import faults_named
from affcli.store.identity import REVISION, is_older, require_current, stored_revision
from affcli.store.journal import set_journal_mode
from affcli.store.migrate import run_migrations
from affcli.store.patience import PATIENCE, patiently
from affcli.store.repository import Store


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
        DatabaseError: as `open_store`; a newer schema is left as it is.
    """
    require_place(path, create=False, write=True)
    with opened(path, "rw", timeout) as driver:
        before = require_something(look(driver, path, timeout), path)
        if is_older(before):
            copy = backup_name(path, before)
            copy_of(driver, path, copy, timeout)
            if copied is not None:
                copied(copy)
            with _engine(driver).connect() as connection:
                _migrate(Store(connection, driver, path, timeout), driver)
        else:
            require_current(before, path)
        return before, REVISION


def _migrate(store: Store, driver: sqlite3.Connection) -> None:
    """Run the migrations that are missing, unless another process has just done so."""
    with store.writing() as connection:
        revision = stored_revision(driver, store.path)
        if revision is None or is_older(revision):
            run_migrations(connection)
        else:
            require_current(revision, store.path)


def _engine(driver: sqlite3.Connection) -> sa.Engine:
    """Return an engine whose one connection is `driver`."""
    # Transactions are ended where they are begun, so nothing is left to reset: and after ctrl-C the
    # driver may be closed already.
    return sa.create_engine(
        "sqlite://", creator=lambda: driver, poolclass=sa.StaticPool, pool_reset_on_return=None
    )


def _prepare(driver: sqlite3.Connection, path: Path, timeout: float, *, write: bool) -> None:
    """Set what SQLite keeps for a connection, and the journal that suits its version."""
    driver.execute("PRAGMA foreign_keys = ON")
    driver.execute("PRAGMA synchronous = FULL")
    if write:
        with faults_named(path, timeout):
            patiently(lambda: set_journal_mode(driver), timeout)
    else:
        driver.execute("PRAGMA query_only = ON")
