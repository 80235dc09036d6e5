"""``affcli new``: a file, or a small package, to begin with."""

import json
import keyword
import re
import sys
import tomllib
from collections.abc import Mapping
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Annotated, Any, cast

import typer

from affcli import registry
from affcli.cli.beginnings import FILES, MODULES, PROJECT
from affcli.cli.files import require_new, save
from affcli.cli.options import Force
from affcli.cli.terminal import say
from affcli.config import toml_file
from affcli.core.identity import Component
from affcli.core.part import Kind
from affcli.core.workspace import ToolGeometry
from affcli.errors import BadInputError, one_line
from affcli.own_files.behaviors import behavior_of_tables
from affcli.own_files.tasks import tasks_of_tables
from affcli.own_files.tools import tool_of_tables
from affcli.own_files.words import checked_name

Name = Annotated[str, typer.Argument(help="What it is to be called.", metavar="NAME")]
OutFile = Annotated[
    Path | None, typer.Option("--out", help="The file; NAME.toml if not given.", metavar="FILE")
]
OutFolder = Annotated[
    Path | None, typer.Option("--out", help="The folder; NAME if not given.", metavar="FOLDER")
]


def tool(name: Name, *, out: OutFile = None, force: Force = False) -> None:
    """Write a tool to begin with: a rake, with what to change said beside it."""
    _write_file("tool", name, out, force=force)


def behavior(name: Name, *, out: OutFile = None, force: Force = False) -> None:
    """Write a behavior to begin with: what the wrist does, piece after piece."""
    _write_file("behavior", name, out, force=force)


def task(name: Name, *, out: OutFile = None, force: Force = False) -> None:
    """Write tasks to begin with: goals, and starts of the attractor."""
    _write_file("task", name, out, force=force)


def planner(name: Name, *, out: OutFolder = None, force: Force = False) -> None:
    """Write a package with a planner to begin with: how to choose a row."""
    _write_package("planner", name, out, force=force)


def explorer(name: Name, *, out: OutFolder = None, force: Force = False) -> None:
    """Write a package with an explorer to begin with: what to try next."""
    _write_package("explorer", name, out, force=force)


def world(name: Name, *, out: OutFolder = None, force: Force = False) -> None:
    """Write a package with a world to begin with: the table, changed."""
    _write_package("world", name, out, force=force)


def _write_file(kind: str, name: str, out: Path | None, *, force: bool) -> None:
    """Write a file of a kind; its name may be another's, which is said before it is written."""
    called = checked_name(name, "NAME")
    path = out or Path(f"{called.replace(' ', '-')}.toml")
    require_new(path, force=force, endings=(".toml",))
    shown = {"file": one_line(path.name), "stem": one_line(path.stem)}
    words = {"quoted": json.dumps(called, ensure_ascii=False), **shown}
    text = FILES[kind].format(**words)
    _require_own(kind, tomllib.loads(text))
    save(path, text.encode())
    say(f"a {kind} to begin with: {one_line(path)}; see: affcli check {one_line(path)}")


def _require_own(kind: str, tables: Mapping[str, Any]) -> None:
    """Refuse a name that is another's: BadInputError."""
    if kind == "tool":
        registry.require_own_tool(tool_of_tables(tables, "NAME"), ToolGeometry(), "NAME")
    elif kind == "behavior":
        registry.require_own_behavior(behavior_of_tables(tables, "NAME"), "NAME")
    else:
        registry.require_own_tasks(tasks_of_tables(tables, "NAME"), "NAME")


def _write_package(kind: str, name: str, out: Path | None, *, force: bool) -> None:
    """Write a package that brings a part of a kind."""
    _require_part_name(cast(Kind, f"{kind}s"), name)
    folder = out or Path(name)
    package = f"affcli-{re.sub(r'[^a-z0-9]+', '-', name).strip('-')}"
    module = package.replace("-", "_")
    words = {"kind": kind, "name": name, "package": package, "module": module}
    texts = {"pyproject.toml": PROJECT, f"{module}.py": MODULES[kind]}
    try:
        folder.mkdir(exist_ok=True)
        used = any(folder.iterdir())
    except OSError as error:
        raise BadInputError(
            f"{one_line(folder)}: {error.strerror}; name another folder with --out"
        ) from error
    ours = used and _brings(folder / "pyproject.toml", f"affcli.{kind}s", name)
    if used and not (ours and force):
        remedy = ", or give --force" if ours else ""
        raise BadInputError(
            f"{one_line(folder)}: exists already and is not empty; name another folder with "
            f"--out{remedy}"
        )
    for file in texts:
        require_new(folder / file, force=force)
    for file, text in texts.items():
        save(folder / file, text.format(folder=folder.name, **words).encode())
    where = one_line(folder)
    one = "an" if kind[0] in "aeiou" else "a"
    say(f"{one} {kind} to begin with: {where}; then: pip install ./{where} && affcli list {kind}s")


def _brings(project: Path, group: str, name: str) -> bool:
    """Tell whether a project brings a part of this name, as one that was begun here does."""
    try:
        told = toml_file(project, one_line(project))["project"]["entry-points"][group]
        return list(told) == [name]
    except (BadInputError, LookupError, TypeError):
        return False  # whatever it is, it is not ours to write over


def _require_part_name(kind: Kind, name: str) -> None:
    """Refuse a name that no part can have, or one of ours, or a module has: BadInputError."""
    try:
        fits = Component.parse(name) == Component(name)
    except BadInputError:
        fits = False
    if not fits or len(name) > 40 or name in registry.parts(kind):
        why = "there is one" if fits and name in registry.parts(kind) else "not a name of a part"
        raise BadInputError(
            f"NAME = {one_line(name, 60)}: {why}; give it 1 to 40 small letters, digits and dashes"
        )
    word = name.replace("-", "_")
    if not word.isidentifier() or keyword.iskeyword(word):
        raise BadInputError(f"NAME = {name}: no name for a module of Python; give another name")
    installed = PathFinder.find_spec(word)
    # A folder without modules, as `new` made it, is found too where Python looks into this one.
    if word in sys.stdlib_module_names or (installed and installed.origin):
        raise BadInputError(f"NAME = {name}: Python has a module of that name; give another name")
