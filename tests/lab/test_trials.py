"""Testing trials: the whole tool and the broken one (§7.1, §7.2)."""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise

import pytest
from affcli.lab.bench import tool_named
from affcli.simulation.world import World
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.config import Settings
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import CONTRACT_ARM, BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.core.observation import movement
from affcli.core.task import goal_regions, start_positions
from affcli.core.tool import ToolName, tool_outlines
from affcli.core.trial import Counters, Outcome, Protocol, TrialRecord, TrialSpec
from affcli.lab.trials import LostAffordances, run_trial, trial_specs, whole_trial
from affcli.simulation.arm import reach_at
from tests.factories import BINDING, bench_with
from tests.lab.quick import EXACT, Steps, counted, learned, spec_of, starts_of, table_from

SETTINGS = Settings()
WORKSPACE = SETTINGS.workspace
LAYOUT = WORKSPACE.layout
WHOLE, BROKEN = Protocol.EXTENSION_OF_REACH, Protocol.TOOL_ADAPTATION
goals, starts = st.integers(1, 4), st.integers(1, 4)
shapes = st.sampled_from(["t-hook", "l-hook", "stick"])


def spec(shape: str = "t-hook", goal: int = 1, start: int = 2, seed: int = 0) -> TrialSpec:
    protocol = WHOLE if shape == "t-hook" else BROKEN
    return TrialSpec(protocol, "t-hook", shape, goal, start, seed, 0, Counters.AS_LEARNED)


def fresh_world(of: Settings = SETTINGS) -> World:
    return World(of.workspace, of.physics)


def t_hook_steps(of: Settings = SETTINGS) -> Steps:
    return learned(spec_of("t-hook", 700, settings=of))


def t_hook_table(of: Settings = SETTINGS) -> AffordanceTable:
    return table_from(t_hook_steps(of))


def tried(shape: str, goal: int, start: int, of: Settings = SETTINGS) -> TrialRecord:
    return whole_trial(spec(shape, goal, start), of, t_hook_table(of), fresh_world(of))


@settings(deadline=None, max_examples=8)
@given(st.lists(st.tuples(shapes, goals, starts), min_size=1, max_size=4))
def test_a_world_shared_between_trials_gives_the_same_trials_as_fresh_ones(
    trials: list[tuple[str, int, int]],
) -> None:
    shared, table = fresh_world(), t_hook_table()
    for trial in trials:
        assert whole_trial(spec(*trial), SETTINGS, table, shared) == tried(*trial)


@settings(deadline=None, max_examples=10)
@given(shapes, goals, starts)
def test_a_trial_leaves_the_table_as_learned(shape: str, goal: int, start: int) -> None:
    """§7.2: "In each of these experiments the robot started the testing trial with the original
    representation for the T-hook tool"."""
    table = t_hook_table()
    before = list(table)
    whole_trial(spec(shape, goal, start), SETTINGS, table, fresh_world())
    assert list(table) == before
    assert all((row.times_used, row.times_successful) == (1, 1) for row in table)


@settings(deadline=None, max_examples=10)
@given(shapes, goals, starts)
def test_the_counters_of_a_table_that_a_trial_may_change_are_those_of_its_steps(
    shape: str, goal: int, start: int
) -> None:
    """§3.2: the counters "are updated during testing trials"."""
    table = t_hook_table()
    records = [r for r, _ in run_trial(spec(shape, goal, start), SETTINGS, table, fresh_world())]
    for row in table:
        uses = [record for record in records if record.row.step == row.step]
        assert row.times_used == 1 + len(uses)
        assert row.times_successful == 1 + sum(record.replicated for record in uses)
        for k, record in enumerate(uses):
            assert record.row.times_used == 1 + k
    assert [step.record for step in tried(shape, goal, start).steps] == records


def test_another_seed_sees_with_other_noise() -> None:
    table = t_hook_table()
    one, other = (
        whole_trial(spec("t-hook", 1, 2, seed), SETTINGS, table, fresh_world()) for seed in (0, 1)
    )
    assert one.steps[0].record.start != other.steps[0].record.start


