"""Small records made by hand, so that what the tables must say is known beforehand."""

from dataclasses import replace
from typing import Any

from affcli.analysis.overview import Breaking, GoalCounts, Overview, ProtocolCounts, SolvedBy
from affcli.analysis.paper import EXTENSION_OF_REACH
from affcli.analysis.reproduction import Reproduction
from affcli.behaviors.moving import CONTRACT_ARM, EXTEND_ARM, SLIDE_ARM_LEFT, SLIDE_ARM_RIGHT
from affcli.core.affordance import PROBABILITY_THRESHOLD, Affordance
from affcli.core.behavior import (
    POSITION_WRIST,
    BehaviorCall,
    BehaviorName,
    Execution,
    ExecutionStatus,
)
from affcli.core.choice import Reason
from affcli.core.geometry import Point, Pose
from affcli.core.identity import Component
from affcli.core.observation import SensorKind, movement
from affcli.core.records import LearningRunInfo, SessionInfo, StoredRow, StoredStep, TrialInfo
from affcli.core.results import BehaviorGroup
from affcli.core.specs import (
    Counters,
    LearningSpec,
    Protocol,
    SessionSpec,
    TrialRecord,
    TrialSpec,
)
from affcli.core.task import GoalRegion, Task
from affcli.core.tool import ToolName
from affcli.core.trial import Outcome, StepRecord, TrialEnd, TrialStep, Truth
from tests.factories import affordance, learning_spec, observation, tool_named, trial_spec

NOW = "2026-01-02T03:04:05+00:00"
NESTED = Component("nested-query")
TASK_SET = "extension-of-reach"
GOAL = GoalRegion("3", Point(-12.0, 24.0), 2.0)


def call(name: BehaviorName, inches: float) -> BehaviorCall:
    """Return an exploratory behavior with its distance."""
    return BehaviorCall.of(name, {"offset_distance": inches})


def group(of: BehaviorCall, tried: int, rows: int = 0, *means: float) -> BehaviorGroup:
    """Return what a behavior gave: its mean movement along with its parts when it made rows."""
    return BehaviorGroup(of, tried, rows, *(means or (None, None, None)))


def learned_run(number: int, spec: LearningSpec, **changes: Any) -> LearningRunInfo:
    """Return a learning run of an hour."""
    run = LearningRunInfo(
        id=number,
        session_id=None,
        spec=spec,
        versions={},
        status="done",
        behaviors=800,
        rows=97,
        resets=12,
        redraws=0,
        robot_seconds=3601.2,
        checkpoint=None,
        started_at="2026-01-02T03:04:05+00:00",
    )
    return replace(run, **changes)


def trial_info(
    number: int,
    run: LearningRunInfo,
    tool: str,
    goal: str,
    start: str = "1",
    *,
    shape: str | None = None,
    protocol: Protocol = Protocol.EXTENSION_OF_REACH,
    task_set: str = TASK_SET,
    planner: str = "nested-query",
    sensor: SensorKind = "noisy",
    outcome: Outcome = Outcome.SOLVED,
    run_id: int | None = None,
) -> TrialInfo:
    """Return a trial of session 1 that ended after 4 steps."""
    usual = trial_spec(run.spec)
    region = replace(usual.task.goal, name=goal)
    spec = replace(
        usual,
        protocol=protocol,
        tool=tool,
        held=replace(run.spec.held, name=ToolName(shape or tool)),
        task=Task(task_set, region, start, usual.task.start),
        planner=Component.parse(planner),
        sensor=sensor,
    )
    return TrialInfo(*(number, 1, run_id or run.id, spec, run.spec, {}), *(outcome, 4, 20.0, None))


def session_of(number: int, *, kind: str = "reproduce", **changes: Any) -> SessionInfo:
    """Return a finished session with the paper's parts, seed 1000."""
    learned = learning_spec()
    spec = SessionSpec(
        kind=kind,
        seed=1000,
        robots=4,
        world=learned.world,
        repertoire=learned.repertoire,
        binding=learned.binding,
        explorer=learned.explorer,
        planner=NESTED,
        sensor=learned.sensor,
        settings="{}",
        task_set=TASK_SET,
    )
    return SessionInfo(number, replace(spec, **changes), {}, "done")


