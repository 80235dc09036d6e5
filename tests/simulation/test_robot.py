"""The simulated robot: where its behaviors lead, what they take, and what they never touch."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.behaviors.moving import (
    CONTRACT_ARM,
    DIRECTIONS,
    EXTEND_ARM,
    SLIDE_ARM_LEFT,
    SLIDE_ARM_RIGHT,
)
from affcli.behaviors.moving import moving as moving_behavior
from affcli.config import settings_with
from affcli.core.behavior import (
    GRASP,
    POSITION_WRIST,
    BehaviorCall,
    BehaviorName,
    Execution,
    ExecutionStatus,
)
from affcli.core.geometry import Point, Pose
from affcli.core.tool import ToolName
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError
from affcli.simulation.arm import joint_angles, reach_at
from affcli.simulation.robot import SimulatedRobot
from affcli.simulation.table_world import TableSetting
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.simulation.wrist_motion import GRID, STEP, on_grid
from tests.factories import observation, setting_with

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


def setting_at(wrist: Point, puck: Pose = AWAY, tool: str = "t-hook") -> TableSetting:
    setting = setting_with(tool)
    setting.table.wrist, setting.table.attractor = Pose(*wrist), puck
    return setting


def call_of(name: BehaviorName, distance: float) -> BehaviorCall:
    return BehaviorCall.of(name, {"offset_distance": distance})


def do(setting: TableSetting, name: BehaviorName, distance: float) -> Execution:
    """Execute a moving behavior of any distance, in the repertoire or not."""
    behaviors = moving_behavior(name, distance)
    setting.robot._motions |= SimulatedRobot(setting.table, behaviors)._motions
    return setting.robot.execute(behaviors[0].call, None)


def carry_to(setting: TableSetting, target: Point) -> ExecutionStatus:
    """Position the wrist at `target`."""
    call = BehaviorCall.of(POSITION_WRIST, {"x": 1.0, "y": 9.0})
    seen = observation(Point(target.x + 1.0, target.y + 9.0))
    return setting.robot.execute(call, seen).status


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
        setting = setting_at(start)
        done = do(setting, name, distance)
        assert done.status is DONE
        assert (done.wrist_start, done.wrist_end) == (Pose(*start), setting.robot.wrist)
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
    setting = setting_at(start)
    done = do(setting, name, distance)
    gone = math.dist(start, done.wrist_end.point)
    assert done.call == call
    assert gone == pytest.approx(free_way(start, direction, distance), abs=2e-3)
    assert done.wrist_end.x == pytest.approx(start.x + gone * direction[0], abs=GRID)
    assert done.wrist_end.y == pytest.approx(start.y + gone * direction[1], abs=GRID)
    near_end = Point(done.wrist_end.x - 1e-6 * direction[0], done.wrist_end.y - 1e-6 * direction[1])
    assert LOW.holds(done.wrist_end.point) or LOW.holds(near_end)
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
    setting = setting_at(start)
    there = do(setting, name, 40.0)
    assert there.status is TRUNCATED
    gone = math.dist(start, there.wrist_end.point)
    returned = do(setting, back, gone)
    assert returned.status is DONE
    assert returned.wrist_end == Pose(*start)


@settings(deadline=None)
@given(st.lists(st.tuples(moving, st.floats(0.1, 9.0)), min_size=1, max_size=6), wrists())
def test_the_wrist_stays_on_its_grid(calls: list[tuple[BehaviorName, float]], start: Point) -> None:
    setting = setting_at(start)
    for name, distance in calls:
        do(setting, name, distance)
        assert all((c / GRID).is_integer() for c in setting.robot.wrist.point)


@settings(deadline=None)
@given(wrists(), wrists())
def test_position_wrist_goes_there_and_takes_lift_way_and_stillness(
    start: Point, target: Point
) -> None:
    """The clock counts the closed form of a trapezoid of speed, lifting, lowering and holding."""
    setting = setting_at(start)
    setting.robot.clock = 100.0
    assert carry_to(setting, target) is DONE
    assert setting.robot.wrist.x == pytest.approx(target.x, abs=GRID)
    assert setting.robot.wrist.y == pytest.approx(target.y, abs=GRID)
    way = math.dist(start, setting.robot.wrist.point)
    expected = (
        trapezoid_seconds(way, MOTION.transfer_speed, MOTION.transfer_acceleration)
        + 2.0 * ARM.lift_height / MOTION.lift_speed
        + MOTION.hold
    )
    assert setting.robot.clock - 100.0 == pytest.approx(expected)


@settings(deadline=None)
@given(wrists(), moving, st.floats(0.0, 8.0))
def test_a_slide_takes_the_time_of_its_trapezoid_and_of_holding_still(
    start: Point, name: BehaviorName, distance: float
) -> None:
    """Closed form of the trapezoid over the way truly gone. Steps of the physics clock round it: a
    ramp is a whole number of steps, and a remainder takes some more."""
    setting = setting_at(start)
    done = do(setting, name, distance)
    way = math.dist(start, done.wrist_end.point)
    sliding = trapezoid_seconds(way, MOTION.push_speed, MOTION.push_acceleration)
    assert done.duration == pytest.approx(sliding + MOTION.hold, abs=8.0 * STEP, rel=0.02)


@settings(deadline=None, max_examples=40)
@given(st.lists(st.tuples(moving, st.floats(0.1, 9.0)), max_size=6))
def test_the_clock_is_the_sum_of_what_the_behaviors_took(
    calls: list[tuple[BehaviorName, float]],
) -> None:
    """§6: "one hour of run time for every tool": the robot's own time."""
    setting = setting_at(Point(0.0, on_grid(0.5 * (INNER + OUTER))))
    grasp = setting.robot.execute(setting.binding, None)
    assert grasp.duration == MOTION.grasp_time
    took = [do(setting, *call).duration for call in calls]
    assert setting.robot.clock == pytest.approx(MOTION.grasp_time + sum(took))
    assert all(seconds > MOTION.hold - 1e-9 for seconds in took)


