"""What every experimenter must keep to."""

import math

import numpy as np
import pytest

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.ports import Experimenter, Robot, Sensor


class ExperimenterContract:
    """An experimenter puts the attractor where it is wanted, while the robot's clock stands still.

    A subclass gives the fixtures `experimenter`, `robot` and `sensor` of one table, `binding`, and
    `row`, a row that was learned there.

    Attributes:
        hair: how far what is seen may lie from what is there (in).
    """

    hair = 0.1

    @pytest.fixture(autouse=True)
    def holding(self, robot: Robot, binding: BehaviorCall) -> None:
        """Have the robot take the tool."""
        robot.execute(binding, None)

    def test_looking_changes_nothing(self, experimenter: Experimenter, sensor: Sensor) -> None:
        before = sensor.observe().object_position
        answers = {experimenter.attractor_out_of_reach() for _ in range(3)}
        assert len(answers) == 1
        assert answers <= {True, False}
        assert math.dist(sensor.observe().object_position, before) < self.hair

    def test_the_attractor_is_put_back_within_reach_in_no_time(
        self, experimenter: Experimenter, robot: Robot
    ) -> None:
        for _ in range(5):
            before = robot.clock, robot.wrist
            experimenter.put_attractor_back()
            assert not experimenter.attractor_out_of_reach()
            assert (robot.clock, robot.wrist) == before

    def test_the_attractor_is_put_where_a_row_can_be_done_again(
        self, experimenter: Experimenter, robot: Robot, sensor: Sensor, row: Affordance
    ) -> None:
        for _ in range(5):
            clock = robot.clock
            experimenter.put_attractor_for(row)
            assert robot.clock == clock
            asked = sensor.observe().wrist_for(row.start.wrist_to_object)
            off = np.linspace(-self.hair, self.hair, 21)
            x, y = (axis.ravel() for axis in np.meshgrid(asked.x + off, asked.y + off))
            assert robot.reaches(x, y).any()