GROUPS = (
    group(call(CONTRACT_ARM, 2), 101),
    group(call(CONTRACT_ARM, 5), 99, 12, 3.44, 0.1, -3.4),
    group(call(EXTEND_ARM, 5), 100, 1, 0.96, 0.0, 0.96),
    group(call(SLIDE_ARM_LEFT, 2), 98, 20, 1.25, -1.25, 0.002),
    group(call(SLIDE_ARM_RIGHT, 5), 102, 33, 2.55, 2.5, -0.005),
)
"""The last moved at 359.9 degrees, which is 0 and not 360."""

RUNS = (
    learned_run(1, learning_spec("t-hook")),
    learned_run(
        2,
        replace(learning_spec("stick", seed=2**63 - 1), settings='{"sensor.position_noise":0.12}'),
        status="running",
        behaviors=500,
        rows=1,
        resets=1,
        robot_seconds=2399.6,
    ),
)


def row(step: int = 7, *, offset_x: float = -5.0, used: int = 1, successful: int = 1) -> Affordance:
    """Return a row that slides the attractor 4 in to the left."""
    return affordance(
        step,
        moved=(-4.0, 0.0),
        offset=Point(offset_x, 8.0),
        used=used,
        successful=successful,
        call=call(SLIDE_ARM_LEFT, 5),
    )


def stored_row(number: int, run: int, tool: str, learned: Affordance) -> StoredRow:
    """Return a row of an affordance table as it is stored."""
    return StoredRow(number, run, tool, learned)


REASONS = (
    Reason("consistent", 97),
    Reason("probable", 80, 0.5),
    Reason("reachable", 24),
    Reason("nearest", 5, 0.2),
)


def step(
    number: int,
    tried: Affordance,
    *,
    seen: tuple[float, float] = (-4.0, 0.0),
    blocked: bool = False,
    lost: bool | None = None,
    regrasped: bool = False,
    reasons: tuple[Reason, ...] = REASONS,
) -> TrialStep:
    """Return a step that tried a row; it replicated when the attractor went to the left."""
    at, wrist = Point(6.0, 24.0), Pose(1.0, 16.0)
    start = observation(at, wrist=wrist)
    end = start if blocked else observation(Point(at.x + seen[0], at.y + seen[1]), wrist=wrist)
    status = ExecutionStatus.BLOCKED if blocked else ExecutionStatus.DONE
    aim = BehaviorCall.of(POSITION_WRIST, {"x": -5.0, "y": 8.0})
    done = Execution(tried.exploratory, ExecutionStatus.DONE, wrist, Pose(-4.0, 16.0), 2.0)
    record = StepRecord(
        number=number,
        clock=6.0 * number,
        reasons=reasons,
        row=tried,
        placing=Execution(aim, status, Pose(0.0, 17.0), wrist, 2.0),
        execution=None if blocked else done,
        start=start,
        end=end,
        expected=tried.expected_movement,
        seen=movement(start, end),
        replicated=seen[0] < -0.5 and not blocked,
        regrasped=regrasped,
        threshold=PROBABILITY_THRESHOLD,
    )
    return TrialStep(record, Truth(Pose(6.0, 24.0), Pose(2.0, 24.0)), lost)


def spec(
    start: int | str = 1,
    *,
    goal: int | str = 3,
    tool: str = "t-hook",
    shape: str | None = None,
    planner: Component = NESTED,
) -> TrialSpec:
    """Return a trial, with a broken tool when a `shape` is given."""
    task = Task(TASK_SET, replace(GOAL, name=str(goal)), str(start), Point(6.0, 24.0))
    return TrialSpec(
        protocol=Protocol.TOOL_ADAPTATION if shape else Protocol.EXTENSION_OF_REACH,
        tool=tool,
        held=tool_named(shape or tool),
        task=task,
        seed=0,
        robot=0,
        counters=Counters.AS_LEARNED,
        planner=planner,
        sensor="noisy",
        world=Component("table"),
    )


def trial(of: TrialSpec, outcome: Outcome, *steps: TrialStep, steps_taken: int = -1) -> TrialRecord:
    """Return a trial with these steps; with `steps_taken` it says another number of them."""
    taken = len(steps) if steps_taken < 0 else steps_taken
    left = (Reason("consistent", 97), Reason("probable", 2, 0.5), Reason("reachable", 0))
    return TrialRecord(
        of, steps, TrialEnd(outcome, taken, 6.0 * taken, left if outcome is NO_ROW else None)
    )


NO_ROW = Outcome.NO_ROW


