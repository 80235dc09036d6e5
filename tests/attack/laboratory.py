"""A database that lives on through many attacks; after each it is checked and read."""

import os
import shutil
import sqlite3
from collections import Counter
from contextlib import closing
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from threading import Thread

import numpy as np

from tests.attack.attacks import (
    NOT_THERE,
    Args,
    Attack,
    drawn,
    has_database,
    in_database,
    named,
    plainly,
)
from tests.attack.checks import (
    LASTING,
    check_end,
    check_kept,
    check_said,
    check_sound,
    contents,
)
from tests.attack.disturbing import disturbance
from tests.cli.forked import Finished, Forked
from tests.fuzz.running import check_ending
from tests.states.commands import ALWAYS_WRITE

OLD_DATABASES = Path(__file__).parents[1] / "store" / "databases"
LIVING, OLDER = "living.db", "older.db"
VERSION = "alembic_version"
"""The table that an upgrade changes."""
NEIGHBOUR = ("solve", "--goal", "1", "--start", "1", "--tool", "t-hook", "--db", LIVING)
QUICK = ("db info", "report", "table list", "table show", "table export", "cite", "sql")
"""Readers of which three are drawn after each attack, of the others sometimes one."""
MORE: tuple[Args, ...] = (
    ("report", "--html", "new.html", "--force"),
    ("replay", "1", "--gif", "new.gif", "--steps", "1", "--speed", "20", "--force"),
    ("figure", "affordances", "--after-trial", "2", "--out", "new.svg", "--force"),
)
MOST_REPLAYED = 10
PART = ".affcli-part"
HOURS = 7200.0


