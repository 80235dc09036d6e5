"""Counts and sums over stored records: what reports are made from."""

from dataclasses import dataclass

from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.core.specs import Protocol
from affcli.core.trial import Outcome


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
class TrialResult:
    """How one testing trial ended.

    Args:
        id: its number in the store.
        session_kind, session_id: the command it is part of.
        run_id: the learning run whose table it used.
        robot, protocol, tool, shape, task_set, goal, start: which trial; the last five are names.
        planner: how the robot chose its rows, as `core.identity.Component` writes it.
        sensor: through what the robot saw.
        outcome: how it ended.
        steps: how many steps it took.
        robot_seconds: how long it took.
    """

    id: int
    session_kind: str
    session_id: int
    run_id: int
    robot: int
    protocol: Protocol
    tool: str
    shape: str
    task_set: str
    goal: str
    start: str
    planner: str
    sensor: str
    outcome: Outcome
    steps: int
    robot_seconds: float


@dataclass(frozen=True, slots=True)
class SuccessCount:
    """Successes of one robot with one tool and one goal, over the starts.

    Args:
        session_id: the command they are part of.
        robot, protocol, tool, shape, task_set, goal, planner: which trials, as in `TrialResult`.
        trials: how many ended; invalid ones are left out.
        solved: how many of them were solved.
    """

    session_id: int
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
class OutcomeCount:
    """How many trials of a protocol ended in one way."""

    protocol: Protocol
    outcome: Outcome
    trials: int


@dataclass(frozen=True, slots=True)
class RowUse:
    """What the trials of a session made of one affordance, over all of them.

    Args:
        affordance_id: the row.
        robot: whose row it is.
        step: of the learning run that made it.
        exploratory: its behavior.
        offset: where the attractor was as seen from the wrist when it was made (in).
        lost: whether it was truly lost when the tool broke; None for a whole tool.
        trials: in how many trials it was tried.
        tries, successes: how often it was tried, and replicated.
        deaths: in how many trials it died.
    """

    affordance_id: int
    robot: int
    step: int
    exploratory: BehaviorCall
    offset: Point
    lost: bool | None
    trials: int
    tries: int
    successes: int
    deaths: int


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
