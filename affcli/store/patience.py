"""Waiting for a lock that another process holds."""

import time
from collections.abc import Callable
from typing import TypeVar

from affcli.store.faults import is_busy

T = TypeVar("T")

PATIENCE = 90.0
"""Seconds to wait for a lock unless told otherwise: longer than anybody reads in one go."""

ATTEMPT = 0.25
"""Seconds SQLite itself waits for a lock before Python asks again. SQLite waits deaf to signals:
with the whole patience in one attempt, ctrl-C would not be heard for half a minute."""


def patiently(action: Callable[[], T], seconds: float) -> T:
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
