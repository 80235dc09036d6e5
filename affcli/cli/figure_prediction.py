"""``affcli figure prediction``: how well a table predicts as it grows (§6.1)."""

from affcli import lab
from affcli.cli.database import learned_runs, opened, tool_or_default
from affcli.cli.figure_learned import check_out, save_figure
from affcli.cli.options import (
    DEFAULT_DATABASE,
    Database,
    FigureOut,
    Force,
    LearnedTool,
    Pushes,
    Run,
    Seed,
    TrialSensor,
)
from affcli.cli.terminal import followed
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

    Against the number of rows that it has.

    The numbers are those of `affcli predict` with as many pushes.
    """
    check_out(out, force=force)
    with opened(database) as store:
        (used,) = learned_runs(store, tool_or_default(tool, run), database, run)
        spec = lab.predicting.prediction_spec(used, used.spec.held, seed, sensor, pushes)
        doing = lab.predicting.predict(store, used, spec)
        done = followed(doing, f"pushing with the {spec.tool}", pushes, "pushes")
    title = f"Run {used.id}, {spec.tool}"
    save_figure(out, figures.prediction.prediction_figure(title, done), title)
