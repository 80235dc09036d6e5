"""What commands have in common that ask a database: open it, take what was learned, say what next.

SQLAlchemy loads when the database is opened: a command's help does without.
"""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING

from affcli import store
from affcli.cli.options import DEFAULT_DATABASE
from affcli.cli.terminal import say
from affcli.core.tool import TOOL_PARTS
from affcli.errors import UsageError, one_line

if TYPE_CHECKING:
    from affcli.store import LearningRunInfo, Store


def opened(
    database: Path, *, create: bool = False, write: bool = False
) -> "AbstractContextManager[Store]":
    """Open a database, to read it if nothing else is said, and close it after the block.

    Args:
        database: the file.
        create: make it if there is none.
        write: to write too.

    Raises:
        DatabaseError: it cannot be opened, or is none of ours.
    """
    return store.open_store(database, create=create, write=write)


def learned_runs(records: "Store", tool: str | None, database: Path) -> "list[LearningRunInfo]":
    """Return the latest finished learning run of the tool, or of every tool that has one.

    Raises:
        UsageError: there is none; the message names the command to run.
    """
    names = [tool] if tool is not None else list(TOOL_PARTS)
    runs = [run for run in map(records.latest_run, names) if run is not None]
    if not runs:
        only = " but by robots of a reproduction" if records.sessions("reproduce") else ""
        learning = with_database(f"affcli learn --tool {tool or 't-hook'}", database)
        raise UsageError(
            f"nothing learned with the {tool or 'tools'} in {database}{only}; first run: {learning}"
        )
    return runs


def with_database(command: str, database: Path) -> str:
    """Return a command to suggest, with the database named when it is not the usual one."""
    return command if database == DEFAULT_DATABASE else f"{command} --db {one_line(database)}"


def say_trials(numbers: Sequence[int], worth_seeing: int, database: Path) -> None:
    """Say which trials were saved, and how to see one of them."""
    first, last = numbers[0], numbers[-1]
    which = f"trial {first}" if first == last else f"trials {first} to {last}"
    replay = with_database(f"affcli replay {worth_seeing}", database)
    say(f"{which} saved; to see why each row was chosen: {replay}")
