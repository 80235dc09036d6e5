"""One file, several people: writers at once, readers who stay, locks that are held, copies."""

import os
import sqlite3
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from itertools import count
from pathlib import Path
from threading import Event, Thread

import pytest

from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store.waiting import LONGEST_WAIT as STORE_PATIENCE
from tests.cli.program import (
    Contents,
    contents,
    done,
    ending,
    rows,
    started,
)

LONG = ("--behaviors", "1100")


def by_key(database: Path) -> Contents:
    """Return what a database holds by run and step: runs at once are numbered as they come."""
    found = contents(database)
    names = {run[0]: run[2:5] for run in found["learning_run"]}  # tool, seed, robot
    found["learning_run"] = sorted((run[1:] for run in found["learning_run"]), key=repr)
    for table, own in (("behavior", 0), ("affordance", 1)):
        at = 0 if table == "behavior" else run_column(database)
        found[table] = sorted(
            ((names[row[at]], *row[own:at], *row[at + 1 :]) for row in found[table]), key=repr
        )
    return found


def run_column(database: Path) -> int:
    """Return the place of an affordance's learning run among its columns."""
    names = [name for _, name, *_ in rows(database, "PRAGMA table_info(affordance)")]
    return names.index("learning_run_id")


def learned_at_once(commands: Sequence[tuple[str, ...]], database: Path) -> None:
    """Run several commands beside one another; all must succeed, with one line each, and before
    that one a minute of how far they are.
    """
    with ExitStack() as stack:
        processes = [
            stack.enter_context(started("learn", *args, "--db", database)) for args in commands
        ]
        for process in processes:
            ended = ending(process)
            assert ended.code == 0, ended
            *progress, done = ended.err.splitlines()
            assert done.startswith("learned "), ended
            assert all(line.endswith(" left") for line in progress), ended


@pytest.mark.fault(6)
def test_four_at_once_learn_what_they_would_have_learned_alone(tmp_path: Path) -> None:
    """Three tools, one of them with two seeds; on a file that none of them has made yet."""
    commands = [
        ("--tool", "stick", *LONG),
        ("--tool", "stick", "--seed", "1", *LONG),
        ("--tool", "l-stick", *LONG),
        ("--tool", "t-hook", *LONG),
    ]
    together, alone = tmp_path / "together.db", tmp_path / "alone.db"
    learned_at_once(commands, together)
    for args in commands:
        done("learn", *args, "--db", alone)
    assert by_key(together) == by_key(alone)
    done("db", "check", "--db", together)


