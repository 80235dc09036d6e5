"""Which rows of the affordance tables a command is about: its options, and their checks."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from affcli import lab
from affcli.cli.database import learned_runs
from affcli.cli.options import check_count
from affcli.core.behavior import BehaviorCall
from affcli.core.names import one_of
from affcli.core.records import LearningRunInfo
from affcli.core.row_filter import Comparison, RowFilter
from affcli.errors import BadInputError, UsageError, one_line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from affcli.store import Store

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
        callback=check_count("--run"),
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
        callback=check_count("--limit"),
    ),
]

_NUMBER = r"(\d+(?:\.\d+)?|\.\d+)"
_BOUND = re.compile(rf"(<=|>=|<|>)\s*{_NUMBER}", re.ASCII)
_BETWEEN = re.compile(rf"{_NUMBER}\s*\.\.\s*{_NUMBER}", re.ASCII)


@dataclass(frozen=True, slots=True)
class Choice:
    """Which rows were asked for.

    Args:
        tool: of this tool; of all if None.
        run: of this learning run; of the latest finished one of each tool if None.
        all_runs: of every learning run.
        behavior: of the behavior of this name, with its parameters or without, whatever they were;
            of all if None.
        probability: bounds of the replication probability.
        region: with the attractor nearest to this part of the tool; to any if None.
        limit: no more than so many; all if None.
    """

    tool: str | None
    run: int | None
    all_runs: bool
    behavior: str | None
    probability: "tuple[tuple[Comparison, float], ...]"
    region: str | None
    limit: int | None

    def filter_for(self, runs: "Sequence[LearningRunInfo]") -> "RowFilter":
        """Return what the database can be asked for; it knows no regions.

        Raises:
            UsageError: none of the runs has the behavior; the message has the nearest.
        """
        return RowFilter(
            runs=None if self.all_runs else tuple(run.id for run in runs),
            tool=self.tool,
            behavior=None if self.behavior is None else _behavior(self.behavior, runs),
            probability=self.probability,
            limit=self.limit,
        )


def _behavior(text: str, runs: "Sequence[LearningRunInfo]") -> BehaviorCall:
    """Return the exploratory behavior of this name that learning runs have."""
    calls = dict.fromkeys(one.call for run in runs for one in run.spec.repertoire)
    known = {str(call): call for named in calls for call in (BehaviorCall(named.name, ()), named)}
    return known[one_of("behavior", text, known)]


def checked_choice(
    *,
    tool: str | None,
    run: int | None,
    all_runs: bool,
    behavior: str | None,
    probability: str | None,
    region: str | None,
    limit: int | None,
) -> Choice:
    """Return what was asked for.

    Raises:
        UsageError: a run beside --all-runs.
        BadInputError: a probability that cannot be read.
    """
    if run is not None and all_runs:
        raise UsageError("give --run ID or --all-runs, not both")
    return Choice(
        tool=tool,
        run=run,
        all_runs=all_runs,
        behavior=behavior,
        probability=() if probability is None else checked_probability(probability),
        region=region,
        limit=limit,
    )


def checked_probability(text: str) -> "tuple[tuple[Comparison, float], ...]":
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


def chosen_runs(store: "Store", choice: Choice, database: Path) -> "Sequence[LearningRunInfo]":
    """Return the learning runs whose rows are meant.

    Raises:
        UsageError: there are none; the run is of another tool; or no tool of them has the region.
    """
    runs = _runs(store, choice, database)
    tools = dict.fromkeys(run.spec.tool for run in runs)
    parts = dict.fromkeys(part.name for run in runs for part in run.spec.held.parts)
    if choice.region is not None and choice.region not in parts:
        raise UsageError(
            f"no region {one_line(choice.region, 60)!r} of the {_listed(tools)}; the parts are "
            f"{_listed(parts)}"
        )
    return runs


def _runs(store: "Store", choice: Choice, database: Path) -> "Sequence[LearningRunInfo]":
    """Return the run that was named, all runs, or the latest finished one of each tool."""
    if choice.run is not None:
        run = store.learning.run(choice.run)
        if choice.tool not in (None, run.spec.tool):
            raise UsageError(
                f"run {run.id} is of the {one_line(run.spec.tool, 60)}, not of the {choice.tool}; "
                "leave out --tool"
            )
        return [run]
    runs = [run for run in lab.table.every_run(store) if choice.tool in (None, run.spec.tool)]
    if choice.all_runs and runs:
        return runs
    if runs and all(run.session_id is not None for run in runs):
        raise UsageError(
            f"nothing learned with the {choice.tool or 'tools'} in {one_line(database)} but by "
            "robots of a reproduction; give --run ID or --all-runs"
        )
    return learned_runs(store, choice.tool, database)


def _listed(names: "dict[str, None]") -> str:
    """Return names with commas between them."""
    return ", ".join(one_line(name, 60) for name in names)
