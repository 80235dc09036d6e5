"""Copies of a database: made while others use it, and before its schema changes."""

import os
import sqlite3
from contextlib import closing
from itertools import count
from pathlib import Path

from affcli.errors import DatabaseError, one_line
from affcli.store.database_file import (
    look,
    one_state,
    opened,
    require_place,
    require_something,
)
from affcli.store.faults import faults_named
from affcli.store.replacing import replacing
from affcli.store.waiting import LONGEST_WAIT, Waiting


def backup(path: Path, copy: Path, *, timeout: float = LONGEST_WAIT) -> None:
    """Write a copy of a database, of any schema revision, as it is at one moment.

    Others may read and write it meanwhile. The copy is checked, and appears whole or not at all,
    over whatever stood there before.

    Args:
        path: the database.
        copy: the file to write.
        timeout: seconds to wait for a lock.

    Raises:
        DatabaseError: there is no sound database to copy, or the copy cannot be written.
    """
    require_place(path, create=False, write=False)
    with opened(path, "rw", timeout) as driver:
        require_something(look(driver), path)
        copy_of(driver, copy)


def copy_of(driver: Waiting, copy: Path) -> None:
    """Write a copy of an opened database; see `backup`."""
    path = driver.path
    if copy.exists() and path.samefile(copy):
        raise DatabaseError(f"{one_line(copy)}: that is the database itself; name another file")
    try:
        # Who may not read the database must not read its copy.
        with replacing(copy, path.stat().st_mode & 0o777) as part:
            _fill(part, driver, copy)
        _synced(Path(os.path.realpath(copy)).parent)
    except OSError as error:
        raise DatabaseError(
            f"{one_line(copy)}: no copy can be written there ({error.strerror}); name another place"
        ) from error


def _fill(part: Path, driver: Waiting, copy: Path) -> None:
    """Write a checked copy of an opened database into an empty file."""
    with faults_named(copy), closing(sqlite3.connect(part)) as target:
        # By itself a backup would wait for a lock without end, and hear no signal.
        with one_state(driver):
            driver.backup(target)
        # A copy of a WAL database would need two more files beside it.
        target.execute("PRAGMA journal_mode = delete")
        verdict = target.execute("PRAGMA integrity_check(1)").fetchone()[0]
    if verdict != "ok":
        raise DatabaseError(
            f"{one_line(driver.path)}: damaged ({one_line(verdict)}), so no copy was made; "
            "restore an older one"
        )
    _synced(part)


def backup_name(path: Path, revision: str) -> Path:
    """Return a free name beside a database for its copy before a migration."""
    names = (
        path.with_name(f"{path.name}.{revision}{'' if n == 1 else f'-{n}'}.backup")
        for n in count(1)
    )
    return next(name for name in names if not name.exists())


def _synced(path: Path) -> None:
    """Make sure that a file, or the names in a folder, are on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