def test_grasping_moves_nothing() -> None:
    setting = setting_at(Point(1.0, 12.0), Pose(0.0, 30.0, 1.0))
    done = setting.robot.execute(setting.binding, None)
    assert (done.call.name, done.status) == (GRASP, DONE)
    assert setting.table.wrist == Pose(1.0, 12.0)
    assert setting.table.attractor == Pose(0.0, 30.0, 1.0)


@settings(deadline=None)
@given(wrists(), wrists())
def test_a_lifted_tool_passes_over_the_puck(start: Point, target: Point) -> None:
    """The tool is lifted when it is positioned, so it touches nothing on its way."""
    setting = setting_at(start, tool="t-hook")
    half = 0.5 * WORKSPACE.tools.handle_length
    middle = (0.5 * (start.x + target.x), 0.5 * (start.y + target.y) + half)
    setting.table.attractor = puck = Pose(*middle, 0.2)
    carry_to(setting, target)
    assert setting.table.attractor == puck


def test_a_tool_that_would_come_down_on_the_puck_stays_above_it_and_leaves_it_alone() -> None:
    target = Point(0.0, on_grid(0.5 * (INNER + OUTER)))
    puck = Pose(0.0, target.y + WORKSPACE.tools.handle_length, 0.4)
    setting = setting_at(Point(1.0, target.y), puck)
    assert carry_to(setting, target) is ExecutionStatus.BLOCKED
    assert setting.table.attractor == puck
    assert setting.robot.wrist == Pose(*target)
    assert setting.robot.clock > MOTION.hold
    assert carry_to(setting, Point(target.x, target.y - 3.0 * WORKSPACE.puck.radius)) is DONE
    assert setting.table.attractor == puck


@pytest.mark.parametrize("radius", [0.5 * INNER, 1.2 * OUTER])
def test_where_no_joint_angles_lead_the_arm_does_not_go(radius: float) -> None:
    start = Point(0.0, on_grid(0.5 * (INNER + OUTER)))
    setting = setting_at(start, Pose(0.0, 30.0))
    assert carry_to(setting, Point(0.0, radius)) is ExecutionStatus.OUT_OF_REACH
    assert (setting.robot.wrist, setting.robot.clock) == (Pose(*start), 0.0)
    assert setting.table.attractor == Pose(0.0, 30.0)


@settings(deadline=None)
@given(
    st.lists(st.tuples(st.floats(-25, 25), st.floats(-25, 25)), min_size=1, max_size=20),
    st.sampled_from([90.0, 60.0, 20.0]),
)
def test_the_arm_reaches_where_joint_angles_hold_the_tool_both_lifted_and_on_the_table(
    points: list[tuple[float, float]], waist: float
) -> None:
    """§5: "keeping the wrist perpendicular to the table": so says the inverse kinematics."""
    changed = settings_with({"arm": {"waist_max_degrees": waist}}, "a test")
    arm, robot = changed.workspace.arm, setting_with("t-hook", settings=changed).robot
    x, y = np.array(points).T
    expected = [
        all(
            joint_angles(arm, Point(*point), height) is not None
            for height in (arm.flange_height, arm.flange_height + arm.lift_height)
        )
        for point in points
    ]
    edges = [(abs(math.hypot(*p) - r) for r in (INNER, OUTER)) for p in points]
    turned = [abs(abs(math.atan2(p[0], p[1])) - math.radians(waist)) for p in points]
    sure = [min(*edge, turn) > 1e-6 for edge, turn in zip(edges, turned, strict=True)]
    for said, true, certain in zip(robot.reaches(x, y), expected, sure, strict=True):
        assert not certain or bool(said) is true


