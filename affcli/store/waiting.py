"""Connections that wait for a lock another process holds: the one way in which the store waits."""

import os
import sqlite3
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from affcli.bounded import LARGEST_VALUE
from affcli.errors import DatabaseError, one_line

LONGEST_WAIT = 90.0
"""Seconds to wait for a lock unless told otherwise: longer than anybody reads in one go."""

ATTEMPT = 0.25
"""Seconds SQLite itself waits for a lock before Python asks again. SQLite hears no signal while it
waits: with the whole wait in one attempt, ctrl-C would take effect half a minute late."""

SILENT = 5.0
"""Seconds of waiting after which it is said for whom."""

BUSY = frozenset({sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED, sqlite3.SQLITE_PROTOCOL})
PRIMARY = 0xFF
"""The bits of a result code that say the kind; the others say more exactly what happened."""

DAMAGED = "damaged; restore a copy of the file, or name another with --db"
"""What is said of a file that SQLite cannot make sense of."""

_say: Callable[[str], object] = str


def tell_of_waiting(say: Callable[[str], object]) -> None:
    """Call `say` once in each wait of more than `SILENT` seconds; it is told who is waited for."""
    global _say  # noqa: PLW0603  # whoever waits, one person reads it
    _say = say


class Waiting(sqlite3.Connection):
    """A connection, in autocommit, each of whose statements waits for the locks of others.

    Attributes:
        path: the file.
        longest: seconds to wait for a lock.
    """

    path: Path
    longest: float

    def cursor(self, factory: Any = None) -> Any:
        """Return a cursor that waits, unless another kind is asked for."""
        return super().cursor(factory or _WaitingCursor)

    def execute(self, *statement: Any) -> Any:
        """Execute a statement with a cursor that waits."""
        return self.cursor().execute(*statement)

    def close(self) -> None:
        """Roll back what is open, and close.

        A statement that a signal interrupted keeps a closed file open, with its transaction, lock
        and journal, until the cursor is collected.
        """
        with suppress(sqlite3.Error):
            self.rollback()
        super().close()


class _WaitingCursor(sqlite3.Cursor):
    connection: Waiting

    def execute(self, *statement: Any) -> "_WaitingCursor":
        """Execute a statement as soon as others let it.

        Raises:
            DatabaseError: they do not for too long, or the file is damaged.
        """
        path, longest, told = self.connection.path, self.connection.longest, False
        began = time.monotonic()
        while True:
            try:
                return super().execute(*statement)
            except UnicodeDecodeError as error:
                # SQLite's own message, which quotes what the file calls its tables.
                raise DatabaseError(f"{one_line(path)}: {DAMAGED}") from error
            except sqlite3.Error as error:
                # Errors of Python's own driver have no code.
                if getattr(error, "sqlite_errorcode", 0) & PRIMARY not in BUSY:
                    raise
                waited = time.monotonic() - began
                if waited >= longest:
                    raise DatabaseError(
                        f"{one_line(path)}: locked for more than {longest:g} s by "
                        f"{lock_holder(path)}; wait until it is done, then run the command again"
                    ) from error
                if waited >= SILENT and not told:
                    told = True
                    _say(f"waiting for {lock_holder(path)}, which holds {one_line(path)}")


def connected(path: Path, mode: str, longest: float) -> Waiting:
    """Return a connection to a file.

    Args:
        path: the file.
        mode: of SQLite's URIs: ``ro``, ``rw`` or ``rwc``.
        longest: seconds to wait for a lock.
    """
    # as_uri quotes what a URI would read as its own: ? # %
    uri = f"{path.absolute().as_uri()}?mode={mode}"
    driver = sqlite3.connect(uri, uri=True, timeout=ATTEMPT, isolation_level=None, factory=Waiting)
    driver.path, driver.longest = path, longest
    driver.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_VALUE)
    return driver


def lock_holder(path: Path) -> str:
    """Name the process that holds a lock on the file, where the system tells (Linux)."""
    holders: dict[str, str] = {}
    with suppress(OSError, ValueError):
        files = (path, Path(f"{path}-shm"))
        inodes = {file.stat().st_ino for file in files if file.exists()}
        for line in Path("/proc/locks").read_text().splitlines():
            _, kind, _, access, pid, place, *_ = line.split()
            # 0 is a process of another container.
            ours = kind == "POSIX" and int(place.split(":")[2]) in inodes
            if ours and int(pid) not in (0, os.getpid()):
                holders[access] = f"process {pid}"
    # Without a writer it is a reader who keeps a transaction from being committed.
    holder = holders.get("WRITE") or holders.get("READ") or "another process"
    return f"{holder}, probably another affcli"
