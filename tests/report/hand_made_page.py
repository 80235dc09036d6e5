"""A page's content made by hand, without physics and without a store; and tables of any rows."""

import json
import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from hypothesis import strategies as st

from affcli.behaviors.moving import CONTRACT_ARM, EXTEND_ARM, SLIDE_ARM_RIGHT
from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorName
from affcli.core.geometry import Point, Pose
from affcli.core.replay import Considered, Difference, Replay, ReplayedStep
from affcli.core.scene import Scene
from affcli.core.specs import TrialSpec
from affcli.core.tool import PUCK_COLOR, Tool, ToolName
from affcli.core.trial import Outcome, TrialEnd, TrialStep, Truth
from affcli.core.workspace import Workspace
from affcli.report.page.content import Broken, Content, LearnedRows
from affcli.simulation.tools.paper import paper_tools
from tests.factories import affordance, goal_at, learning_spec
from tests.report.hand_made import call, learned_run, row, spec, step

WORKSPACE = Workspace()
TOOLS = paper_tools(WORKSPACE.tools)
T_HOOK = TOOLS[ToolName("t-hook")]
GOAL = goal_at(0.0, 24.0)
ROWS = {70: row(7), 90: row(9, offset_x=5.0), 110: row(11, offset_x=-3.0)}
"""Rows by their numbers in the store; all slide the attractor to the left."""


def scenes(held: Tool, *places: tuple[float, float, float]) -> tuple[Scene, ...]:
    """Return scenes with the attractor at these poses, and the wrist below it."""
    return tuple(
        Scene(Pose(x, y, angle), PUCK_COLOR, Pose(x - 5.0, y - 8.0), held, GOAL)
        for x, y, angle in places
    )


def replayed(taken: TrialStep, held: Tool) -> ReplayedStep:
    """Return a step done again, for which no other row came close."""
    tried = taken.record.row
    (number,) = (number for number, one in ROWS.items() if one.step == tried.step)
    start, end = taken.truth or Truth(Pose(6.0, 24.0), Pose(6.0, 24.0))
    return ReplayedStep(
        taken,
        taken.record.start,
        GOAL,
        (Considered(number, tried, 2.0, 1.5),),
        scenes(held, (*start.point, 0.0), (*start.point, 0.0), (*end.point, 0.5)),
        1,
    )


def replay(
    of: TrialSpec,
    outcome: Outcome | None,
    *steps: TrialStep,
    number: int = 1,
    workspace: Workspace = WORKSPACE,
    differences: tuple[Difference, ...] = (),
) -> Replay:
    """Return a trial done again; one that was interrupted for no outcome."""
    held = of.held.painted(TOOLS[ToolName(of.tool)].color)
    end = None if outcome is None else TrialEnd(outcome, len(steps), 6.0 * len(steps))
    (opening,) = scenes(held, (6.0, 24.0, 0.0))
    again = tuple(replayed(one, held) for one in steps)
    return Replay(number, 1, of, workspace, opening, again, end, differences)


def learned(tool: Tool = T_HOOK, rows: Mapping[int, Affordance] | None = None) -> LearnedRows:
    """Return what a learning run left."""
    run = learned_run(1, replace(learning_spec(), held=tool), behaviors=565, resets=21)
    return LearnedRows(run, ROWS if rows is None else rows)


BROKEN_TRIALS = (
    replay(spec(1, shape="l-hook"), Outcome.SOLVED, step(1, ROWS[70], lost=False), number=2),
    replay(
        spec(2, shape="l-hook"),
        Outcome.SOLVED,
        step(1, ROWS[90], seen=(0.0, 0.0), lost=True),
        step(2, ROWS[70], lost=False),
        number=3,
    ),
    replay(
        spec(3, shape="l-hook"),
        Outcome.NO_ROW,
        step(1, ROWS[90], seen=(0.0, 0.0), lost=True),
        step(2, ROWS[110], blocked=True, lost=False),
        number=4,
    ),
)
"""Row 90, on the right, is lost and excluded in two trials; 110, on the left, in one."""
BROKEN = Broken(learned(), BROKEN_TRIALS)
WHOLE_TRIAL = replay(spec(1), Outcome.SOLVED, step(1, ROWS[70]))


def content(**changes: object) -> Content:
    """Return the content of a page of one robot whose tool broke."""
    usual: dict[str, object] = {
        "database": "my.db",
        "robot": "the robot of seed 0",
        "reproduction": None,
        "tools": [learned()],
        "replays": [WHOLE_TRIAL, *BROKEN_TRIALS],
        "not_replayed": {},
        "left_out": 0,
        "broken": [BROKEN],
        "versions": {"affcli": "0", "python": "3"},
    }
    return Content(**(usual | changes))  # type: ignore[arg-type]


def data_in(page: str) -> Any:
    """Return the data that the page's script reads."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


behaviors = st.sampled_from([CONTRACT_ARM, EXTEND_ARM, SLIDE_ARM_RIGHT])
coordinates = st.floats(-30, 30)


@st.composite
def tables(draw: st.DrawFn) -> dict[int, Affordance]:
    """Return affordance tables by the rows' numbers."""
    numbers = draw(st.sets(st.integers(1, 10_000), max_size=12))

    def one(number: int) -> Affordance:
        used = draw(st.integers(1, 6))
        name: BehaviorName = draw(behaviors)
        return affordance(
            number,
            moved=(draw(coordinates), draw(coordinates)),
            offset=Point(draw(coordinates), draw(coordinates)),
            used=used,
            successful=draw(st.integers(0, used)),
            call=call(name, draw(st.sampled_from([2.0, 5.0]))),
        )

    return {number: one(number) for number in sorted(numbers)}
