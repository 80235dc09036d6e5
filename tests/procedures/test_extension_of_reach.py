"""The procedure that solves a tool task, against a table without physics (§6.2, §7)."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.affordance import Affordance, replicates
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import POSITION_WRIST, BehaviorCall, ExecutionStatus
from affcli.core.choice import Choice, Reason, Situation
from affcli.core.geometry import Point
from affcli.core.observation import Observation, movement
from affcli.core.ports import Planner
from affcli.core.task import GoalRegion
from affcli.core.tool import ToolName
from affcli.core.trial import Outcome, StepRecord, TrialEnd
from affcli.errors import PartFailedError, SimulationDivergedError
from affcli.planning.lookahead import Lookahead
from affcli.planning.nested_query import NestedQuery
from affcli.procedures.extension_of_reach import TrialLimits, extension_of_reach
from affcli.simulation.tools.paper import TOOL_COLORS
from tests.factories import BINDING, EIGHTH, affordance, goal_at, table_of
from tests.fakes import (
    CALL_SECONDS,
    Effect,
    FakeExperimenter,
    FakeRobot,
    FakeSensor,
    FakeTable,
    everywhere,
    no_effect,
    nowhere,
    scripted,
)

DONE, BLOCKED = ExecutionStatus.DONE, ExecutionStatus.BLOCKED
FAR_GOAL = goal_at(0.0, 1000.0)
AHEAD_5 = affordance(1, moved=(0.0, 5.0))


@dataclass
class Trial:
    """A trial on a fake table, run to its end."""

    table: AffordanceTable
    goal: GoalRegion = FAR_GOAL
    attractor: Point = Point(0.0, 24.0)
    effect: Effect = no_effect
    placings: Iterable[ExecutionStatus] = ()
    reachable: Callable[[Point], bool] = everywhere
    lost: Callable[[Point], bool] = nowhere
    max_steps: int = 32
    planner: Planner = NestedQuery()  # noqa: RUF009 it is frozen
    steps: list[StepRecord] = field(default_factory=list)

    def __post_init__(self) -> None:
        world = FakeTable(attractor=self.attractor, goal=self.goal)
        self.robot = FakeRobot(world, self.effect, self.placings, reachable=self.reachable)
        self.sensor = FakeSensor(world)
        self.end = self._run(FakeExperimenter(world, lost=self.lost))

    def _run(self, experimenter: FakeExperimenter) -> TrialEnd:
        limits = TrialLimits(max_steps=self.max_steps)
        running = extension_of_reach(
            *(self.robot, self.sensor, experimenter, self.table, BINDING, limits),
            planner=self.planner,
        )
        while True:
            try:
                self.steps.append(next(running))
            except StopIteration as stop:
                end: TrialEnd = stop.value
                return end

    @property
    def behaviors(self) -> list[BehaviorCall]:
        """The exploratory behaviors executed."""
        return [c for c in self.robot.calls[1:] if c.name != POSITION_WRIST]


def rows_left(end: TrialEnd) -> tuple[int | None, ...]:
    """Return how many rows each search left, at the query that found none."""
    return tuple(reason.rows for reason in end.last_reasons or ())


@dataclass(frozen=True)
class Undecided(NestedQuery):
    """A planner that finds no plan: it looks as the paper's does, and never chooses."""

    def choose(self, situation: Situation) -> Choice:
        return Choice(None, super().choose(situation).reasons)


def diverging_after(behaviors: int) -> Effect:
    """Move the attractor ahead, until the simulation diverges."""
    calls = 0

    def effect(call: BehaviorCall) -> tuple[float, float]:
        nonlocal calls
        calls += 1
        if calls > behaviors:
            raise SimulationDivergedError("not finite")
        return 0.0, 5.0

    return effect


def test_an_attractor_over_the_goal_at_the_start_is_a_task_solved_without_a_step() -> None:
    trial = Trial(table_of(AHEAD_5), goal=goal_at(1.0, 23.0))
    assert trial.end == TrialEnd(Outcome.SOLVED, 0, CALL_SECONDS)
    assert trial.steps == []
    assert trial.robot.executed == [(BINDING, None)]


def test_a_solved_task_is_solved_even_where_no_tool_reaches() -> None:
    trial = Trial(table_of(AHEAD_5), goal=goal_at(0.0, 24.0), lost=lambda place: True)
    assert trial.end.outcome is Outcome.SOLVED


