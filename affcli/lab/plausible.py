"""Whether what a database holds can be worked with at all: anybody may have written into it."""

from collections.abc import Iterable, Mapping

from affcli.behaviors.registry import paper_behaviors
from affcli.config import Settings
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.core.task import GOAL_NUMBERS, START_NUMBERS
from affcli.core.tool import TOOL_PARTS
from affcli.core.trial import LARGEST_SEED, TrialSpec
from affcli.errors import DatabaseError
from affcli.store import LearningRunInfo, StepScene, Store

FARTHEST = 1e6
"""No number of an observation is larger (in, or of 255)."""


def learned_table(
    store: Store, run: LearningRunInfo, settings: Settings, *, as_learned: bool = False
) -> tuple[AffordanceTable, dict[int, int]]:
    """Return the table of a learning run, every row of which a robot can try.

    Args:
        store: open.
        run: which.
        settings: of that run.
        as_learned: with the counters of fresh rows.

    Returns:
        The table; and the number of each row in the store by its learning step.

    Raises:
        DatabaseError: as `check_rows`.
    """
    table, ids = store.affordance_table(run.id, as_learned=as_learned)
    check_rows(run.id, settings, table)
    return table, ids


def check_scene(step: StepScene, settings: Settings) -> None:
    """Refuse to lay out a table as it cannot have been.

    Args:
        step: of a trial, or a behavior of a learning run.
        settings: of that run.

    Raises:
        DatabaseError: it names a tool, a goal or a behavior that there is not, or places out of all
            bounds.
    """
    places = (step.wrist_start, step.wrist_end, step.attractor_start, step.attractor_end)
    before = step.wrist_before or step.wrist_start
    if not (
        {step.tool, step.shape} <= set(TOOL_PARTS)
        and (step.goal is None or step.goal in GOAL_NUMBERS)
        and step.call in _exploratory(settings)
        and bounded(number for place in (*places, before) for number in place)
    ):
        raise not_written(step.title)


def check_trial(trial_id: int, spec: TrialSpec) -> None:
    """Refuse a trial that cannot have been.

    Args:
        trial_id: its number in the store, for the message.
        spec: what it is said to be.

    Raises:
        DatabaseError: it names a tool, a goal, a start or a seed that there is not.
    """
    tools = {spec.tool, spec.shape} <= set(TOOL_PARTS)
    numbers = (spec.goal in GOAL_NUMBERS, spec.start in START_NUMBERS)
    drawn = all(0 <= number <= LARGEST_SEED for number in (spec.seed, spec.robot))
    if not (tools and all(numbers) and drawn):
        raise not_written(f"trial {trial_id}")


def check_rows(run_id: int, settings: Settings, rows: Iterable[Affordance]) -> None:
    """Refuse rows of an affordance table that no robot can have made.

    Args:
        run_id: number of the learning run in the store, for the message.
        settings: of that run.
        rows: of its table.

    Raises:
        DatabaseError: a row's behavior is not among those of babbling, or was seen out of all
            bounds.
    """
    known = _exploratory(settings)
    for row in rows:
        if row.exploratory not in known or not bounded((*row.start, *row.end)):
            raise not_written(f"row {row.step} of learning run {run_id}")


def check_starts(
    run_id: int, starts: Mapping[int, tuple[Point, Pose]], rows: Iterable[Affordance]
) -> None:
    """Make sure that it is known where each row was made.

    Args:
        run_id: number of the learning run in the store, for the message.
        starts: where wrist and attractor were, by learning step.
        rows: of its table.

    Raises:
        DatabaseError: of a row it is not, or it is out of all bounds.
    """
    for row in rows:
        start = starts.get(row.step)
        if start is None or not bounded((*start[0], *start[1])):
            raise not_written(f"behavior {row.step} of learning run {run_id}")


def check_numbers(place: str, numbers: Iterable[float]) -> None:
    """Refuse numbers that are none, or that no laboratory has.

    Args:
        place: which record they are of, for the message.
        numbers: lengths and colours (in, or of 255).

    Raises:
        DatabaseError: one of them is not within bounds.
    """
    if not bounded(numbers):
        raise not_written(place)


def not_written(place: str) -> DatabaseError:
    """Return what to say of a record with a value that affcli does not write."""
    return DatabaseError(
        f"{place} holds a value that affcli did not write; restore a copy of the database"
    )


def _exploratory(settings: Settings) -> frozenset[BehaviorCall]:
    """Return the behaviors that babbling draws from."""
    place = settings.workspace
    return frozenset(paper_behaviors(place.arm, place.motion, place.tools).exploratory)


def bounded(numbers: Iterable[float]) -> bool:
    """Tell whether numbers are numbers, and not absurdly large."""
    return all(abs(number) <= FARTHEST for number in numbers)
