"""What learning runs, testing trials and verifications are pure functions of.

A spec carries every part by value or by a versioned name, so that whatever the registry holds
later, a stored run can be shown, gone on with and done again.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from functools import cached_property
from typing import Any, NamedTuple

from affcli.core.behavior import BehaviorCall, Repertoire, repertoire_json
from affcli.core.geometry import Pose
from affcli.core.identity import Component, key_of
from affcli.core.invention import Invention
from affcli.core.log import LOG
from affcli.core.mask import Mask
from affcli.core.observation import SensorKind
from affcli.core.task import Task
from affcli.core.tool import Tool
from affcli.core.transfer import Borrowed, Transfer
from affcli.core.trial import BabblingRecord, TrialEnd, TrialStep, Truth


class Protocol(StrEnum):
    """What a testing trial is part of."""

    EXTENSION_OF_REACH = "extension of reach"
    """§7.1: the tool is what it was when its table was learned."""
    TOOL_ADAPTATION = "tool adaptation"
    """§7.2: another shape in the colour of the tool that was learned."""


BROKEN_TOOL, BROKEN_SHAPE = "t-hook", "l-hook"
"""§7.2: the learning was performed with a T-hook which was then replaced with an L-hook."""


REPRODUCE, EXPERIMENT = "reproduce", "experiment"
LIVES = (REPRODUCE, EXPERIMENT)
"""The kinds of sessions that are whole lives of robots: what they learned, and their trials."""


class Keep(StrEnum):
    """How much of a robot's life is stored. All of it is a function of its spec, and can be made
    again.
    """

    ALL = "all"
    """Behaviors, rows, trials, steps."""
    ROWS = "rows"
    """All but the behaviors of learning."""
    TRIALS = "trials"
    """Of learning runs and trials only what came of them."""


class Counters(StrEnum):
    """Which counters a trial starts from and where its updates go."""

    STORED = "stored"
    """From the table as it is in the store; every step updates it there."""
    AS_LEARNED = "as learned"
    """From the table as learned; the trial keeps its counters in its own steps."""


@dataclass(frozen=True, kw_only=True)
class Parts:
    """What a learning run carries, but for the tool, the seed and the time.

    Args:
        settings: those that differ from the defaults, as canonical JSON (see `affcli.config`).
        world: where it takes place.
        repertoire: the exploratory behaviors, by value.
        binding: how the tool is held; where there are several, how trials begin.
        other_bindings: how else it may be held: babbling draws from all of them (§3.2).
        explorer: how the robot chooses what to try next.
        sensor: through what the robot sees.
    """

    settings: str
    world: Component
    repertoire: Repertoire
    binding: BehaviorCall
    explorer: Component
    sensor: SensorKind
    other_bindings: tuple[BehaviorCall, ...] = ()

    @property
    def bindings(self) -> tuple[BehaviorCall, ...]:
        """All ways in which the tool may be held, the first as trials begin."""
        return (self.binding, *self.other_bindings)

    @property
    def logged(self) -> bool:
        """It was imported from a log: no robot could go on with it, in no world."""
        return self.world.name == LOG

    def carried(self) -> dict[str, Any]:
        """Return the parts by name: to carry them on."""
        return {field.name: getattr(self, field.name) for field in fields(Parts)}

    @cached_property
    def key(self) -> str:
        """The key of the run or session: equal specs have equal keys in every version of affcli."""
        return key_of(self.canonical())

    def canonical(self) -> dict[str, Any]:
        """Return all of it as JSON types; what a key is made of, so it must never change."""
        bindings = [{"name": one.name, "params": dict(one.params)} for one in self.bindings]
        return {
            # Several are a list. One stands alone, as it did before there could be several.
            "binding": bindings if self.other_bindings else bindings[0],
            "explorer": self.explorer.canonical(),
            "repertoire": repertoire_json(self.repertoire),
            "sensor": self.sensor,
            "settings": json.loads(self.settings),
            "world": self.world.canonical(),
        }


TOLD = "told"
"""In the place of an explorer: nothing was explored, the table was computed for a planner that is
no robot's own."""


@dataclass(frozen=True)
class LearningSpec(Parts):
    """What a learning run is a pure function of.

    Args:
        held: the tool, by value.
        seed: 0 to 2^63 - 1.
        robot: which of many robots that share the seed; 0 for the first.
        hours: robot hours to babble for, 0 where it only borrows; None when `behaviors` is given.
        behaviors: how many behaviors to execute; None when `hours` is given.
        transfer: what it borrows from others before, and how; None for nothing.
    """

    held: Tool
    seed: int
    robot: int
    hours: float | None
    behaviors: int | None
    transfer: Transfer | None = None

    @property
    def tool(self) -> str:
        """The name of the tool."""
        return self.held.name

    @property
    def told(self) -> bool:
        """Its table is no robot's: it was computed, in no robot time."""
        return self.explorer.name == TOLD

    def canonical(self) -> dict[str, Any]:
        """Return the spec as JSON types; see `Parts`."""
        return {
            **super().canonical(),
            "behaviors": self.behaviors,
            "hours": self.hours,
            "robot": self.robot,
            "seed": self.seed,
            "tool": self.held.canonical(),
            **({"transfer": self.transfer.canonical()} if self.transfer else {}),
        }


