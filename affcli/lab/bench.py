"""One robot at one table: arm, world, sensor, experimenter and behaviors, wired."""

import hashlib
from dataclasses import dataclass

import numpy as np

from affcli.behaviors.registry import BehaviorRegistry, paper_behaviors
from affcli.config import Settings, require_known
from affcli.core.ports import Sensor
from affcli.core.tool import Tool, ToolName, paper_tools
from affcli.core.trial import Truth
from affcli.lab.sensing import sensor_for
from affcli.simulation.experimenter import SimulatedExperimenter
from affcli.simulation.robot import SimulatedRobot
from affcli.simulation.world import World

LEARNING, TRIAL, VERIFICATION, PREDICTION = 0, 1, 3, 4
"""First word of a random stream's key: what it is for. 2 is a camera's power-up (`lab.sensing`)."""
STREAMS = ("choices", "noise", "hand")
"""The random streams of a bench."""


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
    sensor: Sensor
    experimenter: SimulatedExperimenter
    behaviors: BehaviorRegistry
    streams: dict[str, np.random.Generator]

    @classmethod
    def of(
        cls, settings: Settings, world: World, purpose: int, seed: int, robot: int, *words: int
    ) -> "Bench":
        """Wire a bench around `world`, with random streams that depend on the numbers alone.

        Args:
            settings: of everything.
            world: the true state.
            purpose: `LEARNING`, `TRIAL`, `VERIFICATION` or `PREDICTION`.
            seed, robot: whose bench it is.
            words: what else tells its streams from others'.

        Raises:
            DatabaseError: the settings hold some that this version does not know.
        """
        require_known(settings)
        workspace = settings.workspace
        sequence = np.random.SeedSequence((purpose, seed, robot, *words))
        streams = {
            name: np.random.Generator(np.random.PCG64(child))
            for name, child in zip(STREAMS, sequence.spawn(len(STREAMS)), strict=True)
        }
        behaviors = paper_behaviors(workspace.arm, workspace.motion, workspace.tools)
        return cls(
            settings,
            world,
            SimulatedRobot(world, behaviors.paths),
            sensor_for(settings, lambda: world.scene, streams["noise"], seed, robot),
            SimulatedExperimenter(world, streams["hand"]),
            behaviors,
            streams,
        )

    def truth(self) -> Truth:
        """Return where the attractor truly was before and after the last behavior."""
        return Truth(self.robot.attractor_before, self.world.attractor)


def tool_named(settings: Settings, name: str) -> Tool:
    """Return a tool by name; KeyError when there is none."""
    return paper_tools(settings.workspace.tools)[ToolName(name)]


def missing_side(settings: Settings, tool: str, shape: str) -> float:
    """Return x of the middle of the parts that `shape` lacks, in the tool frame (in); 0 if none."""
    parts = tool_named(settings, tool).parts_missing_in(tool_named(settings, shape))
    middles = [0.5 * (p.outline.bounds[0] + p.outline.bounds[2]) for p in parts]
    return sum(middles) / len(middles) if middles else 0.0


def stable_number(name: str) -> int:
    """Return a number of 32 bits that is the same for a name everywhere and always."""
    return int.from_bytes(hashlib.sha256(name.encode()).digest()[:4], "big")
