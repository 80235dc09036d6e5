"""An experiment as data: what a file of one says, all of it checked before anything runs.

``[experiment]`` names it, ``[base]`` is what all conditions share, each ``[[condition]]`` is the
base but for what it says, and ``[sweep]`` holds lists of values: every point of their grid is a
condition. What the store keeps is such a file too, with base and sweep written out everywhere, and
what the files of tools, behaviors and tasks say under ``[[tool]]``, ``[[behavior]]``, ``[[task]]``.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import combinations, product
from math import prod
from pathlib import Path
from typing import Any

from affcli import registry
from affcli.bounded import LARGEST_VALUE
from affcli.config import (
    SECTIONS,
    SENSOR,
    checked_by_name,
    known_settings,
    settings_by_name,
    toml_file,
    with_sensor,
)
from affcli.core.identity import LONGEST_TEXT, canonical_json, key_of, shown
from affcli.core.limits import LARGEST_SEED, LONGEST_HOURS, MOST_ROBOTS
from affcli.core.names import one_of
from affcli.core.part import Kind
from affcli.core.specs import BROKEN_SHAPE, BROKEN_TOOL
from affcli.errors import BadInputError, UsageError, one_line
from affcli.lab.believing import require_believable
from affcli.lab.experiment import ADAPTATION, ADAPTATION_TASKS, Condition, Experiment
from affcli.lab.inventing import EXPLORER, Inventing, are_invented
from affcli.lab.own_parts import TABLES as OWN_TABLES
from affcli.lab.own_parts import OwnParts
from affcli.lab.run_parts import RunParts, tasks_of
from affcli.lab.transferring import Transferring
from affcli.simulation.tools.paper import TOOL_PARTS

TABLES = ("experiment", "base", "condition", "sweep", *OWN_TABLES)
HEAD = ("name", "question", "robots", "seed", "tasks")
NAMED: Mapping[str, Kind] = {
    "explorer": "explorers",
    "planner": "planners",
    "binding": "bindings",
    "world": "worlds",
    "tools": "tools",
    "repertoire": "behaviors",
    "tasks": "tasks",
}
"""What a condition says by the names of parts."""
LISTS = ("tools", "repertoire", "tasks")
SEVERAL = "binding"
"""What may be one name, or a list of several."""
KEYS = (*NAMED, "hours", "minutes", "sensor", "settings", "transfer")
"""What a condition may say; and each setting as ``section.key``."""
USUAL: Mapping[str, Any] = {
    **{key: registry.DEFAULTS[key] for key in ("explorer", "planner", "binding", "world")},
    "hours": 1.0,
    "tools": list(TOOL_PARTS),
    "repertoire": [registry.DEFAULTS["repertoire"]],
    "tasks": [ADAPTATION_TASKS, ADAPTATION],
}
"""What a condition is when nothing is said: the paper's."""
MOST_CONDITIONS = 250
LARGEST_DEFINITION = LARGEST_VALUE - 20_000
"""Bytes of what a file says when it is written out, so that its row has room in a database."""
LONGEST_NAME, LONGEST_QUESTION = 80, 1_000

Said = dict[str, Any]
"""What is said of a condition: by the keys of `USUAL`, and settings by their names."""


def experiment_file(path: Path) -> Experiment:
    """Return the experiment that a TOML file describes.

    Raises:
        BadInputError: it cannot be read, or something in it is not as it must be; the message names
            the file and the place in it.
    """
    source = f"experiment {one_line(path)}"
    return experiment_of(toml_file(path, source), source, path.parent)