@dataclass(frozen=True, slots=True)
class TrialSpec:
    """What a testing trial is a pure function of, beside the table it starts from.

    Args:
        protocol: what it is part of.
        tool: the tool the robot believes to hold: the one whose table it uses.
        held: the tool it truly holds, by value, in its own colour; another one when it broke.
        task: the goal and the start.
        seed: 0 to 2^63 - 1.
        robot: which of many robots that share the seed.
        counters: which counters it starts from and where updates go.
        planner: how the robot chooses a row.
        sensor: through what the robot sees.
        world: where it takes place.
    """

    protocol: Protocol
    tool: str
    held: Tool
    task: Task
    seed: int
    robot: int
    counters: Counters
    planner: Component
    sensor: SensorKind
    world: Component

    @property
    def shape(self) -> str:
        """The name of the tool truly held."""
        return self.held.name

    @property
    def task_set(self) -> str:
        """The name of the set of tasks."""
        return self.task.task_set

    @property
    def goal(self) -> str:
        """The name of the goal."""
        return self.task.goal.name

    @property
    def start(self) -> str:
        """The name of the start."""
        return self.task.start_name


@dataclass(frozen=True, slots=True)
class VerificationSpec:
    """What a verification is a pure function of, beside the table it starts from.

    Args:
        tool: the tool the robot believes to hold: the one whose table is tested.
        held: the tool it truly holds, by value; another one when the tool changed.
        seed: 0 to 2^63 - 1.
        robot: which of many robots that share the seed.
        sensor: through what the robot sees.
        tries: how many are made, at most.
        until_verdict: it ends with the first verdict.
    """

    tool: str
    held: Tool
    seed: int
    robot: int
    sensor: SensorKind
    tries: int
    until_verdict: bool

    @property
    def shape(self) -> str:
        """The name of the tool truly held."""
        return self.held.name


@dataclass(frozen=True)
class SessionSpec(Parts):
    """What a session of testing trials is a function of, beside the tables it starts from; a
    reproduction, which learns its own tables, is a function of nothing else. Of what a
    condition of an experiment is a function beside, its experiment says.

    Args:
        kind: which command: ``solve``, ``break-tool``, or one of `LIVES`.
        seed: of all it does.
        robots: how many; 1 unless it is one of `LIVES`.
        planner: how the robots choose rows.
        task_set: the tasks, by the name of their set.
    """

    kind: str
    seed: int
    robots: int
    planner: Component
    task_set: str

    def canonical(self) -> dict[str, Any]:
        """Return the spec as JSON types; see `Parts`."""
        return {
            **super().canonical(),
            "kind": self.kind,
            "planner": self.planner.canonical(),
            "robots": self.robots,
            "seed": self.seed,
            "task_set": self.task_set,
        }


LearningStep = tuple[BabblingRecord, Truth | None]
"""What one behavior of a learning run gave, and what truly happened where the world can tell."""

RowStarts = dict[int, tuple[Pose, Pose]]
"""Where wrist and attractor truly were when each row of a table was made, by its learning step."""


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


class Tested(NamedTuple):
    """A trial in the life of a robot.

    Args:
        condition: the condition it is part of, by its place in the experiment.
        run: the learning run whose table it started from, by its place in the life.
        trial: the trial.
    """

    condition: int
    run: int
    trial: TrialRecord


class Invented(NamedTuple):
    """What a robot invented in one of its learning runs, for others of its runs.

    Args:
        condition: the first condition that uses it, by its place in the experiment.
        run: the learning run, by its place in the life.
        inventions: what it tried again, kept or not.
    """

    condition: int
    run: int
    inventions: tuple[Invention, ...]


@dataclass(frozen=True, slots=True)
class RobotRecord:
    """The life of one robot of an experiment: what it learned, and its testing trials.

    Args:
        robot: its number.
        learned: the spec, the steps and the robot seconds of each learning run.
        tested: all its testing trials; several conditions may have used one learning run.
        calibrations: of its camera in each learning run, as JSON; None without one.
        invented: what it invented.
        borrowed: what learning runs borrowed, by their places in the life.
        lent: the first condition for which each lender learned, by its place in the life.
        masks: what its camera saw of the tools, of runs that lent or borrowed, likewise.
    """

    robot: int
    learned: tuple[tuple[LearningSpec, tuple[LearningStep, ...], float], ...]
    tested: tuple[Tested, ...]
    calibrations: tuple[str | None, ...]
    invented: tuple[Invented, ...] = ()
    borrowed: Mapping[int, tuple[Borrowed, ...]] = field(default_factory=dict)
    lent: Mapping[int, int] = field(default_factory=dict)
    masks: Mapping[int, Mask] = field(default_factory=dict)

    @property
    def trials(self) -> tuple[TrialRecord, ...]:
        """All its testing trials, of whatever condition."""
        return tuple(one.trial for one in self.tested)
