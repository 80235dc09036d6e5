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
from pathlib import Path
from typing import Any

from tests.cli.program import ROOT, environment
from tests.fuzz.running import Finished
from tests.fuzz.server import TO_STOP

SECONDS = 120.0
"""After these a command is taken to hang; nearly all take less than one."""

Disturbance = Callable[[int], AbstractContextManager[object]]
"""What is done to a process of this number while it runs: entered before it begins."""


def nothing(pid: int) -> AbstractContextManager[object]:
    """Leave a process alone."""
    return nullcontext(pid)


class Held:
    """A server (see ``server.py``), and the commands it runs one after the other."""

    def __init__(self) -> None:
        self.took = self._used = 0.0
        """Seconds of processor time that the last command took; and that all have taken."""
        self.folder = Path(tempfile.mkdtemp(prefix="affcli-attack-"))
        (self.folder / "temporary").mkdir()
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.attack.server"],
            cwd=ROOT,
            env=environment(OPENBLAS_NUM_THREADS="1"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,
        )

    def run(
        self,
        args: Sequence[str],
        cwd: Path,
        disturbed: Disturbance = nothing,
        bounds: Mapping[str, int] | None = None,
    ) -> Finished:
        """Run a command to its end.

        Args:
            args: what follows ``affcli``.
            cwd: where.
            disturbed: what is done to its process.
            bounds: ``memory`` and ``room`` (bytes), ``clock`` (seconds that it is put forward).
        """
        out, err = (str(self.folder / name) for name in ("out", "err"))
        for path in (out, err):  # a signal may come before the command has opened them
            Path(path).write_bytes(b"")
        env = environment(TMPDIR=str(self.folder / "temporary"))
        request = {"args": list(args), "seconds": SECONDS, "bounds": dict(bounds or {})}
        self._tell(json.dumps({**request, "cwd": str(cwd), "env": env, "out": out, "err": err}))
        with disturbed(self._answer(SECONDS)):
            self._tell("go")
            code, stopped, used = self._answer(SECONDS + 3.0 * TO_STOP)
        self.took, self._used = used - self._used, used
        told = Path(err).read_bytes().decode()
        return Finished(code, Path(out).read_bytes(), told, stopped)

    def left_behind(self) -> list[str]:
        """Return what commands left in the folder for temporary files; it is empty then."""
        temporary = self.folder / "temporary"
        names = [path.name for path in temporary.iterdir()]
        shutil.rmtree(temporary)
        temporary.mkdir()
        return names

    def close(self) -> None:
        """End it, with a command that runs, and leave nothing behind."""
        os.killpg(self._process.pid, signal.SIGKILL)
        self._process.communicate()
        shutil.rmtree(self.folder)

    def _tell(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(line.encode() + b"\n")
        self._process.stdin.flush()

    def _answer(self, seconds: float) -> Any:
        assert self._process.stdout is not None
        ready, _, _ = select.select([self._process.stdout], [], [], seconds)
        assert ready, "a command hangs"
        return json.loads(self._process.stdout.readline())
