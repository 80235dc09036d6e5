"""Options that several commands share, each defined once, with the check of what a user gave.

An option's check runs when the command line is read, before the command: what a command gets is
right. An option that only one command has stands in that command's file.
"""

import math
import os
import re
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from affcli import lab, registry, store
from affcli.cli.terminal import say
from affcli.core.identity import Component
from affcli.core.limits import LARGEST_SEED, LONGEST_HOURS, LONGEST_NOTE
from affcli.core.observation import SensorKind
from affcli.core.part import Kind
from affcli.errors import BadInputError, UsageError, one_line

if TYPE_CHECKING:
    from affcli.lab.cluster import Cluster

LARGEST_ID = LARGEST_SEED
MOST_TRIES = 100_000
MOST_WORKERS = 256
SHORTEST, LONGEST = 1e-3, 1e4
"""No length of this laboratory lies beyond them."""
FIGURE_ENDINGS = (".png", ".svg", ".pdf")
"""Endings of the files that a figure can be."""


def checked_sensor(kind: str) -> SensorKind:
    """Return the kind of sensor asked for; UsageError when there is no such kind."""
    return str(registry.component("sensors", kind))


def whole_number(option: str, text: object) -> int:
    """Return a whole number; UsageError for what is none.

    Typer's own reading takes 0-9 for -9.
    """
    try:
        return int(str(text))
    except ValueError:
        raise UsageError(f"{option} {one_line(text, 40)}: must be a whole number") from None


def checked_seed(text: str) -> int:
    """Return the seed; BadInputError when it does not lie in 0 to 2^63 - 1."""
    seed = whole_number("--seed", text)
    if not 0 <= seed <= LARGEST_SEED:
        raise BadInputError(f"--seed {one_line(seed, 40)}: must lie in 0 to 2^63 - 1")
    return seed


def checked_hours_or_none(hours: float) -> float:
    """Return the hours; BadInputError when they do not lie in [0, 10000]."""
    return _checked_time("--hours", hours, 1.0, none=True)


def checked_minutes(minutes: float) -> float:
    """Return the minutes; BadInputError when they are not more than 0, or more than 10000 hours."""
    return _checked_time("--minutes", minutes, 60.0)


def checked_minutes_or_none(minutes: float) -> float:
    """Return the minutes, which may be 0; BadInputError as `checked_minutes`."""
    return _checked_time("--minutes", minutes, 60.0, none=True)


def _checked_time(option: str, given: float, of_an_hour: float, *, none: bool = False) -> float:
    """Return a time; BadInputError when it is not that of a run, or 0 without `none`."""
    if none and given == 0.0:
        return 0.0  # of -0 too: they are equal, and so must be their keys
    if not (math.isfinite(given) and 0.0 < given / of_an_hour <= LONGEST_HOURS):
        most = of_an_hour * LONGEST_HOURS
        raise BadInputError(f"{option} {given}: must be more than 0 and at most {most:g}")
    return given


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


def checked_note(text: str) -> str:
    """Return a note on a run; BadInputError when it is too long or no text."""
    if len(text) > LONGEST_NOTE or any(map(_is_surrogate, text)):
        raise BadInputError(
            f"the note {one_line(text, 40)}: must be text of at most {LONGEST_NOTE} letters"
        )
    return text


def _is_surrogate(letter: str) -> bool:
    """Tell whether a letter stands for a byte that is none."""
    return "\ud800" <= letter <= "\udfff"


def checked_tool(name: str) -> str:
    """Return how a registered tool is named, with its parameters if they are not the default.

    What names a file is read when the sizes are known that it is held against.
    """
    if registry.names_file(name):
        return name
    return str(registry.component("tools", name))


def checked_tools(names: Iterable[str] | None) -> list[str]:
    """Return registered tools, each given by itself or several names with commas, once each."""
    return list(dict.fromkeys(map(checked_tool, names_given(names))))


def names_given(names: Iterable[str] | None) -> list[str]:
    """Return names, each given by itself or several with commas, once each."""
    given = ([text] if ":" in text else text.split(",") for text in names or ())
    return list(dict.fromkeys(name for several in given for name in several))


def checked_workers(workers: int | None) -> int:
    """Return how many processes are to work: one for each core where nothing is said."""
    if workers is not None:
        return workers
    known = hasattr(os, "sched_getaffinity")
    return min(len(os.sched_getaffinity(0)), MOST_WORKERS) if known else 1


def checked_pool(workers: int | None, scheduler: str | None) -> "int | Cluster":
    """Return who is to work: so many processes, or a cluster; UsageError when both are given."""
    if scheduler is None:
        return checked_workers(workers)
    if workers is not None:
        raise UsageError(
            "--workers are processes of this machine, --scheduler is of a cluster: give one of them"
        )
    return lab.cluster.cluster_at(scheduler)


