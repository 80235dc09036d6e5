"""One robot at one table, wired; and the random streams it lives by."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.behaviors.moving import EXTEND_ARM
from affcli.behaviors.positioning import position_wrist
from affcli.config import Settings
from affcli.core.behavior import (
    BehaviorCall,
    BehaviorName,
    ExecutionStatus,
    ExploratoryBehavior,
)
from affcli.core.geometry import Point, Pose
from affcli.core.identity import stream_number
from affcli.core.motion import Carry, Segment, Slide, Wait
from affcli.core.observation import Observation
from affcli.core.records import StepScene
from affcli.core.scene import Scene
from affcli.core.specs import VerificationSpec
from affcli.simulation.table_world import TableSetting, TableWorld
from affcli.simulation.tools.paper import TOOL_PARTS
from tests.factories import (
    EXACT,
    learning_spec,
    seeds,
    setting_with,
    tool_named,
    trial_spec,
    verification_spec,
)

WORLD = TableWorld(Settings())
LEARNED = learning_spec()


def drawn(setting: TableSetting) -> dict[str, list[float]]:
    """Return the first numbers of each random stream of a setting."""
    return {name: stream.random(4).tolist() for name, stream in setting.streams.items()}


@given(seeds, st.integers(0, 1000))
def test_random_streams_depend_on_the_spec_alone(seed: int, robot: int) -> None:
    spec = learning_spec(seed=seed, robot=robot)
    assert drawn(WORLD.learning(spec)) == drawn(TableWorld(EXACT).learning(spec))


def test_whatever_differs_in_a_spec_gives_other_streams() -> None:
    """Seeds, robots, tools; what is held, the task; learning, trials, tests and predictions."""
    held, tested = tool_named("l-hook"), verification_spec(LEARNED)

    def verified(spec: VerificationSpec = tested, uses: int = 0) -> TableSetting:
        return WORLD.verification(spec, LEARNED, uses)

    found = [
        drawn(setting)
        for setting in (
            WORLD.learning(LEARNED),
            WORLD.learning(learning_spec(seed=2**63 - 1)),
            WORLD.learning(learning_spec(robot=1)),
            WORLD.learning(learning_spec("l-hook")),
            WORLD.trial(trial_spec(LEARNED), LEARNED),
            WORLD.trial(trial_spec(LEARNED, goal="2"), LEARNED),
            WORLD.trial(trial_spec(LEARNED, start="2"), LEARNED),
            WORLD.trial(trial_spec(LEARNED, held=held), LEARNED),
            WORLD.trial(trial_spec(LEARNED, seed=1), LEARNED),
            verified(),
            verified(uses=1),
            verified(replace(tested, seed=1)),
            verified(replace(tested, held=held)),
            WORLD.prediction(tested, LEARNED),
        )
    ]
    for one, other in combinations(found, 2):
        assert all(one[name] != other[name] for name in one)


def test_choices_noise_and_the_experimenters_hand_are_streams_of_their_own() -> None:
    """So that looking once more does not change what the robot chooses."""
    streams = drawn(WORLD.learning(LEARNED))
    assert set(streams) == {"choices", "noise", "hand"}
    assert all(streams[a] != streams[b] for a, b in combinations(streams, 2))


def test_the_planner_is_no_part_of_a_trials_streams() -> None:
    """So that planners are compared on equal trials."""
    spec = trial_spec(LEARNED)
    other = replace(spec, planner=replace(spec.planner, params=(("share", 0.05),)))
    assert drawn(WORLD.trial(spec, LEARNED)) == drawn(WORLD.trial(other, LEARNED))


def test_no_two_robots_seeds_tools_or_trials_share_a_stream() -> None:
    keys = [
        (kind, seed, robot, stream_number(tool))
        for kind in (0, 1)
        for seed in (0, 1, 2**32, 2**32 + 1, 2**63 - 1)
        for robot in (0, 1, 2)
        for tool in TOOL_PARTS
    ]
    firsts = {tuple(np.random.SeedSequence(key).generate_state(4)) for key in keys}
    assert len(firsts) == len(keys)


def test_the_number_of_a_name_is_the_same_everywhere_and_always() -> None:
    """Seeds are made of it: were it to change, every stored result would."""
    numbers = {name: stream_number(name) for name in ("stick", "t-hook", "")}
    assert numbers == {"stick": 2404638097, "t-hook": 1015380742, "": 3820012610}


def test_robot_sensor_and_experimenter_share_one_table() -> None:
    spec = trial_spec(LEARNED, goal="3", start="2")
    setting = TableWorld(EXACT).trial(spec, LEARNED)
    table = setting.table
    seen = setting.sensor.observe()
    assert seen.object_position == table.attractor.point == spec.task.start
    assert seen.wrist_to_object == (
        spec.task.start.x - table.wrist.x,
        spec.task.start.y - table.wrist.y,
    )
    assert setting.robot.wrist == table.wrist
    assert setting.sensor.observe_goal() == table.goal == spec.task.goal


def test_a_broken_tool_keeps_its_colour() -> None:
    """§7.2: "the robot was presented with a tool that has the same color ID as another tool with a
    different shape"."""
    left = tool_named("l-hook")
    setting = WORLD.trial(trial_spec(LEARNED, held=left), LEARNED)
    setting.robot.execute(setting.binding, None)
    held = setting.scene().tool
    assert (held.color, held.parts) == (LEARNED.held.color, left.parts)


