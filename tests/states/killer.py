"""Commands killed at one of their writes: ``python -m tests.states.killer``.

As ``tests.cli.warm``, whose requests it takes; beside these each has a kind of write and a number,
before which of its kind the command is killed, and a file in which each write becomes a line. Where
strace is there the writes are the system calls, elsewhere SQLAlchemy's statements and Python's own
changes of files. The answer to each line of JSON is the exit code, negative after a signal.
"""

import ctypes
import gc
import json
import os
import shutil
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import sqlalchemy as sa

from affcli.lab import learning
from tests.cli.warm import import_everything, run, warm_up
from tests.states.commands import CHUNK

STRACE = shutil.which("strace")
CALLS = (
    "fsync,fdatasync,pwrite64,write,ftruncate,?unlink,unlinkat,?rename,?renameat,renameat2,"
    "?chmod,fchmodat"
)
"""What changes files; a name that another processor does not know is passed over."""
ANYBODY = 0x59616D61, -1
"""PR_SET_PTRACER: another child of the same process may trace this one."""
CHANGES = frozenset({"os.rename", "os.remove", "os.chmod", "os.truncate"})


def serve() -> None:
    """Run each command that is asked for."""
    for line in sys.stdin:
        request = json.loads(line)
        ended = traced(request) if STRACE else counted(request)
        sys.stdout.write(f"{os.waitstatus_to_exitcode(ended)}\n")
        sys.stdout.flush()


def traced(request: dict[str, Any]) -> int:
    """Run a command that strace kills on entering a system call."""
    ours, its = os.pipe()
    child = os.fork()
    if child == 0:
        ctypes.CDLL(None).prctl(*ANYBODY, 0, 0, 0)
        os.read(ours, 1)
        run(request)
    arguments = ["-o", request["log"], "-e", f"trace={CALLS}", "-p", str(child)]
    if request["kind"]:
        kill = f"inject={request['kind']}:signal=SIGKILL:when={request['number']}"
        arguments += ["-e", kill]
    with subprocess.Popen([str(STRACE), *arguments], stderr=subprocess.PIPE, text=True) as strace:
        assert strace.stderr is not None
        said = strace.stderr.readline()
        os.write(its, b"!")
        os.close(its)
        os.close(ours)
        status = os.waitpid(child, 0)[1]
        assert said.endswith("attached\n"), said + strace.stderr.read()
    return status


def counted(request: dict[str, Any]) -> int:
    """Run a command that kills itself before a statement or a change of a file."""
    child = os.fork()
    if child == 0:
        done, log = Counter[str](), os.open(request["log"], os.O_CREAT | os.O_WRONLY)

        def write(kind: str) -> None:
            done[kind] += 1
            os.write(log, f"{kind}\n".encode())
            if (kind, done[kind]) == (request["kind"], request["number"]):
                os.kill(os.getpid(), signal.SIGKILL)

        def audited(event: str, args: tuple[Any, ...]) -> None:
            if event in CHANGES:
                write(event)

        sa.event.listen(sa.Engine, "before_cursor_execute", lambda *said: write(said[2][:6]))
        sys.addaudithook(audited)
        run(request)
    return os.waitpid(child, 0)[1]


class Killer:
    """The program, imported and waiting to be killed."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.states.killer"],
            cwd=Path(__file__).parents[2],
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def run(
        self, args: list[str], cwd: Path, kind: str = "", number: int = 0
    ) -> tuple[int, str, list[str]]:
        """Run a command, killed before the write of this kind and number if one is named.

        Returns:
            Its exit code, what it said on stderr, and its writes.
        """
        out, err, log = (self.folder / name for name in ("out", "err", "log"))
        log.unlink(missing_ok=True)
        asked: dict[str, Any] = {"args": args, "env": dict(os.environ), "cwd": str(cwd)}
        asked |= {"kind": kind, "number": number}
        asked |= {"out": str(out), "err": str(err), "log": str(log)}
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(asked) + "\n")
        self._process.stdin.flush()
        code = int(self._process.stdout.readline())
        lines = log.read_text(errors="replace").splitlines() if log.exists() else []
        writes = [line.split("(")[0] for line in lines if line[:1].isalpha()]
        return code, err.read_text(), writes

    def close(self) -> None:
        """End it."""
        self._process.kill()
        self._process.communicate()


if __name__ == "__main__":
    import_everything()
    warm_up()
    learning.CHUNK = CHUNK
    gc.freeze()
    serve()
