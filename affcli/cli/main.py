"""One run of the ``affcli`` program: how errors, signals and the exit code leave it."""

import errno
import gc
import sys
from pathlib import Path

from affcli.cli.commands import how_it_goes_on
from affcli.cli.signals import SignalHandler, Stopped
from affcli.cli.terminal import prepare_streams, say
from affcli.errors import AffcliError, BadInputError, one_line
from affcli.memory import ask_for

OBJECTS_BETWEEN_COLLECTIONS = 100_000
"""New objects after which Python searches for cycles among them. Its own 700 is meant for programs
that run for hours; importing the libraries would be searched three hundred times, which is a tenth
of the time of `affcli learn`."""

ROOM_FOR_NUMPY = 100 << 20
"""Bytes of address space that NumPy needs to be imported: with less, its OpenBLAS ends the process
with a line and a code of its own."""
FOR_WANT_OF_MEMORY = (
    "failed to map segment from shared object",
    "without exception set",
    "without setting an exception",
)
"""What is said where there is no memory for a library (the loader, in an ImportError) or to call a
function (Python, in a SystemError)."""
OUT_OF_MEMORY = "memory ran out; what was saved is kept; ask for less, or leave more memory free"


def main() -> int:
    """Run the program and return its exit code.

    0 ok, 1 the task was not solved, 2 usage, 3 database, 4 bad input or a part that failed, 130/143
    interrupted. Only what a user can cause becomes one line on stderr; a bug keeps its traceback.
    """
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    prepare_streams()
    try:
        Path.cwd()
    except FileNotFoundError:
        return _fail("the working folder is gone; cd to one that is there", BadInputError.exit_code)
    handler = SignalHandler()
    try:
        handler.listen()
        return _run(handler)
    except Stopped:  # it came before the command began, or between an error and its line
        return _stopped(handler)
    except BaseException as error:
        if not _ran_out_of_memory(error):
            raise
    # Only now: until the error is let go of, it holds what the command had in memory.
    return _fail(OUT_OF_MEMORY, BadInputError.exit_code)


def _run(handler: SignalHandler) -> int:
    """Run the command; return its exit code, after a line about what ended it."""
    try:
        if "numpy" not in sys.modules:
            ask_for(ROOM_FOR_NUMPY)
        # Imported only now: a ctrl-C meanwhile is one line like any other.
        from affcli.cli.app import run  # noqa: PLC0415

        code = run()
        handler.silence()
    except BaseException as error:
        handler.silence()
        # After a signal this may be another exception than ours: sqlite3 forgets what is raised in
        # its callbacks, and SQLAlchemy closes the connection that a signal interrupts.
        if handler.signum is not None:
            return _stopped(handler)
        if isinstance(error, AffcliError):
            return _fail(str(error), error.exit_code)
        raise
    return code


def _stopped(handler: SignalHandler) -> int:
    """Say that a signal ended the command, and how it goes on."""
    handler.silence()
    again = how_it_goes_on(sys.argv[1:])
    return _fail(f"stopped; what was saved is kept{again}", 128 + (handler.signum or 0))


def _ran_out_of_memory(error: BaseException | None) -> bool:
    """Tell whether memory ran out, or did and made something else go wrong."""
    while error is not None:
        of_the_system = isinstance(error, OSError) and error.errno == errno.ENOMEM
        said = isinstance(error, (ImportError, SystemError)) and any(
            words in str(error) for words in FOR_WANT_OF_MEMORY
        )
        if isinstance(error, MemoryError) or of_the_system or said:
            return True
        error = error.__context__
    return False


def _fail(message: str, code: int) -> int:
    """Write one line to stderr and return the exit code."""
    say(f"affcli: {one_line(message.strip(), 1000)}")
    return code
