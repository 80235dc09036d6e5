"""Testing trials: the whole tool and the broken one (§7.1, §7.2)."""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.behaviors.moving import CONTRACT_ARM
from affcli.config import Settings, settings_with
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall, Execution
from affcli.core.geometry import Point, Pose
from affcli.core.observation import movement
from affcli.core.specs import Counters, Protocol, TrialRecord, TrialSpec
from affcli.core.trial import Outcome
from affcli.core.world import World
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts
from affcli.lab.trials import run_trial, trial_specs, whole_trial
from affcli.simulation.arm import reach_at
from affcli.simulation.table_world import LostAffordances, TableWorld
from affcli.simulation.tasks.extension_of_reach import goal_regions, start_positions
from affcli.simulation.tools.paper import tool_outlines
from tests.factories import (
    BINDING,
    EXACT,
    affordance,
    learning_spec,
    setting_with,
    table_of,
    tool_named,
    trial_spec,
)
from tests.lab.quick import PLANNER, Steps, learned, spec_of, starts_of, table_from

SETTINGS = Settings()
WORKSPACE = SETTINGS.workspace
LAYOUT = WORKSPACE.layout
goals, starts = st.sampled_from("1234"), st.sampled_from("1234")
shapes = st.sampled_from(["t-hook", "l-hook", "stick"])


def t_hook_steps(of: Settings = SETTINGS) -> Steps:
    return learned(spec_of("t-hook", 700, settings=of))


def t_hook_table(of: Settings = SETTINGS) -> AffordanceTable:
    return table_from(t_hook_steps(of))


def spec(shape: str, goal: str, start: str, of: Settings = SETTINGS, seed: int = 0) -> TrialSpec:
    run = spec_of("t-hook", 700, settings=of)
    return trial_spec(run, goal=goal, start=start, held=tool_named(shape), seed=seed)


def tried(
    shape: str, goal: str, start: str, of: Settings = SETTINGS, world: World | None = None
) -> TrialRecord:
    run = spec_of("t-hook", 700, settings=of)
    trial = spec(shape, goal, start, of)
    return whole_trial(trial, run, t_hook_table(of), world or TableWorld(of))


def sixteen(shape: str, robot: int = 0, seed: int = 0) -> list[TrialSpec]:
    """Return the trials of a T-hook that became another shape, one for each task."""
    world, run = TableWorld(SETTINGS), spec_of("t-hook", 700, robot=robot)
    tasks = world.tasks("extension-of-reach")
    protocol = Protocol.TOOL_ADAPTATION
    return trial_specs(
        *(protocol, run, tool_named(shape), tasks, seed, "noisy", PLANNER, world),
    )


@settings(max_examples=8)
@given(st.lists(st.tuples(shapes, goals, starts), min_size=1, max_size=4))
def test_a_world_shared_between_trials_gives_the_same_trials_as_fresh_ones(
    trials: list[tuple[str, str, str]],
) -> None:
    shared = TableWorld(SETTINGS)
    for trial in trials:
        assert tried(*trial, world=shared) == tried(*trial)


@settings(max_examples=10)
@given(shapes, goals, starts)
def test_a_trial_leaves_the_table_as_learned(shape: str, goal: str, start: str) -> None:
    """§7.2: "In each of these experiments the robot started the testing trial with the original
    representation for the T-hook tool"."""
    table = t_hook_table()
    before = list(table)
    trial = spec(shape, goal, start)
    whole_trial(trial, spec_of("t-hook", 700), table, TableWorld(SETTINGS))
    assert list(table) == before


@settings(max_examples=10)
@given(shapes, goals, starts)
def test_the_counters_of_a_table_that_a_trial_may_change_are_those_of_its_steps(
    shape: str, goal: str, start: str
) -> None:
    """§3.2: the counters "are updated during testing trials"."""
    table, run, trial = t_hook_table(), spec_of("t-hook", 700), spec(shape, goal, start)
    setting = TableWorld(SETTINGS).trial(trial, run)
    records = [record for record, _ in run_trial(trial, run, table, setting)]
    for row in table:
        uses = [record for record in records if record.row.step == row.step]
        assert row.times_used == 1 + len(uses)
        assert row.times_successful == 1 + sum(record.replicated for record in uses)
        for k, record in enumerate(uses):
            assert record.row.times_used == 1 + k
    assert [step.record for step in tried(shape, goal, start).steps] == records


