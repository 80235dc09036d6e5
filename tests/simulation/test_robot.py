"""The simulated robot: where its behaviors lead, what they take, and what they never touch."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.behaviors.registry import DIRECTIONS
from affcli.core.behavior import (
    CONTRACT_ARM,
    EXTEND_ARM,
    GRASP,
    POSITION_WRIST,
    SLIDE_ARM_LEFT,
    SLIDE_ARM_RIGHT,
    BehaviorCall,
    BehaviorName,
    ExecutionStatus,
)
from affcli.core.geometry import Point, Pose
from affcli.core.tool import TOOL_PARTS
from affcli.core.workspace import Workspace
from affcli.lab.bench import Bench
from affcli.simulation.arm import joint_angles, reach_at
from affcli.simulation.wrist_motion import GRID, STEP, on_grid
from tests.factories import bench_with, observation

DONE, TRUNCATED = ExecutionStatus.DONE, ExecutionStatus.TRUNCATED
WORKSPACE = Workspace()
ARM, MOTION = WORKSPACE.arm, WORKSPACE.motion
LOW = reach_at(ARM, ARM.flange_height)
HIGH = reach_at(ARM, ARM.flange_height + ARM.lift_height)
INNER, OUTER = max(LOW.inner, HIGH.inner), min(LOW.outer, HIGH.outer)
AWAY = Pose(0.0, 200.0)
"""A puck that no tool touches."""
OTHER = {
    EXTEND_ARM: EXTEND_ARM,
    CONTRACT_ARM: CONTRACT_ARM,
    SLIDE_ARM_LEFT: SLIDE_ARM_RIGHT,
    SLIDE_ARM_RIGHT: SLIDE_ARM_LEFT,
}
"""Each behavior as a mirror shows it."""
moving = st.sampled_from(sorted(DIRECTIONS))


@st.composite
def wrists(draw: st.DrawFn) -> Point:
    """Draw a wrist position on the grid where the arm can set the tool down."""
    radius = draw(st.floats(INNER + 1e-5, OUTER - 1e-5))
    bearing = draw(st.floats(-1.0, 1.0)) * (LOW.waist_max - 1e-5)
    return Point(on_grid(-radius * math.sin(bearing)), on_grid(radius * math.cos(bearing)))


def bench_at(wrist: Point, puck: Pose = AWAY, tool: str = "t-hook") -> Bench:
    bench = bench_with(tool)
    bench.world.wrist, bench.world.attractor = wrist, puck
    return bench


def call_of(name: BehaviorName, distance: float) -> BehaviorCall:
    return BehaviorCall.of(name, {"offset_distance": distance})


def carry_to(bench: Bench, target: Point) -> ExecutionStatus:
    """Position the wrist at `target`."""
    call = BehaviorCall.of(POSITION_WRIST, {"x": 1.0, "y": 9.0})
    seen = observation(Point(target.x + 1.0, target.y + 9.0))
    return bench.robot.execute(call, seen).status


def free_way(start: Point, direction: tuple[float, float], distance: float) -> float:
    """Return how far a straight way stays in reach, by trying it every thousandth of an inch."""
    steps = max(1, math.ceil(distance / 1e-3))
    for k in range(1, steps + 1):
        t = distance * k / steps
        if not LOW.holds(Point(start.x + t * direction[0], start.y + t * direction[1])):
            return t
    return distance


def trapezoid_seconds(distance: float, speed: float, acceleration: float) -> float:
    """Return the time of a motion that speeds up, cruises and slows down."""
    if distance * acceleration >= speed * speed:
        return distance / speed + speed / acceleration
    return 2.0 * math.sqrt(distance / acceleration)


@pytest.mark.parametrize(
    ("name", "x", "y"),
    [
        (EXTEND_ARM, 0, 1),
        (CONTRACT_ARM, 0, -1),
        (SLIDE_ARM_LEFT, -1, 0),
        (SLIDE_ARM_RIGHT, 1, 0),
    ],
)
def test_each_behavior_moves_the_arm_its_way(name: BehaviorName, x: int, y: int) -> None:
    """§5: "move the arm in the indicated direction": extend +y, contract -y, left -x, right +x."""
    start = Point(0.0, on_grid(0.5 * (INNER + OUTER)))
    for distance in (2.0, 0.25 * (OUTER - INNER)):
        bench = bench_at(start)
        done = bench.robot.execute(call_of(name, distance), None)
        assert done.status is DONE
        assert (done.wrist_start, done.wrist_end) == (start, bench.robot.wrist)
        assert done.wrist_end.x - start.x == pytest.approx(x * distance, abs=GRID)
        assert done.wrist_end.y - start.y == pytest.approx(y * distance, abs=GRID)


@settings(deadline=None)
@given(wrists(), moving, st.floats(0.1, 12.0))
def test_a_behavior_that_meets_the_edge_of_the_reach_stops_there(
    start: Point, name: BehaviorName, distance: float
) -> None:
    """It goes as far along its straight line as the reach goes, no farther; the hole in the middle
    of the ring is an edge too. It keeps the parameter it was commanded with."""
    direction, call = DIRECTIONS[name], call_of(name, distance)
    bench = bench_at(start)
    done = bench.robot.execute(call, None)
    gone = math.dist(start, done.wrist_end)
    assert done.call == call
    assert gone == pytest.approx(free_way(start, direction, distance), abs=2e-3)
    assert done.wrist_end.x == pytest.approx(start.x + gone * direction[0], abs=GRID)
    assert done.wrist_end.y == pytest.approx(start.y + gone * direction[1], abs=GRID)
    near_end = Point(done.wrist_end.x - 1e-6 * direction[0], done.wrist_end.y - 1e-6 * direction[1])
    assert LOW.holds(done.wrist_end) or LOW.holds(near_end)
    assert done.status is (DONE if abs(gone - distance) <= GRID else TRUNCATED)


@settings(deadline=None)
@given(wrists(), moving)
def test_from_the_edge_of_the_reach_the_arm_comes_back(start: Point, name: BehaviorName) -> None:
    """A behavior that was truncated leaves the wrist where it can go on from."""
    back = {
        EXTEND_ARM: CONTRACT_ARM,
        CONTRACT_ARM: EXTEND_ARM,
        SLIDE_ARM_LEFT: SLIDE_ARM_RIGHT,
        SLIDE_ARM_RIGHT: SLIDE_ARM_LEFT,
    }[name]
    bench = bench_at(start)
    there = bench.robot.execute(call_of(name, 40.0), None)
    assert there.status is TRUNCATED
    gone = math.dist(start, there.wrist_end)
    returned = bench.robot.execute(call_of(back, gone), None)
    assert returned.status is DONE
    assert returned.wrist_end == start


@settings(deadline=None)
@given(st.lists(st.tuples(moving, st.floats(0.1, 9.0)), min_size=1, max_size=6), wrists())
def test_the_wrist_stays_on_its_grid(calls: list[tuple[BehaviorName, float]], start: Point) -> None:
    bench = bench_at(start)
    for name, distance in calls:
        bench.robot.execute(call_of(name, distance), None)
        assert all((c / GRID).is_integer() for c in bench.robot.wrist)


@settings(deadline=None)
@given(wrists(), wrists())
def test_position_wrist_goes_there_and_takes_lift_way_and_stillness(
    start: Point, target: Point
) -> None:
    """The clock counts the closed form of a trapezoid of speed, lifting, lowering and holding."""
    bench = bench_at(start)
    bench.robot.clock = 100.0
    assert carry_to(bench, target) is DONE
    assert bench.robot.wrist.x == pytest.approx(target.x, abs=GRID)
    assert bench.robot.wrist.y == pytest.approx(target.y, abs=GRID)
    way = math.dist(start, bench.robot.wrist)
    expected = (
        trapezoid_seconds(way, MOTION.transfer_speed, MOTION.transfer_acceleration)
        + 2.0 * ARM.lift_height / MOTION.lift_speed
        + MOTION.hold
    )
    assert bench.robot.clock - 100.0 == pytest.approx(expected)


@settings(deadline=None)
@given(wrists(), moving, st.floats(0.0, 8.0))
def test_a_slide_takes_the_time_of_its_trapezoid_and_of_holding_still(
    start: Point, name: BehaviorName, distance: float
) -> None:
    """Closed form of the trapezoid over the way truly gone. Steps of the physics clock round it: a
    ramp is a whole number of steps, and a remainder takes some more."""
    bench = bench_at(start)
    done = bench.robot.execute(call_of(name, distance), None)
    way = math.dist(start, done.wrist_end)
    sliding = trapezoid_seconds(way, MOTION.push_speed, MOTION.push_acceleration)
    assert done.duration == pytest.approx(sliding + MOTION.hold, abs=8.0 * STEP, rel=0.02)


@settings(deadline=None, max_examples=40)
@given(st.lists(st.tuples(moving, st.floats(0.1, 9.0)), max_size=6))
def test_the_clock_is_the_sum_of_what_the_behaviors_took(
    calls: list[tuple[BehaviorName, float]],
) -> None:
    """§6: "one hour of run time for every tool": the robot's own time."""
    bench = bench_at(Point(0.0, on_grid(0.5 * (INNER + OUTER))))
    grasp = bench.robot.execute(bench.behaviors.binding, None)
    assert grasp.duration == MOTION.grasp_time
    took = [bench.robot.execute(call_of(*call), None).duration for call in calls]
    assert bench.robot.clock == pytest.approx(MOTION.grasp_time + sum(took))
    assert all(seconds > MOTION.hold - 1e-9 for seconds in took)


