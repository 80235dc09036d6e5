"""What the package offers affcli: a world, its tool, its tasks; KinDER loads when it is used."""

from importlib import import_module
from typing import Any

from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.core.task import GoalRegion, Task
from affcli.core.tool import Color, Tool, ToolName, ToolPart
from affcli.errors import BadInputError

NAME, VERSION = "kinder-hook", 1
SOURCE = "KinDER (kindergarden 0.2.5), DynPushPullHook2D"
COLOR = Color((102.0, 51.0, 26.0))
"""KinDER's brown."""
VARIANTS = (0, 1, 5)


def hook(_: Any) -> Tool:
    """Return KinDER's hook, in inches: the wrist stands 1 in above the lower end of the handle."""
    half, top, bar = 0.5333, 13.0, 5.8333
    handle = ConvexPolygon.box(-half, -1.0, half, top)
    side = ConvexPolygon.box(half, top - 2.0 * half, bar - half, top)
    return Tool(ToolName(NAME), COLOR, (ToolPart("handle", handle), ToolPart("bar", side)))


def tasks(_: Any, *, obstacles: int, first: int, n: int) -> tuple[Task, ...]:
    """Return a task for each of some resets: start ``7`` is the reset by seed 7."""
    if obstacles not in VARIANTS:
        raise BadInputError(
            f"{NAME}: obstacles = {obstacles}; KinDER has this world with 0, 1 and 5"
        )
    world = import_module("kinder_hook.world")
    return tuple(
        Task(NAME, GoalRegion(f"o{obstacles}", Point(start.x, 17.5), 1.0), str(seed), start)
        for seed in range(first, first + n)
        for start in (world.start_of(obstacles, seed),)
    )


def world(settings: Any, task_sets: Any) -> Any:
    """Return the world."""
    return import_module("kinder_hook.world").HookWorld(settings, task_sets)


WORLD = Part("worlds", NAME, "KinDER's room with a hook, a block and a wall", SOURCE, world)
TOOL = Part("tools", NAME, "KinDER's hook: a handle of 14 in, a bar of 5.8 in", SOURCE, hook)
TASKS = Part(
    *("tasks", NAME, "bring the block to the wall, from resets of KinDER", SOURCE, tasks),
    params={
        "obstacles": Setting(0, "", "Blocks in the way: 0, 1 or 5.", 0, 5),
        "first": Setting(0, "", "Seed of the first reset.", 0, 99_999),
        "n": Setting(10, "", "How many resets.", 1, 1_000),
    },
)
