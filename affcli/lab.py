"""The composition root: the one place that wires arm, world, sensor, behaviors and procedures."""

import hashlib
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from affcli.behaviors.registry import BehaviorRegistry, paper_behaviors
from affcli.config import Settings, settings_from_json
from affcli.core.affordance_table import AffordanceTable
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.task import goal_regions, start_positions
from affcli.core.tool import Tool, ToolName, paper_tools
from affcli.core.trial import (
    BabblingRecord,
    LearningSpec,
    StepRecord,
    TrialEnd,
    TrialSpec,
    Truth,
)
from affcli.perception.noisy_sensor import NoisySensor
from affcli.procedures.babbling import BabblingState, babble
from affcli.procedures.extension_of_reach import extension_of_reach
from affcli.simulation.experimenter import SimulatedExperimenter
from affcli.simulation.robot import SimulatedRobot
from affcli.simulation.world import World

LEARNING, TRIAL = 0, 1
"""First word of a random stream's key: what it is for."""


@dataclass(frozen=True, slots=True)
class Bench:
    """One robot at one table, wired.

    Args:
        settings: what everything was made from.
        world: the true state.
        robot, sensor, experimenter: what the procedures meet.
        behaviors: what the robot can do.
        streams: the random streams by name: choices, noise, hand.
    """

    settings: Settings
    world: World
    robot: SimulatedRobot
    sensor: NoisySensor
    experimenter: SimulatedExperimenter
    behaviors: BehaviorRegistry
    streams: dict[str, np.random.Generator]

    @classmethod
    def of(cls, settings: Settings, world: World, *key: int) -> "Bench":
        """Wire a bench around `world`, with random streams that depend on `key` alone."""
        workspace = settings.workspace
        sequence = np.random.SeedSequence(key)
        names = ("choices", "noise", "hand")
        streams = {
            name: np.random.Generator(np.random.PCG64(child))
            for name, child in zip(names, sequence.spawn(len(names)), strict=True)
        }
        behaviors = paper_behaviors(workspace.arm, workspace.motion, workspace.tools)
        return cls(
            settings,
            world,
            SimulatedRobot(world, behaviors.paths),
            NoisySensor(lambda: world.scene, settings.sensor, streams["noise"]),
            SimulatedExperimenter(world, streams["hand"]),
            behaviors,
            streams,
        )

    def truth(self) -> Truth:
        """Return where the attractor truly was before and after the last behavior."""
        return Truth(self.robot.attractor_before, self.world.attractor)


class LearningRun:
    """One robot babbling with one tool; it can be stopped after any behavior and gone on with.

    Args:
        spec: what the run is a function of.
        checkpoint: what `checkpoint` gave when the run was stopped; None to begin.
    """

    def __init__(self, spec: LearningSpec, checkpoint: dict[str, Any] | None = None) -> None:
        settings = settings_from_json(spec.settings)
        world = World(settings.workspace, settings.physics)
        key = (LEARNING, spec.seed, spec.robot, stable_number(spec.tool))
        self.spec = spec
        self.bench = Bench.of(settings, world, *key)
        self._state = BabblingState()
        tool = tool_named(settings, spec.tool)
        if checkpoint is None:
            self.bench.experimenter.lay_out_learning(tool)
        else:
            world.tool = tool
            self._restore(checkpoint)

    def steps(self) -> Iterator[tuple[BabblingRecord, Truth]]:
        """Yield what each behavior gave, until the time or the number of behaviors is up.

        The behavior during which the time runs out is the last.
        """
        bench, spec = self.bench, self.spec
        records = babble(
            bench.robot,
            bench.sensor,
            bench.experimenter,
            bench.behaviors.binding,
            bench.behaviors.exploratory,
            bench.settings.babbling,
            bench.streams["choices"],
            self._state,
        )
        while not self.done:
            yield next(records), bench.truth()

    @property
    def done(self) -> bool:
        """Whether the time or the number of behaviors is up."""
        if self.spec.behaviors is not None:
            return self._state.step >= self.spec.behaviors
        assert self.spec.hours is not None
        return self.bench.robot.clock >= 3600.0 * self.spec.hours

    def checkpoint(self) -> dict[str, Any]:
        """Return, as JSON types, all that a later `LearningRun` needs to go on from here."""
        world = self.bench.world
        return {
            "step": self._state.step,
            "grasped": self._state.grasped,
            "seen": self._state.seen,
            "clock": self.bench.robot.clock,
            "wrist": world.wrist,
            "attractor": world.attractor,
            "streams": {n: s.bit_generator.state for n, s in self.bench.streams.items()},
        }

    def _restore(self, checkpoint: dict[str, Any]) -> None:
        """Put everything where the checkpoint says."""
        seen = checkpoint["seen"]
        self._state.step = checkpoint["step"]
        self._state.grasped = checkpoint["grasped"]
        self._state.seen = None if seen is None else Observation(*seen)
        self.bench.robot.clock = checkpoint["clock"]
        self.bench.world.wrist = Point(*checkpoint["wrist"])
        self.bench.world.attractor = Pose(*checkpoint["attractor"])
        for name, stream in self.bench.streams.items():
            stream.bit_generator.state = checkpoint["streams"][name]


def run_trial(
    spec: TrialSpec, settings: Settings, table: AffordanceTable, world: World
) -> Generator[tuple[StepRecord, Truth], None, TrialEnd]:
    """Run one testing trial; its table's counters change as it goes.

    Args:
        spec: which trial.
        settings: those of the learning run.
        table: what the robot learned of `spec.tool`.
        world: any world of these settings; it is laid out anew. Sharing one saves time.
    """
    layout = settings.workspace.layout
    key = (TRIAL, spec.seed, spec.robot, stable_number(spec.tool), stable_number(spec.shape))
    bench = Bench.of(settings, world, *key, spec.goal, spec.start)
    believed = tool_named(settings, spec.tool)
    held = tool_named(settings, spec.shape).painted(believed.color)
    start = start_positions(layout)[spec.start]
    bench.experimenter.lay_out_trial(held, start, goal_regions(layout)[spec.goal])
    steps = extension_of_reach(
        bench.robot,
        bench.sensor,
        bench.experimenter,
        table,
        bench.behaviors.binding,
        settings.trial,
    )
    while True:
        try:
            record = next(steps)
        except StopIteration as end:
            return end.value  # type: ignore[no-any-return]
        yield record, bench.truth()


def tool_named(settings: Settings, name: str) -> Tool:
    """Return a tool by name; KeyError when there is none."""
    return paper_tools(settings.workspace.tools)[ToolName(name)]


def stable_number(name: str) -> int:
    """Return a number of 32 bits that is the same for a name everywhere and always."""
    return int.from_bytes(hashlib.sha256(name.encode()).digest()[:4], "big")