def test_the_truth_of_a_behavior_is_where_the_attractor_was_before_and_after_it() -> None:
    setting = setting_with("t-stick")
    table, workspace = setting.table, Settings().workspace
    setting.robot.execute(setting.binding, None)
    top = table.wrist.y + workspace.tools.handle_length
    table.attractor = before = Pose(0.0, top + workspace.puck.radius + 0.1, 0.25)
    setting.robot.execute(BehaviorCall.of(EXTEND_ARM, {"offset_distance": 2.0}), None)
    assert setting.truth() == (before, table.attractor)
    assert before != table.attractor
    setting.robot.execute(setting.binding, None)
    assert setting.truth() == (table.attractor, table.attractor)


def test_a_setting_keeps_no_memory_of_the_one_before() -> None:
    world = TableWorld(Settings())
    first = world.learning(LEARNED)
    first.robot.execute(first.binding, None)
    first.table.attractor = Pose(1.0, 20.0)
    drawn(first)
    second, fresh = world.learning(LEARNED), TableWorld(Settings()).learning(LEARNED)
    assert (second.robot.clock, second.robot.holding) == (0.0, None)
    assert second.snapshot() == fresh.snapshot()


def test_tasks_are_those_of_a_set_that_the_table_has() -> None:
    assert len(WORLD.tasks("extension-of-reach")) == 16
    with pytest.raises(KeyError, match="juggling"):
        WORLD.tasks("juggling")


SWEEP = BehaviorCall.of(BehaviorName("sweep"), {})


def sweeping(*segments: Segment) -> TableSetting:
    """Return a setting in which the robot has a behavior of these segments, and its tool."""
    spec = replace(LEARNED, repertoire=(ExploratoryBehavior(SWEEP, segments),))
    setting = TableWorld(EXACT).learning(spec, laid_out=False)
    setting.robot.execute(setting.binding, None)
    setting.table.wrist, setting.table.attractor = Pose(1.0, 14.0), Pose(12.0, 30.0)
    return setting


def test_the_segments_of_a_behavior_are_executed_one_after_the_other() -> None:
    setting = sweeping(Slide(-2.0, 0.0), Carry(Pose(3.0, 15.0, 0.5)), Slide(0.0, 1.0), Wait(2.0))
    done = setting.robot.execute(SWEEP, None)
    assert done.status is ExecutionStatus.DONE
    assert (done.wrist_start, done.wrist_end) == (Pose(1.0, 14.0), Pose(3.0, 16.0, 0.5))


def test_after_a_segment_that_did_not_end_as_asked_only_time_goes_on() -> None:
    waited = 2.0
    setting = sweeping(Slide(0.0, 30.0), Carry(Pose(3.0, 15.0)), Slide(-1.0, 0.0), Wait(waited))
    done = setting.robot.execute(SWEEP, None)
    alone = sweeping(Slide(0.0, 30.0)).robot.execute(SWEEP, None)
    assert done.status is alone.status is ExecutionStatus.TRUNCATED
    assert done.wrist_end == alone.wrist_end
    assert done.duration == pytest.approx(alone.duration + waited)


@pytest.mark.parametrize("blocked", [False, True])
def test_a_step_done_again_looks_as_it_did(blocked: bool) -> None:
    """From where the wrist was before it, by way of where the row says, to where all ended."""
    setting = TableWorld(EXACT).trial(trial_spec(LEARNED, goal="2"), LEARNED)
    robot, table = setting.robot, setting.table
    robot.execute(setting.binding, None)
    table.wrist, table.attractor = Pose(6.0, 14.0), Pose(0.0, 20.0 if blocked else 31.0)
    before, push = table.wrist, BehaviorCall.of(EXTEND_ARM, {"offset_distance": 5.0})
    target = Point(0.0, 14.0)
    aim = Observation(*target, *[0.0] * 10)
    shown: list[Scene] = []
    setting.film(lambda clock, scene: shown.append(scene))
    start = table.attractor
    placed = robot.execute(position_wrist(Point(0.0, 0.0)), aim)
    assert (placed.status is ExecutionStatus.BLOCKED) is blocked
    if not blocked:
        robot.execute(push, aim)
    setting.film(None)
    step = StepScene(
        *("a step", (1, 1), LEARNED, LEARNED.tool, LEARNED.held),
        goal=table.goal,
        seed=0,
        robot=0,
        wrist_before=before,
        wrist_start=before if blocked else placed.wrist_end,
        wrist_end=table.wrist,
        attractor_start=start.point,
        attractor_end=table.attractor.point,
        binding=setting.binding,
        call=push,
        blocked=blocked,
    )
    again: list[Scene] = []
    assert TableWorld(EXACT).step_again(step, lambda clock, scene: again.append(scene))
    assert again == shown
    assert (again[0].wrist, again[0].goal) == (before, table.goal)
    assert again[-1].attractor == table.attractor


def test_a_snapshot_of_what_cannot_be_is_refused() -> None:
    setting = setting_with("stick")
    snapshot = setting.snapshot()
    for name in ("wrist", "attractor"):
        far = snapshot | {name: [0.0, 2e6, 0.0]}
        with pytest.raises(ValueError, match="nothing is that far from the table"):
            setting.restore(far)
