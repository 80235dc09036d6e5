"""What commands have in common that ask a database: open it, take what was learned, say what next.

SQLAlchemy loads when the database is opened: a command's help does without.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from affcli import lab, registry, store
from affcli.cli.options import DEFAULT_TOOL
from affcli.cli.terminal import say
from affcli.core.records import FailedRobot
from affcli.core.specs import Parts
from affcli.core.task import Task
from affcli.core.trial import DIVERGED, Outcome, TrialEnd, is_counted
from affcli.errors import BadInputError, PartFailedError, one_line
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


def say_failures(ends: Sequence[tuple[int, TrialEnd]]) -> int:
    """Say of trials that count for nothing how many, which the first is and why, each reason once.

    Args:
        ends: trials of one command by number.

    Returns:
        The exit code: another than 0 when no trial counts.
    """
    reasons: dict[str, list[int]] = {}
    for number, end in ends:
        if end.outcome is Outcome.INVALID:
            reasons.setdefault(end.failure or DIVERGED, []).append(number)
    for reason, (first, *more) in reasons.items():
        which = f"{1 + len(more)} trials, from trial {first} on, count" if more else ""
        say(f"{which or f'trial {first} counts'} for nothing: {one_line(reason, 500)}")
    counted = any(is_counted(end.outcome) for _, end in ends)
    return 0 if counted else PartFailedError.exit_code


def say_beyond_reach(tasks: Sequence[Task], carried: Parts) -> None:
    """Say which places of a person's own tasks lie where none of the paper's tools reaches.

    Args:
        tasks: of one set or several; none to say nothing.
        carried: the parts of a run, in whose sizes they are done.
    """
    if carried.world.name != registry.DEFAULTS["world"]:
        return
    workspace = lab.run_parts.settings_of(carried).workspace
    for name in dict.fromkeys(task.task_set for task in tasks):
        own = [task for task in tasks if task.task_set == name]
        if words := lab.checking.beyond_reach(own, workspace):
            say(f"tasks {one_line(name, 60)}: {words}")


def say_trials(ends: Sequence[tuple[int, TrialEnd]], worth_seeing: int, database: Path) -> None:
    """Say which trials were saved, and how to see one of them, if there is anything to be seen."""
    first, last = ends[0][0], ends[-1][0]
    which = f"trial {first}" if first == last else f"trials {first} to {last}"
    replay = with_database(f"affcli replay {worth_seeing}", database)
    seen = any(end.steps or is_counted(end.outcome) for _, end in ends)
    say(f"{which} saved" + (f"; to see why each row was chosen: {replay}" if seen else ""))
