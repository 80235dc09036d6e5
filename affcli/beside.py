"""A thread beside the work, for which nothing waits."""

from _thread import start_new_thread
from collections.abc import Callable
from contextlib import suppress

from affcli.memory import ask_for

ROOM = 16 << 20
"""Bytes of address space that a thread needs: 8 MB of stack, and what Python begins with in it."""


def beside(work: Callable[[], object]) -> None:
    """Do something in a thread, if there is room for one: what the caller can do without.

    Not `threading.Thread`: its `start` waits for ever when memory runs out in the new thread
    (https://github.com/python/cpython/issues/140746). The process does not wait for this one at
    its end either.

    Args:
        work: handles its own errors.
    """
    with suppress(MemoryError, RuntimeError):  # no room, or no more threads
        # Asked for here, where it can be refused: a thread that finds none cannot even be told so.
        ask_for(ROOM)
        start_new_thread(work, ())