@dataclass(slots=True)
class Laboratory:
    """A folder with a database, the program, and a neighbour who uses the database too.

    Args:
        home: the folder, as `tests.fuzz.places.furnish` leaves it.
        program: runs the commands.
        neighbour: runs those of the neighbour.
        did: how often which command met which fault, and how it ended.
    """

    home: Path
    program: Forked
    neighbour: Forked
    did: Counter[tuple[str, str, str]] = field(default_factory=Counter)

    def besiege(self, seed: int, count: int) -> None:
        """Attack a fresh database again and again.

        At the end trials are done again.

        Args:
            seed: of all that is drawn.
            count: how many times.
        """
        for left in self.home.glob(f"{LIVING}*"):
            left.unlink()
        shutil.copy(self.home / "filled.db", self.home / LIVING)
        for number in range(1, count + 1):
            attack = drawn(seed, number)
            try:
                self.suffer(attack, np.random.default_rng([seed, number, 1]))
            except AssertionError as error:
                error.add_note(f"seed {seed}, attack {number}: {attack}")
                raise
        self.do_again(np.random.default_rng(seed))

    def suffer(self, attack: Attack, chance: np.random.Generator) -> None:
        """Do one attack, and check all that must hold then."""
        name = OLDER if attack.command == "db upgrade" else LIVING
        database = self.home / name
        if name == OLDER:
            olds = sorted(OLD_DATABASES.glob("*.db"))
            shutil.copyfile(olds[chance.integers(len(olds))], database)
        before, args = contents(database), in_database(attack.args, name)
        journals = self._journals()  # one that need not be rolled back stays till the next write
        ended = self._attacked(attack, args, database)
        check_end(attack, ended)
        after = contents(database)
        if name == LIVING or before.keys() == after.keys():
            check_kept(*({**held, VERSION: set()} for held in (before, after)))
        check_said(ended, database)
        self._check_tidy(attack, ended, journals)
        if name == LIVING:
            check_sound(database)
            self.read(chance)
        if chance.random() < 0.3 or self._parts() or name == OLDER:
            self._again(attack, args)
            check_sound(database)

    def do_again(self, chance: np.random.Generator) -> None:
        """Replay some of the trials that came under attack, which must equal their records."""
        attacked = self._trials()[len(self._trials("filled.db")) :]
        for number in chance.permutation(attacked)[:MOST_REPLAYED]:
            ended = self.program.run(("replay", str(number), "--db", LIVING), self.home)
            assert ended.code == 0, (number, ended)

    def read(self, chance: np.random.Generator) -> None:
        """Run readers, which must succeed and change nothing."""
        database = self.home / LIVING
        before = database.read_bytes()
        quick, slow = readers()
        some = [quick[at] for at in chance.permutation(len(quick))[:3]]
        if chance.random() < 0.3:
            some.append(slow[chance.integers(len(slow))])
        for args in (("db", "check"), ("replay", str(chance.choice(self._trials()))), *some):
            ended = self.program.run((*args, "--db", LIVING), self.home)
            assert (ended.code, ended.stopped) == (0, False), (args, ended)
            assert database.read_bytes() == before, args

    def _attacked(self, attack: Attack, args: Args, database: Path) -> Finished:
        """Run a command while something happens to it; count how it ended."""
        notes = self.home / "calls"
        notes.unlink(missing_ok=True)
        bounds = {}
        if attack.fault == "memory":
            bounds = {"memory": attack.size}
        elif attack.fault == "little room":
            bounds = {"room": database.stat().st_size + attack.size // 1000}
        elif attack.fault == "clock":
            bounds = {"clock": attack.clock}
        if attack.fault == "neighbour":
            ended = self._beside_a_neighbour(args)
        else:
            ended = self.program.run(
                args, self.home, disturbed=disturbance(attack, database, notes), bounds=bounds
            )
        self.did[attack.command, attack.fault, how(ended, notes)] += 1
        return ended

    def _beside_a_neighbour(self, args: Args) -> Finished:
        """Run a command while another one solves a task with a table of the same database."""
        others: list[Finished] = []
        beside = Thread(target=lambda: others.append(self.neighbour.run(NEIGHBOUR, self.home)))
        beside.start()
        ended = self.program.run(args, self.home)
        beside.join()
        assert [other.code in {0, 1} for other in others] == [True], others
        check_said(others[0], self.home / LIVING)
        return ended

    def _again(self, attack: Attack, args: Args) -> None:
        """Run the command undisturbed: it goes on, and removes what a killed one left behind."""
        for part in self._parts():
            os.utime(part, times=(part.stat().st_atime, part.stat().st_mtime - HOURS))
        ended = self.program.run(args, self.home)
        check_ending(attack.command, ended)
        assert ended.code in {0, 1, 2, 4}, ended
        if ended.code in {0, 1}:
            assert self._parts() == []

    def _check_tidy(self, attack: Attack, ended: Finished, journals: set[Path]) -> None:
        """Check that a command which was not killed left nothing that it did not say."""
        left = self.program.left_behind()
        if ended.code < 0:
            return
        assert left == []
        assert self._parts() == []
        if attack.fault in LASTING | {"SIGINT", "SIGTERM", "memory"}:
            assert self._journals() <= journals

    def _journals(self) -> set[Path]:
        """Return the journals of databases."""
        return set(self.home.glob("*.db-*"))

    def _trials(self, name: str = LIVING) -> list[int]:
        """Return the numbers of all trials of a database."""
        with closing(sqlite3.connect(self.home / name)) as driver:
            return [number for (number,) in driver.execute("SELECT id FROM trial ORDER BY id")]

    def _parts(self) -> list[Path]:
        """Return the files that were being written when their process ended."""
        return sorted(self.home.glob(f".*{PART}*"))


def how(ended: Finished, notes: Path) -> str:
    """Return in a word how a command ended; whether a system call failed, too."""
    word = {0: "done", 1: "done", 2: "refused", 3: "database", 4: "refused"}.get(ended.code)
    if word is None:
        return "ended"
    return f"{word}, met" if notes.exists() and "INJECTED" in notes.read_text() else word


@cache
def readers() -> tuple[list[Args], list[Args]]:
    """Return the commands that read, with their arguments: the quick ones, and the others.

    They are found in the program itself: a new one is read with by its being there.
    """
    quick: list[Args] = []
    slow = [*MORE]
    for command in named():
        if has_database(command) and command.name not in ALWAYS_WRITE | NOT_THERE:
            (quick if command.name in QUICK else slow).append(plainly(command))
    return quick, slow
