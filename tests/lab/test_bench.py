"""One robot at one table, wired; and the random streams it lives by."""

from itertools import combinations

import numpy as np
import pytest
from affcli.lab.bench import LEARNING, Bench, missing_side, stable_number, tool_named
from affcli.simulation.world import World
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.config import Settings, settings_from
from affcli.core.behavior import EXTEND_ARM, BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.core.tool import TOOL_PARTS
from affcli.errors import DatabaseError
from tests.factories import bench_with, goal_at
from tests.lab.quick import EXACT

SETTINGS = Settings()
words = st.integers(0, 2**63 - 1)


def drawn(purpose: int, seed: int, robot: int, *words: int) -> dict[str, list[float]]:
    """Return the first numbers of each random stream of a bench."""
    world = World(SETTINGS.workspace, SETTINGS.physics)
    world.tool = tool_named(SETTINGS, "stick")
    streams = Bench.of(SETTINGS, world, purpose, seed, robot, *words).streams
    return {name: stream.random(4).tolist() for name, stream in streams.items()}


@settings(deadline=None, max_examples=30)
@given(st.lists(words, min_size=3, max_size=6))
def test_random_streams_depend_on_the_key_alone(key: list[int]) -> None:
    assert drawn(*key) == drawn(*key)


@settings(deadline=None, max_examples=30)
@given(words, words, st.integers(0, 4), st.integers(0, 1000))
def test_benches_of_another_key_have_other_streams(
    seed: int, tool: int, place: int, other: int
) -> None:
    key = [0, seed, 3, tool, 2]
    changed = [*key[:place], other, *key[place + 1 :]]
    if changed != key:
        one, two = drawn(*key), drawn(*changed)
        assert all(one[name] != two[name] for name in one)


def test_choices_noise_and_the_experimenters_hand_are_streams_of_their_own() -> None:
    """So that looking once more does not change what the robot chooses."""
    streams = drawn(0, 1, 2)
    assert set(streams) == {"choices", "noise", "hand"}
    assert all(streams[a] != streams[b] for a, b in combinations(streams, 2))


def test_no_two_robots_seeds_tools_or_trials_share_a_stream() -> None:
    keys = [
        (kind, seed, robot, stable_number(tool))
        for kind in (0, 1)
        for seed in (0, 1, 2**32, 2**32 + 1, 2**63 - 1)
        for robot in (0, 1, 2)
        for tool in TOOL_PARTS
    ]
    firsts = {tuple(np.random.SeedSequence(key).generate_state(4)) for key in keys}
    assert len(firsts) == len(keys)


def test_robot_sensor_and_experimenter_share_one_world() -> None:
    bench = bench_with("t-stick", settings=EXACT)
    world = bench.world
    bench.experimenter.lay_out_trial(world.tool, Point(0.0, 25.0), goal_at(0.0, 15.0))
    seen = bench.sensor.observe()
    assert seen.object_position == world.attractor.point == Point(0.0, 25.0)
    assert seen.wrist_to_object == (0.0, 25.0 - world.wrist.y)
    assert bench.robot.wrist == world.wrist
    assert bench.sensor.observe_goal() == world.goal == goal_at(0.0, 15.0)


def test_the_truth_of_a_behavior_is_where_the_attractor_was_before_and_after_it() -> None:
    bench = bench_with("t-stick")
    world = bench.world
    top = world.wrist.y + SETTINGS.workspace.tools.handle_length
    world.attractor = before = Pose(0.0, top + SETTINGS.workspace.puck.radius + 0.1, 0.25)
    bench.robot.execute(BehaviorCall.of(EXTEND_ARM, {"offset_distance": 1.0}), None)
    assert bench.truth() == (before, world.attractor)
    bench.robot.execute(bench.behaviors.binding, None)
    assert bench.truth() == (world.attractor, world.attractor)


def test_a_bench_keeps_no_memory_of_another_at_the_same_world() -> None:
    world = World(SETTINGS.workspace, SETTINGS.physics)
    world.tool = tool_named(SETTINGS, "stick")
    first = Bench.of(SETTINGS, world, LEARNING, 1, 0)
    first.robot.execute(first.behaviors.binding, None)
    second = Bench.of(SETTINGS, world, LEARNING, 1, 0)
    assert second.robot.clock == 0.0
    assert (
        second.streams["noise"].random()
        == Bench.of(SETTINGS, world, LEARNING, 1, 0).streams["noise"].random()
    )


@pytest.mark.parametrize("name", sorted(TOOL_PARTS))
def test_tools_are_found_by_name(name: str) -> None:
    assert tool_named(SETTINGS, name).name == name


def test_a_tool_that_is_not_there_is_an_error() -> None:
    with pytest.raises(KeyError, match="spoon"):
        tool_named(SETTINGS, "spoon")


def test_the_side_that_a_broken_tool_misses() -> None:
    """Fig. 9: "The two tools differ in their upper right sections"."""
    reach = SETTINGS.workspace.tools.bar_reach
    assert 0.0 < missing_side(SETTINGS, "t-hook", "l-hook") < reach
    assert missing_side(SETTINGS, "t-hook", "t-hook") == 0.0
    assert missing_side(SETTINGS, "t-hook", "stick") == pytest.approx(0.0)
    assert missing_side(SETTINGS, "l-hook", "stick") < 0.0


def test_the_number_of_a_name_is_the_same_everywhere_and_always() -> None:
    """Seeds are made of it: were it to change, every stored result would."""
    numbers = {name: stable_number(name) for name in ("stick", "t-hook", "")}
    assert numbers == {"stick": 2404638097, "t-hook": 1015380742, "": 3820012610}
    assert all(0 <= stable_number(name) < 2**32 for name in TOOL_PARTS)
    assert len({stable_number(name) for name in TOOL_PARTS}) == len(TOOL_PARTS)


def test_nothing_runs_with_a_setting_that_this_version_does_not_know() -> None:
    later = settings_from({"wings.span": 3.0})
    world = World(later.workspace, later.physics)
    with pytest.raises(DatabaseError, match=r"with wings\.span = 3; install the affcli that wrote"):
        Bench.of(later, world, LEARNING, 0, 0)
