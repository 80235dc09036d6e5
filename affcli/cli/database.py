"""What commands have in common that ask a database: open it, take what was learned, say what next.

SQLAlchemy loads when the database is opened: a command's help does without.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from affcli import store
from affcli.cli.options import DEFAULT_TOOL
from affcli.cli.terminal import say
from affcli.core.records import FailedRobot
from affcli.core.trial import TrialEnd
from affcli.errors import BadInputError, one_line
from affcli.lab.suggesting import with_database

MOST_NAMED = 3
"""So many records that cannot be read are named; `affcli db check` finds the others."""
MOST_FAILED = 10
"""So many robots that failed are named; `affcli report --json` has all."""


@contextmanager
def opened(database: Path, *, create: bool = False, write: bool = False) -> Iterator["store.Store"]:
    """Open a database, to read it if nothing else is said, and close it after the block.

    What lists had to leave out is said then.

    Args:
        database: the file.
        create: make it if there is none.
        write: to write too.

    Raises:
        DatabaseError: it cannot be opened, or is none of ours.
    """
    with store.open_store(database, create=create, write=write) as records:
        yield records
    for line in records.left_out[:MOST_NAMED]:
        say(f"left out: {line}")
    more = len(records.left_out) - MOST_NAMED
    if more > 0:
        say(f"left out: {more} more records; see: {with_database('affcli db check', database)}")


def tool_or_default(tool: str | None, run: int | None) -> str | None:
    """Return the tool that a command with one tool is about: the T-hook, unless a run is named."""
    return tool if tool is not None or run is not None else DEFAULT_TOOL


def say_failed(failed: Sequence[FailedRobot]) -> int:
    """Say which robots failed, if any did; return the exit code."""
    if not failed:
        return 0
    names = ", ".join(str(one.robot) for one in failed[:MOST_FAILED])
    more = f" and {len(failed) - MOST_FAILED} more" if len(failed) > MOST_FAILED else ""
    say(f"failed: robot {names}{more}; the same command tries again")
    return BadInputError.exit_code


def say_failures(ends: Iterable[tuple[int, TrialEnd]]) -> None:
    """Say of trials that a part of another package ended which did, and how."""
    for number, end in ends:
        if end.failure:
            say(f"trial {number} counts for nothing: {one_line(end.failure, 500)}")


def say_trials(numbers: Sequence[int], worth_seeing: int, database: Path) -> None:
    """Say which trials were saved, and how to see one of them."""
    first, last = numbers[0], numbers[-1]
    which = f"trial {first}" if first == last else f"trials {first} to {last}"
    replay = with_database(f"affcli replay {worth_seeing}", database)
    say(f"{which} saved; to see why each row was chosen: {replay}")
