"""Parts by name: the one place where a name becomes a tool, a behavior, a planner, a world.

A part is found by the tuple PARTS of a file in its room: adding one is adding a file. Where a name
is none of ours, the installed packages are asked (`affcli.plugins`). Our sensors are made by
`simulation.sensing`, which must know them, too.
"""

import math
import pkgutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from affcli.core.behavior import BehaviorCall, ExploratoryBehavior, Repertoire
from affcli.core.geometry import Point, near_any
from affcli.core.identity import Component
from affcli.core.names import one_of
from affcli.core.part import Kind, Part
from affcli.core.setting import Value
from affcli.core.tool import Tool, hold_of
from affcli.errors import BadInputError, UsageError, one_line

if TYPE_CHECKING:
    from affcli.config import Settings
    from affcli.core.ports import Explorer, Planner
    from affcli.core.task import Task
    from affcli.core.workspace import ToolGeometry
    from affcli.core.world import MakeSensor, Setting, World
    from affcli.errors import PartFailedError
    from affcli.plugins.entry_points import Offer

KINDS: tuple[Kind, ...] = get_args(Kind)

ROOMS: Mapping[Kind, tuple[str, ...]] = {
    "tools": ("affcli.simulation.tools",),
    "bindings": ("affcli.behaviors",),
    "behaviors": ("affcli.behaviors",),
    "explorers": ("affcli.exploration",),
    "planners": ("affcli.planning", "affcli.baselines"),
    "sensors": ("affcli.simulation.sensing",),
    "tasks": ("affcli.simulation.tasks",),
    "worlds": ("affcli.simulation.worlds",),
}
"""Where the parts of each kind live: packages, whose files are looked through, or single files."""

DEFAULTS: Mapping[str, str] = {
    "binding": "grasp",
    "repertoire": "paper",
    "explorer": "random",
    "planner": "nested-query",
    "sensor": "noisy",
    "task": "extension-of-reach",
    "world": "table",
}
"""What a run carries unless it is told otherwise: the paper's."""

GRIP = 0.5
"""How far the handle may lie beside the wrist (in)."""

MOST_BINDINGS = 20
"""Ways in which one robot may hold a tool."""

REMEDY = "install what made the record"
"""What to do about a record that names a part which is not here."""


@cache
def parts(kind: Kind) -> Mapping[str, Part]:
    """Return affcli's own parts of a kind by name, in the order in which their files name them."""
    named: dict[str, Part] = {}
    for module in chain.from_iterable(map(_modules, ROOMS[kind])):
        for found in getattr(module, "PARTS", ()):
            if found.kind == kind and named.setdefault(found.name, found) is not found:
                raise BadInputError(f"two {kind} are named {found.name}; rename one")
    return named


def of_packages(kind: Kind) -> "Iterator[tuple[Offer, Part | PartFailedError]]":
    """Yield the parts of a kind that packages bring, each with what offers it; or why it cannot be
    used.
    """
    from affcli.plugins.parts import everything

    for offer, found in everything(kind):
        taken = offer.name in parts(kind)
        yield offer, offer.refused("affcli has one of that name, which is used") if taken else found


def part(kind: Kind, name: str) -> Part:
    """Return a part by name.

    Raises:
        UsageError: there is no such part; the message gives the nearest names.
    """
    found = _found(kind, name)
    if found is None:
        one_of(kind.removesuffix("s"), name, known(kind, name), f" (affcli list {kind})")
        raise LookupError(name)  # uninstalled this very moment
    return found


def _found(kind: Kind, name: str) -> Part | None:
    """Return a part by name, one of ours or else of another package; None when there is none.

    Raises:
        PartFailedError: that of a package cannot be loaded, or several packages have one.
    """
    own = parts(kind).get(name)
    if own is not None:
        return own
    from affcli.plugins.parts import find

    return find(kind, name)


def known(kind: Kind, name: str) -> list[str]:
    """Return the names of parts of a kind: those of packages too, where the one asked for is none
    of ours.
    """
    own = parts(kind)
    if name in own:
        return list(own)
    from affcli.plugins.parts import names

    return list(dict.fromkeys([*own, *names(kind)]))


def component(kind: Kind, text: str) -> Component:
    """Return the component that a user's ``name:key=value,key=value`` stands for, checked.

    Raises:
        UsageError: no such part.
        BadInputError: an unknown parameter, a value out of its limits, or another form of text.
    """
    chosen, given = _named(kind, text)
    return chosen.component(given)


def binding(text: str, geometry: "ToolGeometry") -> BehaviorCall:
    """Return the binding behavior that a text names, for tools of these sizes."""
    chosen, given = _named("bindings", text)
    # All that is given is handed on: what is left out, the sizes decide.
    made: BehaviorCall = chosen.build(geometry, **chosen.checked(given))
    hold_of(made)  # the robots know no binding but the grasp: better said before a run begins
    return made