def check_if_given(check: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Return a check for an option that may be left out."""
    return lambda value: None if value is None else check(value)


def check_count(option: str, most: int = LARGEST_ID) -> Callable[[Any], Any]:
    """Return what reads and checks an option that is a count, or a number in the database."""
    return check_if_given(lambda text: checked_count(option, whole_number(option, text), most))


def names_of(kind: Kind) -> Callable[[str], list[str]]:
    """Return what a shell completes an option that takes a part with."""
    return lambda incomplete: [n for n in registry.parts(kind) if n.startswith(incomplete)]


def waited_for(database: Path | None) -> Path | None:
    """Return the database; a command that will have to wait for it says so from now on."""
    store.tell_of_waiting(say)
    return database


# readable=False: whether a file can be read is for those to say who read it, with their exit code.
Database = Annotated[
    Path,
    typer.Option(
        "--db",
        envvar="AFFCLI_DB",
        help="The SQLite file.",
        metavar="FILE",
        readable=False,
        callback=waited_for,
    ),
]

AsJson = Annotated[bool, typer.Option("--json", help="Results as JSON: command, format, results.")]
Seed = Annotated[
    int, typer.Option("--seed", help="0 to 2^63 - 1.", metavar="N", parser=checked_seed)
]
Config = Annotated[
    Path | None,
    typer.Option(
        "--config", help="A TOML file of settings that differ.", metavar="FILE", readable=False
    ),
]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set", help="One setting; several times for several.", metavar="SECTION.KEY=VALUE"
    ),
]
PART = "NAME[:KEY=VALUE,...]"
"""How an option takes a part; `affcli list` has their names."""
Repertoire = Annotated[
    list[str] | None,
    typer.Option(
        "--repertoire",
        help="Exploratory behaviors, or a file; several times for several (default: paper).",
        metavar=PART,
        autocompletion=names_of("behaviors"),
    ),
]
Binding = Annotated[
    list[str] | None,
    typer.Option(
        "--binding",
        help="How the tool is held; several times for several (default: grasp).",
        metavar=PART,
        autocompletion=names_of("bindings"),
    ),
]
Explorer = Annotated[
    str | None,
    typer.Option(
        "--explorer",
        help="What to try next (default: random).",
        metavar=PART,
        autocompletion=names_of("explorers"),
    ),
]
World = Annotated[
    str | None, typer.Option("--world", help="Where it takes place (default: table).", metavar=PART)
]
Planner = Annotated[
    Component,
    typer.Option(
        "--planner",
        help="How the robot chooses a row.",
        metavar=PART,
        autocompletion=names_of("planners"),
        parser=partial(registry.component, "planners"),
    ),
]
DEFAULT_PLANNER = registry.DEFAULTS["planner"]
TaskSet = Annotated[
    str,
    typer.Option("--task", help="The set of tasks (affcli list tasks), or a file.", metavar="NAME"),
]
DEFAULT_TASKS = registry.DEFAULTS["task"]
Force = Annotated[bool, typer.Option("--force", help="Write over existing files.")]
Resume = Annotated[
    bool,
    typer.Option("--resume", help="Go on with what was interrupted; alone, with all of it."),
]
Sensor = Annotated[
    SensorKind | None,
    typer.Option(
        "--sensor",
        help="noisy (the default), exact, camera, or one of a package.",
        metavar="KIND",
        parser=checked_sensor,
    ),
]
TrialSensor = Annotated[
    SensorKind | None,
    typer.Option(
        "--sensor",
        help="As for learn; else that of learning.",
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
        autocompletion=names_of("tools"),
    ),
]
LearnedTool = Annotated[
    str | None,
    typer.Option(
        "--tool",
        help="What was learned (default: t-hook).",
        metavar="NAME",
        autocompletion=names_of("tools"),
    ),
]
DEFAULT_TOOL = "t-hook"
DEFAULT_BROKEN = "l-hook"
Becomes = Annotated[
    str | None,
    typer.Option(
        "--becomes",
        help=f"The tool that is left (default: {DEFAULT_BROKEN}).",
        metavar="NAME",
        autocompletion=names_of("tools"),
    ),
]
HeldShape = Annotated[
    str | None,
    typer.Option(
        "--shape",
        help="What the robot truly holds, in the same colour.",
        metavar="NAME",
    ),
]
Pushes = Annotated[
    int,
    typer.Option(
        "--pushes", help="How many.", metavar="N", parser=check_count("--pushes", MOST_TRIES)
    ),
]
Workers = Annotated[
    int | None,
    typer.Option(
        "--workers",
        help="Processes; one for each core if not given.",
        metavar="N",
        parser=check_count("--workers", MOST_WORKERS),
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        help="Let the workers of a Dask cluster work: tcp://HOST:PORT, or its scheduler's file.",
        metavar="WHERE",
    ),
]
Run = Annotated[
    int | None,
    typer.Option(
        "--run", help="The learning run of this id.", metavar="ID", parser=check_count("--run")
    ),
]
