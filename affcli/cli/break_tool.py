"""``affcli break-tool``: the tool breaks, the robot is not told, and adapts (§7.2)."""

from affcli import lab
from affcli.cli.database import learned_runs, opened, say_trials
from affcli.cli.options import (
    DEFAULT_BROKEN,
    DEFAULT_DATABASE,
    DEFAULT_TOOL,
    AsJson,
    Becomes,
    Database,
    LearnedTool,
    Seed,
    TrialSensor,
)
from affcli.cli.terminal import now, progress, show_either
from affcli.config import settings_from_json
from affcli.errors import UsageError
from affcli.report.breaking import broken_json, broken_tables


def break_tool(
    *,
    tool: LearnedTool = DEFAULT_TOOL,
    becomes: Becomes = DEFAULT_BROKEN,
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Use a broken tool with the table of the whole one: 4 goals x 4 starts.

    Every trial starts from the table as learned and keeps its counters to itself. The same trials
    with the whole tool are done beside them, to compare.
    """
    if becomes == tool:
        raise UsageError(f"--becomes {becomes}: a broken {tool} must be another shape than it was")
    with opened(database, write=True) as store:
        (run,) = learned_runs(store, tool, database)
        with progress(f"{tool} becomes {becomes}", 32) as bar:
            numbers, trials = [], []
            for number, trial in lab.breaking.break_tool(store, run, becomes, seed, now, sensor):
                numbers.append(number)
                trials.append(trial)
                bar.update(len(trials), f"{len(trials)} of 32 trials")
    side = lab.bench.missing_side(settings_from_json(run.spec.settings), tool, becomes)
    show_either(
        as_json=as_json,
        value=lambda: {"run": run.id, "trials": numbers, **broken_json(becomes, side, trials)},
        tables=lambda: broken_tables(becomes, side, trials),
    )
    tried_in_vain = [
        number
        for number, trial in zip(numbers, trials, strict=True)
        if any(step.lost for step in trial.steps)
    ]
    say_trials(numbers, (tried_in_vain or numbers)[0], database)
