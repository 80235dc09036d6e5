"""Hand-made records of learning and trials, without physics; and how they are put into a store."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

from affcli.core.affordance import Affordance
from affcli.core.behavior import POSITION_WRIST, BehaviorCall, Execution, ExecutionStatus
from affcli.core.change_detection import change_detected
from affcli.core.choice import Reason
from affcli.core.geometry import Point, Pose
from affcli.core.identity import Component
from affcli.core.observation import movement
from affcli.core.records import LearningRunInfo
from affcli.core.specs import (
    Counters,
    LearningSpec,
    LearningStep,
    Protocol,
    RobotRecord,
    SessionSpec,
    Tested,
    TrialRecord,
    TrialSpec,
    VerificationSpec,
)
from affcli.core.task import GoalRegion, Task
from affcli.core.trial import (
    Attempt,
    BabblingRecord,
    Outcome,
    StepRecord,
    TrialEnd,
    TrialStep,
    Truth,
)
from affcli.core.verification import ReplicationRecord
from affcli.store import Store
from affcli.store.connection import insert_one
from affcli.store.rows import trial_row
from affcli.store.tables import trial as trial_table
from tests.factories import BINDING, EXTEND_5, learning_spec, observation

NOW = "2026-01-02T03:04:05+00:00"
VERSIONS = {"affcli": "0", "python": "3"}
LONG_RUN = learning_spec(behaviors=120)
"""A run that several processes compute at once."""
ANGLE = 0.25
"""Of the wrist in every record (rad)."""
REASONS = (
    *(Reason("consistent", 9), Reason("probable", 8, 0.5)),
    *(Reason("reachable", 7), Reason("nearest", 2, 0.2)),
)


def session_spec(kind: str = "solve", *, seed: int = 0, robots: int = 1) -> SessionSpec:
    """Return a session by what the short learning runs carry."""
    run = learning_spec()
    planner = Component("nested-query")
    return SessionSpec(kind, seed, robots, planner, "extension-of-reach", **run.carried())


def begun(store: Store, kind: str = "solve", *, seed: int = 0, robots: int = 1) -> int:
    """Begin a session and return its number."""
    return store.sessions.begin(session_spec(kind, seed=seed, robots=robots), VERSIONS, NOW)


def learning_step(
    step: int = 1,
    *,
    moved: tuple[float, float] = (0.0, 0.0),
    call: BehaviorCall = EXTEND_5,
    resets: int = 0,
    redraws: int = 0,
) -> LearningStep:
    """Return one babbled behavior; it makes a row when the attractor moves far enough.

    Every number in it depends on `step`, so that no two columns can be mistaken for each other.
    """
    at = Point(1.0 + step / 8, 24.0 - step / 16)
    wrist = Point(at.x - 0.5, at.y - 14.0)
    end_at, end_wrist = Point(at.x + moved[0], at.y + moved[1]), Point(wrist.x, wrist.y + 5.0)
    start, end = observation(at, wrist=wrist), observation(end_at, wrist=end_wrist)
    aim = BehaviorCall.of(POSITION_WRIST, {"x": 0.5 + step, "y": 14.0})
    travel = Point(end_wrist.x - wrist.x, end_wrist.y - wrist.y)
    row = Affordance(step, BINDING, call, start, end, wrist_angle=ANGLE, travel=travel)
    done = ExecutionStatus.DONE
    record = BabblingRecord(
        step=step,
        clock=5.25 * step,
        resets=resets,
        redraws=redraws,
        placing=Execution(aim, done, Pose(0.0, 17.0), Pose(*wrist, ANGLE), 2.5),
        execution=Execution(call, done, Pose(*wrist, ANGLE), Pose(*end_wrist, ANGLE), 1.75),
        start=start,
        end=end,
        affordance=row if change_detected(start, end) else None,
    )
    truth = Truth(Pose(at.x + 0.03, at.y, 0.1), Pose(end_at.x, end_at.y - 0.03, 0.2))
    return record, truth


def learning_steps(count: int, *, first: int = 1) -> list[LearningStep]:
    """Return babbled behaviors of which every third makes a row."""
    return [
        learning_step(step, moved=(0.0, 4.0) if step % 3 == 0 else (0.0, 0.0), resets=step % 2)
        for step in range(first, first + count)
    ]


def learned(store: Store, count: int = 9, *, spec: LearningSpec | None = None) -> LearningRunInfo:
    """Put a finished run into the store and return what it says of it."""
    spec = spec or learning_spec(behaviors=count)
    run = store.learning.begin(spec, VERSIONS, NOW)
    steps = learning_steps(count)
    assert store.learning.append(run.id, 0, steps, None, 5.25 * count, done=True, now=NOW)
    return store.learning.begin(spec, VERSIONS, NOW)


def task(goal: int = 2, start: int = 1) -> Task:
    """Return a task whose places depend on their names."""
    region = GoalRegion(str(goal), Point(goal / 4, 15.0), 2.25)
    return Task("extension-of-reach", region, str(start), Point(-3.0, 22.0 + start / 8))


def trial_spec(
    goal: int = 2,
    start: int = 1,
    *,
    tool: str = "t-hook",
    shape: str | None = None,
    protocol: Protocol = Protocol.EXTENSION_OF_REACH,
    counters: Counters = Counters.AS_LEARNED,
    robot: int = 0,
    planner: str = "nested-query",
) -> TrialSpec:
    """Return a trial of the whole tool unless another `shape` is given."""
    return TrialSpec(
        *(protocol, tool, learning_spec(shape or tool).held, task(goal, start), 0, robot),
        *(counters, Component.parse(planner), "noisy", Component("table")),
    )


def trial_step(
    row: Affordance,
    number: int = 1,
    *,
    seen: tuple[float, float] = (0.0, 4.0),
    blocked: bool = False,
    lost: bool | None = None,
) -> TrialStep:
    """Return a step that tried `row` and replicated it if the attractor moved the expected way."""
    at, wrist = Point(3.0, 25.0), Point(2.5, 11.0)
    start = observation(at, wrist=wrist)
    end = start if blocked else observation(Point(at.x + seen[0], at.y + seen[1]), wrist=wrist)
    happened, expected = movement(start, end), row.expected_movement
    status = ExecutionStatus.BLOCKED if blocked else ExecutionStatus.DONE
    aim = BehaviorCall.of(POSITION_WRIST, {"x": 0.5, "y": 14.0})
    place, end_wrist = Pose(*wrist, ANGLE), Pose(2.5, 16.0, ANGLE)
    execution = Execution(row.exploratory, ExecutionStatus.DONE, place, end_wrist, 1.5)
    record = StepRecord(
        number=number,
        clock=6.5 * number,
        reasons=REASONS,
        row=row,
        placing=Execution(aim, status, Pose(0.0, 17.0), place, 2.0),
        execution=None if blocked else execution,
        start=start,
        end=end,
        expected=expected,
        seen=happened,
        replicated=happened.distance > 0.5 and math.copysign(1, happened.dy * expected.dy) > 0,
        regrasped=number % 2 == 0,
        threshold=0.5,
    )
    return TrialStep(record, Truth(Pose(3.0, 25.1), Pose(3.1, 29.2)), lost)


def replication(row: Affordance, number: int = 1) -> tuple[ReplicationRecord, Truth | None]:
    """Return a try of `row` in a verification that replicates it."""
    step = trial_step(row, number)
    return ReplicationRecord(**step.record.by_name(), number=number, clock=7.5 * number), step.truth


def verification_spec(shape: str = "l-hook", tries: int = 4) -> VerificationSpec:
    """Return a verification of a T-hook's table."""
    held = learning_spec(shape).held
    return VerificationSpec("t-hook", held, 0, 0, "noisy", tries, until_verdict=False)


