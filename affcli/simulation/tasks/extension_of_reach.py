"""The 16 extension-of-reach tasks: four goals, each from four starts (§7.1, Fig. 8)."""

from affcli.core.geometry import Point
from affcli.core.part import Part
from affcli.core.task import GoalRegion, Task
from affcli.core.workspace import TaskLayout, Workspace

NAME = "extension-of-reach"
STARTS = 4


def goal_regions(layout: TaskLayout) -> dict[str, GoalRegion]:
    """Return the four goal regions by name: near, far, left and right on the mid-line."""
    centers = {
        "1": Point(0.0, layout.goal_1_y),
        "2": Point(0.0, layout.goal_2_y),
        "3": Point(-layout.goal_side_x, layout.midline),
        "4": Point(layout.goal_side_x, layout.midline),
    }
    return {name: GoalRegion(name, at, layout.goal_half_width) for name, at in centers.items()}


def start_positions(layout: TaskLayout) -> dict[str, Point]:
    """Return the four starts of the attractor by name, left to right on the mid-line."""
    middle = (1 + STARTS) / 2
    return {
        str(n): Point((n - middle) * layout.start_spacing, layout.midline)
        for n in range(1, STARTS + 1)
    }


def extension_of_reach(layout: TaskLayout) -> tuple[Task, ...]:
    """Return the paper's 16 tasks, goal by goal and start by start."""
    starts = start_positions(layout)
    return tuple(
        Task(NAME, goal, name, at)
        for goal in goal_regions(layout).values()
        for name, at in starts.items()
    )


def paper_tasks(workspace: Workspace) -> tuple[Task, ...]:
    """Return the paper's 16 tasks at a table."""
    return extension_of_reach(workspace.layout)


PARTS = (
    Part(
        kind="tasks",
        name=NAME,
        summary="the paper's 16 tasks: goals 1 to 4, each from the starts 1 to 4",
        source="Stoytchev 2008, §7.1",
        build=paper_tasks,
    ),
)
