"""Whether what a database holds can be worked with at all: anybody may have written into it."""

from collections.abc import Iterable, Mapping

from affcli.behaviors.registry import paper_behaviors
from affcli.config import Settings
from affcli.core.affordance import Affordance
from affcli.core.geometry import Point, Pose
from affcli.core.task import GOAL_NUMBERS, START_NUMBERS
from affcli.core.tool import TOOL_PARTS
from affcli.core.trial import TrialSpec
from affcli.errors import DatabaseError

LARGEST_SEED = 2**63 - 1
FARTHEST = 1e6
"""No number of an observation is larger (in, or of 255)."""


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
    place = settings.workspace
    known = frozenset(paper_behaviors(place.arm, place.motion, place.tools).exploratory)
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


def _bounded(numbers: Iterable[float]) -> bool:
    """Tell whether numbers are numbers, and not absurdly large."""
    return all(abs(number) <= FARTHEST for number in numbers)
