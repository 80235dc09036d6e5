"""The robot turns its wrist: how far, how long, and what of it the experimenter knows (§7.1)."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.behaviors.positioning import position_wrist
from affcli.behaviors.turning import turn_and_pull, turn_and_slide, turn_wrist
from affcli.core.behavior import Execution, ExecutionStatus, Repertoire
from affcli.core.geometry import Point, Pose
from affcli.core.scene import Scene
from affcli.core.tool import turned_outlines
from affcli.core.workspace import Workspace
from affcli.simulation.arm import WRIST_ROLL_MAX, joint_angles, reach_at
from affcli.simulation.experimenter import SimulatedExperimenter
from affcli.simulation.reach_of_tool import touchable
from affcli.simulation.robot import SimulatedRobot
from affcli.simulation.table_world import TableSetting
from tests.factories import affordance, observation, setting_with, tool_named

DONE, TRUNCATED = ExecutionStatus.DONE, ExecutionStatus.TRUNCATED
WORKSPACE = Workspace()
ARM, MOTION = WORKSPACE.arm, WORKSPACE.motion
LOW = reach_at(ARM, ARM.flange_height)
AWAY = Pose(0.0, 200.0)
"""A puck that no tool touches."""
GRAIN = 1e-6
"""Turns lie on a grid (rad, in)."""


def at_table(
    repertoire: Repertoire, wrist: Pose, puck: Pose = AWAY, tool: str = "stick"
) -> TableSetting:
    """Return a setting whose robot can do a repertoire, the wrist somewhere."""
    setting = setting_with(tool)
    setting.table.wrist, setting.table.attractor = wrist, puck
    robot = SimulatedRobot(setting.table, repertoire)
    rng = np.random.default_rng(1)
    experimenter = SimulatedExperimenter(setting.table, rng, repertoire)
    return replace(setting, robot=robot, experimenter=experimenter)


def done(setting: TableSetting, repertoire: Repertoire) -> Execution:
    """Execute the one behavior of a repertoire."""
    return setting.robot.execute(repertoire[0].call, None)


@given(st.floats(-60.0, 60.0), st.floats(-1.0, 1.0))
@settings(max_examples=30)
def test_the_wrist_turns_where_it_is_by_what_is_asked(degrees: float, start: float) -> None:
    behavior, wrist = turn_wrist(degrees), Pose(2.0, 12.0, start)
    execution = done(at_table(behavior, wrist), behavior)
    assert execution.status is DONE
    assert execution.wrist_end.point == wrist.point
    asked = start + math.radians(degrees)
    assert execution.wrist_end.angle == pytest.approx(asked, abs=GRAIN)


def test_a_turn_and_back_is_no_turn() -> None:
    behaviors = turn_wrist(40.0) + turn_wrist(-40.0)
    setting = at_table(behaviors, Pose(2.0, 12.0))
    for behavior in behaviors:
        setting.robot.execute(behavior.call, None)
    assert setting.table.wrist == Pose(2.0, 12.0)


@given(st.floats(-1.5, 1.5), st.sampled_from([-180.0, 180.0]), st.floats(0.0, 1.5))
@settings(max_examples=30)
def test_a_turn_stops_at_the_roll_limit(waist: float, degrees: float, start: float) -> None:
    """The roll is the angle less the waist; a slide that was to follow is left out."""
    wrist = Pose(-12.0 * math.sin(waist), 12.0 * math.cos(waist), math.copysign(start, degrees))
    behavior = turn_and_pull(degrees, 3.0)
    execution = done(at_table(behavior, wrist), behavior)
    roll = execution.wrist_end.angle - waist
    free = math.pi - math.copysign(1.0, degrees) * (wrist.angle - waist) >= math.pi
    if free:
        assert abs(execution.wrist_end.angle - wrist.angle) == pytest.approx(math.pi, abs=GRAIN)
    else:
        assert execution.status is TRUNCATED
        assert abs(roll) == pytest.approx(WRIST_ROLL_MAX, abs=GRAIN)
        assert abs(roll) <= WRIST_ROLL_MAX
        assert execution.wrist_end.point == wrist.point


def test_a_slide_at_an_angle_stops_where_the_roll_does() -> None:
    """At 120 degrees to the left the waist must not turn more than 60 to the right."""
    behavior = turn_and_slide(120.0, 20.0, 0.0)
    execution = done(at_table(behavior, Pose(0.0, 8.0)), behavior)
    assert execution.status is TRUNCATED
    end = execution.wrist_end
    assert math.degrees(math.atan2(end.x, end.y)) == pytest.approx(60.0, abs=1e-3)
    assert LOW.at_angle(end.angle).holds(end.point)


@given(st.floats(-17.0, 17.0), st.floats(0.0, 17.0), st.floats(-4.0, 4.0))
@settings(max_examples=100)
def test_the_arm_reaches_where_its_joints_do(x: float, y: float, angle: float) -> None:
    """Asked by the planner, and when position wrist asks for an angle."""
    heights = ARM.flange_height, ARM.flange_height + ARM.lift_height
    joints = [joint_angles(ARM, Point(x, y), height, angle) for height in heights]
    setting = at_table((), Pose(0.0, 12.0))
    arrays = (np.array([value]) for value in (x, y, angle))
    assert bool(setting.robot.reaches(*arrays)[0]) is all(joints)
    seen = observation(Point(x, y + 9.0), wrist=Point(0.0, 0.0))
    placing = setting.robot.execute(position_wrist(Point(0.0, 9.0), angle), seen)
    assert (placing.status is DONE) is all(joints)


def test_a_turn_takes_its_time_on_the_table_and_in_the_air() -> None:
    """The tip of a stick of 14.6 in goes nearly at the speed of a push; lifted, the wrist turns
    while it travels."""
    behavior, wrist = turn_wrist(60.0), Pose(2.0, 12.0)
    execution = done(at_table(behavior, wrist), behavior)
    arc = math.hypot(14.6, 0.375) * math.radians(60.0)
    speed, acceleration = MOTION.push_speed, MOTION.push_acceleration
    asked = arc / speed + speed / acceleration + MOTION.hold
    assert asked <= execution.duration <= 1.05 * asked
    lifted = []
    for target in (Pose(2.0, 12.0), Pose(2.0, 12.0, 1.0), Pose(-6.0, 12.0), Pose(-6.0, 12.0, 1.0)):
        setting = at_table((), wrist)
        seen = observation(Point(target.x, target.y + 9.0))
        call = position_wrist(Point(0.0, 9.0), target.angle)
        lifted.append(setting.robot.execute(call, seen).duration)
    still, turned, carried, both = lifted
    degrees, rate, gain = math.degrees(1.0), MOTION.turn_speed, MOTION.turn_acceleration
    assert turned - still == pytest.approx(degrees / rate + rate / gain, abs=1e-9)
    assert both == max(turned, carried)


def test_a_film_of_a_turn_shows_each_angle_and_changes_no_bit() -> None:
    behavior, wrist, puck = turn_and_pull(-50.0, 4.0), Pose(1.0, 12.0), Pose(5.0, 22.0, 0.3)
    plain, filmed = (at_table(behavior, wrist, puck) for _ in range(2))
    shown: list[Scene] = []
    filmed.robot.film = lambda clock, scene: shown.append(scene)
    executions = [done(setting, behavior) for setting in (plain, filmed)]
    assert executions[0] == executions[1]
    assert plain.table.attractor == filmed.table.attractor != puck
    angles = [scene.wrist.angle for scene in shown]
    assert angles == sorted(angles, reverse=True)
    assert max(a - b for a, b in pairwise(angles)) < math.radians(0.1)
    assert shown[-1].wrist == plain.table.wrist
    assert {scene.wrist.point for scene in shown if scene.wrist.angle > angles[-1]} == {wrist.point}


def test_a_turned_tool_is_clear_of_the_attractor_where_it_lies() -> None:
    setting = at_table((), Pose(0.0, 12.0), Pose(0.0, 22.0))
    assert not setting.table.clear_of_attractor(Pose(0.0, 12.0))
    assert setting.table.clear_of_attractor(Pose(0.0, 12.0, 0.5))
    assert not setting.table.clear_of_attractor(Pose(7.0, 15.0, math.pi / 4.0))


def test_what_is_out_of_reach_is_the_same_however_the_wrist_is_turned() -> None:
    """The next position wrist sets the tool down straight again."""
    rng, setting, answers = np.random.default_rng(3), at_table((), Pose(0.0, 12.0)), set()
    for x, y in zip(rng.uniform(-16.0, 16.0, 300), rng.uniform(11.8, 31.6, 300), strict=True):
        setting.table.attractor = Pose(float(x), float(y))
        setting.table.wrist = Pose(0.0, 12.0)
        straight = setting.experimenter.attractor_out_of_reach()
        setting.table.wrist = Pose(0.0, 12.0, 1.2)
        assert setting.experimenter.attractor_out_of_reach() is straight
        answers.add(straight)
    assert answers == {True, False}


@given(st.floats(-3.0, 3.0), st.sampled_from([-1.0, 1.0]), st.floats(2.0, 17.0))
@settings(max_examples=60)
def test_a_turned_tool_touches_what_its_reach_and_its_outline_say(
    angle: float, side: float, radius: float
) -> None:
    """A puck at the tip of a tool held anywhere is touchable; one farther than all is not."""
    outlines = turned_outlines(tool_named("stick").outlines, angle)
    reach = LOW.at_angle(angle)
    bearing = reach.waist_min if side < 0.0 else reach.waist_max
    bearing -= 1e-6 * side
    wrist = Point(-radius * math.sin(bearing), radius * math.cos(bearing))
    tip = Point(wrist.x - 14.6 * math.sin(angle), wrist.y + 14.6 * math.cos(angle))
    assert touchable(outlines, reach, tip, 1.0)
    length = math.hypot(14.6, 0.375) + reach.outer + 1.0 + 0.1
    assert not touchable(outlines, reach, Point(0.0, length), 1.0)


@pytest.mark.parametrize("degrees", [30.0, -100.0, 170.0])
def test_the_attractor_is_put_where_a_row_that_turns_can_be_done_again(degrees: float) -> None:
    """The whole turn and the whole way, from a place where the roll allows it."""
    behavior = turn_and_pull(degrees, 3.0)
    setting = at_table(behavior, Pose(0.0, 12.0))
    wrist = Point(math.copysign(2.0, -degrees), 12.0)
    start = observation(Point(wrist.x, wrist.y + 12.0), wrist=wrist)
    end = observation(Point(wrist.x, wrist.y + 9.0), wrist=Point(wrist.x, wrist.y - 3.0))
    row = replace(affordance(), exploratory=behavior[0].call, start=start, end=end)
    places = set()
    for _ in range(20):
        setting.experimenter.put_attractor_for(row)
        at = setting.table.attractor
        setting.table.wrist = Pose(at.x, at.y - 12.0)
        places.add(setting.table.wrist)
        setting.table.attractor = AWAY
        assert done(setting, behavior).status is DONE
    assert len(places) > 15
