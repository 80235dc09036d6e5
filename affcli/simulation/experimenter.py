"""The person of §6: sees the whole table, lays out trials, and puts the attractor back."""

import math

import numpy as np

from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point, Pose
from affcli.core.task import GoalRegion
from affcli.core.tool import Tool
from affcli.errors import BadInputError
from affcli.simulation.arm import reach_at
from affcli.simulation.reach_of_tool import touchable
from affcli.simulation.world import World
from affcli.simulation.wrist_motion import on_grid

PLACEMENTS = 10_000
"""Random places tried before the geometry is called impossible."""


class SimulatedExperimenter:
    """Serves the robot in the simulated world, behind the `Experimenter` protocol.

    Args:
        world: what it sees and sets.
        rng: where it puts things.
    """

    def __init__(self, world: World, rng: np.random.Generator) -> None:
        self._world = world
        self._rng = rng
        arm = world.workspace.arm
        self._reach = reach_at(arm, arm.flange_height)

    def lay_out_learning(self, tool: Tool) -> None:
        """Begin a learning run: tool and attractor at random positions, no goal (§6)."""
        world = self._world
        world.tool = tool
        world.goal = None
        world.wrist = self._random_wrist()
        self.put_attractor_back()

    def lay_out_trial(self, tool: Tool, start: Point, goal: GoalRegion) -> None:
        """Begin a testing trial: tool at the table's centre, attractor at a start (§7.1)."""
        world = self._world
        world.tool = tool
        world.goal = goal
        world.wrist = world.home
        world.attractor = Pose(start.x, start.y)

    def attractor_out_of_reach(self) -> bool:
        """Tell whether no behavior from any wrist position can touch the attractor.

        A touch counts when it can move the attractor by more than T detects: a tool that can only
        graze it shows the robot nothing. Nothing reaches an attractor pushed over the table's edge.
        """
        world = self._world
        point, table = world.attractor.point, world.workspace.table
        on_table = abs(point.x) <= table.half_width and table.near <= point.y <= table.far
        depth = world.workspace.puck.radius - MOVEMENT_THRESHOLD
        return not (on_table and touchable(world.tool.outlines, self._reach, point, depth))

    def put_attractor_back(self) -> None:
        """Put the attractor at a random place of the table within the tool's reach and off it.

        Raises:
            BadInputError: no such place was found; the geometry leaves no room.
        """
        table, world = self._world.workspace.table, self._world
        for _ in range(PLACEMENTS):
            u, v = self._rng.random(2).tolist()
            x = (2.0 * u - 1.0) * table.half_width
            y = table.near + v * (table.far - table.near)
            world.attractor = Pose(x, y)
            if world.clear_of_attractor(world.wrist) and not self.attractor_out_of_reach():
                return
        raise BadInputError(
            f"table: no place within reach of the {world.tool.name} in {PLACEMENTS} tries; bring "
            "table.near, table.far and table.half_width closer to the arm"
        )

    def _random_wrist(self) -> Point:
        """Return a random position of the tool's grasp point, uniform over the reach."""
        inner, outer = self._reach.inner, self._reach.outer
        u, v = self._rng.random(2).tolist()
        radius = (inner**2 + u * (outer**2 - inner**2)) ** 0.5
        bearing = (2.0 * v - 1.0) * self._reach.waist_max
        return Point(on_grid(-radius * math.sin(bearing)), on_grid(radius * math.cos(bearing)))