def test_grasping_moves_nothing() -> None:
    bench = bench_at(Point(1.0, 12.0), Pose(0.0, 30.0, 1.0))
    done = bench.robot.execute(bench.behaviors.binding, None)
    assert (done.call.name, done.status) == (GRASP, DONE)
    assert bench.world.wrist == Point(1.0, 12.0)
    assert bench.world.attractor == Pose(0.0, 30.0, 1.0)


@settings(deadline=None)
@given(wrists(), wrists())
def test_a_lifted_tool_passes_over_the_puck(start: Point, target: Point) -> None:
    """The tool is lifted when it is positioned, so it touches nothing on its way."""
    bench = bench_at(start, tool="t-hook")
    half = 0.5 * WORKSPACE.tools.handle_length
    middle = (0.5 * (start.x + target.x), 0.5 * (start.y + target.y) + half)
    bench.world.attractor = puck = Pose(*middle, 0.2)
    carry_to(bench, target)
    assert bench.world.attractor == puck


def test_a_tool_that_would_come_down_on_the_puck_stays_above_it_and_leaves_it_alone() -> None:
    target = Point(0.0, on_grid(0.5 * (INNER + OUTER)))
    puck = Pose(0.0, target.y + WORKSPACE.tools.handle_length, 0.4)
    bench = bench_at(Point(1.0, target.y), puck)
    assert carry_to(bench, target) is ExecutionStatus.BLOCKED
    assert bench.world.attractor == puck
    assert bench.robot.wrist == target
    assert bench.robot.clock > MOTION.hold
    assert carry_to(bench, Point(target.x, target.y - 3.0 * WORKSPACE.puck.radius)) is DONE
    assert bench.world.attractor == puck