@pytest.mark.fault(6)
@pytest.mark.torture
def test_eight_at_once_hold_no_lock_against_one_another(
    tmp_path: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    """Every second pair computes the same run: no chunk is there twice."""
    behaviors = "30000" if torture else "600"
    tools = [*TOOL_PARTS, *TOOL_PARTS][:8]
    commands = [("--tool", tool, "--behaviors", behaviors) for tool in tools]
    database = tmp_path / "my.db"
    learned_at_once(commands, database)
    runs = rows(database, "SELECT tool, status, behaviors FROM learning_run ORDER BY tool")
    assert runs == [(tool, "done", int(behaviors)) for tool in sorted(TOOL_PARTS)]
    steps = (
        "SELECT count(*), count(DISTINCT step), max(step) FROM behavior GROUP BY learning_run_id"
    )
    assert rows(database, steps) == [(int(behaviors),) * 3] * 5
    done("db", "check", "--db", database)
    tell(f"8 processes, {5 * int(behaviors)} behaviors saved, no lock error")


@contextmanager
def reading(database: Path, *, at_once: bool) -> Iterator[Event]:
    """Have another connection read, again and again or in one transaction, until told to end."""
    ends = Event()

    def read() -> None:
        with closing(sqlite3.connect(database, timeout=60.0, isolation_level=None)) as driver:
            while not ends.is_set():
                driver.execute("BEGIN")
                driver.execute("SELECT count(*) FROM behavior").fetchone()
                ends.wait(None if at_once else 0.05)
                driver.execute("COMMIT")
                ends.wait(0.01)

    reader = Thread(target=read)
    reader.start()
    try:
        yield ends
    finally:
        ends.set()
        reader.join()


@pytest.mark.fault(7)
@pytest.mark.torture
@pytest.mark.parametrize("at_once", [False, True], ids=["again and again", "in one go"])
def test_a_reader_who_stays_costs_a_writer_nothing(
    at_once: bool, learned: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    """A minute, or two seconds: who reads in between is passed, who reads in one go waited for."""
    seconds = 60.0 if torture else 2.0
    before = rows(learned, "SELECT count(*) FROM learning_run")
    began, written = time.monotonic(), 0
    with reading(learned, at_once=at_once) as ends:
        if at_once:
            with started("learn", "--tool", "l-stick", *LONG, "--db", learned) as process:
                ends.wait(seconds)
                ends.set()
                ended = ending(process)
            assert ended.code == 0, ended
            *waited, _ = ended.err.splitlines()
            assert all(line.startswith("waiting for ") for line in waited), ended
            written = 1
        else:
            for seed in count(1):
                done("learn", "--tool", "l-stick", "--seed", str(seed), *LONG, "--db", learned)
                written += 1
                if time.monotonic() - began > seconds:
                    break
    assert rows(learned, "SELECT count(*) FROM learning_run") == [(before[0][0] + written,)]
    assert rows(learned, "SELECT DISTINCT status FROM learning_run") == [("done",)]
    done("db", "check", "--db", learned)
    tell(f"read for {seconds:g} s, {written} runs of 1100 behaviors saved meanwhile or after")


@pytest.mark.fault(5)
@pytest.mark.torture
def test_whoever_holds_the_lock_for_too_long_is_named(learned: Path, torture: bool) -> None:
    if not torture:
        pytest.skip(f"one waits for {STORE_PATIENCE:g} s; tests/store does so with less patience")
    before = contents(learned)
    with (
        closing(sqlite3.connect(learned, isolation_level=None)) as driver,
        ExitStack() as stack,
    ):
        driver.execute("BEGIN IMMEDIATE")
        commands = (
            ("learn", "--tool", "l-hook", "--behaviors", "5"),
            ("solve", "--goal", "1"),
            ("break-tool",),
            ("reproduce", "--robots", "1", "--workers", "1"),
        )
        for process in [stack.enter_context(started(*c, "--db", learned)) for c in commands]:
            ended = ending(process)
            assert (ended.code, ended.out) == (3, ""), ended
            waited, *_, line = ended.err.splitlines()  # between them, how far it is after a minute
            assert waited.startswith(f"waiting for process {os.getpid()}, ")
            assert line.startswith("affcli: ")
            assert f"locked for more than {STORE_PATIENCE:g} s by " in line
            assert "wait until it is done, then run the command again" in line
        driver.execute("ROLLBACK")
    assert contents(learned) == before


@pytest.mark.fault(18)
def test_copies_made_while_a_run_goes_on_are_each_of_one_moment(tmp_path: Path) -> None:
    database = tmp_path / "my.db"
    done("learn", "--tool", "stick", "--behaviors", "5", "--db", database)
    seen: list[int] = []
    run = ("learn", "--tool", "t-hook", "--behaviors", "6000", "--db", database)
    with started(*run) as process:
        while process.poll() is None:
            copy = tmp_path / f"{len(seen)}.db"
            done("db", "backup", "--db", database, "--out", copy)
            done("db", "check", "--db", copy)
            done("report", "--db", copy)
            saved = "SELECT coalesce(sum(behaviors), 0), (SELECT count(*) FROM behavior) FROM "
            ((said, there),) = rows(copy, saved + "learning_run")
            assert said == there
            seen.append(there)
        assert ending(process).code == 0
    assert seen == sorted(seen)
    assert len(set(seen)) > 1
