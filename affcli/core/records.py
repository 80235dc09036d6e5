"""Records as they are kept: sessions, learning runs, trials, rows, and what was done with a row."""

from dataclasses import dataclass
from typing import Any, NamedTuple

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.choice import Reasons
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Movement
from affcli.core.setting import Value
from affcli.core.specs import Keep, LearningSpec, SessionSpec, TrialSpec
from affcli.core.task import GoalRegion
from affcli.core.tool import Tool
from affcli.core.trial import Outcome


@dataclass(frozen=True, slots=True)
class SessionInfo:
    """One command that produced trials or a reproduction.

    Args:
        id: its number in the store.
        spec: what it is a function of.
        versions: what it was made with.
        status: ``running`` or ``done``.
        experiment_id, condition: of which experiment it is which condition; None when of none.
    """

    id: int
    spec: SessionSpec
    versions: dict[str, str]
    status: str
    experiment_id: int | None = None
    condition: str | None = None


@dataclass(frozen=True, slots=True)
class FailedRobot:
    """A robot of an experiment or of a reproduction that could not live.

    Args:
        robot: its number.
        kind: of the error, by its class.
        message: of the error, in one line.
        tries: how often it was tried, or its worker lost.
        traceback: where it was raised; None for what a user can put right.
    """

    robot: int
    kind: str
    message: str
    tries: int
    traceback: str | None = None


@dataclass(frozen=True, slots=True)
class ExperimentInfo:
    """An experiment.

    Args:
        id: its number in the store.
        name: there is one of a name.
        question: what it asks.
        definition: as JSON types: what `affcli.lab.definition` reads.
        key: of all that its robots' lives are functions of.
        versions: what it was begun with.
        status: ``done`` when all its robots are saved or failed, else ``running``.
        conditions: the name and the session of each, in order.
    """

    id: int
    name: str
    question: str
    definition: dict[str, Any]
    key: str
    versions: dict[str, str]
    status: str
    conditions: tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class LearningRunInfo:
    """A learning run, but for its behaviors and rows.

    Args:
        id: its number in the store.
        session_id: the session it is part of, of an experiment's first that used it; None when it
            stands for itself.
        spec: what it is a function of.
        versions: what it was made with.
        status: ``running`` or ``done``.
        behaviors: exploratory behaviors executed.
        rows: rows of its affordance table.
        resets: how often the attractor was put back.
        redraws: wrist positions drawn again because the attractor was in the way.
        robot_seconds: the robot clock; NaN for a log without times.
        checkpoint: what it needs to go on; None at the beginning and when done.
        kept: how much of it is stored.
        started_at: when it was begun, ISO text, UTC.
        note: what a person wrote of it; no part of what it is a function of.
    """

    id: int
    session_id: int | None
    spec: LearningSpec
    versions: dict[str, str]
    status: str
    behaviors: int
    rows: int
    resets: int
    redraws: int
    robot_seconds: float
    checkpoint: dict[str, Any] | None
    started_at: str
    note: str | None = None
    kept: Keep = Keep.ALL

    @property
    def only_borrowed(self) -> bool:
        """All its rows are other runs', and it will try none: it had no time."""
        return self.status == "done" and not self.behaviors and self.spec.transfer is not None


class Belongings(NamedTuple):
    """How many records belong to a learning run: they would be deleted with it.

    Args:
        behaviors, rows: what it did and learned.
        trials, steps: those that used its table.
        verifications, tries: those of its table.
    """

    behaviors: int
    rows: int
    trials: int
    steps: int
    verifications: int
    tries: int


class ChangedPart(NamedTuple):
    """A setting, or the version of the world, in which two learning runs differ.

    Args:
        name: of the setting, as ``sensor.position_noise``; ``world``.
        stored: what the stored run has; None for the default number 1 of a setting.
        wanted: what the other has; None likewise.
    """

    name: str
    stored: Value | None
    wanted: Value | None


@dataclass(frozen=True, slots=True)
class AlikeRun:
    """A stored learning run that differs from a spec in settings or the world's version alone.

    Args:
        run: the stored run.
        changed: what differs, by name.
    """

    run: LearningRunInfo
    changed: tuple[ChangedPart, ...]


@dataclass(frozen=True, slots=True)
class TrialInfo:
    """A testing trial, but for its steps.

    Args:
        id: its number in the store.
        session_id: the command it is part of.
        run_id: the learning run whose table it used.
        spec: what it is a function of, beside that table.
        learned: what the learning run is a function of.
        versions: what it was made with.
        outcome: how it ended; None while running or when interrupted.
        steps: how many steps were taken; None as `outcome`.
        robot_seconds: how long it took; None as `outcome`.
        last_reasons: as in `TrialEnd`.
    """

    id: int
    session_id: int
    run_id: int
    spec: TrialSpec
    learned: LearningSpec
    versions: dict[str, str]
    outcome: Outcome | None
    steps: int | None
    robot_seconds: float | None
    last_reasons: Reasons | None


