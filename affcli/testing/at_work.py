"""What tools, bindings, behaviors and tasks must keep to in the world in which they are used."""

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np
import pytest

from affcli.behaviors.positioning import position_wrist
from affcli.core.behavior import Execution, ExecutionStatus
from affcli.core.geometry import Point
from affcli.core.specs import LearningSpec, TrialSpec
from affcli.core.task import Task
from affcli.core.world import Setting, World

MakeWorld = Callable[[], World]
PLACES = 40
"""Places beside the tool that are tried before a behavior is done without the attractor."""


class AtWorkContract:
    """Each behavior is executed with the tool, ends in a status, and does the same again.

    A subclass gives the fixtures `make_world`, and `learned`, a run with what is to be tried.
    """

    def test_each_behavior_ends_in_a_status_and_does_the_same_again(
        self, make_world: MakeWorld, learned: LearningSpec
    ) -> None:
        first = list(self._done(make_world().learning(learned)))
        assert [one.call for one in first] == [behavior.call for behavior in learned.repertoire]
        assert {one.status for one in first} <= {ExecutionStatus.DONE, ExecutionStatus.TRUNCATED}
        for one in first:
            assert all(map(math.isfinite, (*one.wrist_end, one.duration)))
            assert one.duration > 0.0
        if make_world().exact_replay:
            assert list(self._done(make_world().learning(learned))) == first

    def test_the_tool_is_taken_as_the_binding_says(
        self, make_world: MakeWorld, learned: LearningSpec
    ) -> None:
        robot = make_world().learning(learned).robot
        assert robot.execute(learned.binding, None).status is ExecutionStatus.DONE
        assert robot.holding == learned.binding

    def _done(self, setting: Setting) -> Iterator[Execution]:
        """Yield what each behavior did, the wrist before the attractor where it can be."""
        robot, rng = setting.robot, np.random.default_rng(5)
        robot.execute(setting.binding, None)
        for call in setting.exploratory:
            setting.experimenter.put_attractor_back()
            for offset in rng.uniform((-7.0, 7.0), (7.0, 19.0), (PLACES, 2)).tolist():
                seen = setting.sensor.observe()
                placing = robot.execute(position_wrist(Point(*offset)), seen)
                if placing.status is ExecutionStatus.DONE:
                    break
            yield robot.execute(call, setting.sensor.observe())


class TasksContract:
    """Tasks have names of their own, begin off their goals, and can be laid out.

    A subclass gives the fixtures `tasks`, `make_world`, and `learned` and `trial`, specs of it.
    """

    def test_there_are_tasks_and_each_has_a_name_of_its_own(self, tasks: Sequence[Task]) -> None:
        assert tasks
        assert len({(task.goal.name, task.start_name) for task in tasks}) == len(tasks)

    def test_none_begins_over_its_goal(self, tasks: Sequence[Task]) -> None:
        for task in tasks:
            assert not task.goal.contains(task.start)

    @pytest.mark.parametrize("which", [0, -1])
    def test_they_can_be_laid_out(
        self,
        tasks: Sequence[Task],
        which: int,
        make_world: MakeWorld,
        learned: LearningSpec,
        make_trial: Callable[[Task], TrialSpec],
    ) -> None:
        setting = make_world().trial(make_trial(tasks[which]), learned)
        assert setting.sensor.observe_goal().name == tasks[which].goal.name
        seen = setting.sensor.observe()
        assert math.dist(seen.object_position, tasks[which].start) < 0.5
