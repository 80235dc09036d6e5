"""Every command reads every state that a kill can leave, and the killed command goes on."""

import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from affcli import store
from affcli.lab import learning
from affcli.store.replacing import OLD
from tests.cli.program import contents, done
from tests.states.commands import (
    CHUNK,
    DATABASE,
    LEARN,
    WRITING,
    Writing,
    called,
    commands,
    reading,
)
from tests.states.conftest import Left
from tests.states.kinds import PART, STATES, kinds
from tests.states.reading import asked

NAMED = {
    "run begun": "run 1",
    "run with a checkpoint": "run 1",
    "session without trials": "session 1 (",
    "session with trials": "session 1 (",
    "reproduction without robots": "session 1 (reproduce)",
    "reproduction with robots": "session 1 (reproduce)",
    "reproduction with all robots": "session 1 (reproduce)",
    "trial without steps": "trial 8",
    "trial without an end": "trial 8",
    "verification without an end": "verification 1",
}
"""What `db check` says of a state: what is unfinished there."""


SHARE = 12
"""Of the calls of a command but its first, one in so many reads a state, another one each."""


@pytest.mark.fault(37)
@pytest.mark.torture
@pytest.mark.parametrize("name", [name for name in STATES if name != "pages to take back"])
def test_every_command_reads_what_a_kill_left(
    name: str, in_state: Callable[[str], Path], torture: bool, tmp_path: Path
) -> None:
    """As it is called at the least; of its other calls there is each on some of the states."""
    folder, copy = in_state(name), tmp_path / "looked at"
    shutil.copytree(folder, copy)
    first, more = calls()
    for line in (*first, *(more if torture else more[list(STATES).index(name) % SHARE :: SHARE])):
        asked(line, folder, copy)
    if (folder / DATABASE).exists():
        assert contents_if_any(folder) == contents_if_any(copy)
    if name in NAMED:
        said = done("db", "check", "--json", "--db", DATABASE, cwd=folder).results
        assert any(NAMED[name] in one["example"] for one in said if one["unfinished"])
        assert not any(one["wrong"] for one in said)


def calls() -> tuple[list[str], list[str]]:
    """Return the first call of each command that reads, and all others."""
    first: dict[str, str] = {}
    more = []
    for line in reading():
        name = next(one for one, _ in commands() if line.startswith(one))
        if first.setdefault(name, line) != line:
            more.append(line)
    return [*first.values()], more


def contents_if_any(folder: Path) -> object:
    """Return all that a database holds; None for an empty file."""
    database = folder / DATABASE
    return contents(database) if database.stat().st_size else None


@pytest.mark.fault(37)
def test_every_command_sets_right_what_a_kill_left_within_a_transaction(
    left: Left, tmp_path: Path
) -> None:
    """Each command on some state, each kind of state by some commands."""
    torn: dict[frozenset[str], Path] = {}
    for one in left.values():
        for kind, folder in one:
            if "pages to take back" in kind:
                torn.setdefault(kind, folder)
    states = list(torn.items())
    for number, line in enumerate(reading()):
        kind, folder = states[number % len(states)]
        mine, copy = tmp_path / f"{number}", tmp_path / f"{number} looked at"
        shutil.copytree(folder, mine)
        shutil.copytree(folder, copy)
        asked(line, mine, copy)
        asked("db info", mine, copy)
        assert kinds(mine) == kind - {"pages to take back"}
    assert number > len(states)


def test_every_state_is_left_by_some_command_and_no_command_leaves_another(left: Left) -> None:
    found = {name for one in left.values() for kind, _ in one for name in kind}
    assert found == {name for name, state in STATES.items() if not state.older}


@pytest.mark.fault(37)
@pytest.mark.parametrize("name", WRITING)
def test_the_killed_command_goes_on(
    name: str, left: Left, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From each kind of state to the end that an undisturbed run has."""
    monkeypatch.setattr(learning, "CHUNK", CHUNK)
    command, seen = WRITING[name], set()
    *killed, (_, whole) = left[name]
    for number, (kind, folder) in enumerate(killed):
        if kind in seen:
            continue
        seen.add(kind)
        mine = Path(shutil.copytree(folder, tmp_path / f"{number}"))
        done(*command.args, cwd=mine)
        require_whole(command, mine, whole)


def require_whole(command: Writing, folder: Path, whole: Path) -> None:
    """Check that a database is as an undisturbed run leaves it.

    A command that begins anew uses what is saved: then each trial must equal its record.
    """
    database = ("--db", DATABASE)
    if not command.anew:
        assert contents(folder / DATABASE) == contents(whole / DATABASE)
    elif "verify" not in command.line:
        done("replay", "--all", *database, cwd=folder)
    said = done("db", "check", "--json", *database, cwd=folder).results
    assert not any(one["wrong"] for one in said)


@pytest.mark.fault(44)
@pytest.mark.parametrize("name", ["db upgrade", "db backup", "table export --out"])
def test_what_a_killed_command_left_beside_its_file_is_removed_by_the_next(
    name: str, left: Left, tmp_path: Path
) -> None:
    """When it is old: another process may still write it."""
    killed = next(folder for kind, folder in left[name] if "part of a file" in kind)
    for age, stay in ((0.0, 1), (OLD + 9.0, 0)):
        folder = Path(shutil.copytree(killed, tmp_path / f"{age:g}"))
        (part,) = folder.glob(PART)
        part.write_bytes(part.read_bytes()[:7])
        os.utime(part, (time.time() - age,) * 2)
        done(*WRITING[name].args, cwd=folder)
        assert len(list(folder.glob(PART))) == stay


def test_whatever_opens_a_database_to_write_is_registered(
    left: Left, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each command of the program is called in all ways that its options allow."""
    folder = Path(shutil.copytree(left["solve"][-1][1], tmp_path / "at"))
    wrote: list[object] = []

    def watched(real: Any) -> Any:
        def opening(*args: object, **how: object) -> Any:
            if real.__name__ != "open_store" or how["write"] or how["create"]:
                wrote.append(how)
            return real(*args, **how)

        return opening

    for door in ("open_store", "upgrade", "backup"):
        monkeypatch.setattr(store, door, watched(getattr(store, door)), raising=False)
    for line in reading():
        asked(line, folder, folder)
        assert not wrote, f"{line}: writes; register it in WRITING"
    registered = {one.split(",")[0].split(" --")[0] for one in WRITING}
    assert {name for name, _ in commands()} > registered
    for one in ("verify --update --rows 2", "db backup --force", LEARN):
        done(*called(one), cwd=folder)
        assert wrote.pop() is not None
