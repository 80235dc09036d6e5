"""A Python process beside this one, at the other end of a pipe; it ends when this one does."""

import os
import subprocess
import sys
from collections.abc import Callable
from multiprocessing.connection import Connection, Pipe
from select import poll
from typing import Any

from affcli.beside import beside

BEGIN = (
    "import sys; from multiprocessing.connection import Connection; "
    "pipe = Connection(int(sys.argv[1])); sys.path[:] = pipe.recv(); "
    "from {module} import {function}; {function}(pipe)"
)
"""What it runs: it finds affcli, once it is told, where this process found it."""
GONE = (EOFError, ConnectionError)
"""What a pipe raises when the process at its other end has ended."""


class Child:
    """A process that runs a function on its end of a pipe. It is told `sys.path` first.

    It reads nothing and says nothing; ctrl-C on the terminal reaches this process alone.

    Args:
        serve: the function, ``module:function``.

    Attributes:
        process: it.
        pipe: this end of the pipe.

    Raises:
        OSError: it cannot be started.
    """

    def __init__(self, serve: str) -> None:
        module, _, function = serve.partition(":")
        begin = BEGIN.format(module=module, function=function)
        self.pipe, theirs = Pipe()
        with theirs:
            self.process = subprocess.Popen(  # noqa: S603  # Python itself
                [sys.executable, "-c", begin, str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                process_group=0,
            )

    def end(self) -> None:
        """End it at once, whatever it does."""
        self.process.kill()
        self.process.wait()
        self.pipe.close()


def received(pipe: "Connection[Any, Any]") -> Callable[[], Any]:
    """Return what gives what comes through a pipe, piece by piece.

    For the child: it ends with the parent, which may be killed while the child does something.
    """
    parent = poll()
    parent.register(pipe, 0)

    def ends_with_parent() -> None:
        parent.poll()  # until the other end is closed: nothing else was asked for
        os._exit(1)

    def receive() -> Any:
        try:
            return pipe.recv()
        except GONE:
            os._exit(1)

    beside(ends_with_parent)
    return receive
