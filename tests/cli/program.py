"""The program, within this process or as one of its own: run it, read it, see what it wrote."""

import io
import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, chdir, closing, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch

from affcli.cli.main import main

ROOT = Path(__file__).parents[2]
PROGRAM = (sys.executable, "-m", "affcli")
PATIENCE = 120.0
"""Seconds after which a command is taken to hang. No test is about speed."""

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)
"""What the program handles while it runs."""

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

    @property
    def results(self) -> list[dict[str, Any]]:
        """What a command with --json answered, in the shape that all answers have."""
        answer = self.json
        assert list(answer) == ["command", "format", "results"]
        assert answer["format"] == 1
        results: list[dict[str, Any]] = answer["results"]
        return results

    @property
    def result(self) -> dict[str, Any]:
        """The one thing that it answered."""
        (result,) = self.results
        return result


def environment(**changes: str) -> dict[str, str]:
    """Return this process's environment without what changes the program's looks or database."""
    ours = ("AFFCLI_DB", "COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR", "TERM", "PYTHONIOENCODING")
    return {k: v for k, v in os.environ.items() if k not in ours} | changes


def affcli(*args: Arg, cwd: Path | None = None, **env: str) -> Ended:
    """Run a command to its end within this process; only an error of affcli's own may leave it.

    Its streams are as in a shell; what a shell does besides, `executed` and `started` are for.
    """
    # As Python reads a command line: what is no character becomes a lone surrogate.
    words = ["affcli", *map(os.fsdecode, args)]
    out, err = io.BytesIO(), io.BytesIO()
    hook, handlers = sys.unraisablehook, {one: signal.getsignal(one) for one in SIGNALS}
    with (
        Path(os.devnull).open(encoding="utf-8") as nothing,
        io.TextIOWrapper(out, "utf-8") as stdout,
        io.TextIOWrapper(err, "utf-8") as stderr,
        chdir(cwd or Path.cwd()),
        patch.dict(os.environ, environment(**env), clear=True),
        patch.multiple(sys, argv=words, stdin=nothing, stdout=stdout, stderr=stderr),
    ):
        try:
            code = main()
        finally:
            sys.unraisablehook = hook
            for signum, handler in handlers.items():
                signal.signal(signum, handler)
        stdout.flush()
        stderr.flush()
        return Ended(code, *(text.getvalue().decode().replace("\r\n", "\n") for text in (out, err)))


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


def side_by_side(copies: int, *args: Arg) -> list[Ended]:
    """Run copies of the same command at once, each a process, to its end."""
    with ExitStack() as all_of_them:
        processes = [all_of_them.enter_context(started(*args)) for _ in range(copies)]
        return [ending(process) for process in processes]


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


@contextmanager
def opened(database: Path) -> Iterator[sqlite3.Connection]:
    """Open a database without affcli; wait for whoever writes to it."""
    # Not read-only: after a kill the file must first be set right from its journal.
    with closing(sqlite3.connect(f"{database.absolute().as_uri()}?mode=rw", uri=True)) as driver:
        driver.execute("PRAGMA busy_timeout = 20000")
        yield driver


def rows(database: Path, query: str) -> list[tuple[Any, ...]]:
    """Ask a database without affcli; wait for whoever writes to it."""
    with opened(database) as driver:
        return list(driver.execute(query))


def contents(database: Path) -> Contents:
    """Return all that a database holds, table by table, but when it happened, and the last ids."""
    chosen = "type = 'table' AND name <> 'sqlite_sequence'"
    held: Contents = {}
    with opened(database) as driver:
        tables = list(driver.execute(f"SELECT name FROM sqlite_master WHERE {chosen}"))
        for (table,) in sorted(tables):
            columns = [name for _, name, *_ in driver.execute(f"PRAGMA table_info({table})")]
            kept = ", ".join(column for column in columns if column not in CLOCKS)
            held[table] = sorted(driver.execute(f"SELECT {kept} FROM {table}"), key=repr)
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
