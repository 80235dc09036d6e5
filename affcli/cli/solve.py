"""``affcli solve``: bring the attractor over a goal with what was learned (§6.2, §7.1)."""

from typing import Annotated, Any

import typer

from affcli import lab
from affcli.cli.database import learned_runs, opened, say_trials
from affcli.cli.options import (
    DEFAULT_DATABASE,
    AsJson,
    Database,
    Seed,
    TrialSensor,
    check_if_given,
    checked_goal,
    checked_starts,
    checked_tool,
)
from affcli.cli.terminal import now, show, show_either
from affcli.config import settings_from_json
from affcli.core.task import GoalRegion, goal_regions
from affcli.core.trial import StepRecord
from affcli.report.trials import distances, explain_trial, solve_table

DISTANCES = ("distance_to_goal", "expected_distance_to_goal", "repositioning")
"""What searches 3 and 4 weighed, in inches."""


def solve(
    *,
    goal: Annotated[
        int, typer.Option("--goal", help="1 to 4.", metavar="N", callback=checked_goal)
    ],
    tool: Annotated[
        str | None,
        typer.Option(
            "--tool",
            help="One tool; all learned ones if not given.",
            metavar="NAME",
            callback=check_if_given(checked_tool),
        ),
    ] = None,
    start: Annotated[str, typer.Option("--start", help="1 to 4, or all.", metavar="N")] = "all",
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
    single start was asked for and not solved.
    """
    starts = checked_starts(start)
    trials: list[lab.solving.SolvedTrial] = []
    steps: list[list[tuple[int, StepRecord]]] = [[]]
    with opened(database, write=True) as store:
        runs = learned_runs(store, tool, database)
        regions = {
            run.spec.tool: goal_regions(settings_from_json(run.spec.settings).workspace.layout)[
                goal
            ]
            for run in runs
        }
        for event in lab.solving.solve(store, runs, goal, starts, seed, now, sensor):
            if isinstance(event, lab.solving.SolvedStep):
                steps[-1].append((event.row, event.record))
                continue
            trials.append(event)
            steps.append([])
            if explain and not as_json:
                show(explain_trial(event.trial, event.end, steps[-2], regions[event.trial.tool]))
    used = {run.spec.tool: run.id for run in runs}
    show_either(
        as_json=as_json,
        value=lambda: [
            _as_json(used, trial, taken, regions[trial.trial.tool] if explain else None)
            for trial, taken in zip(trials, steps[:-1], strict=True)
        ],
        tables=lambda: [solve_table(goal, [(t.trial, t.end) for t in trials], used)],
    )
    numbers = [trial.id for trial in trials]
    say_trials(numbers, numbers[-1], database)
    return 0 if len(starts) > 1 or all(t.solved for t in trials) else 1


def _as_json(
    runs: dict[str, int],
    trial: "lab.solving.SolvedTrial",
    steps: list[tuple[int, StepRecord]],
    goal: GoalRegion | None,
) -> dict[str, Any]:
    """Return one trial as JSON types; with its steps when the goal is given to explain them by."""
    spec, end = trial.trial, trial.end
    value: dict[str, Any] = {
        "trial": trial.id,
        "run": runs[spec.tool],
        "sensor": spec.sensor,
        "tool": spec.tool,
        "goal": spec.goal,
        "start": spec.start,
        "outcome": end.outcome.value,
        "steps": end.steps,
        "robot_seconds": end.clock,
    }
    if goal is not None:
        left = end.last_survivors
        value["rows_left_at_end"] = None if left is None else left._asdict()
        value["explain"] = [
            {
                "step": record.number,
                "row": row,
                "behavior": str(record.row.exploratory),
                "rows_left": record.survivors._asdict(),
                "placing": record.placing.status.value,
                **dict(zip(DISTANCES, distances(record, goal), strict=True)),
                "expected": [record.expected.dx, record.expected.dy],
                "seen": [record.seen.dx, record.seen.dy],
                "replicated": record.replicated,
                "probability_before": record.row.replication_probability,
                "probability_after": record.times_successful_after / record.times_used_after,
            }
            for row, record in steps
        ]
    return value
