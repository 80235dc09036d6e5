"""The suites of each kind for one part: ``affcli check --part`` (`affcli.testing.serving`)."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from affcli import registry
from affcli.config import Settings
from affcli.core.affordance import Affordance
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall
from affcli.core.identity import Component, canonical_json
from affcli.core.part import Part
from affcli.core.ports import Experimenter, Planner, Robot, Sensor
from affcli.core.specs import Counters, LearningSpec, Protocol, TrialSpec, VerificationSpec
from affcli.core.task import Task
from affcli.core.world import Setting, World
from affcli.exploration.random_babbling import RandomBabbling
from affcli.procedures.babbling import BabblingState, babble
from affcli.testing import examples
from affcli.testing.at_work import AtWorkContract, TasksContract
from affcli.testing.experimenter import ExperimenterContract
from affcli.testing.explorer import ExplorerContract, MakeExplorer
from affcli.testing.part import PartContract
from affcli.testing.planner import PlannerContract
from affcli.testing.robot import RobotContract
from affcli.testing.sensor import SensorContract
from affcli.testing.world import WorldContract

SETTINGS = Settings()
GEOMETRY = SETTINGS.workspace.tools


def learning(**other: Any) -> LearningSpec:
    """Return the spec of a short run of the paper's, but for what is said."""
    usual = registry.DEFAULTS
    return LearningSpec(
        **{
            "settings": canonical_json(SETTINGS.differing()),
            "world": registry.component("worlds", usual["world"]),
            "repertoire": registry.repertoire([usual["repertoire"]]),
            "binding": registry.binding(usual["binding"], GEOMETRY),
            "explorer": registry.component("explorers", usual["explorer"]),
            "sensor": SETTINGS.sensor.kind,
            "held": registry.tool("t-hook", GEOMETRY),
            "seed": 0,
            "robot": 0,
            "hours": None,
            "behaviors": 20,
            **other,
        }
    )


def trial_of(learned: LearningSpec, task: Task) -> TrialSpec:
    """Return the spec of a trial."""
    planner = registry.component("planners", registry.DEFAULTS["planner"])
    return TrialSpec(
        *(Protocol.EXTENSION_OF_REACH, learned.tool, learned.held, task, 0, 0),
        *(Counters.AS_LEARNED, planner, learned.sensor, learned.world),
    )


class TestPart(PartContract):
    """The part says what it is."""


class TestPlanner(PlannerContract):
    """The part is a planner."""

    @pytest.fixture
    def planner(self, build: Callable[..., Any]) -> Planner:
        """It, with its parameters."""
        made: Planner = build()
        return made


class TestExplorer(ExplorerContract):
    """The part is an explorer."""

    @pytest.fixture
    def make_explorer(self, build: Callable[..., Any]) -> MakeExplorer:
        """What makes it."""
        return lambda rng: build(examples.CALLS, BabblingSettings(draws=8), rng)


class AtTheTable:
    """The paper's table."""

    @pytest.fixture
    def make_world(self) -> Callable[[], World]:
        """What makes a table."""
        return lambda: registry.world(learning().world, SETTINGS)


class TestTool(AtTheTable, AtWorkContract):
    """The part is a tool."""

    @pytest.fixture
    def learned(self, build: Callable[..., Any], part: Part) -> LearningSpec:
        """A run with it; it has the name of its part, and no colour of ours."""
        held = build(GEOMETRY)
        assert held.name == part.name
        if part.package:
            registry.require_own_tool(held, GEOMETRY, part.name)
        return learning(held=held)


class TestBinding(AtTheTable, AtWorkContract):
    """The part is a binding."""

    @pytest.fixture
    def learned(self, part: Part) -> LearningSpec:
        """A run with it; what is not given, the sizes decide."""
        return learning(binding=part.build(GEOMETRY))


class TestBehaviors(AtTheTable, AtWorkContract):
    """The part is one behavior or several."""

    @pytest.fixture
    def learned(self, build: Callable[..., Any]) -> LearningSpec:
        """A run with them."""
        return learning(repertoire=tuple(build()))


class TestTasks(AtTheTable, TasksContract):
    """The part is a set of tasks."""

    @pytest.fixture
    def tasks(self, build: Callable[..., Any]) -> tuple[Task, ...]:
        """All of them."""
        return tuple(build(SETTINGS.workspace))

    @pytest.fixture
    def learned(self) -> LearningSpec:
        """A run of the paper's."""
        return learning()

    @pytest.fixture
    def make_trial(self, learned: LearningSpec) -> Callable[[Task], TrialSpec]:
        """What makes a trial of a task."""
        return lambda task: trial_of(learned, task)


