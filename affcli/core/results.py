"""Counts and sums over stored records: what reports are made from."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from affcli.core.behavior import BehaviorCall
from affcli.core.records import SessionInfo
from affcli.core.specs import Protocol


@dataclass(frozen=True, slots=True)
class BehaviorGroup:
    """What one exploratory behavior with one value of its parameters gave in a learning run.

    Args:
        call: the behavior and its parameters.
        tried: how often it was executed.
        rows: how often it moved the attractor, which makes a row.
        mean_movement: mean distance of these movements (in); None without rows.
        mean_dx, mean_dy: mean movement (in, table frame); None without rows.
    """

    call: BehaviorCall
    tried: int
    rows: int
    mean_movement: float | None
    mean_dx: float | None
    mean_dy: float | None


class VerificationResult(NamedTuple):
    """What one stored verification found.

    Args:
        id, run_id: which; the learning run whose table it tested.
        tool, shape: what the robot believed to hold, and what it held.
        sensor: through what it saw.
        verdict: its words; None when it was interrupted.
        live, failed: tries of rows that were not excluded; of these, not replicated.
        decided_after: after how many tries the verdict could be told; None if it could not.
        robot_seconds: how long it took; None when it was interrupted.
        borrowed, borrowed_failed: how many of `live` and of `failed` are of borrowed rows.
    """

    id: int
    run_id: int
    tool: str
    shape: str
    sensor: str
    verdict: str | None
    live: int
    failed: int
    decided_after: int | None
    robot_seconds: float | None
    borrowed: int = 0
    borrowed_failed: int = 0


@dataclass(frozen=True, slots=True)
class LearningInterval:
    """What one learning run did in one interval of robot time.

    Args:
        run_id: the learning run.
        number: of the interval: 0 is the first.
        behaviors: exploratory behaviors that ended in it.
        effects: how many of these moved the attractor, which made as many rows.
    """

    run_id: int
    number: int
    behaviors: int
    effects: int


@dataclass(frozen=True, slots=True)
class SuccessCount:
    """Successes of one robot with one tool and one goal, over the starts.

    Args:
        robot, protocol, tool, shape, task_set, goal: which trials.
        planner: how the robot chose its rows, as `core.identity.Component` writes it.
        trials: how many ended; invalid ones are left out.
        solved: how many of them were solved.
    """

    robot: int
    protocol: Protocol
    tool: str
    shape: str
    task_set: str
    goal: str
    planner: str
    trials: int
    solved: int


@dataclass(frozen=True, slots=True)
class StepSums:
    """What the trials of one group made of a step number.

    Args:
        number: which step: 1, 2, 3, ...
        trials: how many took it.
        lost: how many of them tried a row that was truly lost.
        change: by how much the mean replication probability of the rows on one side changed in it,
            summed over the trials.
    """

    number: int
    trials: int
    lost: int
    change: float


@dataclass(frozen=True, slots=True)
class TrialGroup:
    """Trials that are summed: all of one robot, or a single one.

    Args:
        key: the robot, or the id of the trial.
        trials: how many ended; invalid ones are left out.
        with_rows: how many of them started from a table that has rows on the side.
        steps: sums of each step number that some of them took, in order.
    """

    key: int
    trials: int
    with_rows: int
    steps: tuple[StepSums, ...]


class InvalidTrials(NamedTuple):
    """Trials of a session that count for nothing (see `Outcome`): how many, and why the first."""

    trials: int = 0
    why: str = ""


class Cell(NamedTuple):
    """Which trials are counted together; empty where it makes no difference."""

    protocol: str
    task_set: str
    tool: str = ""
    shape: str = ""
    goal: str = ""
    start: str = ""


@dataclass(frozen=True, slots=True)
class ConditionCounts:
    """What the robots of one condition solved.

    Args:
        name: of the condition.
        session: in which its trials are. Its robots are those of another condition number by
            number, if the two share their seed.
        cells: for each cell by robot how many trials ended, and how many of them were solved;
            invalid ones are left out.
        failed: the numbers of the robots that could not live, which tried nothing.
        beside: what its experiment says of it that is not in its session: how long its robots
            learn, what they invent or borrow before; empty for the usual.
    """

    name: str
    session: SessionInfo
    cells: Mapping[Cell, Mapping[int, tuple[int, int]]]
    failed: tuple[int, ...] = ()
    beside: str = ""

    @property
    def robots(self) -> frozenset[int]:
        """The numbers of the robots that tried anything."""
        return frozenset().union(*self.cells.values())