def test_a_task_is_solved_step_by_step_as_the_rows_promise() -> None:
    """§6.2: the table "can be queried to dynamically create behavioral sequences that solve a
    specific tool task"."""
    trial = Trial(table_of(AHEAD_5), goal=goal_at(0.0, 39.0), effect=lambda call: (0.0, 5.0))
    assert trial.end.outcome is Outcome.SOLVED
    assert trial.end.steps == len(trial.steps) == 3
    assert [step.end.object_y for step in trial.steps] == [29.0, 34.0, 39.0]
    assert [step.number for step in trial.steps] == [1, 2, 3]
    assert all(step.replicated for step in trial.steps)
    assert trial.behaviors == [AHEAD_5.exploratory] * 3


@pytest.mark.parametrize(
    ("row", "reachable", "survivors"),
    [
        (affordance(tool_color=TOOL_COLORS[ToolName("stick")]), everywhere, (0, 0, 0, 0)),
        (affordance(used=2, successful=1), everywhere, (1, 0, 0, 0)),
        (AHEAD_5, nowhere, (1, 1, 0, 0)),
    ],
    ids=["another tool", "dead", "out of the arm's reach"],
)
def test_without_a_row_the_trial_ends_and_says_which_search_left_none(
    row: Affordance, reachable: Callable[[Point], bool], survivors: tuple[int, ...]
) -> None:
    trial = Trial(table_of(row), reachable=reachable)
    assert trial.end.outcome is Outcome.NO_ROW
    assert trial.end.steps == 0
    assert rows_left(trial.end) == survivors
    assert trial.robot.calls == [BINDING]


def test_a_blank_table_solves_nothing() -> None:
    trial = Trial(AffordanceTable())
    assert (trial.end.outcome, rows_left(trial.end)) == (Outcome.NO_ROW, (0, 0, 0, 0))


def test_a_planner_that_chooses_none_of_the_usable_rows_has_found_no_plan() -> None:
    trial = Trial(table_of(AHEAD_5), planner=Undecided())
    assert trial.end == TrialEnd(Outcome.NO_PLAN, 0, CALL_SECONDS, trial.end.last_reasons)
    assert rows_left(trial.end) == (1, 1, 1, 1)
    assert trial.robot.calls == [BINDING]


@pytest.mark.parametrize(
    ("row", "reachable", "usable"),
    [
        (affordance(tool_color=TOOL_COLORS[ToolName("stick")]), everywhere, False),
        (affordance(used=2, successful=1), everywhere, False),
        (AHEAD_5, nowhere, False),
        (AHEAD_5, lambda place: place != Point(0.0, 16.0), False),
        (AHEAD_5, lambda place: place == Point(0.0, 16.0), True),
        (affordance(used=5, successful=3), everywhere, True),
    ],
    ids=["another tool", "dead", "nowhere", "not its place", "its place alone", "not yet dead"],
)
def test_whatever_the_planner_is_no_row_is_left_where_none_can_be_used(
    row: Affordance, reachable: Callable[[Point], bool], *, usable: bool
) -> None:
    """The procedure looks for itself: by what it tells of the reason a planner is not believed."""
    trial = Trial(table_of(row), planner=Undecided(), reachable=reachable)
    assert trial.end.outcome is (Outcome.NO_PLAN if usable else Outcome.NO_ROW)


@pytest.mark.parametrize(("threshold", "outcome"), [(0.5, "no plan found"), (0.6, "no row left")])
def test_which_rows_can_be_used_goes_by_the_planner_s_own_threshold(
    threshold: float, outcome: str
) -> None:
    row = affordance(used=5, successful=3)
    trial = Trial(table_of(row), planner=Undecided(threshold=threshold))
    assert trial.end.outcome == outcome


def test_a_lookahead_that_expects_of_every_row_within_reach_no_movement_finds_no_plan() -> None:
    """The wrist can be set down, but the way of the behavior ends there."""
    row = replace(AHEAD_5, travel=Point(0.0, 5.0))
    trial = Trial(
        table_of(row), planner=Lookahead(), reachable=lambda place: place == Point(0.0, 16.0)
    )
    assert trial.end.outcome is Outcome.NO_PLAN
    assert [(reason.name, reason.rows) for reason in trial.end.last_reasons or ()] == [
        *(("consistent", 1), ("probable", 1), ("reachable", 1)),
        ("expected to move the attractor", 0),
    ]


def test_an_attractor_out_of_the_tools_reach_ends_the_trial() -> None:
    """§7.1: "The most common failure condition was due to pushing the attractor out of tool's
    reach"."""
    trial = Trial(table_of(AHEAD_5), effect=lambda call: (0.0, 5.0), lost=lambda p: p.y > 30.0)
    assert trial.end.outcome is Outcome.ATTRACTOR_OUT_OF_REACH
    assert trial.end.steps == len(trial.steps) == 2
    assert trial.end.last_reasons is None
    assert len(trial.behaviors) == 2


