"""Every command of the program by what it does to a database, found in the program itself.

What writes is registered here, and nowhere else; whatever else is asked a database reads it, and
is called as its options say. So a new command is read with on every state by its being there, and
one that writes is told to be registered.
"""

import shlex
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from affcli.cli.app import program
from tests.cli.program import rows

DATABASE = "my.db"
"""The database of every command here, in a folder of its own."""
SETTINGS = "[motion]\nhold = 60.0\n[trial]\nmax_steps = 2\n"
"""An hour holds some thirty behaviors, and trials are given up soon."""
EXPERIMENT = """
[experiment]
name = "two"
question = "Is what conditions share learned once?"
robots = 2
[base]
minutes = 4
tools = ["t-hook"]
trial.max_steps = 2
[[condition]]
name = "paper"
[[condition]]
name = "fewer"
planner = "nested-query:share=0.05"
"""
MAP = """
[log]
source = "made up"
[columns]
tool = 1
behavior = 2
start_x = 3
start_y = 4
end_x = 5
end_y = 6
"""
LOG = "rake draw 0 20 0 12\nrake draw 1 20 1 13\nstick draw 0 20 0 20\nstick push 0 20 0 26\n"
"""A log of another robot, and how it is read."""
OTHER = "other.db"
"""What is merged: the database that the commands before made."""
CHUNK = 20
"""Behaviors saved at once, so that a short run is saved in several chunks."""


@dataclass(frozen=True, slots=True)
class Writing:
    """A command that writes, in a folder made ready for it.

    Args:
        line: the command, without its database.
        before: commands that run first.
        revision: of the database that is there; none if empty.
        anew: done again it does not go on where it was but begins anew, from what is saved.
        once: what it says when it was killed after it had done what can be done once.
    """

    line: str
    before: tuple[str, ...] = ()
    revision: str = ""
    anew: bool = False
    once: str = ""

    @property
    def args(self) -> list[str]:
        """The words of the command."""
        return shlex.split(self.line) if "--into" in self.line else called(self.line)


LEARN = "learn --tool stick --tool t-hook --behaviors 60 --set trial.max_steps=4"
LIVED = "experiment two.toml --workers 1"
USED = (LEARN, "solve --goal 2 --start 1 --tool t-hook")

WRITING = {
    "learn": Writing(LEARN),
    "learn, through a camera": Writing("learn --tool stick --behaviors 4 --sensor camera"),
    "learn, carrying over": Writing(
        "learn --tool fork --behaviors 4 --transfer-from 1,2 --set trial.max_steps=4", (LEARN,)
    ),
    "invent": Writing("invent --tool stick --minutes 6"),
    "solve": Writing("solve --goal 3", (LEARN,), anew=True),
    "break-tool": Writing("break-tool", (LEARN,), anew=True),
    "verify --update": Writing("verify --update --rows 4", (LEARN,), anew=True),
    "reproduce": Writing("reproduce --robots 2 --workers 1 --config settings.toml"),
    "experiment": Writing(LIVED),
    "import": Writing("import log.txt --map map.toml"),
    "runs note": Writing("runs note 1 seen", (LEARN,)),
    "runs delete": Writing("runs delete 2 --yes", USED, once="it was deleted"),
    "db merge": Writing(f"db merge {OTHER} --into {DATABASE}", (LIVED,)),
    "db upgrade": Writing("db upgrade", revision="0003"),
    "db upgrade, from the first": Writing("db upgrade", revision="0001"),
    "db backup": Writing("db backup --force", (LEARN,)),
    "table export --out": Writing("table export --force --out out.csv", (LEARN,)),
    "report --html": Writing("report --force --html out.html", USED),
}
"""What writes: a database, a copy of one, or another file; by the words that call it."""

ALWAYS_WRITE = frozenset(name.partition(",")[0] for name in WRITING if " --" not in name)
"""Commands that write a database, or a copy of one, whatever they are given."""

