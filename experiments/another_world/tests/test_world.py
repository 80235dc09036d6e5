"""The world keeps affcli's contract; an episode ends where KinDER or the budget ends it."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from kinder_hook import schemas
from kinder_hook.episode import Episode
from kinder_hook.parts import NAME, hook, tasks
from kinder_hook.world import NO_EVALUATION, HookWorld

from affcli import registry
from affcli.config import load_settings
from affcli.core.behavior import POSITION_WRIST, BehaviorCall, ExecutionStatus
from affcli.core.specs import Counters, LearningSpec, Protocol, TrialSpec, VerificationSpec
from affcli.core.world import World
from affcli.errors import BadInputError
from affcli.lab.run_parts import RunParts
from affcli.testing.world import WorldContract


def make() -> HookWorld:
    return HookWorld(load_settings(None, ()), {NAME: lambda _: tasks(_, obstacles=0, first=7, n=2)})


@pytest.fixture(scope="module")
def learned() -> LearningSpec:
    settings = load_settings(None, ("sensor.kind=exact",))
    return RunParts.chosen(settings, world=NAME).spec(hook(None), 7, 0, None, 60)


@pytest.fixture(scope="module")
def trial(learned: LearningSpec) -> TrialSpec:
    planner, task = registry.component("planners", "lookahead"), make().tasks(NAME)[0]
    parts = (Protocol.EXTENSION_OF_REACH, NAME, learned.held, task, 0, 0, Counters.AS_LEARNED)
    return TrialSpec(*parts, planner, "exact", learned.world)


class TestHookWorld(WorldContract):
    @pytest.fixture
    def make_world(self) -> Callable[[], World]:
        return make

    @pytest.fixture
    def verification(self, learned: LearningSpec) -> VerificationSpec:
        return VerificationSpec(NAME, learned.held, 7, 0, "exact", 10, until_verdict=False)


@pytest.mark.parametrize("seed", range(8))
def test_the_hook_is_taken_and_held_upright(seed: int) -> None:
    episode = Episode(0, NO_EVALUATION + seed, 3000)
    assert schemas.take_hook(episode)
    assert episode.held
    assert abs(episode.wrist.angle - np.pi / 2) < 0.05
    assert episode.steps < 300


def test_nothing_is_done_once_the_steps_are_spent(learned: LearningSpec, trial: TrialSpec) -> None:
    setting = make().trial(trial, learned)
    episode = setting.robot.episode
    episode.budget = 30
    setting.robot.execute(learned.binding, None)
    assert (episode.steps, episode.over, episode.solved) == (30, True, False)
    seen = setting.sensor.observe()
    setting.robot.execute(learned.repertoire[0].call, seen)
    assert (episode.steps, setting.sensor.observe()) == (30, seen)
    assert setting.experimenter.attractor_out_of_reach()
    assert not setting.sensor.observe_goal().reached(seen)


def test_the_goal_is_where_the_block_touches_the_wall(
    learned: LearningSpec, trial: TrialSpec
) -> None:
    setting = make().trial(trial, learned)
    goal, block = setting.sensor.observe_goal(), setting.robot.episode.block
    assert goal.height == pytest.approx(17.75 + 10.0 * block.below)
    at = setting.sensor.observe().object_position
    down = np.array([0.0, goal.height - at.y, -20.0])
    away = goal.squared_distance(at, np.zeros(3), down)
    assert away == pytest.approx([(at.y - goal.height) ** 2, 0.0, 0.0])


def test_a_hook_that_would_come_down_on_the_block_stays_where_it_is(
    learned: LearningSpec, trial: TrialSpec
) -> None:
    setting = make().trial(trial, learned)
    setting.robot.execute(learned.binding, None)
    seen, clock = setting.sensor.observe(), setting.robot.clock
    onto = BehaviorCall.of(POSITION_WRIST, {"x": 0.0, "y": 12.0})
    assert setting.robot.execute(onto, seen).status is ExecutionStatus.BLOCKED
    assert setting.robot.clock == clock


def test_other_hooks_grasps_and_sensors_are_refused(learned: LearningSpec) -> None:
    binding = registry.binding("grasp:grasp_point=3", load_settings(None, ()).workspace.tools)
    for other in (replace(learned, sensor="noisy"), replace(learned, binding=binding)):
        with pytest.raises(BadInputError, match=NAME):
            make().learning(other)
