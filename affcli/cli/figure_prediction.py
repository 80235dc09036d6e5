"""``affcli figure prediction``: how well a table predicts as it grows (§6.1)."""

from pathlib import Path
from typing import Annotated

import typer

from affcli.cli.files import require_new, save
from affcli.cli.options import (
    DEFAULT_DATABASE,
    MOST_TRIES,
    Database,
    Force,
    Seed,
    TrialSensor,
    checked_count,
    checked_seed,
    checked_sensor,
    checked_tool,
)
from affcli.cli.solve import learned_runs
from affcli.cli.terminal import progress, say
from affcli.errors import one_line

ENDINGS = (".png", ".svg", ".pdf")


def prediction(
    *,
    out: Annotated[
        Path, typer.Option("--out", help="The figure: *.png, *.svg, *.pdf.", metavar="FILE")
    ],
    tool: Annotated[str, typer.Option("--tool", help="What was learned.", metavar="NAME")] = (
        "t-hook"
    ),
    pushes: Annotated[int, typer.Option("--pushes", help="How many.", metavar="N")] = 2000,
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw how well a table predicts fresh pushes.

    Against how many rows it was learned from.

    The numbers are those of `affcli predict` with as many pushes.
    """
    checked_tool(tool)
    checked_count("--pushes", pushes, MOST_TRIES)
    checked_seed(seed)
    kind = checked_sensor(sensor)
    require_new(out, force=force, endings=ENDINGS)

    from affcli.lab.predicting import predict, prediction_spec
    from affcli.report.figures.canvas import encoded
    from affcli.report.figures.prediction import prediction_figure
    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        (run,) = learned_runs(store, tool, database)
        spec = prediction_spec(run, tool, seed, kind, pushes)
        done = []
        with progress(f"pushing with the {tool}", pushes) as bar:
            for push in predict(store, run, spec):
                done.append(push)
                bar.update(len(done), f"{len(done)} of {pushes} pushes")
    title = f"Run {run.id}, {tool}"
    save(out, encoded(prediction_figure(title, done), out.suffix))
    say(f"{title}: {one_line(out)}")