class TestOwnSensor(AtTheTable, SensorContract):
    """The part is a sensor; one of ours is made with the table."""

    @pytest.fixture
    def look_through(self, build: Callable[..., Any], part: Part) -> Callable[[Setting], Sensor]:
        """What makes it for a world that was laid out."""

        def through(setting: Setting) -> Sensor:
            if not part.package:
                return setting.sensor
            rng, tool = np.random.default_rng(3), learning().held
            made: Sensor = build(setting.scene, rng, SETTINGS.workspace, tool)
            return made

        return through

    @pytest.fixture
    def learned(self, part: Part) -> LearningSpec:
        """A run of the paper's; seen through a sensor of ours."""
        return learning() if part.package else learning(sensor=part.name)

    @pytest.fixture
    def sensor(
        self,
        look_through: Callable[[Setting], Sensor],
        make_world: Callable[[], World],
        learned: LearningSpec,
    ) -> Sensor:
        """That of a trial."""
        world = make_world()
        task = world.tasks(registry.DEFAULTS["task"])[0]
        return look_through(world.trial(trial_of(learned, task), learned))

    @pytest.fixture
    def sensor_without_goal(
        self,
        look_through: Callable[[Setting], Sensor],
        make_world: Callable[[], World],
        learned: LearningSpec,
    ) -> Sensor:
        """That of learning."""
        return look_through(make_world().learning(learned))


class OfTheWorld:
    """The part is a world."""

    @pytest.fixture
    def make_world(self, build: Callable[..., Any]) -> Callable[[], World]:
        """What makes it."""
        return lambda: build(SETTINGS, registry.TaskSets())

    @pytest.fixture
    def learned(self, part: Part) -> LearningSpec:
        """A run in it."""
        return learning(world=Component(part.name, (), part.version, part.package))

    @pytest.fixture
    def trial(self, learned: LearningSpec, make_world: Callable[[], World]) -> TrialSpec:
        """A trial in it."""
        return trial_of(learned, make_world().tasks(registry.DEFAULTS["task"])[0])


class TestWorld(OfTheWorld, WorldContract):
    """It keeps the contract of a world."""

    @pytest.fixture
    def verification(self, learned: LearningSpec) -> VerificationSpec:
        """A verification in it."""
        own = (learned.tool, learned.held, 0, 0, learned.sensor)
        return VerificationSpec(*own, tries=20, until_verdict=False)


class Inside(OfTheWorld):
    """What procedures meet in it."""

    @pytest.fixture
    def setting(self, make_world: Callable[[], World], learned: LearningSpec) -> Setting:
        """It, laid out for learning."""
        return make_world().learning(learned)

    @pytest.fixture
    def robot(self, setting: Setting) -> Robot:
        """Its robot."""
        return setting.robot

    @pytest.fixture
    def sensor(self, setting: Setting) -> Sensor:
        """Its sensor."""
        return setting.sensor

    @pytest.fixture
    def binding(self, setting: Setting) -> BehaviorCall:
        """How its robot takes the tool."""
        return setting.binding


class TestRobot(Inside, RobotContract):
    """Its robot keeps the contract of a robot."""

    @pytest.fixture
    def other_binding(self) -> BehaviorCall:
        """Another grasp."""
        return registry.binding("grasp:grasp_point=3,angle=90", GEOMETRY)

    @pytest.fixture
    def exploratory(self, setting: Setting) -> tuple[BehaviorCall, ...]:
        """What it can try."""
        return tuple(setting.exploratory)


class TestSensor(Inside, SensorContract):
    """Its sensor keeps the contract of a sensor."""

    @pytest.fixture
    def sensor(
        self, make_world: Callable[[], World], learned: LearningSpec, trial: TrialSpec
    ) -> Sensor:
        """That of a trial."""
        return make_world().trial(trial, learned).sensor

    @pytest.fixture
    def sensor_without_goal(self, setting: Setting) -> Sensor:
        """That of learning."""
        return setting.sensor


class TestExperimenter(Inside, ExperimenterContract):
    """Its experimenter keeps the contract of one."""

    @pytest.fixture
    def experimenter(self, setting: Setting) -> Experimenter:
        """Its experimenter."""
        return setting.experimenter

    @pytest.fixture
    def row(self, make_world: Callable[[], World], learned: LearningSpec) -> Affordance:
        """The first row that a robot learns there."""
        setting = make_world().learning(replace(learned, seed=learned.seed))
        explorer = RandomBabbling(setting.exploratory, BabblingSettings(), setting.choices)
        meets = (setting.robot, setting.sensor, setting.experimenter, setting.binding)
        steps = babble(*meets, explorer, BabblingState())
        return next(step.affordance for step in steps if step.affordance is not None)
