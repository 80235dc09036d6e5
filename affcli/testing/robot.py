"""What every robot must keep to."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from affcli.behaviors.positioning import position_wrist
from affcli.core.behavior import BehaviorCall, BehaviorName, Execution, ExecutionStatus
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.ports import Robot, Sensor
from affcli.errors import BadInputError

NO_SUCH = BehaviorCall.of(BehaviorName("stand on its head"), {})
TICK = 1e-9
"""Within this two robot times are one (s)."""


class RobotContract:
    """A robot executes behaviors to their ends, and its clock runs meanwhile.

    A subclass gives the fixtures `robot`, which has executed nothing, `sensor`, through which it
    sees, `binding` and `other_binding`, and `exploratory`, what it can try.

    Attributes:
        hair: how far a wrist may lie from where it was asked to be (in).
    """

    hair = 0.01

    @pytest.fixture
    def seen(self, sensor: Sensor) -> Observation:
        """What is seen before anything was executed."""
        return sensor.observe()

    @pytest.fixture
    def within_reach(self, robot: Robot, seen: Observation) -> list[Point]:
        """Offsets that the wrist can be asked for, by what is seen."""
        grid = [Point(0.5 * x, 0.5 * y) for y in range(10, 44) for x in range(-16, 17)]
        found = [at for at in grid if reaches(robot, seen.wrist_for(at))]
        assert found, "the arm must reach some wrist position near the attractor"
        return found[:: max(1, len(found) // 12)]

    def test_it_begins_with_empty_hands(self, robot: Robot) -> None:
        assert robot.holding is None
        assert robot.clock >= 0.0
        assert all(map(math.isfinite, robot.wrist))

    def test_binding_takes_the_tool_and_time(self, robot: Robot, binding: BehaviorCall) -> None:
        done = executed(robot, binding, None)
        assert done.status is ExecutionStatus.DONE
        assert robot.holding == binding

    def test_grasping_the_tool_anew_costs_time(
        self, robot: Robot, binding: BehaviorCall, other_binding: BehaviorCall, seen: Observation
    ) -> None:
        executed(robot, binding, None)
        assert executed(robot, other_binding, seen).duration > 0.0
        assert robot.holding == other_binding
        assert executed(robot, binding, seen).duration > 0.0
        assert robot.holding == binding

    def test_every_behavior_ends_where_and_when_it_says(
        self,
        robot: Robot,
        binding: BehaviorCall,
        exploratory: Sequence[BehaviorCall],
        sensor: Sensor,
    ) -> None:
        executed(robot, binding, None)
        for call in exploratory:
            executed(robot, call, sensor.observe())
        assert robot.holding == binding

    def test_position_wrist_goes_where_the_arm_reaches(
        self, robot: Robot, binding: BehaviorCall, sensor: Sensor, within_reach: list[Point]
    ) -> None:
        executed(robot, binding, None)
        for offset in within_reach:
            seen = sensor.observe()
            asked = seen.wrist_for(offset)
            if not reaches(robot, asked):
                continue
            done = executed(robot, position_wrist(offset), seen)
            assert done.status in (ExecutionStatus.DONE, ExecutionStatus.BLOCKED)
            assert math.dist(robot.wrist.point, asked) < self.hair
            assert robot.wrist.angle == 0.0

    def test_position_wrist_turns_the_wrist_as_asked(
        self, robot: Robot, binding: BehaviorCall, seen: Observation, within_reach: list[Point]
    ) -> None:
        executed(robot, binding, None)
        executed(robot, position_wrist(within_reach[0], 0.5), seen)
        assert math.isclose(robot.wrist.angle, 0.5)

    def test_out_of_reach_the_wrist_stays(
        self, robot: Robot, binding: BehaviorCall, seen: Observation
    ) -> None:
        executed(robot, binding, None)
        before, far = robot.wrist, Point(0.0, -900.0)
        assert not reaches(robot, seen.wrist_for(far))
        done = executed(robot, position_wrist(far), seen)
        assert done.status is ExecutionStatus.OUT_OF_REACH
        assert robot.wrist == before

    def test_a_behavior_that_it_does_not_have_changes_nothing(
        self, robot: Robot, binding: BehaviorCall, seen: Observation
    ) -> None:
        executed(robot, binding, None)
        before = robot.clock, robot.wrist, robot.holding
        with pytest.raises(BadInputError):
            robot.execute(NO_SUCH, seen)
        assert (robot.clock, robot.wrist, robot.holding) == before

    def test_asking_takes_no_time_and_changes_nothing(self, robot: Robot, sensor: Sensor) -> None:
        before = robot.clock, robot.wrist, robot.holding
        x, y = np.linspace(-30.0, 30.0, 60), np.linspace(30.0, -5.0, 60)
        given = x.copy(), y.copy()
        answers = robot.reaches(x, y)
        assert answers.dtype == np.bool_
        assert answers.shape == (60,)
        assert np.array_equal(given, (x, y)), "what is asked about must stay as it is"
        assert np.array_equal(robot.reaches(x, y), answers)
        assert [reaches(robot, Point(*at)) for at in zip(x.tolist(), y.tolist(), strict=True)] == (
            answers.tolist()
        )
        sensor.observe()
        assert (robot.clock, robot.wrist, robot.holding) == before


def reaches(robot: Robot, wrist: Point) -> bool:
    """Tell whether the arm reaches one wrist position."""
    return bool(robot.reaches(np.array([wrist.x]), np.array([wrist.y]))[0])


def executed(robot: Robot, call: BehaviorCall, seen: Observation | None) -> Execution:
    """Execute one behavior, and check what the robot says of it against wrist and clock."""
    clock, wrist = robot.clock, robot.wrist
    done = robot.execute(call, seen)
    assert done.call == call
    assert isinstance(done.status, ExecutionStatus)
    assert (done.wrist_start, done.wrist_end) == (wrist, robot.wrist)
    assert done.duration >= 0.0
    assert math.isclose(robot.clock - clock, done.duration, abs_tol=TICK)
    return done
