"""Parts that break their contracts, each in one way; the suites must find each of them.

This file is run as tests by `test_suites.py`, for which every test class names what must fail.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
import pytest
from numpy.typing import NDArray

from affcli.config import Settings
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import GRASP, BehaviorCall, Execution
from affcli.core.choice import Choice, Reaches, Situation
from affcli.core.geometry import Point
from affcli.core.goal import Goal
from affcli.core.observation import Observation
from affcli.core.ports import Planner, Robot, Sensor
from affcli.core.specs import LearningSpec, TrialSpec, VerificationSpec
from affcli.core.task import GoalRegion
from affcli.core.trial import BabblingRecord
from affcli.core.world import Film, World
from affcli.exploration.random_babbling import RandomBabbling
from affcli.planning.nested_query import NestedQuery
from affcli.simulation.table_world import TableSetting, TableWorld
from affcli.testing import examples
from affcli.testing.explorer import ExplorerContract, MakeExplorer
from affcli.testing.goal import GoalContract
from affcli.testing.planner import PlannerContract
from affcli.testing.robot import RobotContract
from affcli.testing.sensor import SensorContract
from affcli.testing.world import WorldContract
from tests.factories import BINDING, goal_at, learning_spec, trial_spec, verification_spec
from tests.fakes import FakeRobot, FakeSensor, FakeTable


class FirstRowPlanner(NestedQuery):
    """Takes the first row, whatever stands in it."""

    def choose(self, situation: Situation) -> Choice:
        return Choice(0, ())


class CountingPlanner(NestedQuery):
    """Counts a use when it chooses: the procedure's business."""

    def choose(self, situation: Situation) -> Choice:
        choice = super().choose(situation)
        if choice.position is not None:
            situation.table.count_use(choice.position, success=True)
        return choice


class RememberingPlanner(NestedQuery):
    """Stands where its wrist was when it was asked before."""

    asked: list[Situation]

    def __init__(self) -> None:
        super().__init__()
        object.__setattr__(self, "asked", [])

    def choose(self, situation: Situation) -> Choice:
        self.asked.append(situation)
        return super().choose(replace(situation, wrist=self.asked[-2:][0].wrist))


class ForgetfulExplorer(RandomBabbling):
    """Goes farther the more often it was told something, which its state does not say."""

    told: list[int]

    def __init__(self, rng: np.random.Generator) -> None:
        super().__init__(examples.CALLS, BabblingSettings(draws=8), rng)
        object.__setattr__(self, "told", [])

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        return super().places(seen, reaches) + len(self.told)

    def tell(self, record: BabblingRecord) -> None:
        self.told.append(record.step)


class GossipingExplorer(RandomBabbling):
    """Goes where any explorer was refused a place: explorers share what they remember."""

    refusals: ClassVar[list[Point]] = []

    def __init__(self, rng: np.random.Generator) -> None:
        super().__init__(examples.CALLS, BabblingSettings(draws=8), rng)

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        return super().places(seen, reaches) + len(self.refusals)

    def refused(self, place: Point) -> None:
        self.refusals.append(place)


class HoarderExplorer(RandomBabbling):
    """Writes down every record at length."""

    told: list[str]

    def __init__(self, rng: np.random.Generator) -> None:
        super().__init__(examples.CALLS, BabblingSettings(draws=8), rng)
        object.__setattr__(self, "told", [])

    def tell(self, record: BabblingRecord) -> None:
        self.told.append(repr(record))

    def state(self) -> dict[str, Any]:
        return {"version": 1, "told": self.told}

    def restore(self, state: Mapping[str, Any]) -> None:
        object.__setattr__(self, "told", list(state["told"]))


