"""Several commands use the table of one run at once: they take turns, and each can be replayed."""

import sqlite3
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, closing
from pathlib import Path

import numpy as np
import pytest

from affcli.lab.replaying import replay_trial
from affcli.store import open_store
from tests.attack.checks import check_said, check_sound
from tests.cli.forked import Forked
from tests.cli.program import done

WRITERS = 4
DATABASE = "shared.db"


def drawn(chance: np.random.Generator) -> tuple[str, ...]:
    """Draw a command that uses the table of the one run there is; half of them bring a puck."""
    goal, start = (str(number) for number in chance.integers(1, 5, size=2))
    lines = (
        ("solve", "--goal", goal, "--start", start),
        ("solve", "--goal", goal),
        ("solve", "--goal", goal, "--seed", start, "--planner", "nested-query:share=0.05"),
        ("verify", "--update", "--rows", "12", "--seed", start),
        ("break-tool", "--becomes", "l-hook"),
    )
    return lines[chance.choice(len(lines), p=(0.3, 0.3, 0.1, 0.25, 0.05))]


def trials_in(database: Path) -> int:
    """Return how many trials with the stored counters are saved."""
    with closing(sqlite3.connect(database, timeout=60.0)) as driver:
        query = "SELECT count(*) FROM trial WHERE counters = 'stored'"
        return int(driver.execute(query).fetchone()[0])


def write(program: Forked, home: Path, seed: int, wanted: int) -> tuple[int, float]:
    """Run commands until there are so many trials; return how many, and how long one took."""
    chance = np.random.default_rng(seed)
    commands, longest = 0, 0.0
    while trials_in(home / DATABASE) < wanted:
        args, began = drawn(chance), time.monotonic()
        ended = program.run((*args, "--db", DATABASE), home)
        assert ended.code in {0, 1}, (args, ended)
        check_said(ended, home / DATABASE)
        commands, longest = commands + 1, max(longest, time.monotonic() - began)
    return commands, longest


@pytest.mark.fault(41)
@pytest.mark.torture
def test_four_who_use_one_table_take_turns_and_every_trial_can_be_replayed(
    tmp_path: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    wanted, seed = (2000, time.time_ns() % 1_000_000) if torture else (12, 0)
    (tmp_path / "few.toml").write_text("[trial]\nmax_steps = 12\n")
    learn = ("learn", "--tool", "t-hook", "--behaviors", "500", "--config", "few.toml")
    done(*learn, "--db", DATABASE, cwd=tmp_path)
    with ExitStack() as stack, ThreadPoolExecutor(WRITERS) as together:
        programs = [Forked() for _ in range(WRITERS)]
        for program in programs:
            stack.callback(program.close)
        did = [
            together.submit(write, program, tmp_path, seed + number, wanted)
            for number, program in enumerate(programs)
        ]
        ends = [one.result() for one in did]
    check_sound(tmp_path / DATABASE)
    with open_store(tmp_path / DATABASE, create=False, write=False) as store:
        trials = store.trials.trials()
        differing = [one.id for one in trials if replay_trial(store, one.id).differences]
    assert not differing, f"seed {seed}"
    commands, longest = sum(n for n, _ in ends), max(seconds for _, seconds in ends)
    tell(
        f"{WRITERS} writers, seed {seed}: {commands} commands, {len(trials)} trials, all of them "
        f"replayed equal; the longest command took {longest:.1f} s"
    )
