"""The parts that a run carries: chosen by name for a new one, brought back for a stored one."""

import json
import math
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from affcli import registry
from affcli.config import Settings, require_known, settings_from, with_sensor
from affcli.core.behavior import ExploratoryBehavior
from affcli.core.identity import Component, canonical_json
from affcli.core.observation import SensorKind
from affcli.core.records import LearningRunInfo
from affcli.core.specs import LearningSpec, Parts
from affcli.core.task import Task
from affcli.core.tool import Tool, hold_of
from affcli.core.transfer import Transfer
from affcli.core.world import World
from affcli.errors import BadInputError, DatabaseError, UsageError, one_line
from affcli.simulation.sensing import require_camera

TaskSet = str | tuple[Task, ...]
"""A set of tasks: by its name or file, or by value."""


class RunParts(Parts):
    """What new learning runs carry, but for the tool, the seed and the time."""

    @classmethod
    def chosen(
        cls,
        settings: Settings,
        *,
        repertoire: Sequence[str | ExploratoryBehavior] = (),
        binding: str | Sequence[str] | None = None,
        explorer: str | None = None,
        world: str | None = None,
    ) -> "RunParts":
        """Return the parts that a user named, each as ``name:key=value``; the paper's for the rest.
        Behaviors also by their files, or by value; of bindings one, or several.

        Raises:
            UsageError: no part of that name, or the camera's packages are missing.
            BadInputError: a wrong parameter.
        """
        if settings.sensor.kind == "camera":
            require_camera()
        usual = registry.DEFAULTS
        texts = [binding] if isinstance(binding, str) else [*(binding or [usual["binding"]])]
        first, *others = registry.bindings(texts, settings.workspace.tools)
        return cls(
            settings=canonical_json(settings.differing()),
            world=registry.component("worlds", world or usual["world"]),
            repertoire=registry.repertoire(repertoire or [usual["repertoire"]]),
            binding=first,
            other_bindings=tuple(others),
            explorer=registry.component("explorers", explorer or usual["explorer"]),
            sensor=settings.sensor.kind,
        )

    def spec(
        self,
        tool: str | Tool,
        seed: int,
        robot: int,
        hours: float | None,
        behaviors: int | None = None,
        transfer: Transfer | None = None,
    ) -> LearningSpec:
        """Return what a learning run with these parts is a function of.

        Args:
            tool: as in `tool`.
            seed, robot, hours, behaviors, transfer: as in `LearningSpec`.
        """
        return LearningSpec(
            self.tool(tool), seed, robot, hours, behaviors, transfer, **self.carried()
        )

    def tool(self, tool: str | Tool) -> Tool:
        """Return a tool: a registered one by its name in these settings' sizes, a person's own by
        its file or by its value.

        Raises:
            UsageError: there is none of this name.
            BadInputError: there is nothing of it where it is to be grasped.
        """
        sizes = settings_of_text(self.settings).workspace.tools
        made = tool if isinstance(tool, Tool) else registry.tool(tool, sizes)
        for point in (one["grasp_point"] for one in self.bindings):
            if point != sizes.handle_below_grasp:
                registry.require_handle(made, point, f"tool {one_line(made.name, 40)}")
        return made


def beyond_the_box(learned: LearningSpec) -> str:
    """Return where babbling will not put the attractor though the tool is there; empty if nowhere.

    The robot knows nothing of the tool's shape (§4), so one box serves all tools: one that is
    larger, or held otherwise, is not learned where it lies outside.
    """
    settings = settings_of(learned)
    box, radius = settings.babbling, settings.workspace.puck.radius
    holds = [learned.held.held(hold_of(one)).outlines for one in learned.bindings]
    outlines = [part for held in holds for part in held]
    sides = max(max(-o.bounds[0], o.bounds[2]) for o in outlines) + radius
    far = max(o.bounds[3] for o in outlines) + radius
    wider = [
        f"{key}={math.ceil(10.0 * needed) / 10.0:g}"
        for key, needed, has in (
            ("offset_x_max", sides, box.offset_x_max),
            ("offset_y_max", far, box.offset_y_max),
        )
        if needed > has
    ]
    nearest = min(max(o.bounds[3] for o in held) + radius for held in holds)
    if nearest <= box.offset_y_min:
        wider.append(f"offset_y_min={min(0.0, nearest):g}")
    if not wider:
        return ""
    changes = " ".join(f"--set babbling.{one}" for one in wider)
    return (
        f"babbling does not bring the attractor to all sides of the {learned.tool} as it is held; "
        f"for that: {changes}"
    )


