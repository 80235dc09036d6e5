"""The five-axis arm holds its wrist perpendicular to the table and knows its own reach (§4, §5)."""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from affcli.core.geometry import Point
from affcli.core.workspace import ArmGeometry
from affcli.errors import BadInputError
from affcli.simulation.arm import (
    WRIST_PITCH_MAX,
    JointAngles,
    joint_angles,
    reach_at,
)
from affcli.simulation.tasks.extension_of_reach import start_positions
from tests.physics.pushes import RADIUS, WORKSPACE

ARM = WORKSPACE.arm
LOW = ARM.flange_height
HIGH = ARM.flange_height + ARM.lift_height
EDGE = 1e-9
"""Positions this close to an edge of the reach may count either way (in, rad)."""

heights = st.one_of(st.sampled_from((LOW, HIGH)), st.floats(0.0, 8.0))
wrists = st.builds(Point, st.floats(-25.0, 25.0), st.floats(-25.0, 25.0))


def wrist_position(arm: ArmGeometry, joints: JointAngles) -> tuple[float, float, float]:
    """Forward kinematics: return the flange position (x, y, z) (in, table frame)."""
    forearm = joints.shoulder - joints.elbow
    hand = forearm - joints.pitch
    radius = (
        arm.upper_arm * math.cos(joints.shoulder)
        + arm.forearm * math.cos(forearm)
        + arm.wrist_to_flange * math.cos(hand)
    )
    z = (
        arm.shoulder_height
        + arm.upper_arm * math.sin(joints.shoulder)
        + arm.forearm * math.sin(forearm)
        + arm.wrist_to_flange * math.sin(hand)
    )
    return -radius * math.sin(joints.waist), radius * math.cos(joints.waist), z


@st.composite
def held(draw: st.DrawFn) -> tuple[Point, float, JointAngles]:
    """Return a wrist position within the reach, its height and its joint angles."""
    height = draw(heights)
    reach = reach_at(ARM, height)
    radius = draw(st.floats(reach.inner, reach.outer))
    bearing = draw(st.floats(-reach.waist_max, reach.waist_max))
    wrist = Point(-radius * math.sin(bearing), radius * math.cos(bearing))
    joints = joint_angles(ARM, wrist, height)
    assume(joints is not None)
    assert joints is not None
    return wrist, height, joints


@given(held=held())
def test_the_joint_angles_bring_the_flange_where_it_is_to_be(
    held: tuple[Point, float, JointAngles],
) -> None:
    wrist, height, joints = held
    assert wrist_position(ARM, joints) == pytest.approx((*wrist, height), abs=1e-9)


@given(
    waist=st.floats(-math.radians(ARM.waist_max_degrees), math.radians(ARM.waist_max_degrees)),
    shoulder=st.floats(
        math.radians(ARM.shoulder_min_degrees) + EDGE, math.radians(ARM.shoulder_max_degrees) - EDGE
    ),
    elbow=st.floats(0.01, math.radians(ARM.elbow_max_degrees) - EDGE),
)
def test_joint_angles_with_a_vertical_hand_are_found_again_from_the_flange(
    waist: float, shoulder: float, elbow: float
) -> None:
    joints = JointAngles(waist, shoulder, elbow, math.pi / 2 + shoulder - elbow, -waist)
    assume(abs(joints.pitch) <= WRIST_PITCH_MAX - EDGE)
    x, y, z = wrist_position(ARM, joints)
    # Behind the shoulder the arm would have to reach over itself; no wrist position lies there.
    assume(-x * math.sin(waist) + y * math.cos(waist) > 0.01)
    found = joint_angles(ARM, Point(x, y), z)
    assert found is not None
    for name in ("waist", "shoulder", "elbow", "pitch", "roll"):
        assert getattr(found, name) == pytest.approx(getattr(joints, name), abs=1e-7)


@given(held=held())
def test_the_hand_points_straight_down_and_the_roll_undoes_the_waist(
    held: tuple[Point, float, JointAngles],
) -> None:
    _, _, joints = held
    assert joints.shoulder - joints.elbow - joints.pitch == pytest.approx(-math.pi / 2)
    assert joints.roll == -joints.waist


@given(held=held())
def test_no_joint_goes_beyond_its_limits(held: tuple[Point, float, JointAngles]) -> None:
    _, _, joints = held
    slack = 1e-9
    assert 0.0 <= joints.elbow <= math.radians(ARM.elbow_max_degrees) + slack
    assert joints.shoulder >= math.radians(ARM.shoulder_min_degrees) - slack
    assert joints.shoulder <= math.radians(ARM.shoulder_max_degrees) + slack
    assert abs(joints.pitch) <= WRIST_PITCH_MAX + slack
    assert abs(joints.waist) <= math.radians(ARM.waist_max_degrees) + slack


@given(wrist=wrists, height=heights)
def test_the_reach_is_exactly_where_joint_angles_exist(wrist: Point, height: float) -> None:
    reach = reach_at(ARM, height)
    radius, bearing = math.hypot(*wrist), abs(math.atan2(-wrist.x, wrist.y))
    edges = (radius - reach.inner, radius - reach.outer, bearing - reach.waist_max)
    assume(min(map(abs, edges)) > EDGE)
    assert reach.holds(wrist) == (joint_angles(ARM, wrist, height) is not None)


@pytest.mark.parametrize("height", [LOW, HIGH])
def test_the_edges_of_the_reach_can_be_held(height: float) -> None:
    reach = reach_at(ARM, height)
    for radius in (reach.inner, reach.outer):
        assert joint_angles(ARM, Point(0.0, radius), height) is not None
        outside = radius + math.copysign(1e-6, radius - reach.inner - 1e-9)
        assert joint_angles(ARM, Point(0.0, outside), height) is None


def test_a_vertical_wrist_reaches_at_most_twenty_inches() -> None:
    """Two links of 10 in; with the wrist joint 4 in over the table 19.1 in (facts of the arm)."""
    assert all(reach_at(ARM, height).outer <= 20.0 for height in (LOW, HIGH))
    assert reach_at(ARM, 4.0 - ARM.wrist_to_flange).outer == pytest.approx(19.08, abs=0.01)


def test_every_start_of_the_puck_lies_beyond_the_bare_arms_reach() -> None:
    """The flange cannot even come to the near edge of the puck."""
    for start in start_positions(WORKSPACE.layout).values():
        assert math.hypot(*start) - RADIUS > reach_at(ARM, LOW).outer
        assert joint_angles(ARM, start, LOW) is None


@pytest.mark.parametrize("height", [LOW, HIGH])
def test_the_tool_can_be_held_where_it_lies_at_the_start_of_a_trial(height: float) -> None:
    start = Point(0.0, WORKSPACE.wrist_start.y)
    assert reach_at(ARM, height).holds(start)


def test_a_shoulder_that_is_too_high_is_an_error_that_names_it() -> None:
    with pytest.raises(BadInputError, match="shoulder_height"):
        reach_at(replace(ARM, shoulder_height=40.0), LOW)


def test_joint_limits_that_leave_no_reach_are_an_error_that_names_them() -> None:
    with pytest.raises(BadInputError, match="elbow_max_degrees"):
        reach_at(ArmGeometry(shoulder_min_degrees=100.0, shoulder_max_degrees=101.0), LOW)
