"""``affcli verify``: does the table still hold? The robot tries its rows again (§3.1, §8)."""

from typing import Annotated

import typer

from affcli.cli.options import (
    DEFAULT_DATABASE,
    MOST_TRIES,
    AsJson,
    Database,
    Seed,
    TrialSensor,
    checked_count,
    checked_seed,
    checked_sensor,
    checked_tool,
)
from affcli.cli.solve import learned_runs
from affcli.cli.terminal import now, progress, show, show_json


def verify(
    *,
    tool: Annotated[str, typer.Option("--tool", help="What was learned.", metavar="NAME")] = (
        "t-hook"
    ),
    shape: Annotated[
        str | None,
        typer.Option("--shape", help="What the robot truly holds, painted alike.", metavar="NAME"),
    ] = None,
    rows: Annotated[
        int | None,
        typer.Option("--rows", help="How many to try; each once if not given.", metavar="N"),
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
    checked_tool(tool)
    held = tool if shape is None else checked_tool(shape)
    if rows is not None:
        checked_count("--rows", rows, MOST_TRIES)
    checked_seed(seed)
    kind = checked_sensor(sensor)

    from affcli.lab.verifying import verification_spec
    from affcli.lab.verifying import verify as verify_table
    from affcli.report.verification import Verification, verification_json, verification_tables
    from affcli.store import open_store

    with open_store(database, create=False, write=update) as store:
        (run,) = learned_runs(store, tool, database)
        spec = verification_spec(run, held, seed, kind, rows, until_verdict=until_verdict)
        tries = []
        with progress(f"{tool}, row by row", spec.tries) as bar:
            for one in verify_table(store, run, spec, now, update=update):
                tries.append(one)
                bar.update(len(tries), f"{len(tries)} of {spec.tries} tries")
    found = Verification(run.id, spec, run.rows, update, tuple(tries))
    if as_json:
        show_json(verification_json(found))
    else:
        show(*verification_tables(found))