def tried(trial_id: int, step: TrialStep, of: TrialSpec) -> tuple[StoredStep, TrialSpec]:
    """Return a step as the history of its row holds it."""
    record = step.record
    execution = record.execution
    stored = StoredStep(
        trial_id=trial_id,
        number=record.number,
        clock=record.clock,
        reasons=record.reasons,
        affordance_id=9,
        row=record.row,
        regrasped=record.regrasped,
        placing_status=record.placing.status.value,
        status=None if execution is None else execution.status.value,
        wrist_start=record.placing.wrist_end,
        wrist_end=record.placing.wrist_end,
        seen_start=record.start.object_position,
        seen_end=record.end.object_position,
        true_start=None,
        true_end=None,
        expected=record.expected,
        seen=record.seen,
        seen_distance=record.seen.distance,
        replicated=record.replicated,
        died=record.died,
        lost=step.lost,
        times_used_after=record.times_used_after,
        times_successful_after=record.times_successful_after,
    )
    return stored, of


BROKEN = (
    trial(spec(1, shape="l-hook"), Outcome.SOLVED, step(1, row(7), lost=False)),
    trial(
        spec(2, shape="l-hook"),
        Outcome.SOLVED,
        step(1, row(9, offset_x=5.0), seen=(0.0, 0.0), lost=True),
        step(2, row(9, offset_x=5.0, used=2), lost=True),
        step(3, row(7), lost=False),
    ),
    trial(
        spec(3, shape="l-hook"),
        Outcome.NO_ROW,
        step(1, row(9, offset_x=5.0), seen=(0.0, 0.0), lost=True),
        step(2, row(11, offset_x=-3.0), blocked=True, lost=False),
    ),
)
"""Row 9, on the right, is lost; 9 and 11 are excluded (9 in two trials)."""

WHOLE = (
    trial(spec(1), Outcome.SOLVED, step(1, row(7))),
    trial(spec(2), Outcome.SOLVED, step(1, row(9))),
    trial(spec(3), Outcome.ATTRACTOR_OUT_OF_REACH, step(1, row(9), seen=(3.0, 0.0))),
)

FOUR_ROBOTS = Reproduction(
    session=session_of(5),
    robots=4,
    cells={
        (tool, goal): [paper] * 4 if tool != "stick" else [0, 1, 1, 2]
        for (tool, goal), paper in EXTENSION_OF_REACH.items()
    },
    broken=[14, 15, 15, 16],
    others={},
    failures={"attractor out of reach": 40, "no row left": 9, "step limit": 9},
    trials=384,
    tries_on_lost=123,
)

MANY_ROBOTS = replace(
    FOUR_ROBOTS,
    session=session_of(5, robots=40, settings='{"friction.tool_puck":0.45}'),
    robots=40,
    cells={cell: list(counts) * 10 for cell, counts in FOUR_ROBOTS.cells.items()},
    broken=[14, 15, 15, 15] * 10,
)
"""Enough robots to hold the paper's counts against: 16 with the broken tool and 69 of 80 lie
outside."""


def by(run: int, tool: str, sensor: str = "noisy", planner: str = "nested-query") -> SolvedBy:
    """Return whose trials are counted together."""
    return SolvedBy(run, tool, sensor, planner, TASK_SET)


OVERVIEW = Overview(
    learned=[(RUNS[0], GROUPS), (RUNS[1], ())],
    solved=[
        GoalCounts(by(1, "t-hook"), True, {"1": (3, 4), "4": (12, 16)}),
        GoalCounts(by(1, "t-hook", "camera"), True, {"4": (4, 4)}),
        GoalCounts(by(2, "stick"), True, {"1": (0, 4)}),
    ],
    breakings=[
        Breaking(
            *(2, 1, 0, "t-hook", "l-hook", "camera", "nested-query", TASK_SET, True),
            ProtocolCounts(16, 13, 5.25, 31, 9),
            ProtocolCounts(16, 16, 4.0, 0, 2),
        ),
        Breaking(
            *(3, 7, 1, "t-stick", "stick", "noisy", "nested-query", TASK_SET, False),
            ProtocolCounts(16, 0, None, 16, 4),
            ProtocolCounts(16, 10, 2.0, 0, 0),
        ),
    ],
    failures={"attractor out of reach": 5, "no row left": 1},
    trials=56,
    reproductions=[FOUR_ROBOTS],
)
