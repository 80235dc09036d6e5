"""Robots whose hour is short and whose trials end soon, so that whole lives fit into a test."""

from collections.abc import Iterable, Iterator
from functools import cache

from affcli.config import Settings, settings_with
from affcli.core.affordance_table import AffordanceTable
from affcli.core.geometry import Point, Pose
from affcli.core.trial import BabblingRecord, LearningSpec, Truth
from affcli.lab.learning_run import LearningRun

NOW = "2026-01-02T03:04:05+00:00"
Steps = tuple[tuple[BabblingRecord, Truth], ...]

LEISURELY = settings_with({"motion": {"hold": 40.0}, "trial": {"max_steps": 4}}, "a test")
"""Standing still for so long after every move that an hour holds some forty behaviors."""
IMPATIENT = settings_with({"trial": {"max_steps": 6}}, "a test")
"""Trials are given up soon."""
EXACT = settings_with({"sensor": {"position_noise": 0, "color_noise": 0}}, "a test")
"""A sensor without noise."""


def now() -> str:
    """Return the same time whenever asked, so that databases can be compared."""
    return NOW


@cache
def learned(spec: LearningSpec) -> Steps:
    """Return all that a learning run gives."""
    return tuple(LearningRun(spec).steps())


def table_from(steps: Iterable[tuple[BabblingRecord, Truth]]) -> AffordanceTable:
    """Return the affordance table that a learning run leaves."""
    return AffordanceTable(r.affordance for r, _ in steps if r.affordance is not None)


def starts_of(steps: Iterable[tuple[BabblingRecord, Truth]]) -> dict[int, tuple[Point, Pose]]:
    """Return where wrist and attractor truly were when each row was made, by step."""
    return {r.step: (r.execution.wrist_start, t.start) for r, t in steps if r.affordance}


def spec_of(
    tool: str = "t-hook",
    behaviors: int = 400,
    seed: int = 0,
    robot: int = 0,
    settings: Settings | None = None,
) -> LearningSpec:
    """Return the spec of a learning run of so many behaviors."""
    text = (settings or Settings()).to_json()
    return LearningSpec(tool, seed, robot, None, behaviors, text)


def counted(items: Iterable[object]) -> int:
    """Run through an iterator; return how many items it gave."""
    return sum(1 for _ in items)


def taken(items: Iterator[object], number: int) -> None:
    """Take so many items of an iterator, then let go of it."""
    for _ in range(number):
        next(items)