def experiment_of(tables: Mapping[str, Any], source: str, folder: Path | None = None) -> Experiment:
    """Return the experiment that tables describe, as a file has them; see `experiment_file`.

    Args:
        tables: what the file says.
        source: where it is, for the message.
        folder: from which its files are named; None for a stored form, which names none.
    """
    with _at(source):
        for table in tables:
            one_of("table", table, TABLES)
        own_parts = OwnParts(folder, tables)
        head = _table(tables, "experiment")
        base, sweep = _table(tables, "base"), _table(tables, "sweep")
    place = f"{source}: experiment"
    with _at(place):
        for key in head:
            one_of("key", key, HEAD)
        name = _text(head.get("name"), "name", LONGEST_NAME)
        question = _text(head.get("question", ""), "question", LONGEST_QUESTION, least=0)
        robots = _whole(head.get("robots"), "robots", 1, MOST_ROBOTS)
        seed = _whole(head.get("seed", 0), "seed", 0, LARGEST_SEED)
    shared = _said({key: head[key] for key in head if key == "tasks"}, place, own_parts)
    shared |= _said(base, f"{source}: base", own_parts)
    named = _named_conditions(tables.get("condition", []), source, own_parts)
    most = MOST_CONDITIONS // max(len(named), 1)
    grid = _grid(sweep, f"{source}: sweep", most, own_parts)
    conditions, forms = [], []
    there: dict[str, str] = {}
    for where, own, said in named:
        for label, point in grid:
            with _at(where):
                for key in point.keys() & said.keys():
                    raise BadInputError(f"{key} is said here and in the sweep; say it once")
                title = ", ".join(filter(None, (own, label))) or "base"
                if len(title) > LONGEST_NAME:
                    raise BadInputError(
                        f"the name {one_line(title, 200)} has more than {LONGEST_NAME} letters; "
                        "give the condition a shorter one, or sweep fewer things at once"
                    )
                with _of_condition(own):
                    condition, form = _condition(title, shared | said | point, own_parts)
                _require_new(condition, there)
            conditions.append(condition)
            forms.append(form)
    definition = {
        "experiment": {"name": name, "question": question, "robots": robots, "seed": seed},
        "condition": forms,
        **own_parts.stored(),
    }
    if len(canonical_json(definition).encode()) > LARGEST_DEFINITION:
        raise BadInputError(
            f"{source}: its {len(forms)} conditions, written out, are more than "
            f"{LARGEST_DEFINITION} bytes; make several experiments of them"
        )
    return Experiment(name, question, robots, seed, tuple(conditions), definition)


@contextmanager
def _at(place: str) -> Iterator[None]:
    """Say at which place of the file something is wrong."""
    try:
        yield
    except (BadInputError, UsageError) as error:
        # A key is a part of the place; a word that is said of the place stands after it.
        raise BadInputError(f"{place}: {error}") from error


@contextmanager
def _of_condition(name: str) -> Iterator[None]:
    """Say in which condition something is wrong: its place is counted from 0, its name is not."""
    try:
        yield
    except (BadInputError, UsageError) as error:
        named = f"; in condition {one_line(name, 60)}" if name else ""
        raise BadInputError(f"{error}{named}") from error