def test_another_seed_sees_with_other_noise() -> None:
    one, other = (
        whole_trial(
            *(spec("t-hook", "1", "2", seed=seed), spec_of("t-hook", 700), t_hook_table()),
            TableWorld(SETTINGS),
        )
        for seed in (0, 1)
    )
    assert one.steps[0].record.start != other.steps[0].record.start


@settings(max_examples=12)
@given(shapes, goals, starts)
def test_a_trial_begins_at_its_start_and_only_the_robot_moves_the_attractor(
    shape: str, goal: str, start: str
) -> None:
    """§7.1: "There were 4 initial attractor positions per goal"."""
    trial = tried(shape, goal, start)
    truths = [step.truth for step in trial.steps if step.truth is not None]
    assert len(truths) == len(trial.steps)
    if truths:
        assert truths[0].start == Pose(*start_positions(LAYOUT)[start], 0.0)
    assert all(before.end == after.start for before, after in pairwise(truths))
    for step, truth in zip(trial.steps, truths, strict=True):
        assert step.record.seen == movement(step.record.start, step.record.end)
        if step.record.execution is None:
            assert truth.start == truth.end


@settings(max_examples=12)
@given(goals, starts)
def test_without_noise_a_trial_is_solved_if_and_only_if_the_attractor_lies_over_the_goal(
    goal: str, start: str
) -> None:
    """§7.1: "required to pull the attractor over a color coded goal region"; what the robot sees
    without noise is what is true."""
    trial = tried("t-hook", goal, start, EXACT)
    region = goal_regions(LAYOUT)[goal]
    rest = start_positions(LAYOUT)[start]
    for step in trial.steps:
        record, truth = step.record, step.truth
        assert truth is not None
        assert record.seen.dx == pytest.approx(truth.end.x - truth.start.x, abs=1e-9)
        assert record.seen.dy == pytest.approx(truth.end.y - truth.start.y, abs=1e-9)
        assert not region.contains(truth.start.point)
        rest = truth.end.point
    assert (trial.end.outcome is Outcome.SOLVED) is region.contains(rest)
    assert trial.end.steps == len(trial.steps) <= EXACT.trial.max_steps


@cache
def with_a_broken_tool(robot: int) -> tuple[TrialRecord, ...]:
    """Return the 16 trials of one robot whose T-hook became an L-hook."""
    run = spec_of("t-hook", 700, robot=robot)
    world, steps = TableWorld(SETTINGS), learned(run)
    lost = world.lost_rows(run, tool_named("l-hook"), starts_of(steps))
    table = table_from(steps)
    return tuple(whole_trial(trial, run, table, world, lost) for trial in sixteen("l-hook", robot))


def test_the_robot_believes_that_it_is_still_using_the_old_tool() -> None:
    """§7.2: "Because color is the only feature used to recognize tools the robot believes that it
    is still using the old tool": all its rows are candidates at the first step."""
    rows = len(t_hook_table())
    for trial in with_a_broken_tool(0):
        assert all(step.lost is not None for step in trial.steps)
        for step in trial.steps[:1]:
            left = {reason.name: reason.rows for reason in step.record.reasons}
            assert left["consistent"] == left["probable"] == rows


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
    assert all(step.lost is None for step in tried("t-hook", "1", "2").steps)


def test_a_trial_whose_simulation_diverges_is_invalid_and_never_solved() -> None:
    """A puck of next to no mass makes the engine give numbers that are not finite; the world goes
    on to serve the next trial."""
    puck = replace(WORKSPACE.puck, mass=1e-300)
    weightless = Settings(workspace=replace(WORKSPACE, puck=puck))
    table, world, run = t_hook_table(), TableWorld(weightless), spec_of("t-hook", 700)
    outcomes = [whole_trial(trial, run, table, world).end.outcome for trial in sixteen("t-hook")]
    assert outcomes.count(Outcome.INVALID) > 8
    assert Outcome.SOLVED not in outcomes


