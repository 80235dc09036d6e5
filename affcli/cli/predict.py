"""``affcli predict``: the table as a predictive model of pushes it has never seen (§6.1)."""

from affcli import lab
from affcli.cli.database import opened, tool_or_default
from affcli.cli.options import (
    AsJson,
    Database,
    HeldShape,
    LearnedTool,
    Pushes,
    Run,
    Seed,
    TrialSensor,
)
from affcli.cli.terminal import followed, show_either
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.planning.prediction import RADIUS
from affcli.report.prediction import prediction_json, prediction_tables


def predict(
    *,
    tool: LearnedTool = None,
    run: Run = None,
    shape: HeldShape = None,
    pushes: Pushes = 500,
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Predict fresh pushes with a table, and see how often it is right.

    A push is predicted by the nearest row of the same behavior: of all rows, and of only the first
    that were learned. Of a log that was imported each trial is predicted by the rows of the others.
    Nothing is written.
    """
    with opened(database) as store:
        (used,) = lab.choosing.learned_runs(store, tool_or_default(tool, run), run)
        held = lab.run_parts.tool_of(used.spec, shape or used.spec.tool)
        spec = lab.predicting.prediction_spec(used, held, seed, sensor, pushes)
        doing = lab.predicting.predict(store, used, spec)
        pushes = min(pushes, used.behaviors) if used.spec.logged else pushes
        done = followed(doing, f"pushing with the {held.name}", pushes, "pushes")
    about = {
        "run": used.id,
        "tool": spec.tool,
        "shape": spec.shape,
        "sensor": spec.sensor,
        "seed": seed,
        "pushes": pushes,
        "radius": RADIUS,
    }
    show_either(
        as_json=as_json,
        results=lambda: [{**about, "scores": prediction_json(done)}],
        tables=lambda: prediction_tables(
            f"Run {used.id}, {spec.tool}", RADIUS, done, logged=used.spec.logged
        ),
    )