def _table(tables: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """Return a table of the file, empty when it has none."""
    found = tables.get(name, {})
    if not isinstance(found, dict):
        raise BadInputError(f"{name} must be a table, [{name}]")
    return found


def _text(value: object, key: str, most: int, least: int = 1) -> str:
    """Return a text of so many printable letters."""
    if not isinstance(value, str) or not value.isprintable() or not least <= len(value) <= most:
        raise BadInputError(f"{key} must be a line of {least} to {most} letters")
    return value


def _whole(value: object, key: str, low: int, high: int) -> int:
    """Return a whole number within limits."""
    if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
        said = "" if value is None else f" = {one_line(value, 40)}"
        raise BadInputError(f"{key}{said} must be a whole number in {low} to {high}")
    return value


def _hours(value: object, of_an_hour: float) -> float:
    """Return robot hours, given in hours or in minutes: how many of them are an hour.

    None at all are enough where robots borrow: see `_condition`.
    """
    most = LONGEST_HOURS * of_an_hour
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if not (number and 0.0 <= value <= most):  # type: ignore[operator]
        raise BadInputError(
            f"{one_line(value, 40)} must be a number of more than 0 (0 with transfer) and at most "
            f"{most:g}"
        )
    # Adding zero makes -0 into 0: they are equal, and so must be their keys.
    return value / of_an_hour + 0.0  # type: ignore[operator]


def _named_conditions(
    tables: object, source: str, own_parts: OwnParts
) -> list[tuple[str, str, Said]]:
    """Return the place, the name and what is said of each condition; without any, of one."""
    if not isinstance(tables, list) or not all(isinstance(one, dict) for one in tables):
        raise BadInputError(f"{source}: condition must be tables, [[condition]]")
    named = []
    for number, table in enumerate(tables):
        place = f"{source}: condition[{number}]"
        with _at(place):
            name = _text(table.get("name"), "name", LONGEST_NAME)
        own = {key: value for key, value in table.items() if key != "name"}
        with _of_condition(name):
            said = _said(own, place, own_parts)
        named.append((place, name, said))
    return named or [(source, "", {})]


def _grid(
    table: Mapping[str, Any], place: str, most: int, own_parts: OwnParts
) -> list[tuple[str, Said]]:
    """Return the name and what is said of each point of a grid; one of no name without a sweep."""
    axes: dict[str, Any] = {}
    for key, values in _by_name(table, place):
        _require_unsaid(key, map(_one_key, axes), place)
        axes[key] = values
    short = [key.rpartition(".")[2] for key in axes]
    for key, values in axes.items():
        if not isinstance(values, list) or not values:
            raise BadInputError(f"{place}.{key}: must be a list of values")
    if prod(map(len, axes.values())) > most:
        raise BadInputError(f"{place}: more than {MOST_CONDITIONS} conditions; sweep fewer values")
    points = [
        [
            (f"{last if short.count(last) == 1 else key}={_shown(key, value, own_parts)}", said)
            for number, value in enumerate(values)
            for said in [_said({key: value}, f"{place}[{number}]", own_parts)]
        ]
        for last, (key, values) in zip(short, axes.items(), strict=True)
    ]
    return [
        (", ".join(name for name, _ in point), {k: v for _, said in point for k, v in said.items()})
        for point in product(*points)
    ]


def _shown(key: str, value: Any, own_parts: OwnParts) -> str:
    """Return a swept value as it stands in the name of a condition."""
    if isinstance(value, list):
        return "+".join(_shown(key, one, own_parts) for one in value)
    if isinstance(value, int | float):
        return shown(value)
    return one_line(own_parts.name(key, str(value)), LONGEST_NAME)


def _by_name(table: Mapping[str, Any], place: str) -> Iterator[tuple[str, Any]]:
    """Yield what a table says by the names of keys and of settings, in whatever way it is written:
    ``friction.tool_puck``, ``[base.friction]``, ``settings.friction.tool_puck``.
    """
    for key, value in table.items():
        if key == "settings" and isinstance(value, dict):
            for name, one in value.items():
                section = name if "." in name or isinstance(one, dict) else f"{name}."
                yield from _by_name({section: one}, place)
        elif isinstance(value, dict):
            yield from ((f"{key}.{name}", one) for name, one in value.items())
        else:
            if "." not in key:
                with _at(place):
                    one_of("key", key, [*KEYS, *SECTIONS])
            yield key, value


def _one_key(given: str) -> str:
    """Return the one key of what may be said by several."""
    return {"minutes": "hours", "sensor": SENSOR}.get(given, given)


def _require_unsaid(given: str, said: Iterable[str], place: str) -> None:
    """Refuse a key whose thing is said already."""
    if (key := _one_key(given)) in said:
        raise BadInputError(f"{place}.{given}: {key} is said twice")


def _said(table: Mapping[str, Any], place: str, own_parts: OwnParts) -> Said:
    """Return what a table says, each value checked by itself."""
    said: Said = {}
    for given, value in _by_name(table, place):
        key = _one_key(given)
        _require_unsaid(given, said, place)
        if "." in key and key != SENSOR:
            said |= checked_by_name({key: value}, place)
            continue
        with _at(f"{place}.{given}"):
            if key == SENSOR:
                said[key] = str(registry.component("sensors", _text(value, "a name", LONGEST_NAME)))
            elif key == "transfer":
                said[key] = str(Transferring.parse(_text(value, "what is borrowed", LONGEST_TEXT)))
            elif key == "hours":
                said[key] = _hours(value, 1.0 if given == "hours" else 60.0)
            else:
                said[key] = _parts(key, value, own_parts)
    return said


def _parts(key: str, value: object, own_parts: OwnParts) -> str | list[str]:
    """Return the parts that are asked for by name or file, each by its name as it is written."""
    several = (*LISTS, SEVERAL)
    given: list[object] = value if isinstance(value, list) and key in several else [value]
    texts = [one for one in given if isinstance(one, str)]
    if key not in NAMED or not texts or texts != given:
        kind = "names in a list" if key in LISTS else "a name"
        kind += ", or several in a list" if key == SEVERAL else ""
        raise BadInputError(f"{one_line(value, 40)} must be {kind}")
    found = []
    for text in texts:
        name = own_parts.name(key, text)
        if own_parts.has(key, name):
            found.append(name)
            continue
        if key == "tasks" and not {":", "@"} & set(text):
            one_of("tasks", text, [*registry.known("tasks", text), ADAPTATION])
        if key == "repertoire" and are_invented(text):
            found.append(str(Inventing.parse(text)))
            continue
        own = text if text == ADAPTATION else registry.component(NAMED[key], text)
        # What of a binding is left out, the sizes of the tools decide: it stays as it is written.
        found.append(text if key == "binding" else str(own))
    for one, other in combinations(found, 2):
        if one == other:
            raise BadInputError(f"{one} comes twice")
    return found if key in LISTS or len(found) > 1 else found[0]


def _condition(name: str, said: Said, own_parts: OwnParts) -> tuple[Condition, dict[str, Any]]:
    """Return a condition of all that is said of it, and its stored form."""
    own = {**USUAL, **{key: value for key, value in said.items() if "." not in key}}
    # By its version, as one that is said: read again, the stored form is to be the same.
    own["world"] = str(registry.component("worlds", own["world"]))
    changed = {k: v for k, v in said.items() if "." in k and k != SENSOR}
    settings = with_sensor(settings_by_name(changed, "settings"), said.get(SENSOR))
    given = [text for text in own["repertoire"] if not are_invented(text)]
    inventing = tuple(Inventing.parse(one) for one in own["repertoire"] if one not in given)
    if not given:
        raise BadInputError("repertoire: what robots begin with is missing; add paper")
    parts = RunParts.chosen(
        settings,
        repertoire=own_parts.repertoire(given),
        **{key: own[key] for key in ("binding", "explorer", "world")},
    )
    if parts.other_bindings and parts.explorer.name == EXPLORER:
        raise BadInputError(f"binding: robots that explore by {EXPLORER} take one grasp; give one")
    planner = registry.component("planners", own["planner"])
    registry.planner(planner)
    tools, tasks = own_parts.tools(own["tools"]), own_parts.tasks(own["tasks"])
    transferring = Transferring.parse(own["transfer"]) if "transfer" in own else None
    condition = Condition(
        *(name, parts, planner, own["hours"], tuple(tools), tuple(tasks), inventing, transferring)
    )
    _require_lenders(condition)
    require_believable(planner, parts)
    world = condition.world
    for task_set in condition.tasks:
        tasks_of(world, ADAPTATION_TASKS if task_set == ADAPTATION else task_set, 0)
    for tool in (*tools, BROKEN_SHAPE):
        made = parts.tool(tool)
        if tool is made:
            registry.require_own_tool(made, settings.workspace.tools, f"tool {made.name}")
    _require_use(own["tools"], own["tasks"])
    default = {key: one.default for key, one in known_settings().items()}
    differing = {k: v for k, v in settings.values().items() if v != default[k] and k != SENSOR}
    sensor = {"sensor": parts.sensor, "settings": differing}
    return condition, {"name": name, **own, **sensor}


def _require_lenders(condition: Condition) -> None:
    """Refuse no time without anything to borrow, and to borrow where nothing is or can be."""
    transferring = condition.transferring
    if transferring is None:
        if condition.hours == 0.0:
            raise BadInputError(
                "hours: 0 must be more than 0 where robots borrow nothing; else say from which "
                'tools they do: transfer = "t-hook,l-stick"'
            )
        return
    if registry.is_told(condition.planner):
        raise BadInputError(f"transfer: {condition.planner.name} is told its table; leave it out")
    for tool in condition.tools:
        if transferring.tools == (condition.parts.tool(tool).name,):
            raise BadInputError(f"transfer: the {transferring.tools[0]} has none to borrow from")


def _require_use(tools: Sequence[str], tasks: Sequence[str]) -> None:
    """Refuse tasks without their tool, and tools without a task."""
    if ADAPTATION in tasks and BROKEN_TOOL not in tools:
        raise BadInputError(f"tasks {ADAPTATION} is of the {BROKEN_TOOL}, which is not in tools")
    idle = [tool for tool in tools if tool != BROKEN_TOOL and set(tasks) == {ADAPTATION}]
    if idle:
        raise BadInputError(f"tools: no tasks for the {idle[0]}; leave it out, or add tasks")


def _require_new(condition: Condition, there: dict[str, str]) -> None:
    """Refuse a condition that is there already, by name or in all it says; else note it.

    Args:
        condition: the condition.
        there: the names of the conditions before it, by their keys.
    """
    name = one_line(condition.name)
    if condition.name in there.values():
        raise BadInputError(f"a condition named {name} is there already; name this one otherwise")
    other = there.setdefault(key_of(condition.canonical() | {"name": ""}), condition.name)
    if other != condition.name:
        raise BadInputError(f"{name} is the same as {one_line(other)}; leave one of them out")