def test_there_are_4_goals_with_4_starts_each_from_the_table_as_learned() -> None:
    """§7.1: "4 goals x 4 attractor positions"; §7.2: "4 goal regions x 4 initial attractor
    positions"."""
    specs = sixteen("l-hook", robot=7, seed=5)
    assert len(specs) == len({(s.goal, s.start) for s in specs}) == 16
    assert {s.goal for s in specs} == {s.start for s in specs} == set("1234")
    assert {s.counters for s in specs} == {Counters.AS_LEARNED}
    assert {(s.tool, s.shape, s.seed, s.robot) for s in specs} == {("t-hook", "l-hook", 5, 7)}


def pulled_by(hook: str, step: int) -> tuple[Affordance, tuple[Pose, Pose]]:
    """Return a row of the T-hook, pulling the puck with one of its hooks, and where it began."""
    setting = setting_with("t-hook", settings=EXACT)
    reach = reach_at(WORKSPACE.arm, WORKSPACE.arm.flange_height)
    wrist = Pose(0.0, math.floor(reach.outer) - 1.0)
    outlines = tool_outlines(WORKSPACE.tools)
    left, _, right, _ = outlines[hook].bounds
    bar = outlines["left bar"].bounds[1]
    inside = right if hook == "left hook" else left
    toward_handle = 1.0 if hook == "left hook" else -1.0
    radius = WORKSPACE.puck.radius
    puck = Pose(wrist.x + inside + toward_handle * (radius + 0.1), wrist.y + bar - radius - 0.1)
    setting.robot.execute(setting.binding, None)
    setting.table.wrist, setting.table.attractor = wrist, puck
    assert setting.table.clear_of_attractor(wrist)
    start = setting.sensor.observe()
    call = BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 5.0})
    setting.robot.execute(call, start)
    return Affordance(step, BINDING, call, start, setting.sensor.observe()), (wrist, puck)


def test_rows_of_the_missing_hook_are_lost_and_rows_of_the_hook_that_is_left_are_not() -> None:
    """§7.2: "Whenever the robot tried to use affordances associated with the missing parts of the
    tool they did not produce the expected attractor movements"."""
    right, right_start = pulled_by("right hook", 1)
    left, left_start = pulled_by("left hook", 2)
    for row in (right, left):
        assert row.expected_movement.dy == pytest.approx(-4.9, abs=0.1)
    begun, run = {1: right_start, 2: left_start}, spec_of(settings=EXACT)
    found = {
        shape: [judge.lost(right), judge.lost(left)]
        for shape in ("l-hook", "t-hook", "stick")
        for judge in [LostAffordances(EXACT, run, tool_named(shape), begun)]
    }
    assert found == {"l-hook": [True, False], "t-hook": [False, False], "stick": [True, True]}


def test_a_tool_that_did_not_break_has_lost_nothing() -> None:
    """Without noise every row replicates itself from where it was made, to the bit."""
    steps, table, run = t_hook_steps(EXACT), t_hook_table(EXACT), spec_of(settings=EXACT)
    whole = LostAffordances(EXACT, run, run.held, starts_of(steps))
    assert len(table) > 10
    assert not any(whole.lost(row) for row in table)


def test_a_broken_tool_has_lost_some_rows_and_kept_others_whatever_the_order_of_asking() -> None:
    begun, rows = starts_of(t_hook_steps()), list(t_hook_table())
    judge = LostAffordances(SETTINGS, spec_of(), tool_named("l-hook"), begun)
    forwards = {row.step: judge.lost(row) for row in rows}
    assert {row.step: judge.lost(row) for row in rows} == forwards
    judge = LostAffordances(SETTINGS, spec_of(), tool_named("l-hook"), begun)
    assert {row.step: judge.lost(row) for row in rows[::-1]} == forwards
    assert set(forwards.values()) == {True, False}


HIGH = "grasp:grasp_point=4"


