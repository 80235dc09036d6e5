"""Asking again for a lock that another process holds: the one way in which the store waits."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from affcli.errors import one_line
from affcli.store.faults import is_busy, lock_holder

T = TypeVar("T")

LONGEST_WAIT = 90.0
"""Seconds to wait for a lock unless told otherwise: longer than anybody reads in one go."""

ATTEMPT = 0.25
"""Seconds SQLite itself waits for a lock before Python asks again. SQLite hears no signal while it
waits: with the whole wait in one attempt, ctrl-C would take effect half a minute late."""


SILENT = 5.0
"""Seconds of waiting after which it is said for whom."""

_listeners: list[Callable[[str], object]] = []


def tell_of_waiting(say: Callable[[str], object]) -> None:
    """Call `say` once in each wait of more than `SILENT` seconds; it is told who is waited for."""
    _listeners.append(say)


def retried(action: Callable[[], T], seconds: float, path: Path) -> T:
    """Return what `action` gives, asking again while another process holds the lock.

    Args:
        action: raises SQLite's error when the lock is held.
        seconds: after these the error goes through.
        path: the database, to find out who holds it.
    """
    began, told = time.monotonic(), False
    while True:
        try:
            return action()
        except Exception as error:
            waited = time.monotonic() - began
            if not is_busy(error) or waited >= seconds:
                raise
            if waited >= SILENT and not told:
                told = True
                for say in _listeners:
                    say(f"waiting for {lock_holder(path)}, which holds {one_line(path)}")
