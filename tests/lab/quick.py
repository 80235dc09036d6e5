"""Robots whose hour is short and whose trials end soon, so that whole lives fit into a test."""

import sqlite3
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from affcli.config import Settings, settings_with
from affcli.core.affordance_table import AffordanceTable
from affcli.core.identity import Component
from affcli.core.observation import SensorKind
from affcli.core.records import LearningRunInfo
from affcli.core.specs import LearningSpec, LearningStep, RowStarts, TrialRecord
from affcli.core.task import ALL_STARTS
from affcli.lab.breaking import break_tool
from affcli.lab.learning_run import LearningRun
from affcli.lab.reproduction import Reproduced, reproduce
from affcli.lab.run_parts import RunParts, tool_of
from affcli.lab.solving import SolvedTrial, WantedTasks, solve
from affcli.store import Store
from tests.factories import learning_spec

NOW = "2026-01-02T03:04:05+00:00"
Steps = tuple[LearningStep, ...]

LEISURELY = settings_with({"motion": {"hold": 40.0}, "trial": {"max_steps": 4}}, "a test")
"""Standing still for so long after every move that an hour holds some forty behaviors."""
IMPATIENT = settings_with({"trial": {"max_steps": 6}}, "a test")
"""Trials are given up soon."""
PLANNER = Component("nested-query")
INTERRUPTED = (
    "DELETE FROM step WHERE number > 2",
    "UPDATE trial SET outcome = NULL, steps = NULL, robot_seconds = NULL",
)
"""Leave of a trial what an earlier affcli did that was stopped in it."""


def now() -> str:
    """Return the same time whenever asked, so that databases can be compared."""
    return NOW


@cache
def learned(spec: LearningSpec) -> Steps:
    """Return all that a learning run gives."""
    return tuple(LearningRun(spec).steps())


def table_from(steps: Iterable[LearningStep]) -> AffordanceTable:
    """Return the affordance table that a learning run leaves."""
    return AffordanceTable(r.affordance for r, _ in steps if r.affordance is not None)


def starts_of(steps: Iterable[LearningStep]) -> RowStarts:
    """Return where wrist and attractor truly were when each row was made, by step."""
    return {
        r.step: (r.execution.wrist_start, truth.start)
        for r, truth in steps
        if r.affordance is not None and truth is not None
    }


def spec_of(
    tool: str = "t-hook",
    behaviors: int = 400,
    seed: int = 0,
    robot: int = 0,
    settings: Settings | None = None,
) -> LearningSpec:
    """Return the spec of a learning run of so many behaviors."""
    return learning_spec(tool, seed=seed, robot=robot, behaviors=behaviors, settings=settings)


def stored(store: Store, spec: LearningSpec) -> LearningRunInfo:
    """Put a finished run into the store, learned once for all tests."""
    run, steps = store.learning.begin(spec, {}, NOW), learned(spec)
    clock = steps[-1][0].clock
    assert store.learning.append(run.id, 0, steps, None, clock, done=True, now=NOW)
    return store.learning.run(run.id)


def solving(
    store: Store,
    runs: LearningRunInfo | list[LearningRunInfo],
    goal: str = "1",
    start: str = ALL_STARTS,
    *,
    seed: int = 0,
    planner: Component = PLANNER,
    sensor: SensorKind | None = None,
) -> Iterator[SolvedTrial]:
    """Solve some of the paper's tasks with what the store holds."""
    wanted = WantedTasks("extension-of-reach", goal, start)
    many = runs if isinstance(runs, list) else [runs]
    return solve(store, many, wanted, seed, now, planner, sensor)


def breaking(
    store: Store,
    run: LearningRunInfo,
    shape: str = "l-hook",
    seed: int = 0,
    planner: Component = PLANNER,
) -> Iterator[tuple[int, TrialRecord, float]]:
    """Let the tool of a run break, and try what is left of it beside the whole one."""
    return break_tool(store, run, tool_of(run.spec, shape), seed, now, planner)


def reproducing(store: Store, settings: Settings, robots: int, seed: int) -> Iterator[int]:
    """Let robots live in this process."""
    what = Reproduced(RunParts.chosen(settings), PLANNER, seed)
    return reproduce(store, what, robots, 1, now)


def altered(path: Path, *statements: str) -> None:
    """Change the database as no affcli would."""
    with sqlite3.connect(path) as driver:
        for statement in statements:
            driver.execute(statement)
    driver.close()


def counted(items: Iterable[object]) -> int:
    """Run through an iterator; return how many items it gave."""
    return sum(1 for _ in items)


def taken(items: Iterator[object], number: int) -> None:
    """Take so many items of an iterator, then let go of it."""
    for _ in range(number):
        next(items)
