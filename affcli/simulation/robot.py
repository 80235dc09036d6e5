"""The simulated robot: it executes motions on the table and keeps the robot clock."""

import math
from dataclasses import replace

from affcli.behaviors.positioning import wrist_target
from affcli.core.behavior import (
    GRASP,
    POSITION_WRIST,
    BehaviorCall,
    Execution,
    ExecutionStatus,
    Repertoire,
    composed_motion,
)
from affcli.core.geometry import Point, Pose
from affcli.core.motion import Motion, Slide, Turn, Wait
from affcli.core.observation import Observation
from affcli.core.tool import hold_of
from affcli.core.world import Film
from affcli.errors import BadInputError, one_line
from affcli.simulation.arm import ReachableWrists, free_turn, reach_at
from affcli.simulation.strides import Moment
from affcli.simulation.table import Table
from affcli.simulation.wrist_motion import (
    GRID,
    duration,
    lever_of,
    on_grid,
    stop_at_edge,
    tip_of,
    trapezoid,
    trapezoid_time,
    trapezoid_travel,
    turning,
)

FILM_STEP = 1.0 / 120.0
"""While the tool is carried the film is called this often (robot seconds)."""


class SimulatedRobot:
    """The five-axis arm at the simulated table; a `Robot`.

    Args:
        table: what it acts on.
        repertoire: the exploratory behaviors by value; grasp and position wrist it knows, and what
            is composed of motor schemas.
    """

    def __init__(self, table: Table, repertoire: Repertoire) -> None:
        self._table = table
        arm = table.workspace.arm
        self._motions = {one.call: one.motion for one in repertoire}
        self._low = reach_at(arm, arm.flange_height)
        self._high = reach_at(arm, arm.flange_height + arm.lift_height)
        low, high = self._low, self._high
        inner, outer = max(low.inner, high.inner), min(low.outer, high.outer)
        self.reaches = ReachableWrists(inner, outer, low.waist_max)
        """Where the arm can set the tool down: it must hold it there both lifted and on the table.
        """
        self.slides = ReachableWrists(low.inner, low.outer, low.waist_max)
        """Where it can hold the tool on the table: nearer than where it could lift it, too."""
        self.clock = 0.0
        self.holding: BehaviorCall | None = None
        """The binding behavior by which the tool is held."""
        self.attractor_before = table.attractor
        """Where the attractor truly was when the last behavior began; not for the robot's eyes."""
        self.film: Film | None = None
        """Shown what happens while a behavior is executed; it changes nothing."""

    @property
    def wrist(self) -> Pose:
        """The wrist now (in, rad, table frame), by the joint encoders."""
        return self._table.wrist

    def execute(self, call: BehaviorCall, seen: Observation | None) -> Execution:
        """Execute one behavior to its end (see the protocol in `core.ports`)."""
        start, began = self._table.wrist, self.clock
        self.attractor_before = self._table.attractor
        if call.name == POSITION_WRIST:
            status = self._carry(wrist_target(call, seen))
        else:
            status = self._run(self._motion(call))
        return Execution(call, status, start, self._table.wrist, self.clock - began)

    def _motion(self, call: BehaviorCall) -> Motion:
        """Return the motion of a grasp or of an exploratory behavior; BadInputError for another."""
        if call.name == GRASP:
            return self._take(call)
        motion = self._motions.get(call) or composed_motion(call)
        if motion is None:
            raise BadInputError(
                f"{one_line(call, 60)}: this robot has no such behavior; install the affcli that "
                "made the record"
            )
        return (*motion, Wait(self._table.workspace.motion.hold))

    def _take(self, call: BehaviorCall) -> Motion:
        """Take the tool as a grasp says; return the motion, which is a wait."""
        timing, first = self._table.workspace.motion, self.holding is None
        self._table.take(hold_of(call))
        self.holding = call
        return (Wait(timing.grasp_time if first else timing.regrasp_time),)

    def _run(self, motion: Motion) -> ExecutionStatus:
        """Execute the segments of a motion until one of them does not end as asked."""
        status = ExecutionStatus.DONE
        for segment in motion:
            if isinstance(segment, Wait):
                self.clock += segment.seconds
                if self.film is not None:
                    self.film(self.clock, self._table.scene)
            elif status is not ExecutionStatus.DONE:
                continue
            elif isinstance(segment, Slide):
                status = self._slide(segment.dx, segment.dy)
            elif isinstance(segment, Turn):
                status = self._turn(math.radians(segment.degrees))
            else:
                status = self._carry(segment.to)
        return status

    def _carry(self, to: Pose) -> ExecutionStatus:
        """Move lifted and lower the tool; keep it lifted there when the attractor lies under it."""
        target = Pose(on_grid(to.x), on_grid(to.y), to.angle)
        if not (
            self._high.at_angle(to.angle).holds(target)
            and self._low.at_angle(to.angle).holds(target)
        ):
            return ExecutionStatus.OUT_OF_REACH
        timing, height = self._table.workspace.motion, self._table.workspace.arm.lift_height
        if self.film is not None:
            self._film_carrying(target, self.film)
        still = 2.0 * height / timing.lift_speed + timing.hold
        self.clock += still + self._carrying_time(target)
        self._table.wrist = target
        clear = self._table.clear_of_attractor(target)
        return ExecutionStatus.DONE if clear else ExecutionStatus.BLOCKED

    def _carrying_time(self, target: Pose) -> float:
        """Return how long the wrist travels lifted (s); it turns meanwhile."""
        timing, wrist = self._table.workspace.motion, self._table.wrist
        travel = math.dist(wrist.point, target.point)
        seconds = trapezoid_time(travel, timing.transfer_speed, timing.transfer_acceleration)
        if target.angle == wrist.angle:
            return seconds
        turn = math.degrees(abs(target.angle - wrist.angle))
        return max(seconds, trapezoid_time(turn, timing.turn_speed, timing.turn_acceleration))

    def _slide(self, dx: float, dy: float) -> ExecutionStatus:
        """Slide straight on the table, as far as the reach goes."""
        start, timing = self._table.wrist.point, self._table.workspace.motion
        asked = Point(on_grid(start.x + dx), on_grid(start.y + dy))
        end = stop_at_edge(self._low.at_angle(self._table.wrist.angle), start, asked)
        distance = math.dist(start, end)
        if distance > 0.0:
            motion = trapezoid(on_grid(distance), timing.push_speed, timing.push_acceleration)
            ways = ((end.x - start.x) / distance, (end.y - start.y) / distance)
            direction = Point(*map(on_grid, ways))
            watch = None if self.film is None else self._filmed(self.film, Pose(*direction))
            self._table.slide(direction, end, motion, watch)
            self.clock += duration(motion)
        return ExecutionStatus.DONE if end == asked else ExecutionStatus.TRUNCATED

    def _turn(self, angle: float) -> ExecutionStatus:
        """Turn on the table about the wrist, as far as the roll goes."""
        table, timing = self._table, self._table.workspace.motion
        tip = tip_of(table.tool.outlines)
        lever = lever_of(tip)
        asked = on_grid(abs(angle) * lever)
        free = math.floor(free_turn(table.wrist, angle) * lever / GRID) * GRID
        arc = min(asked, free)
        motion = turning(arc, lever, tip, timing.push_speed, timing.push_acceleration)
        if motion:
            lever = math.copysign(lever, angle)
            course = Pose(0.0, 0.0, 1.0 / lever)
            watch = None if self.film is None else self._filmed(self.film, course)
            table.turn(lever, motion, watch)
            self.clock += duration(motion)
        return ExecutionStatus.DONE if arc == asked else ExecutionStatus.TRUNCATED

    def _filmed(self, film: Film, course: Pose) -> Moment:
        """Return what shows a film each moment of a push that begins now.

        Args:
            film: what it is shown to.
            course: how far the wrist goes along x and y and turns, for each inch of the push.
        """
        began, start = self.clock, self._table.wrist

        def watch(elapsed: float, gone: float, puck: Pose) -> None:
            """Show where tool and puck are."""
            wrist = Pose(*(a + gone * b for a, b in zip(start, course, strict=True)))
            film(began + elapsed, replace(self._table.scene, attractor=puck, wrist=wrist))

        return watch

    def _film_carrying(self, target: Pose, film: Film) -> None:
        """Show a film how the tool is lifted, carried to `target` and turned, and lowered."""
        timing, height = self._table.workspace.motion, self._table.workspace.arm.lift_height
        start = self._table.wrist
        distance = math.dist(start.point, target.point)
        turn = math.degrees(abs(target.angle - start.angle))
        lifting, travelling = height / timing.lift_speed, self._carrying_time(target)
        steps = math.ceil((2.0 * lifting + travelling) / FILM_STEP)
        for elapsed in (FILM_STEP * k for k in range(steps + 1)):
            under_way = min(travelling, max(0.0, elapsed - lifting))
            gone = trapezoid_travel(
                under_way, distance, timing.transfer_speed, timing.transfer_acceleration
            )
            turned = trapezoid_travel(under_way, turn, timing.turn_speed, timing.turn_acceleration)
            share = gone / distance if distance > 0.0 else 1.0
            swing = turned / turn if turn > 0.0 else 1.0
            lowering = elapsed - lifting - travelling
            lift = min(elapsed, lifting, lifting - lowering) * timing.lift_speed
            shares = (share, share, swing)
            wrist = Pose(*(a + s * (b - a) for a, b, s in zip(start, target, shares, strict=True)))
            scene = replace(self._table.scene, wrist=wrist, lift=max(0.0, lift))
            film(self.clock + elapsed, scene)
