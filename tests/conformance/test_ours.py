"""The parts that affcli brings keep to the contracts of their ports."""

from collections.abc import Callable

import pytest

from affcli import registry
from affcli.behaviors.grasping import grasp
from affcli.config import Settings, settings_with
from affcli.core.affordance import Affordance
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall
from affcli.core.goal import Goal
from affcli.core.ports import Experimenter, Planner, Robot, Sensor
from affcli.core.specs import LearningSpec, TrialSpec, VerificationSpec
from affcli.core.workspace import ToolGeometry
from affcli.core.world import World
from affcli.exploration.inventing import Inventing, Limits
from affcli.exploration.random_babbling import RandomBabbling
from affcli.simulation.table_world import TableSetting, TableWorld
from affcli.testing import examples
from affcli.testing.experimenter import ExperimenterContract
from affcli.testing.explorer import ExplorerContract, MakeExplorer
from affcli.testing.goal import GoalContract
from affcli.testing.planner import PlannerContract
from affcli.testing.robot import RobotContract
from affcli.testing.sensor import SensorContract
from affcli.testing.world import WorldContract
from tests.factories import (
    goal_at,
    learning_spec,
    rows_learned,
    setting_with,
    trial_spec,
    verification_spec,
)

EXACT = settings_with({"sensor": {"kind": "exact"}}, "a test")
SENSORS = tuple(registry.parts("sensors"))


class TestPlanners(PlannerContract):
    @pytest.fixture(
        params=[
            *registry.parts("planners"),
            "nested-query:share=0.05",
            "nested-query:threshold=0,share=1",
        ]
    )
    def planner(self, request: pytest.FixtureRequest) -> Planner:
        return registry.planner(registry.component("planners", request.param))


class TestRandomBabbling(ExplorerContract):
    @pytest.fixture
    def make_explorer(self) -> MakeExplorer:
        return lambda rng: RandomBabbling(examples.CALLS, BabblingSettings(draws=8), rng)


class TestFocused(ExplorerContract):
    @pytest.fixture(params=sorted(registry.parts("explorers").keys() - {"random", "inventing"}))
    def make_explorer(self, request: pytest.FixtureRequest) -> MakeExplorer:
        part = registry.part("explorers", request.param)
        usual = {name: one.default for name, one in part.params.items()}
        return lambda rng: part.build(examples.CALLS, BabblingSettings(draws=8), rng, **usual)


class TestInventing(ExplorerContract):
    """In each of its three ways to go on, and of all that there is to go on from."""

    @pytest.fixture(params=[(30.0, 20.0), (0.1, 20.0), (0.1, 0.5)])
    def make_explorer(self, request: pytest.FixtureRequest) -> MakeExplorer:
        babbling, composing = request.param
        limits = Limits(babbling, composing, turn=45.0, slide=5.0, schemas=2, most=6)
        return lambda rng: Inventing(examples.CALLS, BabblingSettings(draws=8), rng, limits)


class TestGoalRegion(GoalContract):
    @pytest.fixture(params=[0.5, 2.25, 9.0])
    def goal(self, request: pytest.FixtureRequest) -> Goal:
        return goal_at(-3.0, 21.0, request.param)


class TestSensors(SensorContract):
    @pytest.fixture(params=SENSORS)
    def setting(self, request: pytest.FixtureRequest) -> TableSetting:
        settings = settings_with({"sensor": {"kind": request.param}}, "a test")
        setting = setting_with("l-stick", settings=settings)
        setting.table.attractor = setting.table.attractor._replace(x=5.0)
        return setting

    @pytest.fixture
    def sensor(self, setting: TableSetting) -> Sensor:
        setting.table.goal = goal_at(-6.0, 16.0)
        return setting.sensor

    @pytest.fixture
    def sensor_without_goal(self, setting: TableSetting) -> Sensor:
        return setting.sensor


class AtTheTable:
    """A robot at the table, its tool before it."""

    @pytest.fixture(params=["stick", "t-hook"])
    def setting(self, request: pytest.FixtureRequest) -> TableSetting:
        return TableWorld(EXACT).learning(learning_spec(request.param, settings=EXACT))

    @pytest.fixture
    def robot(self, setting: TableSetting) -> Robot:
        return setting.robot

    @pytest.fixture
    def sensor(self, setting: TableSetting) -> Sensor:
        return setting.sensor

    @pytest.fixture
    def binding(self, setting: TableSetting) -> BehaviorCall:
        return setting.binding


class TestSimulatedRobot(AtTheTable, RobotContract):
    @pytest.fixture
    def other_binding(self) -> BehaviorCall:
        return grasp(ToolGeometry(), grasp_point=3.0, angle=90.0)

    @pytest.fixture
    def exploratory(self, setting: TableSetting) -> tuple[BehaviorCall, ...]:
        return setting.exploratory


class TestSimulatedExperimenter(AtTheTable, ExperimenterContract):
    @pytest.fixture
    def experimenter(self, setting: TableSetting) -> Experimenter:
        return setting.experimenter

    @pytest.fixture(params=[0, 5, 9])
    def row(self, setting: TableSetting, request: pytest.FixtureRequest) -> Affordance:
        number: int = request.param
        return rows_learned(setting.table.tool.name, settings=EXACT)[number]


class TestTableWorld(WorldContract):
    @pytest.fixture(params=SENSORS)
    def settings(self, request: pytest.FixtureRequest) -> Settings:
        return settings_with({"sensor": {"kind": request.param}}, "a test")

    @pytest.fixture
    def make_world(self, settings: Settings) -> Callable[[], World]:
        return lambda: TableWorld(settings)

    @pytest.fixture
    def learned(self, settings: Settings) -> LearningSpec:
        return learning_spec(settings=settings)

    @pytest.fixture
    def trial(self, learned: LearningSpec) -> TrialSpec:
        return trial_spec(learned)

    @pytest.fixture
    def verification(self, learned: LearningSpec) -> VerificationSpec:
        return verification_spec(learned)
