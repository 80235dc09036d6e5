"""Records of a laboratory with more than the paper's: six tools, five goals, two planners, two
grasps, a behavior that turns the wrist; and a tool of which only the name is known.
"""

import math
from dataclasses import replace

from affcli.analysis.overview import Breaking, Overview, ProtocolCounts, goal_counts
from affcli.analysis.paper import EXTENSION_OF_REACH, TOOLS
from affcli.analysis.reproduction import Reproduction
from affcli.behaviors.moving import EXTEND_ARM
from affcli.core.affordance import Affordance
from affcli.core.behavior import GRASP, BehaviorCall, BehaviorName, ExploratoryBehavior
from affcli.core.choice import Reason
from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.identity import Component
from affcli.core.motion import Carry
from affcli.core.records import LearningRunInfo, TrialInfo
from affcli.core.replay import Considered, Replay, ReplayedStep
from affcli.core.results import SuccessCount
from affcli.core.scene import Scene
from affcli.core.specs import Protocol, TrialSpec
from affcli.core.tool import PUCK_COLOR, Color, Tool, ToolName, ToolPart, hold_of, unknown_tool
from affcli.core.trial import Outcome, TrialEnd, TrialStep
from affcli.core.workspace import Workspace
from affcli.report.page.content import Broken, Content, LearnedRows
from tests.factories import affordance, learning_spec
from tests.report.hand_made import TASK_SET, call, learned_run, session_of, spec, step, trial_info

RAKE = Tool(
    ToolName("rake"),
    Color((20.0, 200.0, 200.0)),
    (
        ToolPart("handle", ConvexPolygon.box(-0.5, -1.0, 0.5, 14.0)),
        ToolPart("comb", ConvexPolygon.box(-4.0, 14.0, 4.0, 15.0)),
    ),
)
HANDLE = replace(RAKE, name=ToolName("bare handle"), parts=RAKE.parts[:1])
SPOON = unknown_tool("spoon")
LOOKAHEAD = Component.of("lookahead", {"depth": 2.0})
GRASP_HIGH = BehaviorCall.of(GRASP, {"grasp_point": 4.0, "angle": 15.0})
TURN = BehaviorCall.of(BehaviorName("turn wrist"), {"angle": 30.0})
WEIGHED = (Reason("imagined", 140), Reason("expected distance", value=3.25))
"""The reasons of a planner that no paper describes."""

PLAIN = learning_spec()
TURNING = replace(
    PLAIN,
    held=RAKE,
    binding=GRASP_HIGH,
    repertoire=(
        *PLAIN.repertoire,
        ExploratoryBehavior(TURN, (Carry(Pose(0.0, 0.0, math.radians(30.0))),)),
    ),
)
RUNS = (
    *(learned_run(n, learning_spec(tool)) for n, tool in enumerate(TOOLS, start=1)),
    learned_run(6, TURNING),
    learned_run(7, replace(PLAIN, held=SPOON)),
)
"""One of each of the paper's tools, of the rake, and of what is only known as a spoon."""


def results() -> list[TrialInfo]:
    """Return one trial of each run, at each of five goals, by each of two planners."""
    return [
        trial_info(number, run, run.spec.tool, goal, planner=planner)
        for number, run in enumerate(RUNS, 1)
        for goal in ("1", "2", "3", "4", "far corner")
        for planner in ("nested-query", "lookahead:depth=2")
    ]


def count(
    tool: str, goal: str, robot: int, solved: int, *, shape: str = "", planner: str = "nested-query"
) -> SuccessCount:
    """Return how often a robot solved four trials."""
    protocol = Protocol.TOOL_ADAPTATION if shape else Protocol.EXTENSION_OF_REACH
    return SuccessCount(
        robot, protocol, tool, shape or tool, TASK_SET, goal, planner, trials=4, solved=solved
    )


def counts() -> list[SuccessCount]:
    """Return what three robots did: the paper's 80 + 16, a sixth tool, a fifth goal, a planner."""
    found = []
    for robot in range(3):
        found += [count(tool, goal, robot, n) for (tool, goal), n in EXTENSION_OF_REACH.items()]
        found += [count("t-hook", goal, robot, 4, shape="l-hook") for goal in "1234"]
        found += [count("rake", goal, robot, 3 + robot % 2) for goal in "1234"]
        found += [count("t-hook", "far corner", robot, robot)]
        found += [count("t-hook", "1", robot, 4, planner="lookahead:depth=2")]
        found += [count("rake", "1", robot, 1, shape="bare handle")]
    return found


