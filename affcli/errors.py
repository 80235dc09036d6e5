"""The errors a user can cause, each with the exit code the command line gives it.

Every message is one line that names the value, the place and the remedy. Anything that is not
an ``AffcliError`` is a bug and keeps its traceback.
"""


class AffcliError(Exception):
    """Base of every error that a user can cause and put right."""

    exit_code = 1


class UsageError(AffcliError):
    """The command asks for something that does not exist (a tool, a goal, a run)."""

    exit_code = 2


class DatabaseError(AffcliError):
    """The database cannot be opened, read, written or migrated."""

    exit_code = 3


class BadInputError(AffcliError):
    """A value (number, name, file content) lies outside what it may be."""

    exit_code = 4


class NotSeenError(AffcliError):
    """The camera does not see something that must be seen, or sees it twice."""

    exit_code = 4


class SimulationDivergedError(AffcliError):
    """The physics produced a number that is not finite: the settings are beyond it."""

    exit_code = 4


class PartFailedError(AffcliError):
    """A part of another package failed while it was used; its message names both."""

    exit_code = 4


class WorkersDiedError(AffcliError):
    """Worker processes died, as they do where there is not enough memory for so many."""

    exit_code = 4


class ClusterError(AffcliError):
    """The scheduler of a cluster does not answer, or none of its workers can be used."""

    exit_code = 4


def one_line(text: object, limit: int = 200) -> str:
    """Return `text` as one printable line, so that an error can quote what a user wrote."""
    try:
        start = str(text)[: limit + 1]
    except (ValueError, RecursionError):
        # A number of 100,000 digits, a table nested as deep: Python itself declines to write them.
        start = f"({type(text).__name__} too large to show)"
    shown = "".join(c if c.isprintable() else repr(c)[1:-1] for c in start)
    return shown if len(shown) <= limit else shown[: limit - 3] + "..."