PLACES = {"--out", "--html", "--gif"}
"""Options that name a file to be written."""
ENDINGS = {"figure": "svg", "camera": "png", "table": "csv", "--html": "html", "--gif": "gif"}
ENDINGS |= {"compare": "md"}
USUAL = {"predict": "--pushes 2", "verify": "--rows 2", "figure prediction": "--pushes 2"}
USUAL |= dict.fromkeys(("compare", "figure compare"), "--session 1 --session {session}")
USUAL |= dict.fromkeys(("power", "figure curve"), "--session {session}")
USUAL |= {f"camera view {one}": "--step 1 --out out.png" for one in ("--run", "--trial")}
USUAL |= {"camera view --after": "--trial {trial} --step 1 --out out.png"}
USUAL |= {f"replay {one}": "{trial} --speed 100" for one in ("--gif", "--json")}
"""Given beside what is asked for, so that it ends soon or can be done at all."""
NOT_ASKED = {"--force", "--update", "--frame", "--pattern", "--help", "--video", "--no-caption"}
"""Options that are given always, that write, or that leave out the database or words; and a film of
what the camera sees, for which one trial is read as for a picture, and then a thousand pictures
drawn."""
LATEST = {"--session": "session", "--trial": "trial", "--after-trial": "trial", "TRIAL": "trial"}
LATEST |= {"--run": "learning_run", "--compare": "learning_run", "ID": "affordance"}
"""Which number is meant, of an option or, without one, by the word that stands for it."""


def called(line: str) -> list[str]:
    """Return the words of a command line, with its database."""
    return [*shlex.split(line), "--db", DATABASE]


@cache
def commands() -> tuple[tuple[str, list[Any]], ...]:
    """Return every command that is asked a database: its name and its parameters."""
    return tuple(_commands(program, ()))


def _commands(group: Any, path: tuple[str, ...]) -> Iterator[tuple[str, list[Any]]]:
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from _commands(command, (*path, name))
        else:
            params = command.loaded.params
            if any({"--db", "--into"} & set(one.opts) for one in params):
                yield " ".join((*path, name)), params


def reading() -> Iterator[str]:
    """Yield calls of every command that reads a database, with ``{table}`` for a number.

    Each is called with what it needs; then with each thing more that it may be asked: a number, a
    flag, a file to write.
    """
    for name, params in commands():
        if name in WRITING:
            continue
        flags = {one.opts[0] for one in params if getattr(one, "is_flag", False)}
        always = [name, *(["--force"] if "--force" in flags else [])]
        needed = [_given(one, name) for one in params if one.required]
        yield " ".join((*always, *needed, USUAL.get(name, "")))
        for one in params:
            asked = _asked(one, name)
            if asked and not one.required:
                more = USUAL.get(f"{name} {one.opts[0]}", USUAL.get(name, ""))
                yield " ".join((*always, *needed, asked, more))


def _asked(one: Any, name: str) -> str:
    """Return an option or argument as it is asked for; empty if it says nothing of the database."""
    option = one.opts[0]
    if option in NOT_ASKED:
        return ""
    if getattr(one, "is_flag", False):
        return str(option)
    if one.metavar in {"ID", "TRIAL"} or option in PLACES:
        return _given(one, name)
    return ""


def _given(one: Any, name: str) -> str:
    """Return an option or argument with its value."""
    option = one.opts[0] if one.param_type_name == "option" else ""
    if option in PLACES:
        ending = ENDINGS.get(option) or ENDINGS.get(name) or ENDINGS[name.split(maxsplit=1)[0]]
        return f"{option} out.{ending}"
    if one.metavar == "QUERY":
        return "'select * from affordance_table'"
    if one.metavar in {"STEP", "WAY"}:
        return {"STEP": "1", "WAY": "nearer"}[one.metavar]
    named = {"figure trial": "trial", "runs show": "learning_run"}
    table = named.get(name) or LATEST.get(option) or LATEST[one.metavar]
    return f"{option} {{{table}}}"


@dataclass(slots=True)
class Numbers:
    """The latest number of each table of a database; 1 where there is none."""

    database: Path
    known: dict[str, int] = field(default_factory=dict)

    def __getitem__(self, table: str) -> int:
        """Return the number; called by `str.format_map`."""
        if table not in self.known:
            number = None
            with suppress(Exception):  # no such file or table: then it is for the command to say
                ((number,),) = rows(self.database, f"SELECT max(id) FROM {table}")
            self.known[table] = number or 1
        return self.known[table]
