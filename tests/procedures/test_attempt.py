"""One use of a row, with the row's own hold and wrist angle (§3.2, §5.1)."""

import math

import pytest

from affcli.behaviors.grasping import grasp
from affcli.behaviors.positioning import position_wrist
from affcli.core.behavior import POSITION_WRIST, BehaviorCall, ExecutionStatus
from affcli.core.geometry import Point, Pose
from affcli.core.workspace import ToolGeometry
from affcli.procedures.attempt import attempt
from tests.factories import BINDING, EXACT, affordance, setting_with
from tests.fakes import CALL_SECONDS, FakeRobot, FakeSensor, FakeTable

OTHER = BehaviorCall.of(BINDING.name, {"grasp_point": 3.0})
BLOCKED = ExecutionStatus.BLOCKED


def holding(binding: BehaviorCall, **scripts: object) -> FakeRobot:
    """Return a robot that has grasped its tool; its behaviors move the attractor ahead."""
    robot = FakeRobot(FakeTable(), effect=lambda call: (0.0, 5.0), **scripts)  # type: ignore[arg-type]
    robot.execute(binding, None)
    return robot


def test_a_row_of_the_present_hold_is_used_without_a_grasp() -> None:
    robot = holding(BINDING)
    row = affordance()
    use = attempt(robot, sensor := FakeSensor(robot.table), row, sensor.observe())
    offset = row.start.wrist_to_object
    assert robot.calls[1:] == [position_wrist(offset), row.exploratory]
    assert not use.regrasped
    assert use.replicated


def test_a_row_of_another_hold_is_grasped_anew_first_and_once() -> None:
    robot = holding(BINDING)
    sensor = FakeSensor(robot.table)
    row = affordance(binding=OTHER)
    first, second = (attempt(robot, sensor, row, sensor.observe()) for _ in range(2))
    assert [call.name for call in robot.calls[1:]] == [
        *(OTHER.name, POSITION_WRIST, row.exploratory.name),
        *(POSITION_WRIST, row.exploratory.name),
    ]
    assert (first.regrasped, second.regrasped) == (True, False)
    assert robot.holding == OTHER
    assert robot.clock == CALL_SECONDS * (1 + 3 + 2)
    back = attempt(robot, sensor, affordance(), sensor.observe())
    assert back.regrasped
    assert robot.holding == BINDING


def test_a_row_is_used_at_its_own_wrist_angle() -> None:
    """The wrist is turned as it was when the row was made, and turned back for the next."""
    robot = holding(BINDING)
    sensor = FakeSensor(robot.table)
    for angle in (0.5, 0.0):
        use = attempt(robot, sensor, affordance(wrist_angle=angle), sensor.observe())
        assert use.execution is not None
        assert use.execution.wrist_start.angle == pytest.approx(angle)


def test_a_blocked_placing_after_a_grasp_is_a_failure_that_tells_of_the_grasp() -> None:
    robot = holding(BINDING, placings=[BLOCKED])
    sensor = FakeSensor(robot.table)
    use = attempt(robot, sensor, affordance(binding=OTHER), sensor.observe())
    assert use.regrasped
    assert use.execution is None
    assert not use.replicated


@pytest.mark.parametrize(("angle", "replicates"), [(10.0, False), (50.0, True), (180.0, True)])
def test_the_planner_s_angle_decides_what_replicates(angle: float, replicates: bool) -> None:
    """45 degrees lie between what the row expects and what is seen."""
    robot = holding(BINDING)
    sensor = FakeSensor(robot.table)
    row = affordance(moved=(3.0, 3.0))
    use = attempt(robot, sensor, row, sensor.observe(), angle_degrees=angle)
    assert use.replicated is replicates


@pytest.mark.parametrize(("threshold", "died"), [(0.3, False), (0.5, True), (0.7, True)])
def test_the_planner_s_threshold_decides_when_a_row_has_died(threshold: float, died: bool) -> None:
    robot = holding(BINDING, placings=[BLOCKED])
    sensor = FakeSensor(robot.table)
    use = attempt(robot, sensor, affordance(), sensor.observe(), threshold=threshold)
    assert (use.live, use.died) == (True, died)


def test_at_the_table_a_grasp_anew_takes_its_time_and_moves_the_tool_in_the_hand() -> None:
    setting = setting_with("t-stick", settings=EXACT)
    setting.table.attractor = Pose(0.0, 28.0)
    robot, timing = setting.robot, setting.table.workspace.motion
    robot.execute(setting.binding, None)
    assert robot.clock == timing.grasp_time
    row = affordance(binding=grasp(ToolGeometry(), grasp_point=3.0), offset=Point(0.0, 16.0))
    far = max(outline.bounds[3] for outline in setting.table.tool.outlines)
    use = attempt(robot, setting.sensor, row, setting.sensor.observe())
    assert use.regrasped
    assert use.execution is not None
    spent = use.placing.duration + use.execution.duration
    assert robot.clock == pytest.approx(timing.grasp_time + timing.regrasp_time + spent)
    assert max(outline.bounds[3] for outline in setting.table.tool.outlines) == far - 2.0
    gap = 16.0 - (far - 2.0) - setting.table.workspace.puck.radius
    assert math.isclose(use.seen.dy, 5.0 - gap, abs_tol=0.05)
