"""The fakes of our own tests keep to the contracts of what they stand for."""

import math
from itertools import repeat

import pytest

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.core.ports import Experimenter, Robot, Sensor
from affcli.testing import examples
from affcli.testing.experimenter import ExperimenterContract
from affcli.testing.explorer import ExplorerContract, MakeExplorer
from affcli.testing.robot import RobotContract
from affcli.testing.sensor import SensorContract
from tests.factories import BINDING, goal_at
from tests.fakes import FakeExperimenter, FakeExplorer, FakeRobot, FakeSensor, FakeTable


class OnTheFakeTable:
    @pytest.fixture
    def table(self) -> FakeTable:
        return FakeTable()

    @pytest.fixture
    def robot(self, table: FakeTable) -> Robot:
        return FakeRobot(
            table,
            effect=lambda call: (0.0, 1.0),
            reachable=lambda wrist: math.hypot(*wrist) < 20.0,
            repertoire=examples.CALLS,
        )

    @pytest.fixture
    def sensor(self, table: FakeTable) -> Sensor:
        return FakeSensor(table)

    @pytest.fixture
    def binding(self) -> BehaviorCall:
        return BINDING


class TestFakeRobot(OnTheFakeTable, RobotContract):
    @pytest.fixture
    def other_binding(self) -> BehaviorCall:
        return BehaviorCall.of(BINDING.name, {"grasp_point": 4.0})

    @pytest.fixture
    def exploratory(self) -> tuple[BehaviorCall, ...]:
        return examples.CALLS


class TestFakeSensor(SensorContract):
    @pytest.fixture
    def sensor(self) -> Sensor:
        return FakeSensor(FakeTable(goal=goal_at(0.0, 30.0)))

    @pytest.fixture
    def sensor_without_goal(self) -> Sensor:
        return FakeSensor(FakeTable())


class TestFakeExperimenter(OnTheFakeTable, ExperimenterContract):
    @pytest.fixture
    def experimenter(self, table: FakeTable) -> Experimenter:
        return FakeExperimenter(table, lost=lambda at: at.y > 40.0, places=repeat(Point(0.0, 22.0)))

    @pytest.fixture
    def row(self) -> Affordance:
        return examples.rows(3)[0]


class TestFakeExplorer(ExplorerContract):
    @pytest.fixture
    def make_explorer(self) -> MakeExplorer:
        return lambda rng: FakeExplorer([(0.0, 8.0), (1.0, 9.0)], examples.CALLS[0])
