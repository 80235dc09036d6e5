"""Small builders of what the tests are about, each with a default for what a test leaves open."""

from collections.abc import Iterable
from functools import cache

from hypothesis import strategies as st

from affcli import registry
from affcli.behaviors.moving import EXTEND_ARM
from affcli.config import Settings, settings_with
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.choice import Situation
from affcli.core.geometry import Point, Pose
from affcli.core.identity import Component
from affcli.core.observation import Movement, Observation, SensorKind
from affcli.core.ports import Robot
from affcli.core.specs import (
    Counters,
    LearningSpec,
    Protocol,
    TrialSpec,
    VerificationSpec,
)
from affcli.core.task import GoalRegion
from affcli.core.tool import PUCK_COLOR, Color, Tool, ToolName
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts
from affcli.simulation.table_world import TableSetting, TableWorld
from affcli.simulation.tools.paper import TOOL_COLORS

TOOL_COLOR = TOOL_COLORS[ToolName("t-hook")]
BINDING = BehaviorCall.of(GRASP, {"grasp_point": 1.0})
EXTEND_5 = BehaviorCall.of(EXTEND_ARM, {"offset_distance": 5.0})

EXACT = settings_with({"sensor": {"position_noise": 0, "color_noise": 0}}, "a test")
"""A sensor without noise."""

UNITS = {"", "in", "in/s", "in/s^2", "s", "kg", "degrees", "degrees/s", "degrees/s^2"}
UNITS |= {"of 255", "mm", "1/mm^2", "px", "min"}
"""In which settings and parameters are told; empty for a count or a share."""

EIGHTH = 0.125
eighths = st.integers(-320, 320).map(lambda n: n * EIGHTH)
"""Lengths up to 40 in on a binary grid: sums, differences and squares of them are exact, so that a
tie is a tie whichever way it is computed."""
places = st.builds(Point, eighths, eighths)
seeds = st.integers(0, 2**63 - 1)


def observation(
    at: Point = Point(0.0, 24.0),
    *,
    wrist: Point | Pose = Point(0.0, 16.0),
    object_color: Iterable[float] = PUCK_COLOR,
    tool_color: Iterable[float] = TOOL_COLOR,
) -> Observation:
    """Return what a sensor without noise sees with the attractor at `at`."""
    offset = (at.x - wrist.x, at.y - wrist.y, 0.0)
    return Observation(at.x, at.y, 0.0, *offset, *object_color, *tool_color)


def moved_by(dx: float, dy: float) -> Movement:
    """Return a movement on the table."""
    return Movement(dx, dy, 0.0)


def affordance(
    step: int = 1,
    *,
    moved: tuple[float, float] = (0.0, 5.0),
    offset: Point = Point(0.0, 8.0),
    at: Point = Point(0.0, 24.0),
    used: int = 1,
    successful: int = 1,
    call: BehaviorCall = EXTEND_5,
    binding: BehaviorCall = BINDING,
    wrist_angle: float = 0.0,
    object_color: Color = PUCK_COLOR,
    tool_color: Color = TOOL_COLOR,
) -> Affordance:
    """Return a row whose attractor, at `offset` from the wrist, moved by `moved`."""
    wrist = Point(at.x - offset.x, at.y - offset.y)
    end = Point(at.x + moved[0], at.y + moved[1])
    start_seen, end_seen = (
        observation(place, wrist=wrist, object_color=object_color, tool_color=tool_color)
        for place in (at, end)
    )
    return Affordance(
        step,
        binding,
        call,
        start_seen,
        end_seen,
        times_used=used,
        times_successful=successful,
        wrist_angle=wrist_angle,
    )


def table_of(*rows: Affordance) -> AffordanceTable:
    """Return a table of these rows."""
    return AffordanceTable(rows)


def goal_at(x: float, y: float, half_width: float = 2.0) -> GoalRegion:
    """Return a goal region with its centre at (x, y)."""
    return GoalRegion("1", Point(x, y), half_width)


def situation(
    table: AffordanceTable, seen: Observation, goal: GoalRegion, robot: Robot
) -> Situation:
    """Return where a robot stands that has this table, sees this and wants this."""
    return Situation(table, seen, goal, robot.wrist, robot.reaches, robot.holding)


def tool_named(name: str, settings: Settings | None = None) -> Tool:
    """Return a registered tool, in the sizes of the settings."""
    return registry.tool(name, (settings or Settings()).workspace.tools)


def setting_with(tool: str, seed: int = 0, settings: Settings | None = None) -> TableSetting:
    """Return a robot at a table of its own, with a tool in its hand at the table's centre."""
    spec = learning_spec(tool, seed=seed, settings=settings)
    setting = TableWorld(settings or Settings()).learning(spec, laid_out=False)
    setting.table.wrist = setting.table.home
    return setting


def learning_spec(
    tool: str = "t-hook",
    *,
    seed: int = 0,
    robot: int = 0,
    behaviors: int | None = 20,
    hours: float | None = None,
    settings: Settings | None = None,
) -> LearningSpec:
    """Return the spec of a short learning run; of a timed one when `hours` is given."""
    limit = None if hours is not None else behaviors
    return RunParts.chosen(settings or Settings()).spec(tool, seed, robot, hours, limit)


def trial_spec(
    learned: LearningSpec,
    *,
    goal: str = "1",
    start: str = "1",
    held: Tool | None = None,
    seed: int = 0,
    sensor: SensorKind | None = None,
) -> TrialSpec:
    """Return one of the paper's trials with the tool that was learned, or with another."""
    tasks = TableWorld(Settings()).tasks(registry.DEFAULTS["task"])
    task = next(t for t in tasks if (t.goal.name, t.start_name) == (goal, start))
    return TrialSpec(
        protocol=Protocol.EXTENSION_OF_REACH,
        tool=learned.tool,
        held=held or learned.held,
        task=task,
        seed=seed,
        robot=learned.robot,
        counters=Counters.AS_LEARNED,
        planner=Component(registry.DEFAULTS["planner"]),
        sensor=sensor or learned.sensor,
        world=learned.world,
    )


def verification_spec(
    learned: LearningSpec, *, held: Tool | None = None, seed: int = 0, tries: int = 20
) -> VerificationSpec:
    """Return a verification with the tool that was learned, or with another."""
    return VerificationSpec(
        tool=learned.tool,
        held=held or learned.held,
        seed=seed,
        robot=learned.robot,
        sensor=learned.sensor,
        tries=tries,
        until_verdict=False,
    )


@cache
def rows_learned(
    tool: str = "t-hook", behaviors: int = 400, settings: Settings | None = None
) -> tuple[Affordance, ...]:
    """Return the rows of a learning run of so many behaviors."""
    spec = learning_spec(tool, behaviors=behaviors, settings=settings)
    return tuple(r.affordance for r, _ in LearningRun(spec).steps() if r.affordance is not None)
