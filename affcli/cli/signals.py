"""How ctrl-C and SIGTERM end the program: by an exception, so that what is open is closed."""

import signal
import sys
from types import FrameType

REPEAT_AFTER = 0.1
"""Seconds after which `Stopped` is raised again when it has not ended the program."""


class Stopped(BaseException):
    """The process was asked to end; not an Exception, so nothing takes it for a failure."""


class SignalHandler:
    """Raises `Stopped` at SIGINT and SIGTERM.

    Python swallows an exception that is raised in a callback, as the import system, sqlite3 and
    finalizers have many. So it is raised again and again until `silence` is called. A second
    signal ends the process at once; SQLite then rolls back when the file is next opened.
    """

    signum: int | None = None
    """The signal that came; None if none did."""

    def listen(self) -> None:
        """Raise `Stopped` from now on when a signal comes; it may be while this is done."""
        for signum in (signal.SIGINT, signal.SIGTERM):
            signal.signal(signum, self)
        signal.signal(signal.SIGALRM, _raise_again)
        sys.unraisablehook = _report_unraisable

    def __call__(self, signum: int, frame: FrameType | None) -> None:
        """Remember the signal and raise."""
        del frame
        self.signum = signum
        for either in (signal.SIGINT, signal.SIGTERM):
            signal.signal(either, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, REPEAT_AFTER, REPEAT_AFTER)
        raise Stopped

    def silence(self) -> None:
        """Stop raising: nothing is open any more, and a signal that comes now ends the process."""
        for either in (signal.SIGINT, signal.SIGTERM):
            signal.signal(either, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _raise_again(signum: int, frame: FrameType | None) -> None:
    """Raise, unless it was raised and is still closing what was open."""
    del signum, frame
    error = sys.exception()
    while error is not None:
        if isinstance(error, Stopped):
            return
        error = error.__context__
    raise Stopped


def _report_unraisable(unraisable: "sys.UnraisableHookArgs") -> None:
    """Report an exception that Python had to swallow, unless it is ours, or memory ran out.

    Where memory runs out in a thread or a finalizer, what the command needs of it soon fails too.
    """
    if not issubclass(unraisable.exc_type, (Stopped, MemoryError)):
        sys.__unraisablehook__(unraisable)
