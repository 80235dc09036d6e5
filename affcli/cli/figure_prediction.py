"""``affcli figure prediction``: how well a table predicts as it grows (§6.1)."""

from affcli import lab
from affcli.cli.database import learned_runs, opened, tool_or_default
from affcli.cli.files import require_new, save
from affcli.cli.options import (
    DEFAULT_DATABASE,
    FIGURE_ENDINGS,
    Database,
    FigureOut,
    Force,
    LearnedTool,
    Pushes,
    Run,
    Seed,
    TrialSensor,
)
from affcli.cli.terminal import progress, say
from affcli.errors import one_line
from affcli.report import figures


def prediction(
    *,
    out: FigureOut,
    tool: LearnedTool = None,
    run: Run = None,
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
        (used,) = learned_runs(store, tool_or_default(tool, run), database, run)
        spec = lab.predicting.prediction_spec(used, used.spec.held, seed, sensor, pushes)
        done = []
        with progress(f"pushing with the {spec.tool}", pushes) as bar:
            for push in lab.predicting.predict(store, used, spec):
                done.append(push)
                bar.update(len(done), f"{len(done)} of {pushes} pushes")
    title = f"Run {used.id}, {spec.tool}"
    save(out, figures.canvas.encoded(figures.prediction.prediction_figure(title, done), out.suffix))
    say(f"{title}: {one_line(out)}")
