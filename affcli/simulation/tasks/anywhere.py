"""Tasks at random places: a start and a goal where at least one of the paper's tools reaches.

The paper's 16 tasks are too easy to tell planners apart: its goals are wide, and all starts lie on
one line. Here the places are drawn anew for each seed, and the goals are as small as is asked for.
"""

from collections.abc import Iterator

import numpy as np

from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point, near_any
from affcli.core.limits import LARGEST_SEED
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.core.task import GoalRegion, Task
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError
from affcli.simulation.arm import reach_at
from affcli.simulation.reach_of_tool import touchable
from affcli.simulation.tools.paper import paper_tools

NAME = "anywhere"
MOST_TASKS = 1_000
PLACEMENTS = 1_000
"""Places tried for a task before it is called impossible."""


def anywhere(workspace: Workspace, half_width: float, n: int, seed: int) -> tuple[Task, ...]:
    """Return random tasks; those of more tasks of a seed begin with those of fewer, and goals of
    another width lie at the same places unless a start lies over one.

    Args:
        workspace: what stands where; the tools are the paper's five, in its sizes.
        half_width: half the side of each goal region (in).
        n: how many.
        seed: of the places.

    Raises:
        BadInputError: no tool reaches a place for a start and one for a goal.
    """
    part = PARTS[0]
    name = str(part.component({"half_width": half_width, "n": n, "seed": seed}))
    places = _Places(workspace)
    tasks = []
    for number in range(1, n + 1):
        # Each task has a stream of its own: whatever one rejects, the next begins alike.
        rng = np.random.default_rng(np.random.SeedSequence((seed, number)))
        start = places.start(rng)
        goal = GoalRegion(str(number), places.goal(rng, start, half_width), half_width)
        tasks.append(Task(name, goal, str(number), start))
    return tuple(tasks)


class _Places:
    """Places of the table where a tool reaches.

    Args:
        workspace: what stands where.
    """

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        tools = paper_tools(workspace.tools).values()
        self._tools = tuple(tool.outlines for tool in tools)
        arm = workspace.arm
        self._reach = reach_at(arm, arm.flange_height)

    def start(self, rng: np.random.Generator) -> Point:
        """Return a place within reach and off every tool that lies at the table's centre."""
        x, y = self._workspace.wrist_start
        radius = self._workspace.puck.radius
        for place in self._drawn(rng):
            beside = Point(place.x - x, place.y - y)
            if not any(near_any(outlines, beside, radius) for outlines in self._tools):
                return place
        raise self._nowhere("a start")

    def goal(self, rng: np.random.Generator, start: Point, half_width: float) -> Point:
        """Return a place within reach that is the middle of a goal which `start` is not over."""
        for place in self._drawn(rng):
            if not GoalRegion("", place, half_width).contains(start):
                return place
        raise self._nowhere("a goal that its start is not over,", "make half_width smaller, or ")

    def _drawn(self, rng: np.random.Generator) -> Iterator[Point]:
        """Yield random places of the table (uniform) that some tool reaches, as long as it takes
        few enough tries.
        """
        top, depth = self._workspace.table, self._workspace.puck.radius - MOVEMENT_THRESHOLD
        for u, v in (rng.random(2).tolist() for _ in range(PLACEMENTS)):
            place = Point((2.0 * u - 1.0) * top.half_width, top.near + v * (top.far - top.near))
            if any(touchable(one, self._reach, place, depth) for one in self._tools):
                yield place

    def _nowhere(self, what: str, or_else: str = "") -> BadInputError:
        return BadInputError(
            f"tasks {NAME}: no place for {what} that a tool reaches in {PLACEMENTS} tries: nobody "
            f"could do it; {or_else}bring table.near, table.far and table.half_width closer to the "
            "arm"
        )


PARTS = (
    Part(
        kind="tasks",
        name=NAME,
        summary="random starts and goals where at least one of the paper's tools reaches",
        source="affcli",
        build=anywhere,
        params={
            "half_width": Setting(2.25, "in", "Half the side of each goal region.", 0.1, 10.0),
            "n": Setting(20, "", "How many tasks.", 1, MOST_TASKS),
            "seed": Setting(
                *(0, ""),
                "Of the places; that of the session where it is not given.",
                *(0, LARGEST_SEED),
            ),
        },
    ),
)
