"""Killed again and again, as by a cluster or a power cut, and gone on with."""

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import termios
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tests.cli.program import (
    PATIENCE,
    PROGRAM,
    contents,
    done,
    environment,
    rows,
    started,
    wait_until,
)
from tests.cli.pseudo_terminal import ESCAPE
from tests.cli.test_interrupt import children_of, count

ENDLESS = ("learn", "--tool", "stick", "--behaviors", "1000000")
SAID = re.compile(r"(\d+) behaviors, (\d+) rows?, (\d+) resets?")


@dataclass(slots=True)
class Watched:
    """A program on a terminal, and what it has said so far."""

    process: subprocess.Popen[bytes]
    terminal: int
    said: str = ""

    def listen(self, seconds: float) -> None:
        """Read what comes within so many seconds."""
        deadline = time.monotonic() + seconds
        with suppress(OSError):  # how a terminal says that the other end has gone
            while (left := deadline - time.monotonic()) > 0.0:
                ready, _, _ = select.select([self.terminal], [], [], left)
                if ready:
                    self.said += os.read(self.terminal, 65536).decode(errors="replace")

    def wait_until(self, happened: Callable[[], bool]) -> None:
        """Listen until something has happened, to the program or by it."""
        deadline = time.monotonic() + PATIENCE
        while not happened():
            assert self.process.poll() is None, self.said
            assert time.monotonic() < deadline
            self.listen(0.0005)

    def saved(self) -> tuple[int, ...]:
        """Return the behaviors, rows and resets that were last said to be saved."""
        found = SAID.findall(ESCAPE.sub("", self.said))
        return tuple(map(int, found[-1])) if found else (0, 0, 0)


@contextmanager
def watched(*args: str | Path) -> Iterator[Watched]:
    """Run the program on a terminal of 80 columns; kill it at the end if it still runs."""
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    with subprocess.Popen(
        [*PROGRAM, *args],
        env=environment(TERM="xterm"),
        stdin=subprocess.DEVNULL,
        stdout=its,
        stderr=its,
        start_new_session=True,
    ) as process:
        os.close(its)
        try:
            yield Watched(process, ours)
        finally:
            process.kill()
            os.close(ours)


def journal_of(database: Path) -> bool:
    """Tell whether a write is going on."""
    return any(Path(f"{database}-{kind}").exists() for kind in ("journal", "wal"))


@pytest.mark.fault(1)
@pytest.mark.fault(19)
@pytest.mark.torture
def test_every_behavior_that_was_said_to_be_saved_outlives_a_kill(
    tmp_path: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    """Killed after something was said to be saved, while something is, and at any moment."""
    database, alone = tmp_path / "my.db", tmp_path / "alone.db"
    kills = 100 if torture else 6
    moments = np.random.default_rng(5)
    kept = acknowledged = while_saving = 0
    for kill in range(kills):
        with watched(*ENDLESS, "--db", database) as program:
            if kill % 3 == 0:
                program.wait_until(lambda: program.saved()[0] > kept)  # noqa: B023 asked at once
                program.listen(float(moments.uniform(0.0, 0.3)))
            elif kill % 3 == 1:
                program.wait_until(lambda: journal_of(database))
                program.listen(float(moments.uniform(0.0, 0.004)))
            else:
                program.listen(float(moments.uniform(0.0, 1.5)))
            program.process.kill()
            torn = journal_of(database)
            program.listen(0.01)
            assert program.process.wait(PATIENCE) == -signal.SIGKILL
            said = program.saved()
        while_saving += torn
        there = state(database)
        assert all(a <= b for a, b in zip(said, there, strict=True)), f"kill {kill + 1}"
        assert there[0] >= kept, f"kill {kill + 1}"
        acknowledged += max(0, said[0] - kept)
        kept = there[0]
    assert acknowledged >= kills // 3 * 500
    done(*ENDLESS[:-1], str(kept), "--db", alone)
    for table in ("behavior", "affordance"):
        assert contents(database)[table] == contents(alone)[table]
    done("db", "check", "--db", database)
    tell(
        f"{kills} kills, {while_saving} of them in the middle of a write; {kept} behaviors kept, "
        f"{acknowledged} of them acknowledged before a kill; all equal those of a run undisturbed"
    )


def state(database: Path) -> tuple[int, ...]:
    """Return behaviors, rows and resets that a database holds, after SQLite has checked it."""
    if not database.exists() or not rows(database, "SELECT 1 FROM sqlite_master"):
        return (0, 0, 0)
    assert rows(database, "PRAGMA integrity_check") == [("ok",)]
    run = "SELECT behaviors, rows, resets FROM learning_run"
    counts = (
        "SELECT (SELECT count(*) FROM behavior), (SELECT count(*) FROM affordance), "
        "(SELECT coalesce(sum(resets), 0) FROM behavior)"
    )
    held = rows(database, run)
    assert held in ([], rows(database, counts))
    return tuple(held[0]) if held else (0, 0, 0)


@pytest.mark.fault(2)
@pytest.mark.torture
def test_a_reproduction_killed_again_and_again_ends_as_if_nothing_had_happened(
    leisurely: Path, reproduced: Path, tmp_path: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    """Killed at any moment, gone on with by --resume or the same command, by one worker or more."""
    moments = np.random.default_rng(6)
    rounds, kills = (10, 4) if torture else (1, 2)
    fell = 0
    for number in range(rounds):
        database = tmp_path / f"{number}.db"
        command = ("reproduce", "--robots", "2", "--config", leisurely, "--db", database)
        for kill in range(kills):
            resumes = kill % 2 and unfinished(database)
            again = ("reproduce", "--resume", "--db", database) if resumes else command
            with started(*again, "--workers", str(1 + kill % 3)) as process:
                with suppress(subprocess.TimeoutExpired):
                    process.wait(float(moments.uniform(0.3, 2.5)))
                fell += process.poll() is None
                process.kill()
            if database.exists():
                assert rows(database, "PRAGMA integrity_check") == [("ok",)]
        done(*command, "--workers", "1")
        assert contents(database) == contents(reproduced)
    tell(f"{rounds} reproductions, {fell} kills before the end; every table as undisturbed")


def unfinished(database: Path) -> int:
    """Return how many reproductions were begun and are not done."""
    return count(database, "SELECT count(*) FROM session WHERE status = 'running'")


@pytest.mark.fault(2)
def test_the_workers_of_a_killed_reproduction_end_with_it(tmp_path: Path) -> None:
    """None is left to wait for work that will never come."""
    command = ("reproduce", "--robots", "9", "--workers", "2", "--db", tmp_path / "my.db")
    with started(*command) as process:
        wait_until(lambda: len(children_of(process.pid, "affcli.lab.workers")) == 2, process)
        workers = children_of(process.pid, "affcli.lab.workers")
        process.kill()
        process.wait(PATIENCE)
        deadline = time.monotonic() + PATIENCE
        while any(map(runs, workers)):
            assert time.monotonic() < deadline
            time.sleep(0.05)


def runs(pid: int) -> bool:
    """Tell whether a process runs; one that only waits to be buried does not."""
    command = ["/bin/ps", "-o", "stat=", "-p", str(pid)]
    status = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    return not status.startswith("Z") and bool(status.strip())
