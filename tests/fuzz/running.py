"""A case: one command in a folder of its own; and what must hold of it, whatever it was."""

import json
import os
import select
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from tests.cli.program import ROOT, environment
from tests.fuzz.server import TO_STOP

SECONDS = 30.0
"""After these a command is asked to stop; nearly all take a few milliseconds."""
LONGEST_LINE = 1100
SPEAKING_FIRST = ("learn", "reproduce", "db upgrade")
"""What these say of finished work may stand before the line of a refusal."""
REPORTING = ("db check", "doctor", "camera calibrate", "camera locate")
"""These tell what is wrong on stdout."""


@dataclass(frozen=True, slots=True)
class Finished:
    """A command that ended: exit code, output; `stopped` when it had to be asked to."""

    code: int
    out: bytes
    err: str
    stopped: bool


class Program:
    """The program, imported and waiting to be forked (see ``server.py``)."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="affcli-fuzz-"))
        self._process: subprocess.Popen[bytes] | None = None

    def run(self, args: Sequence[str], cwd: Path, env: Mapping[str, str]) -> Finished:
        """Run a command to its end."""
        if self._process is None:
            self._process = self._started()
        process = self._process
        out, err = (str(self.folder / name) for name in ("out", "err"))
        where = {"cwd": str(cwd), "env": environment(**env), "out": out, "err": err}
        request = {"args": list(args), "seconds": SECONDS, **where}
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(json.dumps(request).encode() + b"\n")
        process.stdin.flush()
        ready, _, _ = select.select([process.stdout], [], [], SECONDS + 3.0 * TO_STOP)
        if not ready:
            self.stop()
        assert ready, f"{args} hangs"
        code, stopped = json.loads(process.stdout.readline())
        told = Path(err).read_bytes().decode()
        return Finished(code, Path(out).read_bytes(), told, stopped)

    def stop(self) -> None:
        """End it, and a command that hangs with it."""
        if self._process is not None:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.communicate()
            self._process = None

    def close(self) -> None:
        """End it and leave nothing behind."""
        self.stop()
        shutil.rmtree(self.folder)

    def _started(self) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-m", "tests.fuzz.server"],
            cwd=ROOT,
            env=environment(OPENBLAS_NUM_THREADS="1"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,
        )


def check_ending(name: str, ended: Finished) -> None:
    """Check what holds of every command, however it was called.

    Args:
        name: of the command, with blanks between its words.
        ended: what it did.
    """
    assert "Traceback" not in ended.err, ended.err
    if ended.stopped:
        assert ended.code == 128 + signal.SIGTERM, f"does not stop: {ended}"
        return
    assert ended.code in {0, 1, 2, 3, 4}, ended
    lines = ended.err.removesuffix("\n").split("\n")
    if ended.code in {2, 3, 4} and not (ended.code == 2 and "Usage:" in ended.err):
        if not (ended.code == 3 and name in REPORTING and ended.out):
            assert lines[-1].startswith("affcli: "), ended
            assert len(lines[-1]) <= LONGEST_LINE, ended
            assert len(lines) == 1 or name in SPEAKING_FIRST, ended
        assert all(line.isprintable() for line in lines), ended


def check_json(ended: Finished) -> None:
    """Check that stdout is JSON as everyone reads it: without NaN."""

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    json.loads(ended.out, parse_constant=refuse)


def files_in(folder: Path) -> set[str]:
    """Return the files in a folder and below it, by their way from it."""
    return {
        os.path.relpath(os.path.join(place, name), folder)  # noqa: PTH118 names of any bytes
        for place, _, names in os.walk(folder)
        for name in names
    }


def is_sound(database: Path) -> bool:
    """Tell whether SQLite finds nothing wrong in a file."""
    with closing(sqlite3.connect(database)) as driver:
        found: list[tuple[str]] = driver.execute("PRAGMA integrity_check").fetchall()
    return found == [("ok",)]
