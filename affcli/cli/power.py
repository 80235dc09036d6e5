"""``affcli power``: how many robots it takes to see a difference."""

from typing import Annotated

import typer

from affcli import lab
from affcli.cli.compare import Experiment, Sessions, checked_by
from affcli.cli.database import opened
from affcli.cli.options import AsJson, Database
from affcli.cli.terminal import show_either
from affcli.errors import BadInputError, UsageError, one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.paired import power_json, power_tables

DIFFERENCES = (1.0, 2.0, 4.0)
LARGEST = 1000.0


def _checked_differences(values: list[float] | None) -> list[float]:
    """Return differences to be seen; BadInputError when one is none of solved trials."""
    for value in values or ():
        if not 0.001 <= abs(value) <= LARGEST:
            raise BadInputError(f"--difference {value}: must lie in 0.001 to {LARGEST:g}")
    return list(dict.fromkeys(abs(value) for value in values or DIFFERENCES))


def _checked_power(power: float) -> float:
    """Return the power; BadInputError when it is no chance that can be had."""
    if not 0.1 <= power <= 0.999:
        raise BadInputError(f"--power {power}: must lie in 0.1 to 0.999")
    return power


def _checked_correlation(correlation: float | None) -> float | None:
    """Return the correlation; BadInputError when it is none."""
    if correlation is not None and not -1.0 <= correlation < 1.0:
        raise BadInputError(f"--correlation {correlation}: must lie in -1 to 1, 1 left out")
    return correlation


def power(
    *,
    experiment: Experiment = None,
    sessions: Sessions = None,
    differences: Annotated[
        list[float] | None,
        typer.Option(
            "--difference",
            help="In solved trials; several times for several (default: 1, 2, 4).",
            metavar="D",
            callback=_checked_differences,
        ),
    ] = None,
    wanted: Annotated[
        float,
        typer.Option("--power", help="The chance to see it.", metavar="P", callback=_checked_power),
    ] = 0.8,
    correlation: Annotated[
        float | None,
        typer.Option(
            "--correlation",
            help="Of one session's counts with those to come (default: 0).",
            metavar="R",
            callback=_checked_correlation,
        ),
    ] = None,
    by: Annotated[
        str,
        typer.Option(
            "--by",
            help="Cells too: by tool, goal, start, or several.",
            metavar="NAMES",
            callback=checked_by,
        ),
    ] = "protocol",
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Say how many robots it takes to see a difference.

    From two sessions it knows how the paired differences of their robots vary. From one it takes
    another condition to vary as much, its robots to do as well as --correlation says: 0 as if they
    were not paired, which asks for the most robots. By Student's t of pairs; checked by simulation
    in affcli/analysis/README.md.
    """
    with opened(database) as store:
        conditions = lab.conditions.conditions_named(store, experiment, sessions, 1)
        if len(conditions) > 2:
            of = f"experiment {one_line(experiment)} has" if experiment is not None else "there are"
            two = " ".join(f"--session {one.session.id}" for one in conditions[:2])
            raise UsageError(f"{of} {len(conditions)} conditions; name two of the sessions: {two}")
        if len(conditions) > 1 and correlation is not None:
            raise UsageError(
                "--correlation is of one session; the pairs of two tell it: leave it out"
            )
        plans, untold = lab.conditions.planned(
            store, conditions, by, differences or (), correlation or 0.0, wanted
        )
    names = " and ".join(one.name for one in conditions)
    how = (
        f"from the pairs of {names}"
        if len(conditions) > 1
        else f"from {names}, correlation {correlation or 0.0:g}"
    )
    show_either(
        as_json=as_json,
        results=lambda: [power_json(plans, untold, how, wanted)],
        tables=lambda: power_tables(plans, untold, how, wanted, differences or ()),
    )