def test_a_slide_ends_where_the_robot_says_that_it_cannot_slide() -> None:
    """Nearer than where the tool could be set down."""
    setting = setting_with("stick")
    robot, wrist = setting.robot, Pose(0.0, 0.5 * (INNER + LOW.inner) + 1.0)
    setting.table.wrist, setting.table.attractor = wrist, AWAY
    done = robot.execute(BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 5.0}), None)
    end = done.wrist_end.y
    assert done.status is TRUNCATED
    places = np.array([wrist.y, end + 0.01, end - 0.01])
    assert robot.slides(np.zeros(3), places).tolist() == [True, True, False]
    assert not robot.reaches(np.zeros(1), np.array([end + 0.01])).any()


def test_robots_alike_reach_alike_so_that_what_is_worked_out_for_one_serves_the_next() -> None:
    """A planner remembers by it: each trial has a robot of its own."""
    one, other = setting_with("stick").robot, setting_with("stick").robot
    shorter = settings_with({"arm": {"upper_arm": ARM.upper_arm - 1.0}}, "a test")
    unlike = setting_with("stick", settings=shorter).robot
    assert (one.reaches, one.slides) == (other.reaches, other.slides)
    assert one.reaches != unlike.reaches
    assert one.reaches != one.slides


@settings(deadline=None)
@given(st.floats(-25.0, 25.0), st.floats(0.5, 25.0))
def test_position_wrist_succeeds_where_the_robot_says_it_reaches(x: float, y: float) -> None:
    target = Point(on_grid(x), on_grid(y))
    setting = setting_at(Point(0.0, on_grid(0.5 * (INNER + OUTER))))
    reached = bool(setting.robot.reaches(np.array([target.x]), np.array([target.y]))[0])
    assert (carry_to(setting, target) is DONE) is reached


def test_the_robot_remembers_for_the_record_where_the_attractor_was_before_a_behavior() -> None:
    wrist = Point(0.0, on_grid(0.5 * (INNER + OUTER)))
    top = wrist.y + WORKSPACE.tools.handle_length
    before = Pose(0.0, top + WORKSPACE.puck.radius + 0.1)
    setting = setting_at(wrist, before, "t-stick")
    table = setting.table
    do(setting, EXTEND_ARM, 5.0)
    assert setting.robot.attractor_before == before
    assert setting.truth() == (before, table.attractor)
    assert table.attractor.y > before.y


def test_a_behavior_that_the_robot_does_not_have_is_an_error() -> None:
    with pytest.raises(BadInputError, match="turn the wrist 2: this robot has no such behavior"):
        setting_at(Point(0.0, 12.0)).robot.execute(
            call_of(BehaviorName("turn the wrist"), 2.0), None
        )


def mirrored_setting(tool: str, *, mirror: bool) -> TableSetting:
    """Return a setting whose tool is turned over left to right when `mirror` is set."""
    setting = setting_with(tool)
    if mirror:
        parts = tuple(
            replace(
                part,
                outline=type(part.outline)(
                    tuple(Point(-p.x, p.y) for p in reversed(part.outline.vertices))
                ),
            )
            for part in setting.table.tool.parts
        )
        setting.table.put_down(replace(setting.table.tool, parts=parts))
    return setting


def test_mirrored_worlds_mirror() -> None:
    """Mirrored inputs give mirrored results within 1e-3 in: sixty behaviors that touch the puck."""
    rng = np.random.default_rng(0)
    settings_of = {
        tool: [mirrored_setting(tool, mirror=mirror) for mirror in (False, True)]
        for tool in sorted(TOOL_PARTS)
    }
    touched = 0
    while touched < 60:
        tool, name = str(rng.choice(sorted(TOOL_PARTS))), BehaviorName(rng.choice(sorted(OTHER)))
        radius, bearing = rng.uniform(INNER, OUTER), rng.uniform(-0.5, 0.5) * LOW.waist_max
        wrist = Point(on_grid(radius * math.sin(bearing)), on_grid(radius * math.cos(bearing)))
        puck = Pose(
            wrist.x + rng.uniform(-1.2, 1.2) * WORKSPACE.tools.bar_reach,
            wrist.y + rng.uniform(0.0, 1.2) * WORKSPACE.tools.handle_length,
        )
        here, there = settings_of[ToolName(tool)]
        here.table.wrist, here.table.attractor = Pose(*wrist), puck
        if not here.table.clear_of_attractor(Pose(*wrist)):
            continue
        done = do(here, name, 5.0)
        if here.table.attractor == puck:
            continue
        touched += 1
        there.table.wrist, there.table.attractor = Pose(-wrist.x, wrist.y), Pose(-puck.x, puck.y)
        mirrored = do(there, OTHER[name], 5.0)
        assert mirrored.status is done.status
        assert mirrored.wrist_end == pytest.approx(
            (-done.wrist_end.x, done.wrist_end.y, 0.0), abs=GRID
        )
        x, y = here.table.attractor.point
        assert there.table.attractor.point == pytest.approx((-x, y), abs=1e-3)
