"""Each command that writes, killed at its writes: what is left is one of the states, and goes on.

`tests/states/kinds.py` makes the states within the process; here the system does.
"""

import shutil
import signal
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from tests.cli.program import Contents, contents
from tests.states.commands import DATABASE, WRITING, reading
from tests.states.conftest import Left
from tests.states.killer import STRACE, Killer
from tests.states.kinds import kinds, recovered
from tests.states.reading import asked

MOST = 25
"""Kills of one command in `make torture`; all its writes where there are fewer."""
FEW = 2
RARE = 4
"""Of a call that a command does no oftener than this, none is left out."""


@pytest.fixture(scope="module")
def killer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Killer]:
    running = Killer(tmp_path_factory.mktemp("killer"))
    yield running
    running.close()


@pytest.mark.torture
@pytest.mark.fault(2)
@pytest.mark.fault(37)
@pytest.mark.parametrize("name", WRITING)
def test_a_command_killed_at_a_write_leaves_a_known_state_and_goes_on(
    name: str,
    left: Left,
    killer: Killer,
    torture: bool,
    tell: Callable[[str], None],
    tmp_path: Path,
) -> None:
    command, states = WRITING[name], left[name]
    known = [held(folder) for _, folder in states]
    ends = Ends(killer, command.args, tmp_path)
    lines = list(reading())
    whole = Path(shutil.copytree(states[0][1], tmp_path / "whole"))
    code, said, writes = killer.run(command.args, whole)
    assert code == 0, said
    points = chosen(writes, MOST if torture else FEW)
    killed: Counter[str] = Counter()
    read, seen = 0, set[frozenset[str]]()
    for number, point in enumerate(points):
        folder = Path(shutil.copytree(states[0][1], tmp_path / "killed"))
        kind = writes[point - 1]
        code, _, _ = killer.run(command.args, folder, kind, writes[:point].count(kind))
        assert code == -signal.SIGKILL, f"{kind}, write {point}: not killed"
        killed[kind] += 1
        there = held(folder)
        assert there in known, f"{kind}, write {point}: a state that no commit leaves"
        require_whole_files(folder, known[0], whole)
        copy = Path(shutil.copytree(folder, tmp_path / "looked at"))
        # Whoever comes first sets the file right. All come where there is a kind of state anew.
        state, first = kinds(copy), lines[(number * 7) % len(lines)]
        for line in (first, *(lines if torture and state not in seen else ["db check"])):
            asked(line, folder, copy)
            read += 1
        seen.add(state)
        code, said, _ = killer.run(command.args, folder)
        assert code == 0 or (command.once and command.once in said), (
            f"{kind}, write {point}: does not go on: {said}"
        )
        if command.anew:
            assert held(folder) == ends.of(there, states[known.index(there)][1])
        else:
            assert held(folder) == known[-1]
        require_whole_files(folder, known[0], whole)
        shutil.rmtree(folder)
        shutil.rmtree(copy)
    how = ", ".join(f"{count} at {call}" for call, count in sorted(killed.items()))
    by = "of system calls" if STRACE else "of statements"
    tell(
        f"{name}: {len(points)} kills of {len(writes)} writes, {by}: {how}; "
        f"{len(seen)} kinds of state, read by {read} commands"
    )


def held(folder: Path) -> Contents:
    """Return what a database holds after a kill, and the tables of one without a schema: none."""
    if not (folder / DATABASE).exists():
        return {}
    with recovered(folder) as copy:
        return contents(copy)


def require_whole_files(folder: Path, before: Contents, whole: Path) -> None:
    """Check that copies of the database and other files are whole, wherever they are."""
    for path in folder.iterdir():
        if path.suffix == ".backup":
            assert contents(path) == before
        elif path.name.startswith("out.") and (whole / path.name).exists():
            assert path.read_bytes() == (whole / path.name).read_bytes()


def chosen(writes: Sequence[str], most: int) -> list[int]:
    """Return at which writes to kill, from 1: all, or of the frequent calls some at even steps."""
    times = Counter(writes)
    rare = [n for n, call in enumerate(writes, 1) if times[call] <= RARE]
    others = [n for n, call in enumerate(writes, 1) if times[call] > RARE]
    room = max(1, most - len(rare)) if most > FEW else most
    step = max(1.0, len(others) / room)
    some = [others[int(k * step)] for k in range(min(room, len(others)))]
    return sorted([*(rare if most > FEW else []), *some]) or [1]


class Ends:
    """Where a command that begins anew ends, from each state that a clean stop leaves."""

    def __init__(self, killer: Killer, args: list[str], folder: Path) -> None:
        self._killer, self._args, self._folder = killer, args, folder
        self._known: list[tuple[Contents, Contents]] = []

    def of(self, there: Contents, state: Path) -> Contents:
        """Return what the database holds in the end."""
        for begins, end in self._known:
            if begins == there:
                return end
        folder = Path(shutil.copytree(state, self._folder / f"from {len(self._known)}"))
        code, said, _ = self._killer.run(self._args, folder)
        assert code == 0, said
        self._known.append((there, held(folder)))
        return self._known[-1][1]


def test_the_writes_at_which_to_kill_are_spread_over_all() -> None:
    writes = ["pwrite64"] * 300 + ["rename"] + ["fdatasync"] * 9
    points = chosen(writes, 40)
    assert len(points) == 40
    assert 301 in points
    assert points[0] == 1
    assert points[-1] > 300
    assert chosen(["write"] * 5, 40) == [1, 2, 3, 4, 5]
    assert chosen(["write"] * 9, 2) == [1, 5]
