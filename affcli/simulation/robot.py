"""The simulated robot: it executes behaviors in the world and keeps the robot clock."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from affcli.core.behavior import BehaviorCall, BehaviorName, Execution, ExecutionStatus, WristPath
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.scene import Scene
from affcli.simulation.arm import reach_at
from affcli.simulation.pushing import Moment
from affcli.simulation.world import World
from affcli.simulation.wrist_motion import (
    duration,
    on_grid,
    stop_at_edge,
    trapezoid,
    trapezoid_time,
    trapezoid_travel,
)

PathMaker = Callable[[BehaviorCall, Point, Observation | None], WristPath]


Film = Callable[[float, Scene], None]
"""Called again and again while a behavior is executed, with the robot clock and the scene."""
FILM_STEP = 1.0 / 120.0
"""While the tool is carried the film is called this often (robot seconds)."""


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
        self.film: Film | None = None
        """Shown what happens while a behavior is executed; it changes nothing."""

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
        if self.film is not None:
            self._film_carrying(path, target, self.film)
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
            watch = None if self.film is None else self._filmed(self.film, start, direction)
            self._world.slide(direction, end, motion, watch)
            self.clock += duration(motion)
        self.clock += path.dwell
        if self.film is not None:
            self.film(self.clock, self._world.scene)
        return ExecutionStatus.DONE if end == asked else ExecutionStatus.TRUNCATED

    def _filmed(self, film: Film, start: Point, direction: Point) -> Moment:
        """Return what shows a film each moment of a push that begins now."""
        began = self.clock

        def watch(elapsed: float, gone: float, puck: Pose) -> None:
            """Show where tool and puck are."""
            wrist = Point(start.x + gone * direction.x, start.y + gone * direction.y)
            film(began + elapsed, replace(self._world.scene, attractor=puck, wrist=wrist))

        return watch

    def _film_carrying(self, path: WristPath, target: Point, film: Film) -> None:
        """Show a film how the tool is lifted, carried to `target` and lowered."""
        motion, height = self._world.workspace.motion, self._world.workspace.arm.lift_height
        start = self._world.wrist
        distance = math.dist(start, target)
        lifting = height / motion.lift_speed
        travelling = trapezoid_time(distance, path.speed, path.acceleration)
        steps = math.ceil((2.0 * lifting + travelling) / FILM_STEP)
        for elapsed in (FILM_STEP * k for k in range(steps + 1)):
            under_way = min(travelling, max(0.0, elapsed - lifting))
            gone = trapezoid_travel(under_way, distance, path.speed, path.acceleration)
            share = gone / distance if distance > 0.0 else 0.0
            lowering = elapsed - lifting - travelling
            lift = min(elapsed, lifting, lifting - lowering) * motion.lift_speed
            wrist = Point(
                start.x + share * (target.x - start.x), start.y + share * (target.y - start.y)
            )
            scene = replace(self._world.scene, wrist=wrist, lift=max(0.0, lift))
            film(self.clock + elapsed, scene)
