"""What commands have in common that ask a database: open it, take what was learned, say what next.

SQLAlchemy loads when the database is opened: a command's help does without.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from affcli import lab, registry, store
from affcli.cli.options import DEFAULT_DATABASE, DEFAULT_TOOL
from affcli.cli.terminal import say
from affcli.core.records import FailedRobot, LearningRunInfo
from affcli.core.specs import LIVES
from affcli.errors import BadInputError, UsageError, one_line

MOST_NAMED = 10

MOST_NAMED = 3
"""So many records that cannot be read are named; `affcli db check` finds the others."""


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


def learned_runs(
    records: "store.Store",
    tool: str | None,
    database: Path,
    run: int | None = None,
    *,
    usable: bool = False,
) -> list[LearningRunInfo]:
    """Return the learning runs whose tables are to be used, or looked at.

    Args:
        records: open.
        tool: the latest finished run of this tool; None for that of every tool that has one.
        database: the file, for the message.
        run: this run and no other.
        usable: a robot is to use them, so none from a log is taken.

    Raises:
        UsageError: there is none; the message names the command to run.
        BadInputError: the run that was named comes from a log, and is to be used.
    """
    if run is not None:
        chosen = records.learning.run(run)
        if chosen.status != "done":
            raise UsageError(f"run {run} is not finished; go on with it first: --resume")
        if tool not in (None, chosen.spec.tool):
            raise UsageError(f"run {run} is of the {chosen.spec.tool}: leave out --tool")
        if usable:
            lab.run_parts.require_robot(chosen.spec)
        return [chosen]
    names = [tool] if tool is not None else _learned_tools(records, usable=usable)
    latest = (records.learning.latest(name, usable=usable) for name in names)
    runs = [found for found in latest if found is not None]
    if not runs:
        logs = records.learning.tools() if usable else frozenset()
        logged = logs if tool is None else logs & {tool}
        wanted = "tools" if tool is None else tool
        if not logged and tool is not None:
            wanted = registry.part("tools", tool).name
        only = " but by robots of a reproduction" if records.sessions.all(*LIVES) else ""
        only = " but from a log, which no robot can use" if logged else only
        simulated = tool if tool in registry.parts("tools") else "t-hook"
        learning = with_database(f"affcli learn --tool {simulated}", database)
        raise UsageError(
            f"nothing learned with the {wanted} in {database}{only}; first run: {learning}"
        )
    return runs


def _learned_tools(records: "store.Store", *, usable: bool) -> list[str]:
    """Return the tools that were learned: those that are registered first, in their order."""
    there = records.learning.tools(usable=usable)
    known = dict.fromkeys([*registry.parts("tools"), *sorted(there)])
    return [name for name in known if name in there]


def tool_or_default(tool: str | None, run: int | None) -> str | None:
    """Return the tool that a command with one tool is about: the T-hook, unless a run is named."""
    return tool if tool is not None or run is not None else DEFAULT_TOOL


def with_database(command: str, database: Path) -> str:
    """Return a command to suggest, with the database named when it is not the usual one."""
    return command if database == DEFAULT_DATABASE else f"{command} --db {one_line(database)}"


def say_failed(failed: Sequence[FailedRobot]) -> int:
    """Say which robots failed, if any did; return the exit code."""
    if not failed:
        return 0
    names = ", ".join(str(one.robot) for one in failed[:MOST_NAMED])
    more = f" and {len(failed) - MOST_NAMED} more" if len(failed) > MOST_NAMED else ""
    say(f"failed: robot {names}{more}; the same command tries again")
    return BadInputError.exit_code


def say_trials(numbers: Sequence[int], worth_seeing: int, database: Path) -> None:
    """Say which trials were saved, and how to see one of them."""
    first, last = numbers[0], numbers[-1]
    which = f"trial {first}" if first == last else f"trials {first} to {last}"
    replay = with_database(f"affcli replay {worth_seeing}", database)
    say(f"{which} saved; to see why each row was chosen: {replay}")
