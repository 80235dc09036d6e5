"""Commands attacked at random: no traceback, nothing lost, every reader reads what is left."""

import os
import shutil
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.attack.attacks import BORROWED
from tests.attack.laboratory import Laboratory
from tests.cli.forked import Forked
from tests.cli.program import done
from tests.fuzz.budget import FIRST_SEED

MINUTES = "AFFCLI_ATTACK_MINUTES"
"""How long commands are attacked, in minutes of wall clock, when they are tortured."""
USUAL_MINUTES = 10.0
LIFE = 40
"""Attacks that a database lives through before a fresh one takes its place."""
SEED = 1
FEW = 4


@pytest.fixture(scope="module")
def laboratory(furnished: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Laboratory]:
    home = tmp_path_factory.mktemp("attacked") / "home"
    shutil.copytree(furnished, home)
    done("learn", "--tool", "l-stick", "--minutes", "0", *BORROWED, "--db", "filled.db", cwd=home)
    attacked = Laboratory(home, Forked(), Forked())
    yield attacked
    attacked.program.close()
    attacked.neighbour.close()


@pytest.mark.fault(1)
@pytest.mark.fault(4)
@pytest.mark.fault(40)
@pytest.mark.torture
def test_no_interruption_no_neighbour_and_no_disk_takes_a_command_down(
    laboratory: Laboratory, torture: bool, tell: Callable[[str], None]
) -> None:
    if not torture:
        laboratory.besiege(SEED, FEW)
        return
    began = time.monotonic()
    minutes = float(os.environ.get(MINUTES, USUAL_MINUTES))
    first = seed = int(os.environ.get(FIRST_SEED, time.time_ns() // 1_000_000_000))
    while time.monotonic() < began + 60.0 * minutes:
        laboratory.besiege(seed, LIFE)
        seed += 1
    tell(f"{report(laboratory.did)}; seeds {first} to {seed - 1}")


def report(did: Counter[tuple[str, str, str]]) -> str:
    """Say how often each fault met how many commands, and how these ended."""
    faults = dict.fromkeys(sorted(fault for _, fault, _ in did))
    said = []
    for fault in faults:
        ends: Counter[str] = Counter()
        for (_, met, end), times in did.items():
            ends[end] += times if met == fault else 0
        words = ", ".join(f"{times} {end}" for end, times in ends.most_common() if times)
        said.append(f"{fault} {ends.total()} ({words})")
    commands: Counter[str] = Counter()
    for (command, _, _), times in did.items():
        commands[command] += times
    named = ", ".join(f"{command} {times}" for command, times in commands.most_common())
    return f"{did.total()} attacks: {'; '.join(said)}; on {named}"
