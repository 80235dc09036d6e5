"""Small records made by hand, so that what the tables must say is known beforehand."""

from dataclasses import dataclass, replace

from affcli.report.paper import EXTENSION_OF_REACH

from affcli.core.affordance import Affordance
from affcli.core.behavior import (
    CONTRACT_ARM,
    EXTEND_ARM,
    POSITION_WRIST,
    SLIDE_ARM_LEFT,
    SLIDE_ARM_RIGHT,
    BehaviorCall,
    BehaviorName,
    Execution,
    ExecutionStatus,
)
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Movement, movement
from affcli.core.trial import (
    Counters,
    LearningSpec,
    Outcome,
    Protocol,
    StepRecord,
    Survivors,
    TrialEnd,
    TrialRecord,
    TrialSpec,
    TrialStep,
    Truth,
)
from affcli.report.overview import Breaking, Overview, ProtocolFigures
from affcli.report.reproduction import Reproduction
from tests.factories import affordance, learning_spec, observation


@dataclass(frozen=True, slots=True)
class Group:
    """A behavior group as the store gives it."""

    call: BehaviorCall
    tried: int
    rows: int = 0
    mean_movement: float | None = None
    mean_dx: float | None = None
    mean_dy: float | None = None


@dataclass(frozen=True, slots=True)
class Run:
    """A learning run as the store gives it."""

    id: int
    spec: LearningSpec
    status: str = "done"
    behaviors: int = 800
    rows: int = 97
    resets: int = 12
    robot_seconds: float = 3601.2
    session_id: int | None = None


@dataclass(frozen=True, slots=True)
class Row:
    """A row of an affordance table as the store gives it."""

    id: int
    run_id: int
    tool: str
    row: Affordance


@dataclass(frozen=True, slots=True)
class Tried:
    """A step that tried a row as the store gives it."""

    trial_id: int
    number: int
    row: Affordance
    placing_status: str
    status: str | None
    expected: Movement
    seen: Movement
    replicated: bool
    died: bool
    lost: bool | None
    times_used_after: int
    times_successful_after: int


def call(name: BehaviorName, inches: float) -> BehaviorCall:
    """Return an exploratory behavior with its distance."""
    return BehaviorCall.of(name, {"offset_distance": inches})


GROUPS = (
    Group(call(CONTRACT_ARM, 2), 101),
    Group(call(CONTRACT_ARM, 5), 99, 12, 3.44, 0.1, -3.4),
    Group(call(EXTEND_ARM, 5), 100, 1, 0.96, 0.0, 0.96),
    Group(call(SLIDE_ARM_LEFT, 2), 98, 20, 1.25, -1.25, 0.002),
    Group(call(SLIDE_ARM_RIGHT, 5), 102, 33, 2.55, 2.5, -0.005),
)
"""The last moved at 359.9 degrees, which is 0 and not 360."""

