"""Doing something to a command while it runs: signals, system calls that fail, a neighbour."""

import os
import sqlite3
import subprocess
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from threading import Event, Thread, Timer

from tests.attack.attacks import SIGNALS, SYSTEM_CALLS, Attack
from tests.cli.forked import Disturbance, nothing

WRITTEN_ON = ("", "-journal", "-wal")


def disturbance(attack: Attack, database: Path, notes: Path) -> Disturbance:
    """Return what an attack does to the process of a command.

    Args:
        attack: which.
        database: that the command is given.
        notes: where is written which system calls failed; it stays empty when none did.
    """
    if attack.fault in SIGNALS:
        return lambda pid: signalled(pid, SIGNALS[attack.fault], attack.moment)
    if attack.fault == "lock":
        return lambda pid: locked(database, attack.moment)
    if attack.fault in {"kill at a call", "EIO", "ENOSPC"}:
        kind, number = attack.call
        if attack.fault == "ENOSPC" and kind in {"read", "remove"}:
            kind = "write"  # a full disk hinders neither
        what = "signal=KILL" if attack.fault == "kill at a call" else f"error={attack.fault}"
        when = f"{number}+" if attack.fault == "ENOSPC" else number  # it stays full
        inject = f"inject={SYSTEM_CALLS[kind]}:{what}:when={when}"
        return lambda pid: traced(pid, inject, database, notes)
    return nothing


@contextmanager
def signalled(pid: int, signum: int, moment: float) -> Iterator[None]:
    """Send a signal at a moment, should the process still run."""

    def send() -> None:
        with suppress(ProcessLookupError):
            os.kill(pid, signum)

    timer = Timer(moment, send)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()


@contextmanager
def traced(pid: int, inject: str, database: Path, notes: Path) -> Iterator[None]:
    """Let system calls on a database, its journal and its folder fail."""
    places = (*(Path(f"{database}{ending}") for ending in WRITTEN_ON), database.parent)
    paths = [word for place in places for word in ("-P", str(place))]
    command = ["strace", "-f", "-o", str(notes), "-p", str(pid), *paths, "-e", inject]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as tracer:
        assert tracer.stderr is not None
        line = tracer.stderr.readline()
        assert "attached" in line, line
        try:
            yield
        finally:
            tracer.communicate(timeout=20)


@contextmanager
def locked(database: Path, moment: float) -> Iterator[None]:
    """Take the whole database for a moment, again and again, so that nobody else can read it."""
    over = Event()

    def hold() -> None:
        with closing(sqlite3.connect(database, timeout=60.0, isolation_level=None)) as driver:
            while not over.is_set():
                driver.execute("BEGIN EXCLUSIVE")
                over.wait(moment)
                driver.execute("COMMIT")
                over.wait(0.2)

    holder = Thread(target=hold)
    holder.start()
    try:
        yield
    finally:
        over.set()
        holder.join()
