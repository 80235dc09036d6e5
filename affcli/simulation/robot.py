"""The simulated robot: it executes behaviors in the world and keeps the robot clock."""

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from affcli.core.behavior import BehaviorCall, BehaviorName, Execution, ExecutionStatus, WristPath
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.simulation.arm import reach_at
from affcli.simulation.world import World
from affcli.simulation.wrist_motion import (
    duration,
    on_grid,
    stop_at_edge,
    trapezoid,
    trapezoid_time,
)

PathMaker = Callable[[BehaviorCall, Point, Observation | None], WristPath]


class SimulatedRobot:
    """The five-axis arm in the simulated world, behind the `Robot` protocol.

    Args:
        world: what it acts on.
        paths: the behavior registry: for each behavior the wrist path it gives.
    """

    def __init__(self, world: World, paths: Mapping[BehaviorName, PathMaker]) -> None:
        self._world = world
        self._paths = paths
        arm = world.workspace.arm
        self._low = reach_at(arm, arm.flange_height)
        self._high = reach_at(arm, arm.flange_height + arm.lift_height)
        self.clock = 0.0
        self.attractor_before = world.attractor
        """Where the attractor truly was when the last behavior began; not for the robot's eyes."""

    @property
    def wrist(self) -> Point:
        """The wrist now (in, table frame), by the joint encoders."""
        return self._world.wrist

    def reaches(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Tell for each wrist position (n,), (n,) whether the arm can set the tool down there.

        To set it down the arm must hold it there both lifted and on the table.
        """
        inner = max(self._low.inner, self._high.inner)
        outer = min(self._low.outer, self._high.outer)
        squared = x * x
        squared += y * y
        held = squared >= inner * inner
        held &= squared <= outer * outer
        # Within the waist's range of straight ahead: y >= r cos(waist), without an arc tangent.
        if self._low.waist_max >= math.radians(90.0):
            held &= y >= 0.0
        else:
            np.sqrt(squared, out=squared)
            squared *= math.cos(self._low.waist_max)
            held &= y >= squared
        return held

    def execute(self, call: BehaviorCall, seen: Observation | None) -> Execution:
        """Execute one behavior to its end (see the protocol in `core.ports`)."""
        start = self._world.wrist
        path = self._paths[call.name](call, start, seen)
        began = self.clock
        self.attractor_before = self._world.attractor
        status = self._carry(path) if path.lifted else self._slide(path)
        return Execution(call, status, start, self._world.wrist, self.clock - began)

    def _carry(self, path: WristPath) -> ExecutionStatus:
        """Move lifted and lower the tool; keep it lifted there when the attractor lies under it."""
        target = Point(on_grid(path.end.x), on_grid(path.end.y))
        if not (self._low.holds(target) and self._high.holds(target)):
            return ExecutionStatus.OUT_OF_REACH
        travel = math.dist(self._world.wrist, target)
        self.clock += path.dwell + trapezoid_time(travel, path.speed, path.acceleration)
        self._world.wrist = target
        clear = self._world.clear_of_attractor(target)
        return ExecutionStatus.DONE if clear else ExecutionStatus.BLOCKED

    def _slide(self, path: WristPath) -> ExecutionStatus:
        """Slide straight on the table, as far as the reach goes."""
        start = self._world.wrist
        asked = Point(on_grid(path.end.x), on_grid(path.end.y))
        end = stop_at_edge(self._low, start, asked)
        distance = math.dist(start, end)
        if distance > 0.0:
            motion = trapezoid(on_grid(distance), path.speed, path.acceleration)
            direction = Point((end.x - start.x) / distance, (end.y - start.y) / distance)
            self._world.slide(direction, end, motion)
            self.clock += duration(motion)
        self.clock += path.dwell
        return ExecutionStatus.DONE if end == asked else ExecutionStatus.TRUNCATED
