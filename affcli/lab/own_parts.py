"""A person's own parts in an experiment: files that it names, kept by value in what is stored."""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from affcli import registry
from affcli.config import toml_file
from affcli.core.behavior import ExploratoryBehavior
from affcli.core.task import Task
from affcli.core.tool import Tool
from affcli.errors import BadInputError, one_line
from affcli.lab.experiment import ADAPTATION
from affcli.own_files.behaviors import behavior_of_tables
from affcli.own_files.tasks import tasks_of_tables
from affcli.own_files.tools import tool_of_tables

Own = Tool | ExploratoryBehavior | tuple[Task, ...]
"""What a file describes."""


class _Kind(NamedTuple):
    """What a file can be of.

    Args:
        table: of an experiment's stored form that holds what such files say.
        read: makes it of the tables of a file.
    """

    table: str
    read: Callable[[Mapping[str, Any], str], Own]


KINDS: Mapping[str, _Kind] = {
    "tools": _Kind("tool", tool_of_tables),
    "repertoire": _Kind("behavior", behavior_of_tables),
    "tasks": _Kind("task", tasks_of_tables),
}
"""By the keys of an experiment that may name files."""
TABLES = tuple(kind.table for kind in KINDS.values())


class OwnParts:
    """What an experiment names by files, each read once.

    Args:
        folder: of the experiment's file, from which theirs are named; None in a stored form, which
            has them by value.
        stored: the tables of that form.

    Raises:
        BadInputError: what is stored is not as its file must be.
    """

    def __init__(self, folder: Path | None, stored: Mapping[str, Any]) -> None:
        self._folder = folder
        self._names: dict[tuple[str, str], str] = {}
        self._own: dict[str, dict[str, Own]] = {key: {} for key in KINDS}
        self._tables: dict[str, list[Mapping[str, Any]]] = {}
        for key, kind in KINDS.items():
            found = stored.get(kind.table, [])
            if not isinstance(found, list) or not all(isinstance(one, dict) for one in found):
                raise BadInputError(f"{kind.table} must be tables of files; name files under {key}")
            for number, tables in enumerate(found):
                self._add(key, tables, f"{kind.table}[{number}]")

    def name(self, key: str, text: str) -> str:
        """Return the name of what a text stands for, if it is one's own; else the text.

        Raises:
            BadInputError: its file is not as it must be, or something else has its name.
        """
        if self._folder is None or key not in KINDS or not registry.names_file(text):
            return text
        if (key, text) not in self._names:
            source = f"{KINDS[key].table} {one_line(text)}"
            tables = toml_file(self._folder / text, source)
            self._names[key, text] = self._add(key, tables, source)
        return self._names[key, text]

    def has(self, key: str, name: str) -> bool:
        """Tell whether a name is of what a file describes."""
        return name in self._own.get(key, {})

    def tools(self, names: Iterable[str]) -> list[str | Tool]:
        """Return tools: one's own by value, the others as they are."""
        return [own if isinstance(own := self._one("tools", n), Tool) else n for n in names]

    def repertoire(self, names: Iterable[str]) -> list[str | ExploratoryBehavior]:
        """Return behaviors: one's own by value, the others as they are."""
        found = ((name, self._one("repertoire", name)) for name in names)
        return [own if isinstance(own, ExploratoryBehavior) else name for name, own in found]

    def tasks(self, names: Iterable[str]) -> list[str | tuple[Task, ...]]:
        """Return sets of tasks: one's own by value, the others as they are."""
        found = ((name, self._one("tasks", name)) for name in names)
        return [own if isinstance(own, tuple) else name for name, own in found]

    def stored(self) -> dict[str, Any]:
        """Return what is stored of them: what the files say; nothing without any."""
        return {KINDS[key].table: tables for key, tables in self._tables.items()}

    def _one(self, key: str, name: str) -> Own | None:
        return self._own[key].get(name)

    def _add(self, key: str, tables: Mapping[str, Any], source: str) -> str:
        """Keep what a file describes, and what it says; return its name."""
        own = KINDS[key].read(tables, source)
        name = _name(own, source)
        known = self._own[key]
        if known.setdefault(name, own) != own:
            raise BadInputError(
                f"{source}: another {KINDS[key].table} of this experiment is named {name}; give it "
                "another name"
            )
        if known[name] is own:
            self._tables.setdefault(key, []).append(tables)
        return name


def _name(own: Own, source: str) -> str:
    """Return what something is called, if that is not the name of a part of ours.

    Of a tool the sizes of each condition decide what it may be.
    """
    match own:
        case Tool():
            return own.name
        case ExploratoryBehavior():
            registry.require_own_behavior(own, source)
            return own.call.name
    registry.require_own_tasks(own, source)
    if own[0].task_set == ADAPTATION:
        raise BadInputError(f"{source}: {ADAPTATION} is another thing; give it another name")
    return own[0].task_set
