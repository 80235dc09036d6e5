"""What is recorded of learning and of testing trials."""

from dataclasses import dataclass, fields
from enum import StrEnum
from typing import Any, NamedTuple

from affcli.core.affordance import Affordance
from affcli.core.behavior import Execution
from affcli.core.geometry import Pose
from affcli.core.observation import Movement, Observation, SensorKind

LARGEST_SEED = 2**63 - 1
LONGEST_HOURS = 10_000.0
MOST_BEHAVIORS = 10_000_000
MOST_ROBOTS = 100_000


class Truth(NamedTuple):
    """Where the attractor truly was before and after a behavior; never for the robot."""

    start: Pose
    end: Pose


class Protocol(StrEnum):
    """What a testing trial is part of."""

    EXTENSION_OF_REACH = "extension of reach"
    """§7.1: the tool is what it was when its table was learned."""
    TOOL_ADAPTATION = "tool adaptation"
    """§7.2: another shape in the colour of the tool that was learned."""


BROKEN_TOOL, BROKEN_SHAPE = "t-hook", "l-hook"
"""§7.2: the learning was performed with a T-hook which was then replaced with an L-hook."""


class Counters(StrEnum):
    """Which counters a trial starts from and where its updates go."""

    STORED = "stored"
    """From the table as it is in the store; every step updates it there."""
    AS_LEARNED = "as learned"
    """From the table as learned; the trial keeps its counters in its own steps."""


@dataclass(frozen=True, slots=True)
class LearningSpec:
    """What a learning run is a pure function of.

    Args:
        tool: name of the tool.
        seed: 0 to 2^63 - 1.
        robot: which of many robots that share the seed; 0 for the first.
        hours: robot hours to babble for; None when `behaviors` is given.
        behaviors: how many behaviors to execute; None when `hours` is given.
        settings: all settings as canonical JSON.
    """

    tool: str
    seed: int
    robot: int
    hours: float | None
    behaviors: int | None
    settings: str


@dataclass(frozen=True, slots=True)
class TrialSpec:
    """What a testing trial is a pure function of, beside the table it starts from.

    Args:
        protocol: what it is part of.
        tool: the tool the robot believes to hold: the one whose table it uses.
        shape: the shape it truly holds; another one when the tool broke.
        goal: 1 to 4.
        start: 1 to 4.
        seed: 0 to 2^63 - 1.
        robot: which of many robots that share the seed.
        counters: which counters it starts from and where updates go.
        sensor: through what the robot sees.
    """

    protocol: Protocol
    tool: str
    shape: str
    goal: int
    start: int
    seed: int
    robot: int
    counters: Counters
    sensor: SensorKind = "noisy"


@dataclass(frozen=True, slots=True)
class BabblingRecord:
    """One executed exploratory behavior of a learning run, with or without effect.

    Args:
        step: 1, 2, 3, ... within the run.
        clock: robot seconds when the step ended.
        resets: how often the attractor was put back by hand before this behavior.
        redraws: wrist positions drawn again because the tool would have come down on the attractor.
        placing: the position wrist that went before.
        execution: the exploratory behavior.
        start: observation before the exploratory behavior (O^s).
        end: observation after it (O^e).
        affordance: the row it made, None when T = 0.
    """

    step: int
    clock: float
    resets: int
    redraws: int
    placing: Execution
    execution: Execution
    start: Observation
    end: Observation
    affordance: Affordance | None


class Survivors(NamedTuple):
    """How many rows each nested search of §6.2 left."""

    consistent: int
    """Search 1: colours fit the current tool and object."""
    probable: int
    """Search 2: replication probability greater than 1/2."""
    reachable: int
    """The wrist position the row asks for is in the arm's reach (not in the paper's list)."""
    nearest: int
    """Search 3 and the cut of search 4: the top 20 % by expected distance to the goal."""


class Outcome(StrEnum):
    """How a testing trial ended."""

    SOLVED = "solved"
    NO_ROW = "no row left"
    ATTRACTOR_OUT_OF_REACH = "attractor out of reach"
    STEP_LIMIT = "step limit"
    INVALID = "invalid"
    """The simulation diverged; the trial counts for nothing."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """One use of a row: it was tried and judged.

    Args:
        row: the affordance tried, with its counters before.
        placing: the position wrist that went before.
        execution: the exploratory behavior; None when lowering the tool was blocked.
        start: observation before the exploratory behavior (before the placing when blocked).
        end: observation after it.
        expected: the movement the row predicts.
        seen: the movement observed.
        replicated: whether `seen` counts as a success of the row.
    """

    row: Affordance
    placing: Execution
    execution: Execution | None
    start: Observation
    end: Observation
    expected: Movement
    seen: Movement
    replicated: bool

    def by_name(self) -> dict[str, Any]:
        """Return the fields of an attempt by name: what a record of it is made from."""
        return {field.name: getattr(self, field.name) for field in fields(Attempt)}

    @property
    def live(self) -> bool:
        """The row's probability was greater than 1/2 before: a robot with a task would use it."""
        return 2 * self.row.times_successful > self.row.times_used

    @property
    def times_used_after(self) -> int:
        """The row's counter of uses after this one."""
        return self.row.times_used + 1

    @property
    def times_successful_after(self) -> int:
        """The row's counter of successes after this use."""
        return self.row.times_successful + int(self.replicated)

    @property
    def died(self) -> bool:
        """This use took the row's probability to 1/2 or below, out of further consideration."""
        return 2 * self.times_successful_after <= self.times_used_after


@dataclass(frozen=True, slots=True)
class StepRecord(Attempt):
    """One step of a testing trial: a row was chosen, tried and judged.

    Args:
        number: 1, 2, 3, ... within the trial.
        clock: robot seconds when the step ended.
        survivors: rows left by each search.
    """

    number: int
    clock: float
    survivors: Survivors


@dataclass(frozen=True, slots=True)
class TrialEnd:
    """The end of a testing trial.

    Args:
        outcome: how it ended.
        steps: how many steps were taken.
        clock: robot seconds it took.
        last_survivors: rows left by each search at the query that found none, else None.
    """

    outcome: Outcome
    steps: int
    clock: float
    last_survivors: Survivors | None = None


class TrialStep(NamedTuple):
    """A step with what the robot cannot see.

    Args:
        record: what the robot did and saw.
        truth: where the attractor truly was.
        lost: whether the row tried was truly lost when the tool broke; None for a whole tool.
    """

    record: StepRecord
    truth: Truth
    lost: bool | None


@dataclass(frozen=True, slots=True)
class TrialRecord:
    """A whole testing trial.

    Args:
        spec: what it was a function of.
        steps: what was done.
        end: how it ended.
        calibration: of the camera it saw through, as JSON; None without one.
    """

    spec: TrialSpec
    steps: tuple[TrialStep, ...]
    end: TrialEnd
    calibration: str | None = None


@dataclass(frozen=True, slots=True)
class RobotRecord:
    """The life of one robot of a reproduction: what it learned, and its testing trials.

    Args:
        robot: its number.
        learned: for each tool the spec, the steps and the robot seconds of its learning run.
        trials: all its testing trials.
        calibration: of its camera, as JSON; None without one.
    """

    robot: int
    learned: tuple[tuple[LearningSpec, tuple[tuple[BabblingRecord, Truth], ...], float], ...]
    trials: tuple[TrialRecord, ...]
    calibration: str | None = None