def bindings(texts: Sequence[str], geometry: "ToolGeometry") -> tuple[BehaviorCall, ...]:
    """Return the binding behaviors that several texts name, in order, for tools of these sizes.

    Raises:
        UsageError: two of them hold the tool the same, or they are too many; or as `component`.
        BadInputError: as `component`, or one of them takes the tool where there is no handle.
    """
    if len(texts) > MOST_BINDINGS:
        raise UsageError(f"--binding: {len(texts)} of them; give at most {MOST_BINDINGS}")
    chosen: dict[tuple[float, float], BehaviorCall] = {}
    for text in texts:
        made = binding(text, geometry)
        held = made["grasp_point"], made.get("angle", 0.0) % 360.0
        if held in chosen:
            raise UsageError(
                f"--binding {one_line(text, 60)}: {one_line(made, 60)} comes twice; leave one out"
            )
        chosen[held] = made
    return tuple(chosen.values())


def repertoire(parts_of_it: Sequence[str | ExploratoryBehavior]) -> Repertoire:
    """Return the exploratory behaviors of several parts, in order.

    Args:
        parts_of_it: each by its name, by its file, or by value.

    Raises:
        UsageError: a behavior comes twice, or as `component`.
        BadInputError: as `component`, or a file is not as it must be.
    """
    chosen: dict[BehaviorCall, ExploratoryBehavior] = {}
    for one in parts_of_it:
        for behavior in _behaviors(one):
            if behavior.call in chosen:
                said = one_line(one if isinstance(one, str) else one.call, 60)
                raise UsageError(f"--repertoire {said}: {behavior.call} comes twice")
            chosen[behavior.call] = behavior
    return tuple(chosen.values())


def _behaviors(one: str | ExploratoryBehavior) -> Repertoire:
    """Return the behaviors of a part of a repertoire."""
    if isinstance(one, ExploratoryBehavior):
        return (one,)
    if not names_file(one):
        made: Repertoire = _built("behaviors", component("behaviors", one))()
        return made
    from affcli.own_files.behaviors import behavior_from_file

    own = behavior_from_file(Path(one))
    require_own_behavior(own, f"behavior {one_line(one)}")
    return (own,)


def require_own_behavior(own: ExploratoryBehavior, source: str) -> None:
    """Make sure that a person's own behavior has no name of ours: BadInputError."""
    if own.call.name.replace(" ", "-") in parts("behaviors"):
        raise _taken(source, own.call.name, "behaviors")


def own_tasks(path: Path) -> "tuple[Task, ...]":
    """Return a person's own tasks, from their file.

    Raises:
        BadInputError: the file is not as it must be, or they have a name of ours.
    """
    from affcli.own_files.tasks import tasks_from_file

    made = tasks_from_file(path)
    require_own_tasks(made, f"task {one_line(path)}")
    return made


def require_own_tasks(own: "tuple[Task, ...]", source: str) -> None:
    """Make sure that a person's own tasks have no name of ours: BadInputError."""
    if own[0].task_set in parts("tasks"):
        raise _taken(source, own[0].task_set, "tasks")


def _taken(source: str, name: str, kind: Kind) -> BadInputError:
    """Return the error that a person's own part has a name of ours."""
    return BadInputError(f"{source}: {name} is one of affcli's own {kind}; give another name")


def tool(text: str, geometry: "ToolGeometry") -> Tool:
    """Return the tool that a text names, in these sizes, or that a file describes.

    Raises:
        UsageError, BadInputError: as `component`; its part makes a tool of another name; or the
            file is not as it must be.
    """
    if names_file(text):
        return own_tool(Path(text), geometry)
    chosen = component("tools", text)
    made: Tool = _built("tools", chosen)(geometry)
    if made.name != chosen.name:
        raise BadInputError(f"tool {chosen.name}: its part makes a {one_line(made.name, 40)}")
    return made


def own_tool(path: Path, geometry: "ToolGeometry") -> Tool:
    """Return a person's own tool, from its file.

    Raises:
        BadInputError: the file is not as it must be, or `require_own_tool`.
    """
    from affcli.own_files.tools import tool_from_file  # few give a file

    made = tool_from_file(path)
    require_own_tool(made, geometry, f"tool {one_line(path)}")
    return made


def require_own_tool(made: Tool, geometry: "ToolGeometry", source: str) -> None:
    """Make sure that a person's own tool is not taken for a registered one.

    Args:
        made: the tool.
        geometry: the sizes of the registered ones, and where a tool is grasped.
        source: where it comes from, for the message.

    Raises:
        BadInputError: it has the name of one, or its colour as the table sees colours (search 1 of
            §6.2); or there is nothing of it where it is grasped.
    """
    from affcli.core.affordance_table import COLOR_TOLERANCE  # NumPy takes long to load

    for name in parts("tools"):
        if name == made.name:
            raise _taken(source, name, "tools")
        if math.dist(made.color, tool(name, geometry).color) <= COLOR_TOLERANCE:
            raise BadInputError(
                f"{source}: its color is taken for that of the {name} (it is within "
                f"{COLOR_TOLERANCE:g} of it); paint it otherwise"
            )
    require_handle(made, geometry.handle_below_grasp, source)


