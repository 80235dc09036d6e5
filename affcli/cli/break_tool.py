"""``affcli break-tool``: the tool breaks, the robot is not told, and adapts (§7.2)."""

from affcli import lab
from affcli.cli.database import learned_runs, opened, say_trials, tool_or_default
from affcli.cli.options import (
    DEFAULT_BROKEN,
    DEFAULT_DATABASE,
    DEFAULT_PLANNER,
    DEFAULT_TASKS,
    AsJson,
    Becomes,
    Database,
    LearnedTool,
    Planner,
    Run,
    Seed,
    TaskSet,
    TrialSensor,
)
from affcli.cli.terminal import now, progress, show_either
from affcli.errors import UsageError
from affcli.report.breaking import broken_json, broken_tables


def break_tool(
    *,
    tool: LearnedTool = None,
    run: Run = None,
    becomes: Becomes = DEFAULT_BROKEN,
    task: TaskSet = DEFAULT_TASKS,
    planner: Planner = DEFAULT_PLANNER,  # type: ignore[assignment]  # parsed like any other
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Use a broken tool with the table of the whole one: 4 goals x 4 starts.

    Every trial starts from the table as learned and leaves the stored counters alone. The same
    trials are done with the whole tool, to compare.
    """
    with opened(database, write=True) as store:
        (used,) = learned_runs(store, tool_or_default(tool, run), database, run)
        name = used.spec.tool
        if becomes == name:
            raise UsageError(f"--becomes {name}: a broken {name} must be another tool than it was")
        left = lab.run_parts.tool_of(used.spec, becomes)
        events = lab.breaking.break_tool(store, used, left, seed, now, planner, sensor, task)
        numbers, trials = [], []
        with progress(f"{name} becomes {becomes}", 1.0) as bar:
            for number, trial, share in events:
                numbers.append(number)
                trials.append(trial)
                bar(share, f"{len(trials)} trials")
    show_either(
        as_json=as_json,
        results=lambda: [{"run": used.id, "trials": numbers, **broken_json(used, trials)}],
        tables=lambda: broken_tables(used, trials),
    )
    tried_in_vain = [
        number
        for number, trial in zip(numbers, trials, strict=True)
        if any(step.lost for step in trial.steps)
    ]
    say_trials(numbers, (tried_in_vain or numbers)[0], database)
