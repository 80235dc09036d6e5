"""The program forked for every command, within bounds: ``python -m tests.cli.server``.

As ``tests.cli.warm``, whose requests it takes; beside these each has `seconds`, after which the
command is asked to stop, which it must do as after ctrl-C, and `bounds`: a clock of its own, little
memory or room for files. A command is named (its process id, a line of JSON) before it begins, so
that it can be traced and signalled; it begins at a line on stdin.

The answer is a line of JSON: the exit code (negative: died of that signal), whether it was asked to
stop, and the seconds of processor time that all commands so far took.
"""

import datetime as dt
import gc
import json
import os
import resource
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from tests.cli.warm import import_everything, run, warm_up

TO_STOP = 20.0
"""Seconds in which a command that is asked to stop must end; it takes some milliseconds."""


def confine(bounds: dict[str, int]) -> None:
    """Let this process have so much more memory, so much room for a file, another clock."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if "memory" in bounds:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        most = pages * resource.getpagesize() + bounds["memory"]
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
    if "room" in bounds:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # as Python does when it starts
        resource.setrlimit(resource.RLIMIT_FSIZE, (bounds["room"], bounds["room"]))
    if "clock" in bounds:
        turn_clock(bounds["clock"])


def turn_clock(seconds: int) -> None:
    """Put the clock that the program looks at forward, or back."""
    from affcli.cli import terminal

    truly = time.time

    class Turned(dt.datetime):
        @classmethod
        def now(cls, tz: dt.tzinfo | None = None) -> "Turned":
            return super().now(tz) + dt.timedelta(seconds=seconds)

    time.time = lambda: truly() + seconds
    vars(terminal)["datetime"] = Turned


def begun(request: dict[str, Any], gate: int) -> None:
    """Be the command, once the gate is opened."""
    if os.read(gate, 1):
        confine(request["bounds"])
        run(request)
    os._exit(0)


def code_within(child: int, seconds: float) -> int | None:
    """Return the exit code of a child, None when it still runs after so many seconds."""
    deadline, nap = time.monotonic() + seconds, 0.0005
    while time.monotonic() < deadline:
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            return os.waitstatus_to_exitcode(status)
        time.sleep(nap)
        nap = min(1.2 * nap, 0.02)
    return None


def serve() -> None:
    """Fork for every request."""
    for line in sys.stdin:
        request = json.loads(line)
        closed, opens = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(opens)
            begun(request, closed)
        os.close(closed)
        answer(child)
        sys.stdin.readline()
        with suppress(BrokenPipeError):  # a signal was faster
            os.write(opens, b"!")
        os.close(opens)
        code, stopped = code_within(child, request["seconds"]), False
        if code is None:
            stopped = True
            os.kill(child, signal.SIGTERM)
            code = code_within(child, TO_STOP)
        if code is None:
            os.kill(child, signal.SIGKILL)
            code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        answer((code, stopped, used.ru_utime + used.ru_stime))


def answer(value: object) -> None:
    """Tell the driver."""
    sys.stdout.write(json.dumps(value) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    import_everything()
    warm_up()
    gc.freeze()
    serve()
