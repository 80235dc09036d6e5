"""``affcli solve``: bring the attractor over a goal with what was learned (§6.2, §7.1)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from affcli.cli.options import (
    DEFAULT_DATABASE,
    AsJson,
    Database,
    Seed,
    TrialSensor,
    checked_goal,
    checked_seed,
    checked_sensor,
    checked_starts,
    checked_tool,
    with_database,
)
from affcli.cli.terminal import now, say, show, show_json
from affcli.core.tool import TOOL_PARTS
from affcli.errors import UsageError

if TYPE_CHECKING:
    from pathlib import Path

    from affcli.core.task import GoalRegion
    from affcli.core.trial import StepRecord
    from affcli.lab.solving import SolvedTrial
    from affcli.store import LearningRunInfo, Store


DISTANCES = ("distance_to_goal", "expected_distance_to_goal", "repositioning")
"""What searches 3 and 4 weighed, in inches."""


def solve(
    *,
    goal: Annotated[int, typer.Option("--goal", help="1 to 4.", metavar="N")],
    tool: Annotated[
        str | None,
        typer.Option("--tool", help="One tool; all learned ones if not given.", metavar="NAME"),
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
    checked_goal(goal)
    starts = checked_starts(start)
    checked_seed(seed)
    kind = checked_sensor(sensor)
    if tool is not None:
        checked_tool(tool)

    from affcli.config import settings_from_json
    from affcli.core.task import goal_regions
    from affcli.lab.solving import SolvedStep
    from affcli.lab.solving import solve as solve_trials
    from affcli.report.trials import explain_trial, solve_table
    from affcli.store import open_store

    trials: list[SolvedTrial] = []
    steps: list[list[tuple[int, StepRecord]]] = [[]]
    with open_store(database, create=False, write=True) as store:
        runs = learned_runs(store, tool, database)
        regions = {
            run.spec.tool: goal_regions(settings_from_json(run.spec.settings).workspace.layout)[
                goal
            ]
            for run in runs
        }
        for event in solve_trials(store, runs, goal, starts, seed, now, kind):
            if isinstance(event, SolvedStep):
                steps[-1].append((event.row, event.record))
                continue
            trials.append(event)
            steps.append([])
            if explain and not as_json:
                show(explain_trial(event.trial, event.end, steps[-2], regions[event.trial.tool]))
    used = {run.spec.tool: run.id for run in runs}
    if as_json:
        show_json(
            [
                _as_json(used, trial, taken, regions[trial.trial.tool] if explain else None)
                for trial, taken in zip(trials, steps[:-1], strict=True)
            ]
        )
    else:
        show(solve_table(goal, [(t.trial, t.end) for t in trials], used))
    numbers = [trial.id for trial in trials]
    say_trials(numbers, numbers[-1], database)
    return 0 if len(starts) > 1 or all(t.solved for t in trials) else 1


def say_trials(numbers: Sequence[int], worth_seeing: int, database: "Path") -> None:
    """Say which trials were saved, and how to see one of them."""
    first, last = numbers[0], numbers[-1]
    which = f"trial {first}" if first == last else f"trials {first} to {last}"
    replay = with_database(f"affcli replay {worth_seeing}", database)
    say(f"{which} saved; to see why each row was chosen: {replay}")


def learned_runs(store: "Store", tool: str | None, database: "Path") -> list["LearningRunInfo"]:
    """Return the latest finished learning run of the tool, or of every tool that has one.

    Raises:
        UsageError: there is none; the message names the command to run.
    """
    names = [tool] if tool is not None else list(TOOL_PARTS)
    runs = [run for run in map(store.latest_run, names) if run is not None]
    if not runs:
        only = " but by robots of a reproduction" if store.sessions("reproduce") else ""
        learning = with_database(f"affcli learn --tool {tool or 't-hook'}", database)
        raise UsageError(
            f"nothing learned with the {tool or 'tools'} in {database}{only}; first run: {learning}"
        )
    return runs


def _as_json(
    runs: dict[str, int],
    trial: "SolvedTrial",
    steps: list[tuple[int, "StepRecord"]],
    goal: "GoalRegion | None",
) -> dict[str, Any]:
    """Return one trial as JSON types; with its steps when the goal is given to explain them by."""
    from affcli.report.trials import distances

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
