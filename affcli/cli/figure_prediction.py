"""``affcli figure prediction``: how well a table predicts as it grows (§6.1)."""

from functools import partial

from affcli import lab
from affcli.cli.database import opened, tool_or_default
from affcli.cli.figure import Figure, figure
from affcli.cli.options import Database, LearnedTool, Pushes, Run, Seed, TrialSensor
from affcli.cli.terminal import followed
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report import figures
from affcli.report.captions import prediction_words


@figure
def prediction(
    *,
    tool: LearnedTool = None,
    run: Run = None,
    pushes: Pushes = 2000,
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw how well a table predicts fresh pushes.

    Against the number of rows that it has.

    The numbers are those of `affcli predict` with as many pushes.
    """
    with opened(database) as store:
        (used,) = lab.choosing.learned_runs(store, tool_or_default(tool, run), run)
        spec = lab.predicting.prediction_spec(used, used.spec.held, seed, sensor, pushes)
        doing = lab.predicting.predict(store, used, spec)
        pushes = min(pushes, used.behaviors) if used.spec.logged else pushes
        done = followed(doing, f"pushing with the {spec.tool}", pushes, "pushes")
    words = prediction_words(used, spec, done)
    return Figure(words, partial(figures.prediction.prediction_figure, done))
