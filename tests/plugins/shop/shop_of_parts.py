"""A package that somebody else wrote: a part of each kind."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from affcli.core.behavior import BehaviorCall, BehaviorName, ExploratoryBehavior
from affcli.core.choice import Candidate, Choice, Reason, Situation
from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.motion import Slide
from affcli.core.part import Part
from affcli.core.scene import Scene
from affcli.core.setting import Setting
from affcli.core.task import GoalRegion, Task
from affcli.core.tool import Color, Tool, ToolName, ToolPart
from affcli.core.workspace import ToolGeometry, Workspace
from affcli.exploration.random_babbling import RandomBabbling
from affcli.perception.noisy_sensor import NoisySensor, SensorSettings
from affcli.planning.nested_query import NestedQuery
from affcli.simulation.table_world import TableWorld

SOURCE = "the shop of parts"


@dataclass(frozen=True, slots=True)
class Nearest:
    """Uses the row that should leave the attractor nearest to the goal."""

    angle_degrees: float = 40.0
    threshold: float = 0.5

    def choose(self, situation: Situation) -> Choice:
        """Return the first of the candidates."""
        found = self.candidates(situation)
        return Choice(found[0].position if found else None, (Reason("usable", len(found)),))

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return all rows that can be used, by where they should leave the attractor."""
        usable = NestedQuery(1.0, self.threshold, self.angle_degrees).candidates(situation)
        return tuple(sorted(usable, key=lambda row: row.expected_distance))


def hoe(geometry: ToolGeometry) -> Tool:
    """Return a handle with a blade across its end."""
    handle = ConvexPolygon.box(-0.4, -geometry.handle_below_grasp, 0.4, 12.0)
    blade = ConvexPolygon.box(-3.0, 12.0, 3.0, 12.8)
    parts = (ToolPart("handle", handle), ToolPart("blade", blade))
    return Tool(ToolName("hoe"), Color((150.0, 210.0, 40.0)), parts)


def shove(far: float) -> tuple[ExploratoryBehavior, ...]:
    """Return one behavior: forward, and back again."""
    call = BehaviorCall.of(BehaviorName("shove"), {"far": far})
    return (ExploratoryBehavior(call, (Slide(0.0, far), Slide(0.0, -far))),)


def low(geometry: ToolGeometry) -> BehaviorCall:
    """Return a grasp at the lower end of the handle."""
    del geometry
    return BehaviorCall.of(BehaviorName("grasp"), {"grasp_point": 0.5})


def blurry(
    look: Callable[[], Scene],
    rng: np.random.Generator,
    workspace: Workspace,
    tool: Tool,
    *,
    noise: float,
) -> NoisySensor:
    """Return a sensor that sees as ours does, only worse."""
    del workspace, tool
    return NoisySensor(look, SensorSettings(position_noise=noise), rng)


def corner(workspace: Workspace) -> tuple[Task, ...]:
    """Return one task: from the middle to a corner."""
    far = workspace.table.far - 6.0
    return (Task("corner", GoalRegion("far", Point(-8.0, far), 2.0), "middle", Point(0.0, 20.0)),)


class Yard(TableWorld):
    """The table again, under another name."""

    name = "yard"
    version = 1


def yard(settings: Any, task_sets: Mapping[str, Any]) -> Yard:
    """Return the yard."""
    return Yard(settings, task_sets)


NOISE = {"noise": Setting(0.05, "in", "Of each position.", 0.0, 1.0)}
FAR = {"far": Setting(3.0, "in", "How far it goes.", 0.5, 10.0)}
NEAREST = Part("planners", "nearest", "nearest to the goal", SOURCE, Nearest)
RAMBLING = Part("explorers", "rambling", "at random, in a shop", SOURCE, RandomBabbling)
HOE = Part("tools", "hoe", "a hoe: handle, blade", SOURCE, hoe)
SHOVE = Part("behaviors", "shove", "forward and back", SOURCE, shove, FAR, version=2)
LOW = Part("bindings", "low", "by the end of the handle", SOURCE, low)
BLURRY = Part("sensors", "blurry", "sees badly", SOURCE, blurry, NOISE)
CORNER = Part("tasks", "corner", "into a corner", SOURCE, corner)
YARD = Part("worlds", "yard", "the table again", SOURCE, yard)
