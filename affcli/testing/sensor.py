"""What every sensor must keep to."""

import math

import pytest

from affcli.core.observation import Observation
from affcli.core.ports import Sensor


class SensorContract:
    """A sensor gives what is seen at this moment, and changes nothing.

    A subclass gives the fixtures `sensor`, with a goal on the table, and `sensor_without_goal`.

    Attributes:
        tolerance: how far two looks at the same may lie apart (in).
    """

    tolerance = 0.5

    def test_an_observation_is_twelve_finite_numbers(self, sensor: Sensor) -> None:
        seen = sensor.observe()
        assert isinstance(seen, Observation)
        assert all(math.isfinite(value) for value in seen)
        assert all(0.0 <= component <= 255.0 for component in seen.colors)

    def test_looking_again_shows_the_same_but_for_noise(self, sensor: Sensor) -> None:
        first = sensor.observe()
        for _ in range(5):
            sensor.observe_goal()
            seen = sensor.observe()
            assert math.dist(seen.object_position, first.object_position) < self.tolerance
            assert math.dist(seen.wrist, first.wrist) < self.tolerance

    def test_the_goal_is_one_and_the_same(self, sensor: Sensor) -> None:
        goals = [sensor.observe_goal() for _ in range(3)]
        assert len({goal.name for goal in goals}) == 1
        for goal in goals:
            assert math.dist(goal.center, goals[0].center) < self.tolerance

    def test_without_a_goal_on_the_table_there_is_none_to_see(
        self, sensor_without_goal: Sensor
    ) -> None:
        with pytest.raises(LookupError):
            sensor_without_goal.observe_goal()
        assert isinstance(sensor_without_goal.observe(), Observation)