def require_handle(made: Tool, grasp_point: float, source: str) -> None:
    """Make sure that there is something of a tool where it is to be grasped: BadInputError.

    Args:
        made: the tool.
        grasp_point: above its lower end (in).
        source: where it comes from, for the message.
    """
    lower_end = min(outline.bounds[1] for outline in made.outlines)
    if not near_any(made.outlines, Point(0.0, lower_end + grasp_point), GRIP):
        raise BadInputError(
            f"{source}: nothing to grasp at x = 0, {grasp_point:g} in above its lower end; let the "
            "handle lie there"
        )


def names_file(text: str) -> bool:
    """Tell whether what stands for a tool, a behavior or tasks is a file, and no name."""
    return text.endswith(".toml")


def planner(chosen: Component) -> "Planner":
    """Return the planner that a component names."""
    return _built("planners", chosen)()  # type: ignore[no-any-return]


def explorer(chosen: Component, setting: "Setting", settings: "Settings") -> "Explorer":
    """Return the explorer that a component names, for a robot in a setting."""
    build = _built("explorers", chosen)
    return build(setting.exploratory, settings.babbling, setting.choices)  # type: ignore[no-any-return]


def world(chosen: Component, settings: "Settings") -> "World":
    """Return the world that a component names, with all sets of tasks that there are."""
    return _built("worlds", chosen)(settings, TaskSets())  # type: ignore[no-any-return]


class TaskSets(Mapping[str, Callable[..., Any]]):
    """What makes the tasks of each set that there is now, by the text of its component; those of
    other packages are found when they are asked for. Their sensors, too (`BringsSensors`).
    """

    def __init__(self) -> None:
        self._parts = dict(parts("tasks"))

    def __getitem__(self, text: str) -> Callable[..., Any]:
        """Return what builds a set with the parameters that the text gives; KeyError for none."""
        try:
            chosen = Component.parse(text)
        except BadInputError as error:
            raise KeyError(text) from error
        found = self._parts.get(chosen.name)
        if found is None and chosen.name not in parts("tasks"):
            found = _found("tasks", chosen.name)
        if found is None:
            raise KeyError(text)
        return partial(found.build, **found.values(chosen))

    def sensor(self, kind: str) -> "MakeSensor":
        """Return what makes a sensor of a package.

        Raises:
            BadInputError, PartFailedError: as `recorded`; or it is here in another version.
        """
        return _built("sensors", Component.parse(kind))

    def __iter__(self) -> Iterator[str]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)


def recorded(kind: Kind, chosen: Component) -> Part:
    """Return the part that a record names, in the version that this affcli has.

    Raises:
        BadInputError: this affcli has no such part.
        PartFailedError: it is of a package, and cannot be loaded.
    """
    found = _found(kind, chosen.name)
    if found is None:
        raise BadInputError(f"{_lacking(kind, chosen)} no such part; {REMEDY}")
    return found


def is_told(planner: Component) -> bool:
    """Tell whether a planner is no robot's own: it is told what no robot sees. None of another
    package is.
    """
    own = parts("planners").get(planner.name)
    return own is not None and own.told


def _named(kind: Kind, text: str) -> tuple[Part, dict[str, Value]]:
    """Return the part that a user's text names, and the parameters given with it, not yet checked.

    Raises:
        UsageError: no such part.
        BadInputError: another form of text, or a version that is not here.
    """
    # What is no name either is told the names that there are.
    given = Component.parse(text) if {":", "@"} & set(text) else Component(text)
    chosen = part(kind, given.name)
    if given.version not in (1, chosen.version) or given.package not in ("", chosen.package):
        raise BadInputError(
            f"{one_line(text, 60)}: this affcli has {_version(chosen)} of {chosen.name}; leave the "
            "version out"
        )
    return chosen, dict(given.params)


def _version(found: Part) -> str:
    """Return in words which version of a part is here."""
    own = f"version {found.version}"
    return f"{own}, from {found.package}," if found.package else own


def present(kind: Kind, chosen: Component) -> Component:
    """Return a component in the version that is here.

    Raises:
        BadInputError, PartFailedError: as `recorded`.
    """
    found = recorded(kind, chosen)
    return replace(chosen, version=found.version, package=found.package)


def _lacking(kind: Kind, chosen: Component) -> str:
    return f"{kind.removesuffix('s')} {one_line(chosen, 80)}: this affcli has"


def _built(kind: Kind, chosen: Component) -> Callable[..., Any]:
    """Return what builds the part that a component names, its parameters given.

    Raises:
        BadInputError: this affcli has no such part, or has it in another version.
    """
    found = recorded(kind, chosen)
    if (found.version, found.package) != (chosen.version, chosen.package):
        raise BadInputError(f"{_lacking(kind, chosen)} {_version(found)} of it; {REMEDY}")
    values = found.values(chosen)

    def build(*given: Any) -> Any:
        return found.build(*given, **values)

    return build


def _modules(home: str) -> Iterator[Any]:
    """Yield a module, or the files of a package in the order of their names."""
    module = import_module(home)
    yield module
    for info in pkgutil.iter_modules(getattr(module, "__path__", ())):
        yield import_module(f"{home}.{info.name}")