@pytest.mark.parametrize("limit", [1, 2, 7])
def test_after_the_last_step_allowed_the_trial_is_given_up(limit: int) -> None:
    trial = Trial(table_of(AHEAD_5), effect=lambda call: (0.0, 5.0), max_steps=limit)
    assert trial.end.outcome is Outcome.STEP_LIMIT
    assert trial.end.steps == len(trial.steps) == limit


def test_a_task_solved_by_the_last_step_allowed_is_solved() -> None:
    solved = goal_at(0.0, 34.0)
    trial = Trial(table_of(AHEAD_5), solved, effect=lambda call: (0.0, 5.0), max_steps=2)
    assert (trial.end.outcome, trial.end.steps) == (Outcome.SOLVED, 2)


def test_a_blocked_placing_counts_as_a_failed_replication_and_runs_no_behavior() -> None:
    table = table_of(AHEAD_5)
    trial = Trial(table, placings=[BLOCKED], effect=lambda call: (0.0, 5.0))
    (step,) = trial.steps
    assert step.placing.status is BLOCKED
    assert step.execution is None
    assert step.start == step.end
    assert step.seen == (0.0, 0.0, 0.0)
    assert not step.replicated
    assert step.died
    assert trial.behaviors == []
    assert (table.row(0).times_used, table.row(0).times_successful) == (2, 1)
    assert trial.end.outcome is Outcome.NO_ROW
    assert rows_left(trial.end) == (1, 0, 0, 0)


def test_a_puck_that_does_not_move_is_a_failure_that_kills_a_fresh_row() -> None:
    """§6.2: "it takes only one unsuccessful behavioral execution in order to eliminate an
    affordance from further consideration"; each row is tried once, then none is left."""
    rows = [affordance(k, moved=(0.0, float(k))) for k in (1, 2, 3, 4)]
    trial = Trial(table_of(*rows))
    assert trial.end.outcome is Outcome.NO_ROW
    assert [step.row.step for step in trial.steps] == [4, 3, 2, 1]
    assert all(step.died and not step.replicated for step in trial.steps)


def test_a_row_that_has_succeeded_before_gets_a_second_chance() -> None:
    """§6.2: 2/3 is greater than 1/2, 2/4 is not."""
    trial = Trial(table_of(AHEAD_5), effect=scripted([(0.0, 5.0)]))
    assert [step.replicated for step in trial.steps] == [True, False, False]
    assert [step.died for step in trial.steps] == [False, False, True]
    assert [(s.times_used_after, s.times_successful_after) for s in trial.steps] == [
        (2, 2),
        (3, 2),
        (4, 2),
    ]
    assert trial.end.outcome is Outcome.NO_ROW


@pytest.mark.fault(29)
@pytest.mark.parametrize(("behaviors", "taken"), [(0, 0), (3, 3)])
def test_a_simulation_that_diverges_makes_the_trial_invalid(behaviors: int, taken: int) -> None:
    """Neither solved nor failed; the steps taken before it are told."""
    trial = Trial(table_of(AHEAD_5), effect=diverging_after(behaviors))
    assert trial.end.outcome is Outcome.INVALID
    assert len(trial.steps) == taken
    assert trial.end.steps == taken


def test_a_sensor_that_fails_before_the_first_step_ends_the_trial_without_one() -> None:
    class Broken(FakeSensor):
        def observe(self) -> Observation:
            raise PartFailedError("the sensor broke")

    world = FakeTable(goal=FAR_GOAL)
    running = extension_of_reach(
        *(FakeRobot(world), Broken(world), FakeExperimenter(world), table_of(AHEAD_5)),
        *(BINDING, TrialLimits()),
        planner=NestedQuery(),
    )
    with pytest.raises(StopIteration) as stopped:
        next(running)
    end = stopped.value.value
    assert (end.outcome, end.steps) == (Outcome.INVALID, 0)
    assert end.last_reasons == (Reason("the sensor broke"),)


@pytest.mark.fault(29)
def test_a_diverging_behavior_does_not_count_as_a_use_of_its_row() -> None:
    table = table_of(AHEAD_5)
    Trial(table, effect=diverging_after(2))
    assert (table.row(0).times_used, table.row(0).times_successful) == (3, 3)


movements = st.tuples(st.integers(-40, 40), st.integers(-40, 40)).map(
    lambda m: (m[0] * EIGHTH, m[1] * EIGHTH)
)
learned = st.lists(movements.filter(lambda m: m[0] ** 2 + m[1] ** 2 > 0.25), max_size=12)


