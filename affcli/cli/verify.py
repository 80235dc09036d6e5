"""``affcli verify``: does the table still hold? The robot tries its rows again (§3.1, §8)."""

from typing import Annotated

import typer

from affcli import lab
from affcli.analysis.verification import Verification
from affcli.cli.database import opened, tool_or_default
from affcli.cli.options import (
    MOST_TRIES,
    AsJson,
    Database,
    HeldShape,
    LearnedTool,
    Run,
    Seed,
    TrialSensor,
    check_count,
)
from affcli.cli.terminal import followed, show_either
from affcli.lab.clock import now
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.verification import verification_json, verification_tables


def verify(
    *,
    tool: LearnedTool = None,
    run: Run = None,
    shape: HeldShape = None,
    rows: Annotated[
        int | None,
        typer.Option(
            "--rows",
            help="How many to try; each once if not given.",
            metavar="N",
            parser=check_count("--rows", MOST_TRIES),
        ),
    ] = None,
    until_verdict: Annotated[
        bool, typer.Option("--until-verdict", help="Stop as soon as it can be told.")
    ] = False,
    update: Annotated[
        bool, typer.Option("--update", help="Count the tries in the stored table.")
    ] = False,
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Let the robot test its own table: does it still hold?

    Rows of the latest learning run are executed again, in random order, each in a fresh situation
    that matches its start. Nothing is written unless told to --update.
    """
    with opened(database, write=update) as store:
        (used,) = lab.choosing.learned_runs(store, tool_or_default(tool, run), run, usable=True)
        held = lab.run_parts.tool_of(used.spec, shape or used.spec.tool)
        spec = lab.verifying.verification_spec(
            used, held, seed, sensor, rows, until_verdict=until_verdict
        )
        doing = lab.verifying.verify(store, used, spec, now, update=update)
        tries = followed(doing, f"{used.spec.tool}, row by row", spec.tries, "tries")
    found = Verification(used.id, spec, used.rows, update, tuple(tries))
    show_either(
        as_json=as_json,
        results=lambda: [verification_json(found)],
        tables=lambda: verification_tables(found),
    )
