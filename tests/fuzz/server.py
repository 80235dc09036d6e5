"""The program forked for every case, within bounds: ``python -m tests.fuzz.server``.

As ``tests.cli.warm``, whose requests it takes, but for this: a command has so much memory and so
many seconds. When these are over it is asked to stop, which it must do as after ctrl-C.

The answer is a line of JSON: the exit code (negative: died of that signal), and whether it was
asked to stop.
"""

import gc
import json
import os
import resource
import signal
import sys
import time
from typing import Any

from tests.cli.warm import import_everything, run, warm_up

MEMORY = 4 * 2**30
"""Bytes of address space: most of it is never touched."""
TO_STOP = 20.0
"""Seconds in which a command that is asked to stop must end; it takes some milliseconds."""


def bounded(request: dict[str, Any]) -> None:
    """Be a command that cannot take all memory, nor leave a core file."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    run(request)


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
        child = os.fork()
        if child == 0:
            bounded(request)
        code, stopped = code_within(child, request["seconds"]), False
        if code is None:
            stopped = True
            os.kill(child, signal.SIGTERM)
            code = code_within(child, TO_STOP)
        if code is None:
            os.kill(child, signal.SIGKILL)
            code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        sys.stdout.write(json.dumps((code, stopped)) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    import_everything()
    warm_up()
    gc.freeze()
    serve()