OUTCOMES = {Outcome.SOLVED: 300, Outcome.NO_ROW: 12}
REPRODUCTION = Reproduction.of(session_of(5, robots=3), range(3), counts(), OUTCOMES, 7)
OTHERWISE = Reproduction.of(
    session_of(6, robots=3, planner=LOOKAHEAD, binding=GRASP_HIGH), range(3), counts(), OUTCOMES, 7
)
"""The same counts of robots that held and chose otherwise than the paper's."""

OVERVIEW = Overview(
    learned=[(run, ()) for run in RUNS],
    solved=goal_counts(results(), RUNS),
    breakings=[
        Breaking(
            *(2, 6, 0, "rake", "bare handle", "noisy", "lookahead:depth=2", TASK_SET, False),
            ProtocolCounts(20, 13, 5.25, 31, 9),
            ProtocolCounts(20, 16, 4.0, 0, 2),
        )
    ],
    failures={"no row left": 12},
    trials=312,
    reproductions=[REPRODUCTION, OTHERWISE],
)


def rows() -> dict[int, Affordance]:
    """Return rows of the rake: with either grasp, with the wrist straight and turned."""
    made = {
        60 + n: affordance(
            n, call=behavior, binding=binding, wrist_angle=math.radians(angle), moved=(1.0, -3.0)
        )
        for n, (behavior, binding, angle) in enumerate(
            [
                (call(EXTEND_ARM, 5), GRASP_HIGH, 0.0),
                (TURN, GRASP_HIGH, 30.0),
                (TURN, BehaviorCall.of(GRASP, {"grasp_point": 1.0}), 0.0),
            ],
            start=1,
        )
    }
    return {number: replace(row, travel=Point(0.0, 0.0)) for number, row in made.items()}


LEARNED = LearnedRows(RUNS[5], rows())
SPOONS = LearnedRows(RUNS[6], {90: affordance(1, moved=(0.0, -2.0))})


def trial(number: int, held: Tool, outcome: Outcome, *steps: TrialStep) -> Replay:
    """Return a trial of the rake by another planner, its wrist turned and its tool grasped anew."""
    of = _spec(held)
    holds = (GRASP_HIGH, *(taken.record.row.binding for taken in steps))
    scenes = [
        Scene(
            Pose(6.0 - n, 24.0),
            PUCK_COLOR,
            Pose(1.0, 12.0, math.radians(30.0 * n)),
            held.painted(RAKE.color).held(hold_of(binding)),
            of.task.goal,
        )
        for n, binding in enumerate(holds)
    ]
    replayed = tuple(
        ReplayedStep(
            taken,
            taken.record.start,
            of.task.goal,
            (Considered(60 + taken.record.row.step, taken.record.row, 2.0, 1.5),),
            (scenes[n], scenes[n + 1]),
            1,
        )
        for n, taken in enumerate(steps)
    )
    end = TrialEnd(outcome, len(steps), 6.0, WEIGHED if outcome is Outcome.NO_ROW else None)
    return Replay(number, 6, of, Workspace(), scenes[0], replayed, end, ())


def _spec(held: Tool) -> TrialSpec:
    """Return a trial with the rake, or with what is left of it."""
    shape = None if held == RAKE else "stick"
    usual = spec("left of the middle", goal="far corner", shape=shape, planner=LOOKAHEAD)
    return replace(usual, tool="rake", held=held)


def _steps() -> tuple[TrialStep, ...]:
    """Return a step with the hold that was learned, and one for which it is grasped anew."""
    first, _, anew = rows().values()
    return (
        step(1, first, seen=(0.0, 0.0), reasons=WEIGHED, lost=True),
        step(2, anew, reasons=WEIGHED, regrasped=True),
    )


WHOLE = trial(31, RAKE, Outcome.SOLVED, *_steps())
BROKEN = trial(32, HANDLE, Outcome.NO_ROW, *_steps())
CONTENT = Content(
    database="many.db",
    robot="the robot of seed 0",
    reproduction=REPRODUCTION,
    tools=[LEARNED, SPOONS],
    replays=[WHOLE, BROKEN],
    not_replayed={33: "a spoon", 34: "a spoon", 35: "another world"},
    left_out=0,
    broken=[Broken(LEARNED, [BROKEN])],
    versions={"affcli": "0"},
)


def info(number: int) -> LearningRunInfo:
    """Return a run by its number."""
    return RUNS[number - 1]
