"""The program on a terminal, so that the tests see what a person sees."""

import fcntl
import os
import pty
import re
import struct
import subprocess
import termios
from contextlib import suppress
from pathlib import Path

from tests.cli.program import PATIENCE, PROGRAM, environment

ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
COLOR = re.compile(r"\x1b\[(?:\d+;)*(?:3\d|4\d|9\d|10\d)(?:;\d+)*m")


def on_terminal(
    *args: str | Path, columns: int = 80, results_to: Path | None = None, **env: str
) -> tuple[int, str]:
    """Run the program on a terminal; return the exit code and all that the terminal got.

    Args:
        args: of the program.
        columns: how wide the terminal is.
        results_to: where stdout goes; None for the terminal.
        env: what is added to the environment.
    """
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    elsewhere = None if results_to is None else results_to.open("wb")
    with subprocess.Popen(
        [*PROGRAM, *args],
        env=environment(**{"TERM": "xterm", **env}),
        stdin=its,
        stdout=elsewhere or its,
        stderr=its,
    ) as process:
        os.close(its)
        got = b""
        with suppress(OSError):  # how a terminal says that the other end has gone
            while piece := os.read(ours, 65536):
                got += piece
        os.close(ours)
        code = process.wait(PATIENCE)
    if elsewhere is not None:
        elsewhere.close()
    return code, got.decode().replace("\r\n", "\n")
