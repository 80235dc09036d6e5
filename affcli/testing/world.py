"""What every world must keep to."""

import json
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib.metadata import version
from itertools import islice, pairwise
from typing import Any

import numpy as np
import pytest

from affcli.core.babbling_box import BabblingSettings
from affcli.core.scene import Scene
from affcli.core.specs import LearningSpec, LearningStep, RowStarts, TrialSpec, VerificationSpec
from affcli.core.trial import Truth
from affcli.core.world import Setting, World
from affcli.exploration.random_babbling import RandomBabbling
from affcli.procedures.babbling import BabblingState, babble
from affcli.testing.robot import TICK, executed

MakeWorld = Callable[[], World]
BEHAVIORS = 12
"""So many are enough for the attractor to be moved and put back."""


class WorldContract:
    """A world is laid out by specs, and equal specs give equal records.

    A subclass gives the fixtures `make_world`, a function that makes a world of its own each time
    it is called, and `learned`, `trial` and `verification`, specs of that world.

    Attributes:
        box: where the attractor may stand to the wrist.
        hair: how far what is seen may lie from what is there (in).
    """

    box = BabblingSettings()
    hair = 0.5

    @pytest.fixture
    def world(self, make_world: MakeWorld) -> World:
        """A world in which nothing has happened."""
        return make_world()

    def test_it_says_what_it_is(self, world: World, learned: LearningSpec) -> None:
        assert world.name == learned.world.name
        assert world.version == learned.world.version >= 1
        assert world.unit
        assert world.exact_replay in (True, False)
        assert all(version(package) for package in world.packages(learned.sensor))

    def test_its_tasks_have_names_of_their_own(self, world: World, trial: TrialSpec) -> None:
        tasks = world.tasks(trial.task.task_set)
        assert trial.task in tasks
        assert len({(task.goal.name, task.start_name) for task in tasks}) == len(tasks)
        assert {task.task_set for task in tasks} == {trial.task.task_set}
        with pytest.raises(KeyError):
            world.tasks("no such set")

    def test_a_run_offers_what_its_spec_carries(self, world: World, learned: LearningSpec) -> None:
        setting = world.learning(learned)
        assert setting.binding == learned.binding
        assert list(setting.exploratory) == [behavior.call for behavior in learned.repertoire]
        assert setting.robot.holding is None
        assert setting.robot.clock == 0.0
        with pytest.raises(LookupError):
            setting.sensor.observe_goal()

    def test_learning_twice_gives_the_same(
        self, make_world: MakeWorld, learned: LearningSpec, trial: TrialSpec
    ) -> None:
        """Also in a world that was used before."""
        world = make_world()
        if not world.exact_replay:
            pytest.skip("this world does not give the same twice")
        first = self._learn(world.learning(learned))
        world.trial(trial, learned).robot.execute(learned.binding, None)
        assert self._learn(world.learning(learned)) == first
        assert self._learn(make_world().learning(learned)) == first

    def test_another_robot_or_seed_learns_something_else(
        self, world: World, learned: LearningSpec
    ) -> None:
        others = (learned, replace(learned, robot=learned.robot + 1), replace(learned, seed=7_001))
        runs = [self._learn(world.learning(spec)) for spec in others]
        assert runs[0] != runs[1]
        assert runs[0] != runs[2]

    def test_truth_and_scene_tell_of_one_and_the_same(
        self, world: World, learned: LearningSpec
    ) -> None:
        setting = world.learning(learned)
        before = setting.scene()
        for _, truth in self._learn(setting):
            scene = setting.scene()
            assert (truth is None) is (scene is None) is (before is None)
        truth, scene = setting.truth(), setting.scene()
        if truth is not None and scene is not None:
            assert isinstance(truth, Truth)
            assert truth.end == scene.attractor
            assert scene.wrist == setting.robot.wrist

    def test_filming_changes_nothing(self, make_world: MakeWorld, learned: LearningSpec) -> None:
        setting = make_world().learning(learned)
        shown: list[tuple[float, Scene]] = []
        films = setting.film(lambda clock, scene: shown.append((clock, scene)))
        filmed = self._learn(setting)
        assert setting.film(None) is films
        assert bool(shown) is films
        clocks = [clock for clock, _ in shown]
        assert all(a <= b + TICK for a, b in pairwise(clocks))
        assert all(math.isfinite(c) for _, scene in shown for c in (*scene.attractor, *scene.wrist))
        frames = len(shown)
        setting.robot.execute(setting.exploratory[0], setting.sensor.observe())
        assert len(shown) == frames, "a film that was stopped must be shown no more"
        if make_world().exact_replay:
            assert self._learn(make_world().learning(learned)) == filmed

    @pytest.mark.parametrize("behaviors", [0, 1, 7])
    def test_from_a_snapshot_a_run_goes_on_as_if_it_had_not_stopped(
        self, make_world: MakeWorld, learned: LearningSpec, behaviors: int
    ) -> None:
        setting, state = make_world().learning(learned), BabblingState()
        self._learn(setting, behaviors, state)
        snapshot = setting.snapshot()
        if snapshot is None:
            pytest.skip("this world cannot be gone on with")
        resumed = make_world().learning(learned, laid_out=False)
        resumed.restore(json.loads(json.dumps(snapshot, allow_nan=False)))
        assert resumed.robot.clock == setting.robot.clock
        assert resumed.robot.wrist == setting.robot.wrist
        assert resumed.robot.holding == setting.robot.holding
        assert resumed.snapshot() == snapshot
        kept = replace(state)
        assert self._learn(resumed, 6, kept) == self._learn(setting, 6, state)

    @pytest.mark.parametrize("nonsense", [{}, {"clock": "late"}, {"what": None}])
    def test_what_is_no_snapshot_is_refused(
        self, world: World, learned: LearningSpec, nonsense: dict[str, Any]
    ) -> None:
        setting = world.learning(learned)
        if setting.snapshot() is None:
            pytest.skip("this world cannot be gone on with")
        with pytest.raises((ValueError, KeyError, TypeError)):
            setting.restore(nonsense)

    def test_a_trial_is_laid_out_by_its_task(
        self, make_world: MakeWorld, learned: LearningSpec, trial: TrialSpec
    ) -> None:
        for task in make_world().tasks(trial.task.task_set):
            setting = make_world().trial(replace(trial, task=task), learned)
            assert (setting.robot.clock, setting.robot.holding) == (0.0, None)
            assert setting.binding == learned.binding
            goal, seen = setting.sensor.observe_goal(), setting.sensor.observe()
            assert goal.name == task.goal.name
            assert math.dist(goal.center, task.goal.center) < self.hair
            assert math.dist(seen.object_position, task.start) < self.hair

    def test_each_goal_and_start_has_random_streams_of_its_own(
        self, world: World, learned: LearningSpec, trial: TrialSpec
    ) -> None:
        """Else the four starts of a goal would share the noise of what is seen."""
        tasks = world.tasks(trial.task.task_set)
        drawn = [self._drawn(world.trial(replace(trial, task=one), learned)) for one in tasks]
        assert len(set(drawn)) == len(tasks)
        if world.exact_replay:
            assert self._drawn(world.trial(replace(trial, task=tasks[0]), learned)) == drawn[0]

    def test_a_verification_has_no_goal_and_fresh_streams_after_each_use(
        self, world: World, learned: LearningSpec, verification: VerificationSpec
    ) -> None:
        laid_out = [
            world.verification(verification, learned, 0),
            world.verification(verification, learned, 5),
            world.prediction(verification, learned),
        ]
        assert len({self._drawn(setting) for setting in laid_out}) == 3
        for setting in (world.verification(verification, learned, 0), laid_out[2]):
            assert setting.robot.clock == 0.0
            with pytest.raises(LookupError):
                setting.sensor.observe_goal()

    def test_rows_can_be_done_again_in_a_verification(
        self, world: World, learned: LearningSpec, verification: VerificationSpec
    ) -> None:
        rows = [r.affordance for r, _ in self._learn(world.learning(learned), 60) if r.affordance]
        assert rows, "60 behaviors must make a row"
        setting = world.verification(verification, learned, 0)
        executed(setting.robot, setting.binding, None)
        for row in rows[:5]:
            setting.experimenter.put_attractor_for(row)
            executed(setting.robot, row.exploratory, setting.sensor.observe())

    def test_lost_rows_are_told_again_the_same(self, world: World, learned: LearningSpec) -> None:
        steps = [(r, t) for r, t in self._learn(world.learning(learned), 60) if r.affordance]
        starts: RowStarts = {r.step: (r.execution.wrist_start, t.start) for r, t in steps if t}
        lost = world.lost_rows(learned, learned.held, starts)
        if lost is None:
            return
        rows = [r.affordance for r, _ in steps if r.affordance]
        answers = [lost.lost(row) for row in rows]
        assert set(answers) <= {True, False}
        assert [lost.lost(row) for row in rows] == answers

    def _learn(
        self, setting: Setting, behaviors: int = BEHAVIORS, state: BabblingState | None = None
    ) -> list[LearningStep]:
        """Let a robot babble at random; return what came of it."""
        return list(islice(self._babbling(setting, state or BabblingState()), behaviors))

    def _babbling(self, setting: Setting, state: BabblingState) -> Iterator[LearningStep]:
        """Yield what each behavior gives, without end."""
        explorer = RandomBabbling(setting.exploratory, self.box, setting.choices)
        robot, sensor, hand = setting.robot, setting.sensor, setting.experimenter
        for record in babble(robot, sensor, hand, setting.binding, explorer, state):
            yield record, setting.truth()

    @staticmethod
    def _drawn(setting: Setting) -> float:
        """Return the first number that the robot's own choices draw."""
        assert isinstance(setting.choices, np.random.Generator)
        return float(setting.choices.random())
