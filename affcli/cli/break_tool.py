"""``affcli break-tool``: the tool breaks, the robot is not told, and adapts (§7.2)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from affcli import lab, registry
from affcli.cli.database import opened, say_failures, say_trials, tool_or_default
from affcli.cli.options import (
    DEFAULT_BROKEN,
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
from affcli.cli.terminal import progress, show_either
from affcli.errors import UsageError
from affcli.lab.clock import now
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.breaking import broken_json, broken_tables

if TYPE_CHECKING:
    from affcli.core.specs import LearningSpec
    from affcli.core.tool import Tool


def break_tool(
    *,
    tool: LearnedTool = None,
    run: Run = None,
    becomes: Becomes = None,
    loses: Annotated[
        list[str] | None,
        typer.Option(
            "--loses", help="A part that breaks off; several times for several.", metavar="PART"
        ),
    ] = None,
    task: TaskSet = DEFAULT_TASKS,
    planner: Planner = DEFAULT_PLANNER,  # type: ignore[assignment]  # parsed like any other
    seed: Seed = 0,
    sensor: TrialSensor = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> int:
    """Use a broken tool with the table of the whole one: 4 goals x 4 starts.

    Every trial starts from the table as learned and leaves the stored counters alone. The same
    trials are done with the whole tool, to compare. Exit code 4 when no trial counts.
    """
    if becomes and loses:
        raise UsageError("--becomes the tool that is left, or --loses parts: give one of them")
    with opened(database, write=True) as store:
        (used,) = lab.choosing.learned_runs(store, tool_or_default(tool, run), run, usable=True)
        name = used.spec.tool
        left = _left(used.spec, becomes, loses or ())
        events = lab.breaking.break_tool(store, used, left, seed, now, planner, sensor, task)
        numbers, trials = [], []
        with progress(f"{name} becomes {left.name}", 1.0) as bar:
            for number, trial, share in events:
                numbers.append(number)
                trials.append(trial)
                bar(share, f"{len(trials)} trials")
    show_either(
        as_json=as_json,
        results=lambda: [{"run": used.id, "trials": numbers, **broken_json(used, trials)}],
        tables=lambda: broken_tables(used, trials),
    )
    ends = list(zip(numbers, (trial.end for trial in trials), strict=True))
    code = say_failures(ends)
    tried_in_vain = [
        number
        for number, trial in zip(numbers, trials, strict=True)
        if any(step.lost for step in trial.steps)
    ]
    say_trials(ends, (tried_in_vain or numbers)[0], database)
    return code


def _left(used: "LearningSpec", becomes: str | None, loses: Sequence[str]) -> "Tool":
    """Return what is left of the tool of a run: another tool, or it without some parts."""
    name = used.tool
    lost = loses or (used.held.loses if becomes is None else ())
    if lost:
        return used.held.without(lost)
    if becomes is None and name not in registry.parts("tools"):
        parts = ", ".join(part.name for part in used.held.parts)
        raise UsageError(f"what does the {name} lose? give --loses with one of {parts}")
    left = lab.run_parts.tool_of(used, becomes or DEFAULT_BROKEN)
    if left.name == name:
        raise UsageError(f"--becomes {name}: a broken {name} must be another tool than it was")
    return left