@pytest.mark.parametrize("radius", [0.5 * INNER, 1.2 * OUTER])
def test_where_no_joint_angles_lead_the_arm_does_not_go(radius: float) -> None:
    start = Point(0.0, on_grid(0.5 * (INNER + OUTER)))
    bench = bench_at(start, Pose(0.0, 30.0))
    assert carry_to(bench, Point(0.0, radius)) is ExecutionStatus.OUT_OF_REACH
    assert (bench.robot.wrist, bench.robot.clock) == (start, 0.0)
    assert bench.world.attractor == Pose(0.0, 30.0)


@settings(deadline=None)
@given(st.lists(st.tuples(st.floats(-25, 25), st.floats(-25, 25)), min_size=1, max_size=20))
def test_the_arm_reaches_where_joint_angles_hold_the_tool_both_lifted_and_on_the_table(
    points: list[tuple[float, float]],
) -> None:
    """§5: "keeping the wrist perpendicular to the table": so says the inverse kinematics."""
    robot = bench_at(Point(0.0, 12.0)).robot
    x, y = np.array(points).T
    expected = [
        all(
            joint_angles(ARM, Point(*point), height) is not None
            for height in (ARM.flange_height, ARM.flange_height + ARM.lift_height)
        )
        for point in points
    ]
    sure = [
        min(abs(math.hypot(*p) - INNER), abs(math.hypot(*p) - OUTER), abs(p[1])) > 1e-6
        for p in points
    ]
    for said, true, certain in zip(robot.reaches(x, y), expected, sure, strict=True):
        assert not certain or bool(said) is true


