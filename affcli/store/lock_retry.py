"""Asking again for a lock that another process holds: the one way in which the store waits."""

import time
from collections.abc import Callable
from typing import TypeVar

from affcli.store.faults import is_busy

T = TypeVar("T")

LONGEST_WAIT = 90.0
"""Seconds to wait for a lock unless told otherwise: longer than anybody reads in one go."""

ATTEMPT = 0.25
"""Seconds SQLite itself waits for a lock before Python asks again. SQLite hears no signal while it
waits: with the whole wait in one attempt, ctrl-C would be heard half a minute late."""


def retried(action: Callable[[], T], seconds: float) -> T:
    """Return what `action` gives, asking again while another process holds the lock.

    Args:
        action: raises SQLite's error when the lock is held.
        seconds: after these the error goes through.
    """
    deadline = time.monotonic() + seconds
    while True:
        try:
            return action()
        except Exception as error:
            if not is_busy(error) or time.monotonic() >= deadline:
                raise