@cache
def two_grasps() -> tuple[Affordance, ...]:
    """Return the rows of two runs of the T-hook, each by another grasp, as one table."""
    parts = RunParts.chosen(EXACT, binding=HIGH)
    low = table_from(learned(spec_of("t-hook", 300, settings=EXACT)))
    high = table_from(learned(parts.spec("t-hook", 0, 0, None, 300)))
    return tuple(replace(row, step=step) for step, row in enumerate([*low, *high], 1))


def test_a_row_of_another_grasp_is_used_with_its_own_and_the_tool_is_grasped_anew() -> None:
    """At a cost in robot time, and only where the grasp changes."""
    run, table = spec_of(settings=EXACT), table_of(*two_grasps())
    regrasp = WORKSPACE.motion.regrasp_time
    seen: set[bool] = set()
    for goal in "1234":
        trial = trial_spec(run, goal=goal)
        record = whole_trial(trial, run, table, TableWorld(EXACT))
        holding, clock = run.binding, WORKSPACE.motion.grasp_time
        for step in (one.record for one in record.steps):
            assert step.regrasped is (step.row.binding != holding)
            took = [step.placing] if step.execution is None else [step.placing, step.execution]
            passed = sum(execution.duration for execution in took)
            passed += regrasp if step.regrasped else 0.0
            assert step.clock - clock == pytest.approx(passed)
            holding, clock = step.row.binding, step.clock
            seen.add(step.regrasped)
    assert regrasp > 0.0
    assert seen == {True, False}


def test_rows_of_either_grasp_replicate_from_the_other() -> None:
    """The attractor is put where the row met it; without noise it goes where it went then."""
    rows = two_grasps()
    low, high = rows[0], next(row for row in rows if row.binding != rows[0].binding)
    for row, held in ((low, high.binding), (high, low.binding)):
        run = replace(spec_of(settings=EXACT), binding=held)
        trial, at = trial_spec(run), Point(*row.end.object_position)
        region = replace(trial.task.goal, center=at, half_width=0.2)
        start = Point(*row.start.object_position)
        task = replace(trial.task, goal=region, start=start)
        record = whole_trial(replace(trial, task=task), run, table_of(row), TableWorld(EXACT))
        assert record.end.outcome is Outcome.SOLVED
        assert [step.record.regrasped for step in record.steps] == [True]
        assert record.steps[0].record.seen == pytest.approx(row.expected_movement, abs=0.05)


def test_a_row_that_was_made_at_an_angle_is_used_at_that_angle() -> None:
    """Position wrist restores it; the paper's rows have none."""
    run, angle = learning_spec(settings=EXACT), math.radians(30.0)
    row = affordance(offset=Point(4.0, 9.0), wrist_angle=angle, moved=(0.0, -4.0))
    record = whole_trial(trial_spec(run), run, table_of(row), TableWorld(EXACT))
    placings = [step.record.placing for step in record.steps]
    assert placings
    assert all(placing.call["angle"] == pytest.approx(30.0) for placing in placings)
    assert all(placing.wrist_end.angle == pytest.approx(angle) for placing in placings)
    pushes = [step.record.execution for step in record.steps]
    assert [push for push in pushes if push is not None]
    assert all(_angles(push) == pytest.approx((angle, angle)) for push in pushes if push)


def _angles(execution: Execution) -> tuple[float, float]:
    return execution.wrist_start.angle, execution.wrist_end.angle


def test_another_repertoire_solves_what_it_learned() -> None:
    chosen = ["paper", "extend-arm:offset_distance=3"]
    parts = RunParts.chosen(
        settings_with({"trial": {"max_steps": 20}}, "a test"), repertoire=chosen
    )
    run = parts.spec("t-hook", 0, 0, None, 400)
    table = table_from(tuple(LearningRun(run).steps()))
    mine = [row for row in table if str(row.exploratory) == "extend arm 3"]
    assert mine
    assert all(row.travel.y <= 3.0 for row in mine)
    record = whole_trial(
        trial_spec(run, goal="2", start="1"), run, table_of(*mine), TableWorld(SETTINGS)
    )
    used = {str(step.record.row.exploratory) for step in record.steps}
    assert used == {"extend arm 3"}
    assert any(step.record.replicated for step in record.steps)
