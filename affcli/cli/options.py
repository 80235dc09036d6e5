"""Options that several commands share, each defined once, with the check of what a user gave.

An option's check runs when the command line is read, before the command: what a command gets is
right. An option that only one command has stands in that command's file.
"""

import difflib
import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any

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
FIGURE_ENDINGS = (".png", ".svg", ".pdf")
"""Endings of the files that a figure can be."""


def checked_sensor(kind: str) -> SensorKind:
    """Return the kind of sensor asked for; UsageError when there is none such."""
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


def checked_tools(names: Iterable[str] | None) -> list[str]:
    """Return tool names, each given by itself or several with commas, without repeats."""
    single = [part for name in names or () for part in name.split(",")]
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


def check_if_given(check: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Return a check for an option that may be left out."""
    return lambda value: None if value is None else check(value)


def check_count(option: str, most: int = LARGEST_ID) -> Callable[[Any], Any]:
    """Return a check for an option that is a count, or a number in the database."""
    return check_if_given(lambda count: checked_count(option, count, most))


# readable=False: whether a file can be read is for those to say who read it, with their exit code.
Database = Annotated[
    Path,
    typer.Option(
        "--db", envvar="AFFCLI_DB", help="The SQLite file.", metavar="FILE", readable=False
    ),
]
DEFAULT_DATABASE = Path("affcli.db")

AsJson = Annotated[bool, typer.Option("--json", help="Write JSON to stdout.")]
Seed = Annotated[
    int, typer.Option("--seed", help="0 to 2^63 - 1.", metavar="N", callback=checked_seed)
]
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
    SensorKind | None,
    typer.Option(
        "--sensor",
        help="noisy (the default), exact or camera.",
        metavar="KIND",
        parser=checked_sensor,
    ),
]
TrialSensor = Annotated[
    SensorKind | None,
    typer.Option(
        "--sensor",
        help="noisy, exact or camera; else that of learning.",
        metavar="KIND",
        parser=checked_sensor,
    ),
]
Tools = Annotated[
    list[str] | None,
    typer.Option(
        "--tool",
        help="A tool; give it several times for several.",
        metavar="NAME",
        callback=checked_tools,
    ),
]
LearnedTool = Annotated[
    str,
    typer.Option("--tool", help="What was learned.", metavar="NAME", callback=checked_tool),
]
DEFAULT_TOOL = "t-hook"
Becomes = Annotated[
    str,
    typer.Option(
        "--becomes", help="The shape that is left.", metavar="NAME", callback=checked_tool
    ),
]
DEFAULT_BROKEN = "l-hook"
HeldShape = Annotated[
    str | None,
    typer.Option(
        "--shape",
        help="What the robot truly holds, painted alike.",
        metavar="NAME",
        callback=check_if_given(checked_tool),
    ),
]
Pushes = Annotated[
    int,
    typer.Option(
        "--pushes", help="How many.", metavar="N", callback=check_count("--pushes", MOST_TRIES)
    ),
]
Run = Annotated[
    int | None,
    typer.Option("--run", help="A learning run's id.", metavar="ID", callback=check_count("--run")),
]
FigureOut = Annotated[
    Path, typer.Option("--out", help="The figure: *.png, *.svg or *.pdf.", metavar="FILE")
]
