"""Whether what a database holds can be worked with at all: anybody may have written into it."""

from collections.abc import Iterable, Mapping
from typing import Any

from affcli.behaviors.registry import paper_behaviors
from affcli.config import Settings
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.task import GOAL_NUMBERS, START_NUMBERS
from affcli.core.tool import TOOL_PARTS
from affcli.core.trial import LARGEST_SEED, TrialSpec
from affcli.errors import DatabaseError
from affcli.lab.bench import STREAMS
from affcli.store import LearningRunInfo, StepScene, Store

FARTHEST = 1e6
"""No number of an observation is larger (in, or of 255)."""
CHECKPOINT = {"step", "grasped", "seen", "clock", "wrist", "attractor", "streams"}
STREAM = {"bit_generator": 0, "state": 0, "has_uint32": 2, "uinteger": 2**32}
"""What the state of a random stream consists of, with the limit of what is a number."""


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


def check_checkpoint(run: LearningRunInfo) -> None:
    """Refuse to go on with a learning run from where it cannot have been.

    Args:
        run: begun, and not done.

    Raises:
        DatabaseError: what it needs to go on is missing, or is none that `LearningRun` gives.
    """
    place, kept = f"learning run {run.id}", run.checkpoint
    if kept is None:
        if run.behaviors:
            raise not_written(place)
        return
    if kept.keys() != CHECKPOINT:
        raise not_written(place)
    stands = (kept["step"], kept["clock"]) == (run.behaviors, run.robot_seconds)
    seen = kept["seen"] is None or _are_numbers(kept["seen"], len(Observation._fields))
    placed = _are_numbers(kept["wrist"], 2) and _are_numbers(kept["attractor"], 3)
    streams = kept["streams"]
    drawn = (
        isinstance(streams, dict)
        and streams.keys() == set(STREAMS)
        and all(map(_is_stream, streams.values()))
    )
    if not (stands and isinstance(kept["grasped"], bool) and seen and placed and drawn):
        raise not_written(place)


def _are_numbers(value: object, count: int) -> bool:
    """Tell whether a value of JSON is a list of so many numbers within bounds."""
    return (
        isinstance(value, list)
        and len(value) == count
        and all(isinstance(number, int | float) for number in value)
        and _bounded(value)
    )


def _is_stream(value: Any) -> bool:
    """Tell whether a value of JSON is the state of a random stream, a PCG64."""
    if not isinstance(value, dict) or value.keys() != STREAM.keys():
        return False
    words = value["state"]
    if not isinstance(words, dict) or words.keys() != {"state", "inc"}:
        return False
    numbers = [(words["state"], 2**128), (words["inc"], 2**128)]
    numbers += [(value[name], limit) for name, limit in STREAM.items() if limit]
    return value["bit_generator"] == "PCG64" and all(
        isinstance(number, int) and 0 <= number < limit for number, limit in numbers
    )


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
        and _bounded(number for place in (*places, before) for number in place)
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
        if row.exploratory not in known or not _bounded((*row.start, *row.end)):
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
        if start is None or not _bounded((*start[0], *start[1])):
            raise not_written(f"behavior {row.step} of learning run {run_id}")


def check_numbers(place: str, numbers: Iterable[float]) -> None:
    """Refuse numbers that are none, or that no laboratory has.

    Args:
        place: which record they are of, for the message.
        numbers: lengths and colours (in, or of 255).

    Raises:
        DatabaseError: one of them is not within bounds.
    """
    if not _bounded(numbers):
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


def _bounded(numbers: Iterable[float]) -> bool:
    """Tell whether numbers are numbers, and not absurdly large."""
    return all(abs(number) <= FARTHEST for number in numbers)