class CornerGoal(GoalRegion):
    """Takes distances to a corner."""

    def squared_distance(
        self, at: Point, dx: NDArray[np.float64], dy: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        return super().squared_distance(Point(at.x + self.half_width, at.y), dx, dy)


class QuickHands(FakeRobot):
    """Grasps anew in no time, reaches everywhere and has every behavior."""

    def execute(self, call: BehaviorCall, seen: Observation | None) -> Execution:
        regrasp = call.name == GRASP and self.holding is not None
        clock = self.clock
        done = super().execute(call, seen)
        if regrasp:
            self.clock = clock
            return replace(done, duration=0.0)
        return done


class DriftingSensor(FakeSensor):
    """Pushes the attractor away a little with each look, and sees goals where none are."""

    def observe(self) -> Observation:
        at = self.table.attractor
        self.table.attractor = Point(at.x + 0.3, at.y)
        return super().observe()

    def observe_goal(self) -> GoalRegion:
        return self.table.goal or goal_at(0.0, 0.0)


class SharedNoiseWorld(TableWorld):
    """All starts of a goal share their random streams."""

    def trial(self, spec: TrialSpec, learned: LearningSpec) -> TableSetting:
        setting = super().trial(replace(spec, task=replace(spec.task, start_name="1")), learned)
        setting.table.attractor = setting.table.attractor._replace(x=spec.task.start.x)
        return setting


class JudderingSetting(TableSetting):
    """Filming draws from the noise of the sensor; a snapshot forgets the clock."""

    def film(self, film: Film | None) -> bool:
        self.streams["noise"].random()
        return super().film(film)

    def snapshot(self) -> dict[str, Any]:
        return super().snapshot() | {"clock": 0.0}


class JudderingWorld(TableWorld):
    def learning(self, spec: LearningSpec, *, laid_out: bool = True) -> TableSetting:
        made = super().learning(spec, laid_out=laid_out)
        return JudderingSetting(**{name: getattr(made, name) for name in TableSetting.__slots__})


class Planners(PlannerContract):
    planner_class: type[NestedQuery]

    @pytest.fixture
    def planner(self) -> Planner:
        return self.planner_class()


class TestFirstRowPlanner(Planners):
    planner_class = FirstRowPlanner
    must_fail = frozenset(
        {
            "test_the_row_chosen_is_of_the_table_and_can_be_used",
            "test_without_a_row_that_can_be_used_none_is_chosen",
            "test_the_first_candidate_is_the_row_chosen",
        }
    )


class TestCountingPlanner(Planners):
    planner_class = CountingPlanner
    must_fail = frozenset({"test_the_table_is_left_as_it_is"})


class TestRememberingPlanner(Planners):
    planner_class = RememberingPlanner
    must_fail = frozenset({"test_equal_situations_give_equal_answers"})


class TestForgetfulExplorer(ExplorerContract):
    must_fail = frozenset({"test_all_that_it_remembers_is_in_its_state"})

    @pytest.fixture
    def make_explorer(self) -> MakeExplorer:
        return ForgetfulExplorer


class TestGossipingExplorer(ExplorerContract):
    must_fail = frozenset(
        {
            "test_the_same_stream_gives_the_same_choices",
            "test_all_that_it_remembers_is_in_its_state",
        }
    )

    @pytest.fixture
    def make_explorer(self) -> MakeExplorer:
        return GossipingExplorer


class TestHoarderExplorer(ExplorerContract):
    must_fail = frozenset(
        {"test_its_state_does_not_outgrow_a_database", "test_a_state_of_another_version_is_refused"}
    )

    @pytest.fixture
    def make_explorer(self) -> MakeExplorer:
        return HoarderExplorer


class TestCornerGoal(GoalContract):
    must_fail = frozenset({"test_distances_are_taken_to_its_centre"})

    @pytest.fixture
    def goal(self) -> Goal:
        return CornerGoal("a corner", Point(0.0, 20.0), 2.0)


class TestQuickHands(RobotContract):
    must_fail = frozenset(
        {
            "test_grasping_the_tool_anew_costs_time",
            "test_a_behavior_that_it_does_not_have_changes_nothing",
            "test_out_of_reach_the_wrist_stays",
        }
    )

    @pytest.fixture
    def robot(self) -> Robot:
        return QuickHands(FakeTable())

    @pytest.fixture
    def sensor(self, robot: QuickHands) -> Sensor:
        return FakeSensor(robot.table)

    @pytest.fixture
    def binding(self) -> BehaviorCall:
        return BINDING

    @pytest.fixture
    def other_binding(self) -> BehaviorCall:
        return BehaviorCall.of(GRASP, {"grasp_point": 4.0})

    @pytest.fixture
    def exploratory(self) -> tuple[BehaviorCall, ...]:
        return examples.CALLS


class TestDriftingSensor(SensorContract):
    must_fail = frozenset(
        {
            "test_looking_again_shows_the_same_but_for_noise",
            "test_without_a_goal_on_the_table_there_is_none_to_see",
        }
    )

    @pytest.fixture
    def sensor(self) -> Sensor:
        return DriftingSensor(FakeTable(goal=goal_at(0.0, 30.0)))

    @pytest.fixture
    def sensor_without_goal(self) -> Sensor:
        return DriftingSensor(FakeTable())


class Worlds(WorldContract):
    world_class: type[TableWorld]

    @pytest.fixture
    def make_world(self) -> Callable[[], World]:
        return lambda: self.world_class(Settings())

    @pytest.fixture
    def learned(self) -> LearningSpec:
        return learning_spec()

    @pytest.fixture
    def trial(self, learned: LearningSpec) -> TrialSpec:
        return trial_spec(learned)

    @pytest.fixture
    def verification(self, learned: LearningSpec) -> VerificationSpec:
        return verification_spec(learned)


class TestSharedNoiseWorld(Worlds):
    world_class = SharedNoiseWorld
    must_fail = frozenset({"test_each_goal_and_start_has_random_streams_of_its_own"})


class TestJudderingWorld(Worlds):
    world_class = JudderingWorld
    must_fail = frozenset(
        {
            "test_filming_changes_nothing",
            "test_from_a_snapshot_a_run_goes_on_as_if_it_had_not_stopped",
        }
    )
