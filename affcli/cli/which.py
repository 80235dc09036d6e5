"""``affcli which``: which tool, and which behavior with it, moves the attractor where?"""

import re
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.options import AsJson, Database, checked_length
from affcli.cli.table_choice import AllRuns, Behavior, Run, Tool
from affcli.cli.terminal import say, show_either
from affcli.core.effects import Way
from affcli.core.names import one_of
from affcli.errors import BadInputError, one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.logs.mapping import LENGTHS
from affcli.report.effects import best_words, effects_json, effects_table

USUAL = "2in"


def checked_way(text: str) -> Way:
    """Return the way that is asked about; UsageError when it is none."""
    return one_of("way", text, list(Way))


def inches_of(text: str) -> float:
    """Return a length with its unit in inches; BadInputError when it is none."""
    found = re.fullmatch(r"\s*([0-9]+\.?[0-9]*|\.[0-9]+)\s*([a-z]*)\s*", text[:40])
    if found is None or (found[2] or "in") not in LENGTHS:
        raise BadInputError(
            f"--by {one_line(text, 40)}: must be a length as 2in or 5cm; the units are "
            f"{', '.join(LENGTHS)}"
        )
    return checked_length("--by", float(found[1]) * LENGTHS[found[2] or "in"])


def which(
    way: Annotated[
        str,
        typer.Argument(
            help="nearer, farther, left or right, as the robot sees it.",
            metavar="WAY",
            parser=checked_way,
        ),
    ],
    *,
    by: Annotated[
        float,
        typer.Option("--by", help="By more than so much.", metavar="LENGTH", parser=inches_of),
    ] = USUAL,  # type: ignore[assignment]  # the parser reads it
    tool: Tool = None,
    run: Run = None,
    all_runs: AllRuns = False,
    behavior: Behavior = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Say which tool moves the attractor where, by which behavior, and how often.

    Of all that was tried, with or without effect: of the latest finished run of each tool, also of
    logs that were imported.
    """
    where = Way(way)
    with opened(database) as store:
        runs, wanted = lab.choosing.chosen_rows(
            store,
            tool=tool,
            run=run,
            all_runs=all_runs,
            behavior=behavior,
            probability=None,
            region=None,
            limit=None,
        )
        found = lab.effects.effects_of(store, runs, where, by, wanted.behavior)
    show_either(
        as_json=as_json,
        results=lambda: effects_json(found, where, by),
        tables=lambda: [effects_table(found, where, by)],
    )
    if not as_json:
        lent = [str(one.id) for one in runs if one.only_borrowed]
        of_whom = f" by run {', '.join(lent)}, whose rows were borrowed" if lent else ""
        say(best_words(found, where) if found else f"nothing was tried{of_whom}")