@settings(deadline=None, max_examples=12)
@given(shapes, goals, starts)
def test_a_trial_begins_at_its_start_and_only_the_robot_moves_the_attractor(
    shape: str, goal: int, start: int
) -> None:
    """§7.1: "There were 4 initial attractor positions per goal"."""
    trial = tried(shape, goal, start)
    truths = [step.truth for step in trial.steps]
    if truths:
        assert truths[0].start == Pose(*start_positions(LAYOUT)[start], 0.0)
    assert all(before.end == after.start for before, after in pairwise(truths))
    for step in trial.steps:
        assert step.record.seen == movement(step.record.start, step.record.end)
        if step.record.execution is None:
            assert step.truth.start == step.truth.end


@settings(deadline=None, max_examples=12)
@given(goals, starts)
def test_without_noise_a_trial_is_solved_if_and_only_if_the_attractor_lies_over_the_goal(
    goal: int, start: int
) -> None:
    """§7.1: "required to pull the attractor over a color coded goal region"; what the robot sees
    without noise is what is true."""
    trial = tried("t-hook", goal, start, EXACT)
    region = goal_regions(LAYOUT)[goal]
    for step in trial.steps:
        record, truth = step.record, step.truth
        assert record.seen.dx == pytest.approx(truth.end.x - truth.start.x, abs=1e-9)
        assert record.seen.dy == pytest.approx(truth.end.y - truth.start.y, abs=1e-9)
        assert not region.contains(truth.start.point)
    start_at = start_positions(LAYOUT)[start]
    rest = trial.steps[-1].truth.end.point if trial.steps else start_at
    solved = region.contains(rest)
    assert (trial.end.outcome is Outcome.SOLVED) is solved
    assert trial.end.steps == len(trial.steps) <= EXACT.trial.max_steps


def test_a_broken_tool_keeps_its_colour() -> None:
    """§7.2: "the robot was presented with a tool that has the same color ID as another tool with a
    different shape"."""
    world = fresh_world()
    counted(run_trial(spec("l-hook"), SETTINGS, t_hook_table(), world))
    assert world.tool.color == tool_named(SETTINGS, "t-hook").color
    assert world.tool.parts == tool_named(SETTINGS, "l-hook").parts
    assert world.goal == goal_regions(LAYOUT)[1]


@cache
def with_a_broken_tool(robot: int) -> tuple[TrialRecord, ...]:
    """Return the 16 trials of one robot whose T-hook became an L-hook."""
    steps = learned(spec_of("t-hook", 700, robot=robot))
    lost = LostAffordances(SETTINGS, "l-hook", starts_of(steps))
    specs = trial_specs(BROKEN, "t-hook", "l-hook", 0, robot, "noisy")
    table, world = table_from(steps), fresh_world()
    return tuple(whole_trial(trial, SETTINGS, table, world, lost) for trial in specs)


def test_the_robot_believes_that_it_is_still_using_the_old_tool() -> None:
    """§7.2: "Because color is the only feature used to recognize tools the robot believes that it
    is still using the old tool": all its rows are candidates at the first step."""
    rows = len(t_hook_table())
    for trial in with_a_broken_tool(0):
        assert all(step.lost is not None for step in trial.steps)
        for step in trial.steps[:1]:
            assert step.record.survivors.consistent == rows
            assert step.record.survivors.probable == rows


def test_lost_affordances_are_tried_in_vain_and_die() -> None:
    """§7.2: "After several trials the replication probability of the affordances associated with
    that part of the tool was reduced and they were excluded from further consideration"."""
    assert any(
        step.lost and step.record.died
        for robot in range(10)
        for trial in with_a_broken_tool(robot)
        for step in trial.steps
    )


def test_trials_with_a_whole_tool_know_of_no_lost_rows() -> None:
    assert all(step.lost is None for step in tried("t-hook", 1, 2).steps)


def test_a_trial_whose_simulation_diverges_is_invalid_and_never_solved() -> None:
    """A puck of next to no mass makes the engine give numbers that are not finite; the world goes
    on to serve the next trial."""
    workspace = Settings().workspace
    puck = replace(workspace.puck, mass=1e-300)
    weightless = Settings(workspace=replace(workspace, puck=puck))
    table, world = t_hook_table(), fresh_world(weightless)
    outcomes = [
        whole_trial(trial, weightless, table, world).end.outcome
        for trial in trial_specs(WHOLE, "t-hook", "t-hook", 0, 0, "noisy")
    ]
    assert outcomes.count(Outcome.INVALID) > 8
    assert Outcome.SOLVED not in outcomes


