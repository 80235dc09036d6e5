"""``affcli solve``: bring the attractor over a goal with what was learned (§6.2, §7.1)."""

from typing import Annotated

import typer

from affcli import lab, registry
from affcli.cli.database import opened, say_beyond_reach, say_failures, say_trials
from affcli.cli.options import (
    DEFAULT_PLANNER,
    DEFAULT_TASKS,
    AsJson,
    Database,
    Planner,
    Run,
    Seed,
    TaskSet,
    TrialSensor,
    check_count,
)
from affcli.cli.terminal import show, show_either
from affcli.core.task import ALL_STARTS
from affcli.lab.clock import now
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.trials import (
    explain_trial,
    solve_table,
    task_json,
    tasks_table,
    trial_json,
)


def solve(
    *,
    goal: Annotated[
        str | None,
        typer.Option(
            "--goal",
            help="Its name: 1 to 4 are the paper's; of other tasks else all.",
            metavar="NAME",
        ),
    ] = None,
    tool: Annotated[
        str | None,
        typer.Option("--tool", help="One tool; all learned ones if not given.", metavar="NAME"),
    ] = None,
    run: Run = None,
    start: Annotated[
        str, typer.Option("--start", help="Its name, or all.", metavar="NAME")
    ] = ALL_STARTS,
    task: TaskSet = DEFAULT_TASKS,
    count: Annotated[
        int | None,
        typer.Option("--n", help="How many random tasks.", metavar="N", parser=check_count("--n")),
    ] = None,
    planner: Planner = DEFAULT_PLANNER,  # type: ignore[assignment]  # parsed like any other
    seed: Seed = 0,
    sensor: TrialSensor = None,
    explain: Annotated[
        bool, typer.Option("--explain", help="Say step by step why each row was chosen.")
    ] = False,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> int:
    """Bring the attractor over a goal region with the tables that were learned.

    Every step updates the counters of the row it used in the stored table. Exit code 1 only when a
    single start was asked for and not solved; 4 when no trial counts, because a part failed.
    """
    wanted = lab.solving.WantedTasks(lab.solving.tasks_named(task, goal, count), goal, start)
    trials: list[lab.solving.SolvedTrial] = []
    with opened(database, write=True) as store:
        runs = lab.choosing.learned_runs(store, tool, run, usable=True)
        for one in lab.solving.solve(store, runs, wanted, seed, now, planner, sensor):
            trials.append(one)
            if explain and not as_json:
                show(explain_trial(one.trial, one.end, one.steps))
    if registry.names_file(task):
        say_beyond_reach([one.trial.task for one in trials], runs[0].spec)
    used = {one.spec.tool: one for one in runs}
    show_either(
        as_json=as_json,
        results=lambda: [
            {"trial": one.id, "run": used[one.trial.tool].id}
            | trial_json(one.trial, one.end, one.steps if explain else None)
            | ({} if goal is not None else task_json(one.whole))
            for one in trials
        ],
        tables=lambda: [
            solve_table([(one.trial, one.end) for one in trials], used)
            if goal is not None
            else tasks_table([one.whole for one in trials], used)
        ],
    )
    ends = [(one.id, one.end) for one in trials]
    code = say_failures(ends)
    say_trials(ends, ends[-1][0], database)
    return code or int(start != ALL_STARTS and not all(one.solved for one in trials))
