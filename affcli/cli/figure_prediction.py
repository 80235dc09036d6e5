"""``affcli figure prediction``: how well a table predicts as it grows (§6.1)."""

from affcli import lab
from affcli.cli.database import learned_runs, opened
from affcli.cli.files import require_new, save
from affcli.cli.options import (
    DEFAULT_DATABASE,
    DEFAULT_TOOL,
    FIGURE_ENDINGS,
    Database,
    FigureOut,
    Force,
    LearnedTool,
    Pushes,
    Seed,
    TrialSensor,
)
from affcli.cli.terminal import progress, say
from affcli.errors import one_line
from affcli.report import figures


def prediction(
    *,
    out: FigureOut,
    tool: LearnedTool = DEFAULT_TOOL,
    pushes: Pushes = 2000,
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw how well a table predicts fresh pushes.

    Against how many rows it was learned from.

    The numbers are those of `affcli predict` with as many pushes.
    """
    require_new(out, force=force, endings=FIGURE_ENDINGS)
    with opened(database) as store:
        (run,) = learned_runs(store, tool, database)
        spec = lab.predicting.prediction_spec(run, tool, seed, sensor, pushes)
        done = []
        with progress(f"pushing with the {tool}", pushes) as bar:
            for push in lab.predicting.predict(store, run, spec):
                done.append(push)
                bar.update(len(done), f"{len(done)} of {pushes} pushes")
    title = f"Run {run.id}, {tool}"
    save(out, figures.canvas.encoded(figures.prediction.prediction_figure(title, done), out.suffix))
    say(f"{title}: {one_line(out)}")
