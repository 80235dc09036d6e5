"""``affcli predict``: the table as a predictive model of pushes it has never seen (§6.1)."""

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
from affcli.cli.terminal import progress, show, show_json


def predict(
    *,
    tool: Annotated[str, typer.Option("--tool", help="What was learned.", metavar="NAME")] = (
        "t-hook"
    ),
    shape: Annotated[
        str | None,
        typer.Option("--shape", help="What the robot truly holds, painted alike.", metavar="NAME"),
    ] = None,
    pushes: Annotated[int, typer.Option("--pushes", help="How many.", metavar="N")] = 500,
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Ask a table what fresh pushes will do, and see how well it knew.

    The nearest row of the same behavior tells: all of them, and only the first that were learned.
    Nothing is written.
    """
    checked_tool(tool)
    held = tool if shape is None else checked_tool(shape)
    checked_count("--pushes", pushes, MOST_TRIES)
    checked_seed(seed)
    kind = checked_sensor(sensor)

    from affcli.lab.predicting import predict as predict_pushes
    from affcli.lab.predicting import prediction_spec
    from affcli.planning.prediction import RADIUS
    from affcli.report.prediction import prediction_json, prediction_tables
    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        (run,) = learned_runs(store, tool, database)
        spec = prediction_spec(run, held, seed, kind, pushes)
        done = []
        with progress(f"pushing with the {held}", pushes) as bar:
            for push in predict_pushes(store, run, spec):
                done.append(push)
                bar.update(len(done), f"{len(done)} of {pushes} pushes")
    if as_json:
        about = {"run": run.id, "tool": tool, "shape": held, "sensor": spec.sensor, "seed": seed}
        show_json({**about, "pushes": pushes, "radius": RADIUS, "scores": prediction_json(done)})
    else:
        show(*prediction_tables(f"Run {run.id}, {tool}", RADIUS, done))