@settings(deadline=None)
@given(st.floats(-25.0, 25.0), st.floats(0.5, 25.0))
def test_position_wrist_succeeds_where_the_robot_says_it_reaches(x: float, y: float) -> None:
    target = Point(on_grid(x), on_grid(y))
    bench = bench_at(Point(0.0, on_grid(0.5 * (INNER + OUTER))))
    reached = bool(bench.robot.reaches(np.array([target.x]), np.array([target.y]))[0])
    assert (carry_to(bench, target) is DONE) is reached


def test_the_robot_remembers_for_the_record_where_the_attractor_was_before_a_behavior() -> None:
    wrist = Point(0.0, on_grid(0.5 * (INNER + OUTER)))
    top = wrist.y + WORKSPACE.tools.handle_length
    before = Pose(0.0, top + WORKSPACE.puck.radius + 0.1)
    bench = bench_at(wrist, before, "t-stick")
    world = bench.world
    bench.robot.execute(call_of(EXTEND_ARM, 5.0), None)
    assert bench.robot.attractor_before == before
    assert bench.truth() == (before, world.attractor)
    assert world.attractor.y > before.y


def test_a_behavior_that_the_robot_does_not_have_is_an_error() -> None:
    with pytest.raises(KeyError, match="turn the wrist"):
        bench_at(Point(0.0, 12.0)).robot.execute(call_of(BehaviorName("turn the wrist"), 2.0), None)


@cache
def mirrored_bench(tool: str, *, mirror: bool) -> Bench:
    """Return a bench whose tool is turned over left to right when `mirror` is set."""
    bench = bench_with(tool)
    if mirror:
        parts = tuple(
            replace(
                part,
                outline=type(part.outline)(
                    tuple(Point(-p.x, p.y) for p in reversed(part.outline.vertices))
                ),
            )
            for part in bench.world.tool.parts
        )
        bench.world.tool = replace(bench.world.tool, parts=parts)
    return bench


def test_mirrored_worlds_mirror() -> None:
    """Mirrored inputs give mirrored results within 1e-3 in: sixty behaviors that touch the puck."""
    rng = np.random.default_rng(0)
    touched = 0
    while touched < 60:
        tool, name = str(rng.choice(sorted(TOOL_PARTS))), BehaviorName(rng.choice(sorted(OTHER)))
        radius, bearing = rng.uniform(INNER, OUTER), rng.uniform(-0.5, 0.5) * LOW.waist_max
        wrist = Point(on_grid(radius * math.sin(bearing)), on_grid(radius * math.cos(bearing)))
        puck = Pose(
            wrist.x + rng.uniform(-1.2, 1.2) * WORKSPACE.tools.bar_reach,
            wrist.y + rng.uniform(0.0, 1.2) * WORKSPACE.tools.handle_length,
        )
        here = mirrored_bench(tool, mirror=False)
        here.world.wrist, here.world.attractor = wrist, puck
        if not here.world.clear_of_attractor(wrist):
            continue
        done = here.robot.execute(call_of(name, 5.0), None)
        if here.world.attractor == puck:
            continue
        touched += 1
        there = mirrored_bench(tool, mirror=True)
        there.world.wrist, there.world.attractor = Point(-wrist.x, wrist.y), Pose(-puck.x, puck.y)
        mirrored = there.robot.execute(call_of(OTHER[name], 5.0), None)
        assert mirrored.status is done.status
        assert mirrored.wrist_end == pytest.approx((-done.wrist_end.x, done.wrist_end.y), abs=GRID)
        x, y = here.world.attractor.point
        assert there.world.attractor.point == pytest.approx((-x, y), abs=1e-3)