def settings_of(learned: Parts, sensor: SensorKind | None = None) -> Settings:
    """Return the settings of runs with these parts, seen through their own sensor or another."""
    settings = settings_of_text(learned.settings)
    return settings if learned.logged else with_sensor(settings, sensor or learned.sensor)


def tool_of(learned: LearningSpec, name: str) -> Tool:
    """Return a tool by name: the one that was learned, else a registered one in the run's sizes."""
    if name == learned.tool:
        return learned.held
    return registry.tool(name, settings_of_text(learned.settings).workspace.tools)


def world_of(learned: LearningSpec, *, again: bool = False) -> World:
    """Return the world of a learning run: made here and nowhere else.

    Args:
        learned: the run.
        again: what was done there is to be done again, so it must be the same version of the world.

    Raises:
        BadInputError: this affcli has no such world or binding, or another version of the world.
        DatabaseError: it does not know some of the settings, or the shape of the run's tool.
    """
    settings, made = settings_of(learned), learned.world
    require_robot(learned)
    require_known(settings)
    require_shape(learned.held)
    for binding in learned.bindings:
        hold_of(binding)
    if again:
        require_world_version(made)
    return registry.world(registry.present("worlds", made), settings)


def require_robot(learned: LearningSpec) -> None:
    """Make sure that there is a robot that can use what was learned; BadInputError otherwise."""
    if learned.logged:
        raise BadInputError(
            f"the {one_line(learned.tool, 40)} of this run comes from a log: there is no robot "
            "that could use it, nor a world to do it again in; name a run that affcli learned"
        )


def require_learned(run: LearningRunInfo, option: str = "") -> None:
    """Make sure that a table was learned, not computed for a planner that knows more than a robot;
    UsageError otherwise.

    Args:
        run: whose table it is.
        option: which option named it; empty for none.
    """
    if run.spec.told:
        place = f"{option}: run {run.id}" if option else f"run {run.id}"
        raise UsageError(f"{place} is no robot's: its table was computed; name one that learned")


def require_shape(tool: Tool, where: str = "") -> None:
    """Make sure that it is known what a tool looks like; DatabaseError otherwise."""
    if not tool.parts:
        name = one_line(tool.name, 40)
        raise DatabaseError(
            f"{where}this affcli does not know what a {name} looks like; {registry.REMEDY}"
        )


def tasks_of(world: World, task_set: TaskSet, seed: int) -> tuple[Task, ...]:
    """Return the tasks of a set.

    Args:
        world: where they are to be done.
        task_set: its name, maybe with parameters, as ``name:key=value``; a person's own by their
            file or by value.
        seed: of what they are drawn by, where the set has such a parameter and does not give it.

    Raises:
        UsageError: there is no set of this name.
        BadInputError: a wrong parameter, or a file that is not as it must be.
    """
    if not isinstance(task_set, str):
        return task_set
    if registry.names_file(task_set):
        return registry.own_tasks(Path(task_set))
    chosen = registry.component("tasks", task_set)
    found = registry.recorded("tasks", chosen)
    drawn = {"seed": seed} if "seed" in found.params else {}
    try:
        return world.tasks(str(found.component({**drawn, **dict(chosen.params)})))
    except KeyError:
        raise UsageError(
            f"the world {world.name} has no tasks {chosen.name}; choose others"
        ) from None


def require_world_version(made: Component) -> None:
    """Refuse to do again what was made in another version of the world.

    Raises:
        BadInputError: naming both versions; or this affcli has no such world.
    """
    now = registry.present("worlds", made)
    if now.version != made.version:
        raise BadInputError(
            f"made in version {made.version} of the world {made.name}, this affcli has "
            f"{now.version}: it cannot be done again to the bit; {registry.REMEDY}"
        )
    if now.package != made.package:
        raise BadInputError(
            f"made in the world {made.name} of {made.package}, here is that of {now.package}: it "
            f"cannot be done again to the bit; {registry.REMEDY}"
        )


@lru_cache(maxsize=16)
def settings_of_text(text: str) -> Settings:
    """Return the settings that a spec keeps."""
    return settings_from(json.loads(text))