RUNS = (
    Run(1, learning_spec("t-hook")),
    Run(2, learning_spec("stick", seed=2**63 - 1), "running", 500, 1, 1, 2399.6),
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


def step(
    number: int,
    tried: Affordance,
    *,
    seen: tuple[float, float] = (-4.0, 0.0),
    blocked: bool = False,
    lost: bool | None = None,
) -> TrialStep:
    """Return a step that tried a row; it replicated when the attractor went to the left."""
    at, wrist = Point(6.0, 24.0), Point(1.0, 16.0)
    start = observation(at, wrist=wrist)
    end = start if blocked else observation(Point(at.x + seen[0], at.y + seen[1]), wrist=wrist)
    status = ExecutionStatus.BLOCKED if blocked else ExecutionStatus.DONE
    aim = BehaviorCall.of(POSITION_WRIST, {"x": -5.0, "y": 8.0})
    done = Execution(tried.exploratory, ExecutionStatus.DONE, wrist, Point(-4.0, 16.0), 2.0)
    record = StepRecord(
        number=number,
        clock=6.0 * number,
        survivors=Survivors(97, 80, 24, 5),
        row=tried,
        placing=Execution(aim, status, Point(0.0, 17.0), wrist, 2.0),
        execution=None if blocked else done,
        start=start,
        end=end,
        expected=tried.expected_movement,
        seen=movement(start, end),
        replicated=seen[0] < -0.5 and not blocked,
    )
    return TrialStep(record, Truth(Pose(6.0, 24.0), Pose(2.0, 24.0)), lost)


def spec(
    start: int = 1, *, goal: int = 3, tool: str = "t-hook", shape: str | None = None
) -> TrialSpec:
    """Return a trial, with a broken tool when a `shape` is given."""
    protocol = Protocol.TOOL_ADAPTATION if shape else Protocol.EXTENSION_OF_REACH
    return TrialSpec(protocol, tool, shape or tool, goal, start, 0, 0, Counters.AS_LEARNED)


def trial(of: TrialSpec, outcome: Outcome, *steps: TrialStep, steps_taken: int = -1) -> TrialRecord:
    """Return a trial with these steps; with `steps_taken` it says another number of them."""
    taken = len(steps) if steps_taken < 0 else steps_taken
    left = Survivors(97, 2, 0, 0) if outcome is Outcome.NO_ROW else None
    return TrialRecord(of, steps, TrialEnd(outcome, taken, 6.0 * taken, left))


def tried(trial_id: int, step: TrialStep, of: TrialSpec) -> tuple[Tried, TrialSpec]:
    """Return a step as the history of its row holds it."""
    record = step.record
    execution = record.execution
    return (
        Tried(
            trial_id,
            record.number,
            record.row,
            record.placing.status.value,
            None if execution is None else execution.status.value,
            record.expected,
            record.seen,
            record.replicated,
            record.died,
            step.lost,
            record.times_used_after,
            record.times_successful_after,
        ),
        of,
    )


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
    robots=4,
    cells={
        (tool, goal): [paper] * 4 if tool != "stick" else [0, 1, 1, 2]
        for tool, counts in EXTENSION_OF_REACH.items()
        for goal, paper in enumerate(counts, start=1)
    },
    broken=[14, 15, 15, 16],
    failures={"no row left": 9, "attractor out of reach": 40, "step limit": 9},
    trials=384,
    tries_on_lost=123,
    session=5,
    seed=1000,
    settings="defaults",
)

MANY_ROBOTS = replace(
    FOUR_ROBOTS,
    robots=20,
    cells={cell: list(counts) * 5 for cell, counts in FOUR_ROBOTS.cells.items()},
    broken=[14, 15, 15, 15] * 5,
    settings="friction.tool_puck = 0.45",
)
"""Enough robots for intervals; the paper's 16 with the broken tool and 69 of 80 lie outside."""

OVERVIEW = Overview(
    learned=[
        (RUNS[0], "defaults", GROUPS),
        (RUNS[1], "sensor.position_noise = 0.12", ()),
    ],
    solved={
        (1, "t-hook", "noisy", 1): (3, 4),
        (1, "t-hook", "noisy", 4): (12, 16),
        (1, "t-hook", "camera", 4): (4, 4),
        (2, "stick", "noisy", 1): (0, 4),
    },
    breakings=[
        Breaking(
            2,
            1,
            0,
            "t-hook",
            "l-hook",
            "camera",
            ProtocolFigures(16, 13, 5.25, 31, 9),
            ProtocolFigures(16, 16, 4.0, 0, 2),
        ),
        Breaking(
            3,
            7,
            1,
            "t-stick",
            "stick",
            "noisy",
            ProtocolFigures(16, 0, None, 16, 4),
            ProtocolFigures(16, 10, 2.0, 0, 0),
        ),
    ],
    failures={"attractor out of reach": 5, "no row left": 1},
    trials=56,
    reproductions=[FOUR_ROBOTS],
)
