"""What a kill can leave, made once: each test works on a copy of its own."""

import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from affcli.lab import learning
from tests.states.commands import CHUNK, DATABASE, WRITING
from tests.states.kinds import STATES, kinds, prepare, states_of

Left = dict[str, list[tuple[frozenset[str], Path]]]


@pytest.fixture(scope="session")
def left(tmp_path_factory: pytest.TempPathFactory) -> Left:
    """Of each command that writes, in order, the states that a kill of it can leave."""
    made: Left = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(learning, "CHUNK", CHUNK)
        for name, command in WRITING.items():
            folder = tmp_path_factory.mktemp("left") / "at"
            prepare(command, folder)
            made[name] = [(kinds(one), one) for one in states_of(command, folder)]
    return made


@pytest.fixture
def in_state(left: Left, tmp_path: Path) -> Callable[[str], Path]:
    """Give a folder of its own in a state that has this name and no other."""

    def make(name: str) -> Path:
        folder = tmp_path / name
        if older := STATES[name].older:
            whose = "verify --update" if "verification" in name else "solve"
            shutil.copytree(left[whose][-1][1], folder)
            with closing(sqlite3.connect(folder / DATABASE)) as driver:
                driver.executescript(older)
        else:
            alone = (one for each in left.values() for kind, one in each if kind == {name})
            shutil.copytree(next(alone), folder)
        return folder

    return make