def test_there_are_4_goals_with_4_starts_each_from_the_table_as_learned() -> None:
    """§7.1: "4 goals x 4 attractor positions"; §7.2: "4 goal regions x 4 initial attractor
    positions"."""
    specs = trial_specs(BROKEN, "t-hook", "l-hook", 5, 7, "noisy")
    assert len(specs) == len({(s.goal, s.start) for s in specs}) == 16
    assert {s.goal for s in specs} == {s.start for s in specs} == {1, 2, 3, 4}
    assert {s.counters for s in specs} == {Counters.AS_LEARNED}
    assert {(s.tool, s.shape, s.seed, s.robot) for s in specs} == {("t-hook", "l-hook", 5, 7)}


def pulled_by(hook: str, step: int) -> tuple[Affordance, tuple[Point, Pose]]:
    """Return a row of the T-hook, pulling the puck with one of its hooks, and where it began."""
    bench = bench_with("t-hook", settings=EXACT)
    reach = reach_at(WORKSPACE.arm, WORKSPACE.arm.flange_height)
    wrist = Point(0.0, math.floor(reach.outer) - 1.0)
    left, _, right, _ = tool_outlines(WORKSPACE.tools)[hook].bounds
    bar = tool_outlines(WORKSPACE.tools)["left bar"].bounds[1]
    inside = right if hook == "left hook" else left
    toward_handle = 1.0 if hook == "left hook" else -1.0
    radius = WORKSPACE.puck.radius
    puck = Pose(
        wrist.x + inside + toward_handle * (radius + 0.1), wrist.y + bar - radius - 0.1, 0.0
    )
    bench.world.tool = tool_named(EXACT, ToolName("t-hook"))
    bench.world.wrist, bench.world.attractor = wrist, puck
    assert bench.world.clear_of_attractor(wrist)
    start = bench.sensor.observe()
    call = BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 5.0})
    bench.robot.execute(call, start)
    return Affordance(step, BINDING, call, start, bench.sensor.observe()), (wrist, puck)


def test_rows_of_the_missing_hook_are_lost_and_rows_of_the_hook_that_is_left_are_not() -> None:
    """§7.2: "Whenever the robot tried to use affordances associated with the missing parts of the
    tool they did not produce the expected attractor movements"."""
    right, right_start = pulled_by("right hook", 1)
    left, left_start = pulled_by("left hook", 2)
    for row in (right, left):
        assert row.expected_movement.dy == pytest.approx(-4.9, abs=0.1)
    begun = {1: right_start, 2: left_start}
    broken = LostAffordances(EXACT, "l-hook", begun)
    assert broken.lost(right)
    assert not broken.lost(left)
    whole = LostAffordances(EXACT, "t-hook", begun)
    assert not whole.lost(right)
    assert not whole.lost(left)
    stick = LostAffordances(EXACT, "stick", begun)
    assert stick.lost(right)
    assert stick.lost(left)


def test_a_tool_that_did_not_break_has_lost_nothing() -> None:
    """Without noise every row replicates itself from where it was made, to the bit."""
    steps = t_hook_steps(EXACT)
    table = t_hook_table(EXACT)
    whole = LostAffordances(EXACT, "t-hook", starts_of(steps))
    assert len(table) > 10
    assert not any(whole.lost(row) for row in table)


def test_a_broken_tool_has_lost_some_rows_and_kept_others_whatever_the_order_of_asking() -> None:
    begun, rows = starts_of(t_hook_steps()), list(t_hook_table())
    judge = LostAffordances(SETTINGS, "l-hook", begun)
    forwards = {row.step: judge.lost(row) for row in rows}
    assert {row.step: judge.lost(row) for row in rows} == forwards
    judge = LostAffordances(SETTINGS, "l-hook", begun)
    assert {row.step: judge.lost(row) for row in rows[::-1]} == forwards
    assert set(forwards.values()) == {True, False}