def counted(row: Affordance, step: Attempt) -> Affordance:
    """Return `row` with the counters it has after one use."""
    used, successful = step.times_used_after, step.times_successful_after
    return replace(row, times_used=used, times_successful=successful)


def trial_record(
    spec: TrialSpec, rows: Sequence[Affordance], outcome: Outcome = Outcome.SOLVED
) -> TrialRecord:
    """Return a whole trial that tried these rows one after the other, each as learned."""
    steps = tuple(trial_step(row, number) for number, row in enumerate(rows, 1))
    return TrialRecord(spec, steps, TrialEnd(outcome, len(steps), 6.5 * len(steps)))


def robot_record(robot: int, *, behaviors: int = 6, seed: int = 0) -> RobotRecord:
    """Return the life of a robot with two tools, two trials each, and one with a broken tool."""
    steps = tuple(learning_steps(behaviors))
    rows = [record.affordance for record, _ in steps if record.affordance is not None]
    runs, trials = [], []
    for tool in ("stick", "t-hook"):
        spec = learning_spec(tool, seed=seed, robot=robot, behaviors=behaviors)
        runs.append((spec, steps, 31.5))
        for start, outcome in ((1, Outcome.SOLVED), (2, Outcome.NO_ROW)):
            trial = trial_spec(1, start, tool=tool, robot=robot)
            trials.append(trial_record(trial, rows[:start], outcome))
    broken = trial_spec(1, 1, shape="l-hook", protocol=Protocol.TOOL_ADAPTATION, robot=robot)
    failed = trial_step(rows[0], 1, seen=(0.0, 0.0), lost=True)
    again = trial_step(rows[1], 2, lost=False)
    trials.append(TrialRecord(broken, (failed, again), TrialEnd(Outcome.SOLVED, 2, 13.0)))
    tested = (Tested(0, int(trial.spec.tool == "t-hook"), trial) for trial in trials)
    return RobotRecord(robot, tuple(runs), tuple(tested), (None, None))


def all_steps(trials: Sequence[TrialRecord]) -> list[TrialStep]:
    """Return the steps of several trials in one list."""
    return list(itertools.chain.from_iterable(trial.steps for trial in trials))


def save_trial(
    store: Store,
    session: int,
    run: int,
    spec: TrialSpec,
    steps: Sequence[TrialStep] = (),
    outcome: Outcome = Outcome.SOLVED,
) -> int:
    """Save a trial of these steps from beginning to end; return its number."""
    _, ids = store.learning.table(run)
    end = TrialEnd(outcome, len(steps), 6.5 * len(steps))
    (number,) = store.trials.save_all(session, run, [TrialRecord(spec, tuple(steps), end)], ids)
    return number


def unfinished_trial(store: Store, session: int, run: int, spec: TrialSpec) -> int:
    """Leave a trial without steps and end, as affcli did that saved step by step and was killed."""
    row = trial_row(spec, None) | {"session_id": session, "learning_run_id": run}
    with store.database.writing() as connection:
        return insert_one(connection, trial_table, row)