@st.composite
def trials(draw: st.DrawFn) -> tuple[list[Affordance], Trial]:
    """Draw a table, what its behaviors will truly do, and which placings are blocked."""
    rows = [affordance(k, moved=moved) for k, moved in enumerate(draw(learned), start=1)]
    placings = draw(st.lists(st.sampled_from([DONE, DONE, DONE, BLOCKED]), max_size=12))
    trial = Trial(
        AffordanceTable(rows),
        goal=goal_at(*draw(movements)),
        attractor=Point(5.0, 5.0),
        effect=scripted(draw(st.lists(movements, max_size=12))),
        placings=placings,
        lost=lambda place: abs(place.x) > 20.0,
        max_steps=10,
    )
    return rows, trial


@settings(deadline=None)
@given(trials())
def test_the_counters_of_the_table_are_those_of_the_steps(
    drawn: tuple[list[Affordance], Trial],
) -> None:
    """§3.2: the counters "are updated during testing trials": by one use a step, by one success
    if the step replicated the row; and by nothing else."""
    rows, trial = drawn
    used = {row.step: 1 for row in rows}
    successful = dict(used)
    for step in trial.steps:
        key = step.row.step
        assert (step.row.times_used, step.row.times_successful) == (used[key], successful[key])
        used[key] += 1
        successful[key] += step.replicated
        assert step.times_used_after == used[key]
        assert step.times_successful_after == successful[key]
    for row in trial.table:
        assert row.times_used == used[row.step]
        assert row.times_successful == successful[row.step]


@settings(deadline=None)
@given(trials())
def test_a_step_is_judged_by_what_was_expected_and_what_was_seen(
    drawn: tuple[list[Affordance], Trial],
) -> None:
    """§5.2: successful "if the observed attractor movement is within 40 degrees of the expected
    movement stored in the affordance table"; §6.2: no row that is out is ever chosen."""
    for step in drawn[1].steps:
        assert step.expected == step.row.expected_movement
        assert step.seen == movement(step.start, step.end)
        assert step.replicated is replicates(step.expected, step.seen)
        assert (step.execution is None) is (step.placing.status is not DONE)
        assert step.row.replication_probability > 0.5
        if step.execution is not None:
            assert step.execution.call == step.row.exploratory


@settings(deadline=None)
@given(trials())
def test_the_observation_after_a_step_is_that_with_which_the_next_begins(
    drawn: tuple[list[Affordance], Trial],
) -> None:
    """§6.2: the best affordance is chosen for "the current task configuration"."""
    trial = drawn[1]
    aimed_by = [seen for call, seen in trial.robot.executed if call.name == POSITION_WRIST]
    assert (
        aimed_by
        == [trial.sensor.taken[0], *(step.end for step in trial.steps[:-1])][: len(trial.steps)]
    )
    assert trial.sensor.goals_seen == 1


@settings(deadline=None)
@given(trials())
def test_the_wrist_goes_where_the_attractor_has_the_offset_of_the_row(
    drawn: tuple[list[Affordance], Trial],
) -> None:
    """§5: position wrist "moves the manipulator such that the centroid of the attractor is at
    offset (x, y) relative to the wrist": the (x, y) of the row's O^s."""
    for step in drawn[1].steps:
        offset = step.row.start.wrist_to_object
        assert step.placing.call == BehaviorCall.of(POSITION_WRIST, {"x": offset.x, "y": offset.y})
        if step.execution is not None:
            assert step.start.wrist_to_object == offset


@settings(deadline=None)
@given(trials())
def test_the_end_of_a_trial_says_how_far_it_came(drawn: tuple[list[Affordance], Trial]) -> None:
    trial = drawn[1]
    at = trial.robot.table.attractor
    assert trial.end.steps == len(trial.steps)
    assert [step.number for step in trial.steps] == list(range(1, len(trial.steps) + 1))
    assert trial.end.clock == trial.robot.clock
    assert (trial.end.outcome is Outcome.SOLVED) is trial.goal.contains(at)
    assert trial.end.outcome is not Outcome.INVALID
    clocks = [step.clock for step in trial.steps]
    assert clocks == sorted(set(clocks))
    assert (trial.end.last_reasons is None) is (trial.end.outcome is not Outcome.NO_ROW)
    assert trial.end.outcome is not Outcome.NO_PLAN  # the paper's query takes what can be used


def test_the_tool_is_grasped_once_before_the_first_look() -> None:
    trial = Trial(table_of(AHEAD_5), effect=lambda call: (0.0, 5.0), max_steps=3)
    assert trial.robot.executed[0] == (BINDING, None)
    assert trial.robot.calls.count(BINDING) == 1
