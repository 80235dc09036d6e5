"""The program, forked and held: whoever runs a command may do something to its process."""

import json
import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.cli.program import PATIENCE, ROOT, environment
from tests.cli.server import TO_STOP

Disturbance = Callable[[int], AbstractContextManager[object]]
"""What is done to a process of this number while it runs: entered before it begins."""


def nothing(pid: int) -> AbstractContextManager[object]:
    """Leave a process alone."""
    return nullcontext(pid)


@dataclass(frozen=True, slots=True)
class Finished:
    """A command that ended: exit code, output; `stopped` when it had to be asked to."""

    code: int
    out: bytes
    err: str
    stopped: bool


class Forked:
    """A server (see ``server.py``), and the commands it runs one after the other.

    Args:
        seconds: after these a command is asked to stop; nearly all take a few milliseconds.
        bounds: of every command, as `run` takes them.
    """

    def __init__(self, seconds: float = PATIENCE, **bounds: int) -> None:
        self.took = self._used = 0.0
        """Seconds of processor time that the last command took; and that all have taken."""
        self._seconds, self._bounds = seconds, bounds
        self._folder = Path(tempfile.mkdtemp(prefix="affcli-forked-"))
        self._temporary = self._folder / "temporary"
        self._temporary.mkdir()
        self._process: subprocess.Popen[bytes] | None = None

    def run(
        self,
        args: Sequence[str],
        cwd: Path,
        *,
        disturbed: Disturbance = nothing,
        env: Mapping[str, str] | None = None,
        bounds: Mapping[str, int] | None = None,
    ) -> Finished:
        """Run a command to its end.

        Args:
            args: what follows ``affcli``.
            cwd: where.
            disturbed: what is done to its process.
            env: what is added to the environment.
            bounds: ``memory`` and ``room`` (bytes), ``clock`` (seconds that it is put forward).
        """
        out, err = (self._folder / name for name in ("out", "err"))
        for path in (out, err):  # a signal may come before the command has opened them
            path.write_bytes(b"")
        environs = environment(**{"TMPDIR": str(self._temporary), **(env or {})})
        where = {"cwd": str(cwd), "env": environs, "out": str(out), "err": str(err)}
        limits = {"seconds": self._seconds, "bounds": {**self._bounds, **(bounds or {})}}
        self._tell(json.dumps({"args": list(args), **limits, **where}))
        with disturbed(self._answer(PATIENCE)):
            self._tell("go")
            code, stopped, used = self._answer(self._seconds + 3.0 * TO_STOP)
        self.took, self._used = used - self._used, used
        return Finished(code, out.read_bytes(), err.read_bytes().decode(), stopped)

    def left_behind(self) -> list[str]:
        """Return what commands left in the folder for temporary files; it is empty then."""
        names = [path.name for path in self._temporary.iterdir()]
        shutil.rmtree(self._temporary)
        self._temporary.mkdir()
        return names

    def close(self) -> None:
        """End it, with a command that runs, and leave nothing behind."""
        self._stop()
        shutil.rmtree(self._folder)

    def _stop(self) -> None:
        if self._process is not None:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.communicate()
            self._process, self._used = None, 0.0

    def _tell(self, line: str) -> None:
        if self._process is None:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "tests.cli.server"],
                cwd=ROOT,
                env=environment(OPENBLAS_NUM_THREADS="1"),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,
            )
        assert self._process.stdin is not None
        self._process.stdin.write(line.encode() + b"\n")
        self._process.stdin.flush()

    def _answer(self, seconds: float) -> Any:
        assert self._process is not None
        assert self._process.stdout is not None
        ready, _, _ = select.select([self._process.stdout], [], [], seconds)
        if not ready:
            self._stop()
        assert ready, "a command hangs"
        return json.loads(self._process.stdout.readline())