@dataclass(frozen=True, slots=True)
class StoredRow:
    """A row of an affordance table, with its counters as they are now.

    Args:
        id: its number in the store.
        run_id: the learning run that made it.
        tool: the name of the tool held then.
        row: what was learned.
    """

    id: int
    run_id: int
    tool: str
    row: Affordance


@dataclass(frozen=True, slots=True)
class StoredStep:
    """One step of a trial with the row it tried.

    Args:
        trial_id, number: which step.
        clock: robot seconds when it ended.
        reasons: what the planner went by.
        affordance_id: the row tried, in the store.
        row: the row tried, with its counters before the step.
        regrasped: the tool was grasped anew first, as the row's binding asks.
        placing_status: of the position wrist.
        status: of the exploratory behavior; None when lowering the tool was blocked.
        wrist_start, wrist_end: before and after the exploratory behavior; when the tool could not
            be lowered, before and after it was carried there (in, rad, table frame).
        seen_start, seen_end: where the attractor was seen (in, table frame).
        true_start, true_end: where it truly was; None in a world that cannot tell.
        expected, seen: movements (in, table frame); dz is not kept.
        seen_distance: of the movement seen, dz included (in).
        replicated: whether it counts as a success of the row.
        died: the step took the row out of further consideration.
        lost: whether the row was truly lost when the tool broke; None for a whole tool.
        times_used_after, times_successful_after: the row's counters after the step.
    """

    trial_id: int
    number: int
    clock: float
    reasons: Reasons
    affordance_id: int
    row: Affordance
    regrasped: bool
    placing_status: str
    status: str | None
    wrist_start: Pose
    wrist_end: Pose
    seen_start: Point
    seen_end: Point
    true_start: Point | None
    true_end: Point | None
    expected: Movement
    seen: Movement
    seen_distance: float
    replicated: bool
    died: bool
    lost: bool | None
    times_used_after: int
    times_successful_after: int

    @property
    def blocked(self) -> bool:
        """The tool could not be lowered."""
        return self.status is None

    @property
    def moved(self) -> bool:
        """The movement seen is one that the change detection function T detects."""
        return self.seen_distance > MOVEMENT_THRESHOLD

    @property
    def attractor_start(self) -> Point:
        """Where the attractor truly was; where it was seen in a world that cannot tell."""
        return self.true_start or self.seen_start

    @property
    def attractor_end(self) -> Point:
        """As `attractor_start`, after the step."""
        return self.true_end or self.seen_end


class StoredReplication(NamedTuple):
    """What one try of a verification made of a row.

    Args:
        verification, number: which try.
        shape: the name of the tool that the robot truly held.
        expected, seen: movements (in, table frame).
        replicated: whether it counts as a success.
        blocked: the tool could not be lowered.
        died: it took the row out of further consideration.
        before, after: successes and uses around it.
    """

    verification: int
    number: int
    shape: str
    expected: Movement
    seen: Movement
    replicated: bool
    blocked: bool
    died: bool
    before: tuple[int, int]
    after: tuple[int, int]


@dataclass(frozen=True, slots=True)
class StepScene:
    """One step of a trial, or one behavior of a learning run, as it truly was.

    Args:
        title: which, in words.
        key: which, in numbers.
        learned: what the learning run is a function of.
        tool: the name of the tool that the robot believed to hold.
        held: the tool it held, in its own colour.
        goal: of the trial; None while learning.
        seed, robot: whose.
        wrist_before: where the wrist was when it began; None for the first.
        wrist_start, wrist_end: before and after the exploratory behavior; when the tool could not
            be lowered, before and after it was carried there (in, rad, table frame).
        attractor_start, attractor_end: where the attractor truly was (in, table frame).
        binding: how the tool was held.
        call: the exploratory behavior.
        blocked: the tool could not be lowered, so it was not executed.
    """

    title: str
    key: tuple[int, ...]
    learned: LearningSpec
    tool: str
    held: Tool
    goal: GoalRegion | None
    seed: int
    robot: int
    wrist_before: Pose | None
    wrist_start: Pose
    wrist_end: Pose
    attractor_start: Point
    attractor_end: Point
    binding: BehaviorCall
    call: BehaviorCall
    blocked: bool
