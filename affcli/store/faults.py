"""What can go wrong with a database through no bug, as one line that says what to do."""

import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from affcli.errors import DatabaseError, one_line

BUSY = frozenset({sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED, sqlite3.SQLITE_PROTOCOL})

REMEDIES = {
    sqlite3.SQLITE_READONLY: "cannot be written, the file or its folder is read-only; "
    "allow yourself to write there, or name another file with --db",
    sqlite3.SQLITE_PERM: "access is denied; allow yourself to read and write the file",
    sqlite3.SQLITE_CANTOPEN: "cannot be opened; look whether its folder exists and whether you "
    "may write in it",
    sqlite3.SQLITE_FULL: "the disk is full; what was saved before is kept; make room, then run "
    "the command again",
    sqlite3.SQLITE_IOERR: "the disk refused to read or write; what was saved before is kept; look "
    "at free space, quotas and the disk's health, then run the command again",
    sqlite3.SQLITE_CORRUPT: "damaged; restore a copy of the file, or name another with --db",
    sqlite3.SQLITE_NOTADB: "not a SQLite database; name another file with --db",
    sqlite3.SQLITE_NOLFS: "too large for this file system; move it to another",
}
"""By SQLite's primary result code. What is not listed is a bug and keeps its traceback."""


def primary_code(error: BaseException) -> int | None:
    """Return SQLite's primary result code of an error of sqlite3 or SQLAlchemy, None of others."""
    cause = getattr(error, "orig", None) or error
    code = getattr(cause, "sqlite_errorcode", None)
    return None if code is None else code & 0xFF


@contextmanager
def faults_named(path: Path, waited: float) -> Iterator[None]:
    """Turn what SQLite reports about the file, the disk or another process into a DatabaseError.

    Args:
        path: the database.
        waited: seconds after which a lock is given up, for the message.
    """
    try:
        yield
    except Exception as error:
        code = primary_code(error)
        if code in BUSY:
            raise DatabaseError(
                f"{one_line(path)}: locked for more than {waited:g} s by {_lock_holder(path)}; "
                "wait until it is done, then run the command again"
            ) from error
        if code in REMEDIES:
            raise DatabaseError(f"{one_line(path)}: {REMEDIES[code]}") from error
        raise


def _lock_holder(path: Path) -> str:
    """Name the process that holds a lock on the file, where the system tells (Linux)."""
    inodes = set()
    for name in (path, Path(f"{path}-shm")):
        with suppress(OSError):
            inodes.add(name.stat().st_ino)
    with suppress(OSError, ValueError):
        for line in Path("/proc/locks").read_text().splitlines():
            _, kind, _, access, pid, place, *_ = line.split()
            held = kind == "POSIX" and access == "WRITE" and int(pid) not in (0, os.getpid())
            if held and int(place.split(":")[2]) in inodes:
                return f"process {pid}, probably another affcli"
    return "another process, probably another affcli"
