"""Opening a database: made or migrated if it must be, and checked before anything is read."""

import sqlite3
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import sqlalchemy as sa

from affcli.errors import DatabaseError, one_line
from affcli.store.connection import Database
from affcli.store.copying import backup_name, copy_of
from affcli.store.database_file import (
    REVISION,
    is_older,
    look,
    opened,
    require_current,
    require_place,
    require_something,
    stored_revision,
)
from affcli.store.experiments import Experiments
from affcli.store.faults import result_code
from affcli.store.inventions import Inventions
from affcli.store.journal import set_journal_mode
from affcli.store.learning import Learning
from affcli.store.logs import Logs
from affcli.store.migrate import run_migrations
from affcli.store.results import Results
from affcli.store.runs import Runs
from affcli.store.selections import Selections
from affcli.store.sessions import Sessions
from affcli.store.transfers import Transfers
from affcli.store.trials import Trials
from affcli.store.verifications import Verifications
from affcli.store.waiting import LONGEST_WAIT, PRIMARY, Waiting

OF_THE_STATEMENT = frozenset({sqlite3.SQLITE_ERROR, sqlite3.SQLITE_CONSTRAINT})
"""Result codes by which a migration says that it does not fit what it found."""


class Store:
    """An open database: an object for each thing that is kept.

    Every method of these is one transaction and returns plain values; no row or connection leaves
    the store. A method that cannot read or write raises DatabaseError, and what was saved before is
    kept.
    """

    def __init__(self, database: Database) -> None:
        self.database = database
        self.sessions = Sessions(database)
        """Sessions, and the robots of reproductions and experiments."""
        self.experiments = Experiments(database)
        """Experiments, with the sessions of their conditions."""
        self.learning = Learning(database)
        """Learning runs, with the behaviors and the rows of each."""
        self.runs = Runs(database)
        """Learning runs as a person keeps them: their notes, what used them."""
        self.trials = Trials(database)
        """Testing trials, with the steps of each."""
        self.verifications = Verifications(database)
        """Verifications, with the tries of each."""
        self.inventions = Inventions(database)
        """What robots invented."""
        self.transfers = Transfers(database)
        """What runs saw of their tools, and what they borrowed."""
        self.logs = Logs(database)
        """Where imported runs come from."""
        self.results = Results(database)
        """Counts and sums for reports."""
        self.selections = Selections(database)
        """Rows of tables, chosen by what they hold."""

    @property
    def path(self) -> Path:
        """The file."""
        return self.database.path

    @property
    def left_out(self) -> Sequence[str]:
        """What is to be said of records that lists left out, because they cannot be read."""
        return tuple(self.database.left_out)

    @contextmanager
    def turn(self) -> Iterator[None]:
        """Keep all others from writing: what is read, done and saved in the block is one whole.

        Those who use one table take turns by it. A kill in the middle leaves nothing of the block.

        Raises:
            DatabaseError: locked too long, read-only, disk full, damaged; nothing is saved.
        """
        with self.database.writing():
            yield


@contextmanager
def open_store(
    path: Path, *, create: bool, write: bool, timeout: float = LONGEST_WAIT
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
        revision = look(driver)
        if revision is not None or not create:
            require_current(require_something(revision, path), path)
        with _connected(driver) as database:
            if revision is None:
                _migrate(database, driver)
            driver.execute("PRAGMA foreign_keys = ON")
            if write or create:
                set_journal_mode(driver)
            else:
                driver.execute("PRAGMA query_only = ON")
            yield Store(database)


def upgrade(
    path: Path,
    *,
    timeout: float = LONGEST_WAIT,
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
        before = require_something(look(driver), path)
        if is_older(before):
            with _connected(driver) as database:
                _migrate(database, driver, copied)
        else:
            require_current(before, path)
        return before, REVISION


@contextmanager
def _connected(driver: Waiting) -> Iterator[Database]:
    """Give a database whose one connection is `driver`; a commit returns when it is on the disk."""
    # FULL would leave out the folder: after a power cut the journal could be there again, and would
    # take back what was said to be saved.
    driver.execute("PRAGMA synchronous = EXTRA")
    # Transactions are ended where they are begun, so nothing is left to reset: and after ctrl-C the
    # driver may be closed already.
    engine = sa.create_engine(
        "sqlite://", creator=lambda: driver, poolclass=sa.StaticPool, pool_reset_on_return=None
    )
    with engine.connect() as connection:
        yield Database(connection, driver)


def _migrate(
    database: Database, driver: Waiting, copied: Callable[[Path], None] | None = None
) -> None:
    """Run the migrations that are missing, unless another process has just done so.

    What is in the database already is copied first: under the write lock, for the copy of a second
    process that upgrades it too would be of the new schema.
    """
    path = database.path
    with database.writing() as connection:
        revision = stored_revision(driver)
        if revision is None:
            run_migrations(connection)
        elif is_older(revision):
            copy = _copy_before(revision, path)
            if copied is not None:
                copied(copy)
            with _failure_named(path, revision, copy):
                run_migrations(connection)
        else:
            require_current(revision, path)


def _copy_before(revision: str, path: Path) -> Path:
    """Copy a database that this process alone may write; return where the copy is."""
    copy = backup_name(path, revision)
    # Through a connection of its own: SQLite copies nothing from one that is about to write.
    with opened(path, "rw", LONGEST_WAIT) as reader:
        copy_of(reader, copy)
    return copy


@contextmanager
def _failure_named(path: Path, revision: str, copy: Path) -> Iterator[None]:
    """Say in one line that a migration failed on what is in the database."""
    failed = f"{one_line(path)}: could not be brought from revision {revision} to {REVISION}"
    try:
        yield
    except DatabaseError as error:
        raise DatabaseError(f"{failed}: {error}; it is as it was") from error
    except sa.exc.DBAPIError as error:
        if result_code(error) & PRIMARY not in OF_THE_STATEMENT:
            raise
        raise DatabaseError(
            f"{failed}: {one_line(error.orig)}; it is as it was, and {one_line(copy)} is a copy; "
            "was something added to it that is not affcli's? Take that out, then try again"
        ) from error
