"""Which rows of the affordance tables a command is about: its options, and their checks."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli import store as stores
from affcli.cli.database import learned_runs
from affcli.cli.options import check_count
from affcli.core.behavior import BehaviorCall
from affcli.core.names import one_of
from affcli.core.records import LearningRunInfo
from affcli.core.row_filter import Comparison, RowFilter
from affcli.errors import BadInputError, UsageError, one_line

Tool = Annotated[
    str | None,
    typer.Option(
        "--tool",
        help="Rows of this tool alone.",
        metavar="NAME",
    ),
]
Run = Annotated[
    int | None,
    typer.Option(
        "--run",
        help="Of this learning run, not the latest ones.",
        metavar="ID",
        parser=check_count("--run"),
    ),
]
AllRuns = Annotated[
    bool,
    typer.Option("--all-runs", help="Of every run, also of reproductions and unfinished ones."),
]
Behavior = Annotated[
    str | None,
    typer.Option("--behavior", help='"extend arm", or "extend arm 5".', metavar="NAME"),
]
Probability = Annotated[
    str | None,
    typer.Option(
        "--probability", help='Of replication: "<=0.5", ">0.5", "0.2..0.8".', metavar="RANGE"
    ),
]
Region = Annotated[
    str | None,
    typer.Option(
        "--region",
        help='The part of the tool nearest the attractor: "right hook".',
        metavar="PART",
    ),
]
Limit = Annotated[
    int | None,
    typer.Option(
        "--limit",
        help="No more than so many, the oldest.",
        metavar="N",
        parser=check_count("--limit"),
    ),
]

_NUMBER = r"(\d+(?:\.\d+)?|\.\d+)"
_BOUND = re.compile(rf"(<=|>=|<|>)\s*{_NUMBER}", re.ASCII)
_BETWEEN = re.compile(rf"{_NUMBER}\s*\.\.\s*{_NUMBER}", re.ASCII)


def _behavior(text: str, runs: Sequence[LearningRunInfo]) -> BehaviorCall:
    """Return the exploratory behavior of this name that learning runs have."""
    calls = dict.fromkeys(one.call for run in runs for one in run.spec.repertoire)
    known = {str(call): call for named in calls for call in (BehaviorCall(named.name, ()), named)}
    return known[one_of("behavior", text, known)]


def checked_probability(text: str) -> tuple[tuple[Comparison, float], ...]:
    """Return the bounds that a text like ``<=0.5``, ``>0.5`` or ``0.2..0.8`` gives, both included.

    Raises:
        BadInputError: it gives none, or not in 0 to 1.
    """
    bounds: tuple[tuple[Comparison, float], ...] = ()
    if found := _BOUND.fullmatch(text.strip()):
        comparison: Comparison = found[1]  # type: ignore[assignment]  # one of the four
        bounds = ((comparison, float(found[2])),)
    elif found := _BETWEEN.fullmatch(text.strip()):
        bounds = ((">=", float(found[1])), ("<=", float(found[2])))
    numbers = [number for _, number in bounds]
    if not bounds or max(numbers) > 1.0 or numbers != sorted(numbers):
        raise BadInputError(
            f"--probability {one_line(text, 40)}: must be like <=0.5, <0.5, >=0.5, >0.5 or "
            "0.2..0.8, with numbers from 0 to 1"
        )
    return bounds


def chosen_rows(
    store: "stores.Store",
    database: Path,
    *,
    tool: str | None,
    run: int | None,
    all_runs: bool,
    behavior: str | None,
    probability: str | None,
    region: str | None,
    limit: int | None,
) -> tuple[Sequence[LearningRunInfo], RowFilter]:
    """Return the learning runs whose rows are meant, and what the database can be asked for.

    It knows no regions. The run that was named, all runs, or the latest finished one of each tool;
    a behavior with its parameters, or without, whatever they were.

    Raises:
        UsageError: there are no such runs; the run is of another tool; no tool of them has the
            region; none of them has the behavior, and the message has the nearest.
        BadInputError: a probability that cannot be read.
    """
    if run is not None and all_runs:
        raise UsageError("give --run ID or --all-runs, not both")
    bounds = () if probability is None else checked_probability(probability)
    runs = _runs(store, database, tool, run, all_runs=all_runs)
    tools = dict.fromkeys(one.spec.tool for one in runs)
    parts = dict.fromkeys(part.name for one in runs for part in one.spec.held.parts)
    if region is not None and region not in parts:
        raise UsageError(
            f"no region {one_line(region, 60)!r} of the {_listed(tools)}; the parts are "
            f"{_listed(parts)}"
        )
    return runs, RowFilter(
        runs=None if all_runs else tuple(one.id for one in runs),
        tool=tool,
        behavior=None if behavior is None else _behavior(behavior, runs),
        probability=bounds,
        limit=limit,
    )


def _runs(
    store: "stores.Store", database: Path, tool: str | None, run: int | None, *, all_runs: bool
) -> Sequence[LearningRunInfo]:
    """Return the run that was named, all runs, or the latest finished one of each tool."""
    if run is not None:
        chosen = store.learning.run(run)
        if tool not in (None, chosen.spec.tool):
            raise UsageError(
                f"run {run} is of the {one_line(chosen.spec.tool, 60)}, not of the {tool}; "
                "leave out --tool"
            )
        return [chosen]
    runs = [one for one in lab.table.every_run(store) if tool in (None, one.spec.tool)]
    if all_runs and runs:
        return runs
    if runs and all(one.session_id is not None for one in runs):
        raise UsageError(
            f"nothing learned with the {tool or 'tools'} in {one_line(database)} but by "
            "robots of a reproduction; give --run ID or --all-runs"
        )
    return learned_runs(store, tool, database)


def _listed(names: "dict[str, None]") -> str:
    """Return names with commas between them."""
    return ", ".join(one_line(name, 60) for name in names)
