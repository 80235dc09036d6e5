"""The program on a terminal, so that the tests see what a person sees and type what one types."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
from collections import deque
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from tests.cli.program import PATIENCE, PROGRAM, environment

ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
COLOR = re.compile(r"\x1b\[(?:\d+;)*(?:3\d|4\d|9\d|10\d)(?:;\d+)*m")
CTRL_C, CTRL_D = "\x03", "\x04"
AT_ITS_TERMINAL = """\
import fcntl, os, sys, termios
fcntl.ioctl(2, termios.TIOCSCTTY, 0)
os.execv(sys.argv[1], sys.argv[1:])
"""
"""Runs the program so that ctrl-C, typed at the terminal, reaches it."""


def on_terminal(
    *args: str | Path,
    columns: int = 80,
    results_to: Path | None = None,
    answers: Iterable[tuple[str, str | bytes]] = (),
    can_type: bool = True,
    **env: str,
) -> tuple[int, str]:
    """Run the program on a terminal; return the exit code and all that the terminal got.

    Args:
        args: of the program.
        columns: how wide the terminal is; it has 24 lines.
        results_to: where stdout goes; None for the terminal.
        answers: what is typed, each as soon as the text before it has come.
        can_type: stdin is the terminal too.
        env: what is added to the environment.
    """
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    elsewhere = None if results_to is None else results_to.open("wb")
    with subprocess.Popen(
        [sys.executable, "-c", AT_ITS_TERMINAL, *PROGRAM, *args],
        env=environment(**{"TERM": "xterm", **env}),
        stdin=its if can_type else subprocess.DEVNULL,
        stdout=elsewhere or its,
        stderr=its,
        start_new_session=True,
    ) as process:
        os.close(its)
        got = _conversation(ours, answers, process)
        os.close(ours)
        code = process.wait(PATIENCE)
    if elsewhere is not None:
        elsewhere.close()
    return code, got.decode(errors="replace").replace("\r\n", "\n")


def _conversation(
    ours: int, answers: Iterable[tuple[str, str | bytes]], process: subprocess.Popen[bytes]
) -> bytes:
    """Type the answers; return all that the terminal got."""
    waiting, got, answered = deque(answers), b"", 0
    with suppress(OSError):  # how a terminal says that the other end has gone
        while True:
            ready, _, _ = select.select([ours], [], [], PATIENCE)
            if not ready:
                process.kill()
            assert ready, f"it waits; the last it said: {got[-300:]!r}"
            piece = os.read(ours, 65536)
            if not piece:
                break
            got += piece
            if waiting and waiting[0][0].encode() in got[answered:]:
                _, keys = waiting.popleft()
                os.write(ours, keys if isinstance(keys, bytes) else keys.encode())
                answered = len(got)
    assert not waiting, f"it never said {waiting[0][0]!r}: {got[-300:]!r}"
    return got
