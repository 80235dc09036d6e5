"""Another process holds the database: all commands wait for it in one way, and say so."""

import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from threading import Timer
from types import SimpleNamespace

import pytest

from affcli.store import waiting
from tests.attack.attacks import has_database, named, plainly
from tests.cli.program import affcli, names_in, one_printable_line
from tests.fuzz.commands import Command
from tests.states.commands import EXPERIMENT, LOG, MAP

COMMANDS = [command for command in named() if has_database(command)]
HELD_BY = "another process, probably another affcli"


@pytest.fixture
def locked(learned: Path) -> Iterator[sqlite3.Connection]:
    """`learned`, which nobody else can read."""
    with closing(sqlite3.connect(learned, isolation_level=None, check_same_thread=False)) as other:
        other.execute("BEGIN EXCLUSIVE")
        yield other


@pytest.fixture
def hurried(monkeypatch: pytest.MonkeyPatch) -> None:
    """For those who wait, time goes by two hundred times as fast."""
    clock = SimpleNamespace(monotonic=lambda: 200.0 * time.monotonic())
    monkeypatch.setattr(waiting, "time", clock)


@pytest.mark.fault(5)
@pytest.mark.fault(40)
@pytest.mark.usefixtures("locked", "hurried")
@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.name)
def test_every_command_waits_says_for_whom_and_gives_up_after_what_it_says(
    command: Command, learned: Path
) -> None:
    if command.name == "experiment":
        (learned.parent / "two.toml").write_text(EXPERIMENT)
    if command.name == "import":
        (learned.parent / "log.txt").write_text(LOG)
        (learned.parent / "map.toml").write_text(MAP)
    ended = affcli(*plainly(command), "--db", learned, cwd=learned.parent)
    assert ended.code == 3, ended
    lines = ended.err.splitlines()
    assert lines.pop(0) == f"waiting for {HELD_BY}, which holds {learned}"
    said = f"{learned}: locked for more than {waiting.LONGEST_WAIT:g} s by {HELD_BY}; wait until"
    if command.name == "doctor":
        assert said.partition(": ")[2] in " ".join(ended.out.split())
        assert lines == []
    else:
        assert said in one_printable_line("\n".join(lines) + "\n")
        assert ended.out == ""
    assert set(names_in(learned.parent)) <= {learned.name, "two.toml", "log.txt", "map.toml"}


@pytest.mark.fault(40)
def test_who_is_waited_for_is_told_once_in_a_wait(
    learned: Path, locked: sqlite3.Connection, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(waiting, "SILENT", 0.1)
    giving_back = Timer(1.0, locked.execute, ["COMMIT"])
    giving_back.start()
    ended = affcli("sql", "select count(*) as runs from learning_run", "--csv", "--db", learned)
    giving_back.join()
    said = f"waiting for {HELD_BY}, which holds {learned}\n"
    assert (ended.code, ended.out, ended.err) == (0, "runs\n2\n", said)
