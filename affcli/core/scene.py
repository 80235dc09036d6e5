"""What is truly on the table: for simulation, sensor and experimenter, never for the robot."""

from dataclasses import dataclass

from affcli.core.geometry import Pose
from affcli.core.task import GoalRegion
from affcli.core.tool import Color, Tool


@dataclass(frozen=True, slots=True)
class Scene:
    """The true state of the table at one moment.

    Args:
        attractor: pose of the puck's centre (in, rad, table frame).
        attractor_color: its colour.
        wrist: the wrist (in, rad, table frame).
        tool: the tool held, by its true shape, in the hand frame.
        goal: the goal region on the table; None while learning.
        lift: how high over the table the tool is held (in); 0 while it slides.
    """

    attractor: Pose
    attractor_color: Color
    wrist: Pose
    tool: Tool
    goal: GoalRegion | None
    lift: float = 0.0
