"""One run of the ``affcli`` program: how errors, signals and the exit code leave it."""

import gc
import signal
import sys
from types import FrameType

from affcli.cli.terminal import prepare_streams, say
from affcli.errors import AffcliError, one_line

GO_ON = ("learn", "reproduce")
"""The commands that, given again, go on from what is saved."""

GARBAGE = 100_000
"""So many new objects start a search for cycles among them. Python's own 700 is meant for programs
that run for hours; importing the libraries would be searched three hundred times, which is a tenth
of the time of `affcli learn`."""


AGAIN = 0.1
"""Seconds after which a signal is minded once more when nothing has come of it."""


class Stopped(BaseException):
    """The process was asked to end; not an Exception, so nothing takes it for a failure."""


class Stop:
    """What SIGINT and SIGTERM do: leave by an exception, so that what is open is closed.

    Python swallows an exception that falls into a callback, as the import system, sqlite3 and what
    clears up objects have many. So it is raised again and again until `main` has it. A second
    signal ends the process at once; SQLite then rolls back when the file is next opened.
    """

    signum: int | None = None

    def __init__(self) -> None:
        for signum in (signal.SIGINT, signal.SIGTERM):
            signal.signal(signum, self)
        signal.signal(signal.SIGALRM, _leave)
        sys.unraisablehook = _pass_over

    def __call__(self, signum: int, frame: FrameType | None) -> None:
        """Remember the signal and leave."""
        del frame
        self.signum = signum
        for either in (signal.SIGINT, signal.SIGTERM):
            signal.signal(either, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, AGAIN, AGAIN)
        raise Stopped


def _leave(signum: int, frame: FrameType | None) -> None:
    """Leave by an exception, unless one is under way: what it closes on its way is closed."""
    del signum, frame
    error = sys.exception()
    while error is not None:
        if isinstance(error, Stopped):
            return
        error = error.__context__
    raise Stopped


def _pass_over(unraisable: "sys.UnraisableHookArgs") -> None:
    """Say nothing of our exception where Python had to swallow it."""
    if not isinstance(unraisable.exc_value, Stopped):
        sys.__unraisablehook__(unraisable)


def main() -> int:
    """Run the program and return its exit code.

    0 ok, 1 the task was not solved, 2 usage, 3 database, 4 bad input, 130/143 interrupted. Only
    what a user can cause becomes one line on stderr; a bug keeps its traceback.
    """
    gc.set_threshold(GARBAGE)
    prepare_streams()
    stop = Stop()
    try:
        code = _run()
        signal.setitimer(signal.ITIMER_REAL, 0.0)
    except BaseException as error:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        # After a signal this may be another exception than ours: sqlite3 forgets what is raised in
        # its callbacks, and SQLAlchemy closes the connection that a signal interrupts.
        if stop.signum is not None:
            goes_on = ""
            if _command() in GO_ON:
                goes_on = ", and the same command goes on from there (or: --resume)"
            return _fail(f"stopped; what was saved is kept{goes_on}", 128 + stop.signum)
        if isinstance(error, AffcliError):
            return _fail(str(error), error.exit_code)
        raise
    return code


def _run() -> int:
    """Run the command that was given."""
    # Imported only now: a ctrl-C meanwhile is one line like any other.
    import typer

    from affcli.cli.app import app

    try:
        code = app(prog_name="affcli", standalone_mode=False)
    except typer.TyperException as error:
        return _fail(error.format_message(), error.exit_code)
    return code if isinstance(code, int) else 0


def _fail(message: str, code: int) -> int:
    """Write one line to stderr and return the exit code."""
    say(f"affcli: {one_line(message.strip(), 1000)}")
    return code


def _command() -> str:
    """Return the command that was given, empty if none."""
    return next(iter(sys.argv[1:]), "")
