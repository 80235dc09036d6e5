"""The real program as a process: run it, read it, and look into its database."""

import atexit
import json
import os
import select
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
PROGRAM = (sys.executable, "-m", "affcli")
PATIENCE = 120.0
"""Seconds after which a command is taken to hang. No test is about speed."""

CLOCKS = {"started_at", "finished_at"}
"""Columns that say when something happened; all others follow from seeds and settings."""

Arg = str | bytes | Path
Contents = dict[str, list[tuple[object, ...]]]


@dataclass(frozen=True, slots=True)
class Ended:
    """A command that ended: exit code, stdout, stderr."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        """Stdout as JSON; NaN and Infinity, which are no JSON, are refused."""

        def refuse(constant: str) -> None:
            raise AssertionError(f"{constant} is not JSON")

        return json.loads(self.out, parse_constant=refuse)


def environment(**changes: str) -> dict[str, str]:
    """Return this process's environment without what changes the program's looks or database."""
    ours = ("AFFCLI_DB", "COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR", "TERM", "PYTHONIOENCODING")
    return {k: v for k, v in os.environ.items() if k not in ours} | changes


class Warm:
    """The program, imported and waiting to be forked (see ``warm.py``)."""

    def __init__(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.cli.warm"],
            cwd=ROOT,
            env=environment(OPENBLAS_NUM_THREADS="1"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,
        )

    def run(self, args: list[str], cwd: Path, env: dict[str, str], copies: int = 1) -> list[Ended]:
        """Run a command, or several copies of it side by side, to its end."""
        out, err = (f"{self.folder.name}/{name}" for name in ("out", "err"))
        request = {"args": args, "cwd": str(cwd), "env": env, "copies": copies}
        request |= {"out": out, "err": err}
        asked, told = self.process.stdin, self.process.stdout
        assert asked is not None
        assert told is not None
        asked.write(json.dumps(request).encode() + b"\n")
        asked.flush()
        ready, _, _ = select.select([told], [], [], PATIENCE)
        if not ready:
            self.stop()
        assert ready, f"{args} hangs"
        codes = json.loads(told.readline())
        return [
            Ended(code, Path(f"{out}{copy}").read_text(), Path(f"{err}{copy}").read_text())
            for copy, code in enumerate(codes)
        ]

    def stop(self) -> None:
        """End it, and a command that hangs with it."""
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.communicate()
        self.folder.cleanup()
        warm.cache_clear()


@cache
def warm() -> Warm:
    """Return the program, imported once for all tests."""
    started = Warm()
    atexit.register(started.stop)
    return started


def affcli(*args: Arg, cwd: Path | None = None, **env: str) -> Ended:
    """Run the program to its end; whatever happens it must not show a traceback."""
    (ended,) = side_by_side(1, *args, cwd=cwd, **env)
    return ended


def side_by_side(copies: int, *args: Arg, cwd: Path | None = None, **env: str) -> list[Ended]:
    """Run copies of the same command at once, each to its end."""
    # As Python reads a command line: what is no character becomes a lone surrogate.
    as_text = [os.fsdecode(arg) for arg in args]
    ended = warm().run(as_text, cwd or Path.cwd(), environment(**env), copies)
    for one in ended:
        assert "Traceback" not in one.err, one.err
    return ended


def done(*args: Arg, cwd: Path | None = None, **env: str) -> Ended:
    """Run the program, which must succeed."""
    ended = affcli(*args, cwd=cwd, **env)
    assert ended.code == 0, ended
    return ended


def refused(code: int, *args: Arg, cwd: Path | None = None) -> str:
    """Run the program, which must refuse in one printable line; return the line."""
    ended = affcli(*args, cwd=cwd)
    assert ended.code == code, ended
    assert ended.out == ""
    return one_printable_line(ended.err)


def one_printable_line(err: str) -> str:
    """Return the one line that a command wrote to stderr."""
    assert err.startswith("affcli: ")
    assert err.endswith("\n")
    assert err[:-1].isprintable(), err
    assert len(err) <= 1100
    return err[:-1]


def executed(*args: Arg, **env: str) -> Ended:
    """Run the program as a shell does, from the start of Python on."""
    with started(*args, **env) as process:
        return ending(process)


@contextmanager
def started(*args: Arg, **env: str) -> Iterator[subprocess.Popen[str]]:
    """Run the program beside the test, as a shell does: in a process group of its own.

    At the end of the block it is killed with all that it started, should it still run.
    """
    pipe = subprocess.PIPE
    with subprocess.Popen(
        [*PROGRAM, *args],
        env=environment(**env),
        stdin=subprocess.DEVNULL,
        stdout=pipe,
        stderr=pipe,
        text=True,
        start_new_session=True,
    ) as process:
        try:
            yield process
        finally:
            with suppress(ProcessLookupError):  # all of them have ended
                os.killpg(process.pid, signal.SIGKILL)


def ending(process: subprocess.Popen[str], timeout: float = PATIENCE) -> Ended:
    """Wait for a started program."""
    try:
        out, err = process.communicate(timeout=timeout)
    finally:
        process.kill()
    assert "Traceback" not in err, err
    return Ended(process.returncode, out, err)


def rows(database: Path, query: str) -> list[tuple[Any, ...]]:
    """Ask a database without affcli; wait for whoever writes to it."""
    # Not read-only: after a kill the file must first be set right from its journal.
    with closing(sqlite3.connect(f"{database.absolute().as_uri()}?mode=rw", uri=True)) as driver:
        driver.execute("PRAGMA busy_timeout = 20000")
        return list(driver.execute(query))


def contents(database: Path) -> Contents:
    """Return all that a database holds, table by table, but when it happened."""
    tables = rows(database, "SELECT name FROM sqlite_master WHERE type = 'table'")
    held: Contents = {}
    for (table,) in sorted(tables):
        columns = [name for _, name, *_ in rows(database, f"PRAGMA table_info({table})")]
        kept = ", ".join(column for column in columns if column not in CLOCKS)
        held[table] = sorted(rows(database, f"SELECT {kept} FROM {table}"), key=repr)
    return held


def wait_until(happened: Callable[[], bool], process: subprocess.Popen[str]) -> None:
    """Wait until something happened while a process runs."""
    deadline = time.monotonic() + PATIENCE
    while not happened():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.01)


def names_in(folder: Path) -> list[str]:
    """Return what is in a folder."""
    return sorted(path.name for path in folder.iterdir())
