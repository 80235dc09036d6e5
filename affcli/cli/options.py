"""Options that several commands share, and the checks of what a user wrote."""

import difflib
import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from affcli.core.observation import SENSOR_KINDS, SensorKind
from affcli.core.task import GOAL_NUMBERS, START_NUMBERS
from affcli.core.tool import TOOL_PARTS
from affcli.core.trial import LARGEST_SEED, LONGEST_HOURS
from affcli.errors import BadInputError, UsageError, one_line

LARGEST_ID = LARGEST_SEED
MOST_TRIES = 100_000
MOST_WORKERS = 256
SHORTEST, LONGEST = 1e-3, 1e4
"""No length of this laboratory lies beyond them."""

# readable=False: whether a file can be read is for those to say who read it, with their exit code.
Database = Annotated[
    Path,
    typer.Option(
        "--db", envvar="AFFCLI_DB", help="The SQLite file.", metavar="FILE", readable=False
    ),
]
DEFAULT_DATABASE = Path("affcli.db")

AsJson = Annotated[bool, typer.Option("--json", help="Write JSON to stdout.")]
Seed = Annotated[int, typer.Option("--seed", help="0 to 2^63 - 1.", metavar="N")]
Config = Annotated[
    Path | None,
    typer.Option(
        "--config", help="A TOML file of settings that differ.", metavar="FILE", readable=False
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Write over existing files.")]
Resume = Annotated[
    bool,
    typer.Option("--resume", help="Go on with what was interrupted; alone, with all of it."),
]
Sensor = Annotated[
    str | None,
    typer.Option("--sensor", help="noisy (the default), exact or camera.", metavar="KIND"),
]
TrialSensor = Annotated[
    str | None,
    typer.Option("--sensor", help="noisy, exact or camera; else that of learning.", metavar="KIND"),
]


def with_database(command: str, database: Path) -> str:
    """Return a command to suggest, with the database named when it is not the usual one."""
    return command if database == DEFAULT_DATABASE else f"{command} --db {one_line(database)}"


def checked_sensor(kind: str | None) -> SensorKind | None:
    """Return the kind of sensor asked for, None for none; UsageError when there is none such."""
    if kind is None:
        return None
    known = one_of("sensor", kind, SENSOR_KINDS)
    return next(one for one in SENSOR_KINDS if one == known)


def checked_seed(seed: int) -> int:
    """Return the seed; BadInputError when it does not lie in 0 to 2^63 - 1."""
    if not 0 <= seed <= LARGEST_SEED:
        raise BadInputError(f"--seed {one_line(seed, 40)}: must lie in 0 to 2^63 - 1")
    return seed


def checked_hours(hours: float) -> float:
    """Return the hours; BadInputError when they do not lie in (0, 10000]."""
    if not (math.isfinite(hours) and 0.0 < hours <= LONGEST_HOURS):
        raise BadInputError(f"--hours {hours}: must be more than 0 and at most {LONGEST_HOURS:g}")
    return hours


def checked_count(option: str, count: int, most: int) -> int:
    """Return a count; BadInputError when it does not lie in 1 to `most`."""
    if not 1 <= count <= most:
        raise BadInputError(f"{option} {one_line(count, 40)}: must lie in 1 to {most}")
    return count


def checked_range(option: str, text: str) -> tuple[int, int]:
    """Return the first and the last number of ``3-5``, or of ``3``; BadInputError otherwise."""
    found = re.fullmatch(r"([0-9]{1,9})(?:-([0-9]{1,9}))?", text)
    first, last = (int(found[1]), int(found[2] or found[1])) if found else (0, 0)
    if not 1 <= first <= last:
        raise BadInputError(f"{option} {one_line(text, 40)}: must be a number or two, as in 3-5")
    return first, last


def checked_length(option: str, length: float) -> float:
    """Return a length; BadInputError when it is none that a laboratory has."""
    if not (math.isfinite(length) and SHORTEST <= length <= LONGEST):
        raise BadInputError(f"{option} {length}: must lie in {SHORTEST:g} to {LONGEST:g}")
    return length


def checked_numbers(option: str, text: str, count: int) -> list[float]:
    """Return so many numbers from a text with commas; BadInputError when it holds others."""
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(math.isfinite(v) and abs(v) <= LONGEST for v in values):
        raise BadInputError(
            f"{option} {one_line(text, 40)}: must be {count} numbers within {LONGEST:g}, with "
            "commas between them"
        )
    return values


def checked_tool(name: str) -> str:
    """Return the name of a tool; UsageError with the nearest names when there is none such."""
    return one_of("tool", name, list(TOOL_PARTS))


def checked_tools(names: Iterable[str]) -> list[str]:
    """Return tool names, each given by itself or several with commas, without repeats."""
    single = [part for name in names for part in name.split(",")]
    return list(dict.fromkeys(checked_tool(name) for name in single))


def checked_goal(goal: int) -> int:
    """Return the number of a goal; UsageError when there is none such."""
    return int(one_of("goal", str(goal), [str(n) for n in GOAL_NUMBERS]))


def checked_starts(start: str) -> Sequence[int]:
    """Return the starts asked for: one of 1 to 4, or all."""
    if start == "all":
        return START_NUMBERS
    return (int(one_of("start", start, [*(str(n) for n in START_NUMBERS), "all"])),)


def one_of(kind: str, value: str, known: Sequence[str]) -> str:
    """Return `value` when it is known; else say which values are nearest."""
    if value in known:
        return value
    near = difflib.get_close_matches(value[:40].lower(), known, n=3, cutoff=0.4) or known
    raise UsageError(f"no {kind} {one_line(value, 60)!r}; did you mean {' or '.join(near)}?")
