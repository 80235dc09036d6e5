"""Stopped by ctrl-C, by SIGTERM, or killed; and gone on with (faults 1 to 3)."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from affcli.core.identity import Component
from affcli.store import open_store
from tests.cli.program import (
    ROOT,
    Ended,
    affcli,
    contents,
    done,
    ending,
    one_printable_line,
    refused,
    rows,
    started,
    wait_until,
)
from tests.factories import learning_spec
from tests.lab.quick import NOW

LONG = ("learn", "--tool", "stick", "--behaviors", "7000")
SHORTER = ("learn", "--tool", "stick", "--behaviors", "2500")
"""Long enough to be stopped once."""
GOES_ON = (
    "affcli: stopped; what was saved is kept, and the same command goes on from there "
    "(or: --resume)\n"
)
SOON = 10.0
"""Seconds: five times what a person is promised."""


def saved(database: Path) -> int:
    """Return how many behaviors are saved."""
    return count(database, "SELECT coalesce(sum(behaviors), 0) FROM learning_run")


def robots(database: Path) -> int:
    """Return how many robots are saved."""
    return count(database, "SELECT count(DISTINCT robot) FROM learning_run")


def count(database: Path, query: str) -> int:
    """Return what a query counts; 0 while there is no database yet."""
    if not database.exists() or not rows(database, "SELECT 1 FROM sqlite_master LIMIT 1"):
        return 0
    ((number,),) = rows(database, query)
    return int(number)


def more_than(kept: int, how_many: Callable[[], int]) -> Callable[[], bool]:
    """Ask whether there are more than so many."""
    return lambda: how_many() > kept


def stopped(process: subprocess.Popen[str], signum: int) -> Ended:
    """Send a signal; the process must end soon."""
    process.send_signal(signum)
    began = time.monotonic()
    ended = ending(process, SOON)
    assert time.monotonic() - began < SOON
    return ended


@pytest.mark.fault(1)
@pytest.mark.fault(2)
@pytest.mark.fault(3)
def test_learning_goes_on_after_whatever_stopped_it(tmp_path: Path) -> None:
    """Interrupted, terminated and killed in turn, the run ends as if nothing had happened."""
    database, alone = tmp_path / "my.db", tmp_path / "alone.db"
    kept = 0
    for signum, code, says in (
        (signal.SIGINT, 130, GOES_ON),
        (signal.SIGTERM, 143, GOES_ON),
        (signal.SIGKILL, -signal.SIGKILL, ""),
    ):
        with started(*LONG, "--db", database) as process:
            wait_until(more_than(kept, partial(saved, database)), process)
            assert stopped(process, signum) == Ended(code, "", says)
        assert kept < saved(database) < 7000
        kept = saved(database)
        assert rows(database, "SELECT count(*), max(step) FROM behavior") == [(kept, kept)]
        assert rows(database, "PRAGMA integrity_check") == [("ok",)]
    said = done("report", "--db", database).out
    assert "stick (unfinished)" in said
    assert done(*LONG, "--db", database).err.startswith("learned stick")
    assert done(*LONG, "--db", database).err.startswith("already learned")
    done(*LONG, "--db", alone)
    assert contents(database) == contents(alone)


@pytest.mark.fault(2)
def test_resume_alone_goes_on_with_every_interrupted_run(tmp_path: Path) -> None:
    """Each with its own seed, length and settings, which need not be given again."""
    database, alone = tmp_path / "my.db", tmp_path / "alone.db"
    config = tmp_path / "quick.toml"
    config.write_text("[sensor]\nposition_noise = 0.02\n")
    runs = (SHORTER, (*SHORTER, "--seed", "5", "--config", config))
    for number, command in enumerate(runs, 1):
        with started(*command, "--db", database) as process:
            wait_until(more_than(number - 1, partial(begun, database)), process)
            process.kill()
            ending(process)
    ended = done("learn", "--resume", "--db", database)
    assert [line.split(":")[0] for line in ended.err.splitlines()] == [
        "learned stick (run 1, seed 0)",
        "learned stick (run 2, seed 5)",
    ]
    for command in runs:
        done(*command, "--db", alone)
    assert by_key(database) == by_key(alone)


def test_a_run_whose_part_is_missing_does_not_keep_the_others_from_going_on(
    tmp_path: Path,
) -> None:
    database, spec = tmp_path / "my.db", learning_spec("stick", behaviors=3)
    with open_store(database, create=True, write=True) as store:
        for one in (replace(spec, explorer=Component("curious")), replace(spec, seed=5)):
            store.learning.begin(one, {}, NOW)
    ended = affcli("learn", "--resume", "--db", database)
    learned, missing = ended.err.splitlines()
    assert ended.code == 4
    assert learned.startswith("learned stick (run 2, seed 5)")
    assert "the interrupted stick, seed 0: explorer curious: this affcli has no" in missing


def by_key(database: Path) -> dict[str, list[tuple[object, ...]]]:
    """Return what is in a database by run and step: interleaved runs number rows otherwise."""
    found = contents(database)
    found["affordance"] = sorted(row[1:] for row in found["affordance"])
    return found


def begun(database: Path) -> int:
    """Return how many learning runs have saved behaviors."""
    return count(database, "SELECT count(*) FROM learning_run WHERE behaviors > 0")


@pytest.mark.fault(2)
@pytest.mark.fault(39)
def test_resume_with_nothing_to_resume_starts_fresh(tmp_path: Path, leisurely: Path) -> None:
    database, again = tmp_path / "my.db", tmp_path / "again.db"
    learn = ("learn", "--tool", "stick", "--behaviors", "30")
    assert done(*learn, "--resume", "--db", database).err.startswith("learned stick")
    done(*learn, "--db", again)
    assert contents(database) == contents(again)
    ended = affcli("learn", "--resume", "--db", database)
    assert (ended.code, "nothing to resume in" in ended.err) == (2, True)
    ended = affcli("learn", "--resume", "--seed", "3", "--db", database)
    assert (ended.code, "its own hours, seed and settings" in ended.err) == (2, True)
    missing = tmp_path / "missing.db"
    assert affcli("learn", "--resume", "--db", missing).code == 3
    assert not missing.exists()


@pytest.mark.fault(39)
def test_a_reproduction_is_resumed_only_where_one_was_interrupted(reproduced: Path) -> None:
    """By --resume alone; with a number of robots or a seed it is the command itself."""
    before = contents(reproduced)
    line = refused(2, "reproduce", "--resume", "--db", reproduced)
    assert "nothing to resume in" in line
    assert line.endswith("begin one: affcli reproduce --robots 20")
    assert contents(reproduced) == before
    missing = reproduced.with_name("missing.db")
    assert "no database there" in refused(3, "reproduce", "--resume", "--db", missing)
    assert not missing.exists()


@pytest.mark.fault(3)
@pytest.mark.parametrize(("signum", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_stopped_while_it_starts_it_is_one_line_too(
    signum: signal.Signals, code: int, tmp_path: Path
) -> None:
    """From the moment on in which affcli itself runs; before, it is Python that is stopped."""
    for delay in (0.0, 0.1, 0.2):
        with started(*LONG, "--db", tmp_path / "my.db") as process:
            wait_until(partial(handles_signals, process.pid), process)
            time.sleep(delay)
            assert stopped(process, signum) == Ended(code, "", GOES_ON)


IMPORTING = """
import importlib.abc, os, runpy, signal, sys

class Interrupted(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == sys.argv[1]:
            os.kill(os.getpid(), int(sys.argv[2]))

sys.meta_path.insert(0, Interrupted())
runpy.run_module("affcli", run_name="__main__")
"""
"""The program, sent a signal when it imports a module."""


@pytest.mark.fault(45)
@pytest.mark.parametrize("signum", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("module", ["affcli.cli.main", "affcli.cli.signals", "affcli.cli.terminal"])
def test_stopped_before_affcli_listens_it_is_silent(module: str, signum: signal.Signals) -> None:
    """As a shell sees it that is 130 or 143."""
    ended = subprocess.run(
        [sys.executable, "-c", IMPORTING, module, str(int(signum))],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (-signum, "", "")


def sent_to_itself(program: str, signum: signal.Signals) -> subprocess.CompletedProcess[str]:
    """Run `solve` in a program that sends itself a signal; see `TELLING` and `LISTENING`."""
    return subprocess.run(
        [sys.executable, "-c", program, "solve", str(int(signum))],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )


TELLING = """
import os, sys
from affcli.cli import main

told = main.say

def interrupted(line):
    os.kill(os.getpid(), int(sys.argv[-1]))
    told(line)

main.say = interrupted
sys.exit(main.main())
"""
"""The program, sent a signal when it is about to say what was wrong."""


@pytest.mark.fault(45)
@pytest.mark.parametrize("signum", [signal.SIGINT, signal.SIGTERM])
def test_stopped_while_it_says_what_was_wrong_it_ends_at_once(signum: signal.Signals) -> None:
    ended = sent_to_itself(TELLING, signum)
    assert (ended.returncode, ended.stdout, ended.stderr) == (-signum, "", "")


LISTENING = """
import os, signal, sys
from affcli.cli import main

begun = signal.signal

def interrupted(signum, does):
    before = begun(signum, does)
    if signum == signal.SIGTERM and does is not signal.SIG_DFL:
        os.kill(os.getpid(), int(sys.argv[-1]))
    return before

signal.signal = interrupted
sys.exit(main.main())
"""
"""The program, sent a signal while it begins to listen for them."""


@pytest.mark.fault(45)
@pytest.mark.parametrize("signum", [signal.SIGINT, signal.SIGTERM])
def test_stopped_while_it_begins_to_listen_it_says_so(signum: signal.Signals) -> None:
    ended = sent_to_itself(LISTENING, signum)
    assert (ended.returncode, ended.stdout) == (128 + signum, "")
    assert one_printable_line(ended.stderr).startswith("affcli: stopped; what was saved is kept")


@pytest.mark.torture
@pytest.mark.fault(3)
@pytest.mark.fault(45)
def test_a_signal_is_heard_whenever_it_comes(
    torture: bool, tell: Callable[[str], None], tmp_path: Path
) -> None:
    """Raised once only, one in forty fell into a callback of an import and was lost."""
    moments = np.random.default_rng(3).uniform(0.0, 0.5, 200 if torture else 6)
    for k, delay in enumerate(moments.tolist()):
        signum, code = ((signal.SIGINT, 130), (signal.SIGTERM, 143))[k % 2]
        with started(*LONG, "--db", tmp_path / f"{k}.db") as process:
            wait_until(partial(handles_signals, process.pid), process)
            time.sleep(delay)
            assert stopped(process, signum) == Ended(code, "", GOES_ON)
    tell(f"{len(moments)} signals, each heard")


def handles_signals(pid: int) -> bool:
    """Tell whether a process has handlers of its own for both signals (Linux)."""
    status = Path(f"/proc/{pid}/status")
    if not status.exists():
        time.sleep(0.5)
        return True
    caught = next(line for line in status.read_text().splitlines() if line.startswith("SigCgt"))
    both = 1 << (signal.SIGINT - 1) | 1 << (signal.SIGTERM - 1)
    return int(caught.split()[1], 16) & both == both


@pytest.mark.fault(2)
@pytest.mark.fault(3)
def test_a_stopped_reproduction_goes_on(leisurely: Path, tmp_path: Path, reproduced: Path) -> None:
    """Stopped, killed and done with another number of workers: the same store."""
    database = tmp_path / "my.db"
    command = ("reproduce", "--robots", "2", "--config", leisurely, "--db", database)

    with started(*command, "--workers", "2") as process:
        wait_until(more_than(0, partial(robots, database)), process)
        assert stopped(process, signal.SIGINT) == Ended(130, "", GOES_ON)
    kept = robots(database)
    assert 1 <= kept <= 2
    with started(*command, "--workers", "1") as process:
        if kept < 2:
            wait_until(more_than(kept, partial(robots, database)), process)
        process.kill()
        ending(process)
    assert rows(database, "PRAGMA integrity_check") == [("ok",)]
    if rows(database, "SELECT status FROM session") == [("running",)]:
        done("reproduce", "--resume", "--workers", "1", "--db", database)
    done(*command, "--workers", "1")
    assert contents(database) == contents(reproduced)


@pytest.mark.fault(3)
@pytest.mark.parametrize("signum", [signal.SIGINT, signal.SIGTERM])
def test_workers_end_with_their_parent(signum: signal.Signals, tmp_path: Path) -> None:
    """Lives of full length take seconds; nobody waits for those begun."""
    database = tmp_path / "my.db"
    with started("reproduce", "--robots", "9", "--workers", "2", "--db", database) as process:
        wait_until(lambda: len(children_of(process.pid, WORKER)) == 2, process)
        time.sleep(1.0)
        assert stopped(process, signum) == Ended(128 + signum, "", GOES_ON)


WORKER = "affcli.lab.workers"
"""A process that lives lives has this in its command line."""
SEVERAL = ("learn", "--tool", "stick", "--tool", "l-stick", "--tool", "t-stick", "--behaviors")


def test_several_tools_give_the_same_store_for_any_number_of_workers(tmp_path: Path) -> None:
    """Of more than a chunk each, which are saved in turn; one of them was begun before."""
    stores = []
    for workers in ("1", "2", "9"):
        database = tmp_path / f"{workers}.db"
        done("learn", "--tool", "l-stick", "--behaviors", "20", "--db", database)
        ended = done(*SEVERAL, "600", "--workers", workers, "--db", database)
        assert [line.split(" (")[0] for line in ended.err.splitlines()] == [
            *("learned stick", "learned l-stick", "learned t-stick")
        ]
        stores.append(contents(database))
    assert stores[0] == stores[1] == stores[2]


@pytest.mark.fault(2)
@pytest.mark.fault(3)
def test_several_tools_that_were_interrupted_go_on(tmp_path: Path) -> None:
    """Stopped, then the program killed, then a worker killed: all that was saved is kept."""
    database, alone = tmp_path / "my.db", tmp_path / "alone.db"
    command = (*SEVERAL, "2000", "--workers", "2", "--db", database)
    with started(*command) as process:
        wait_until(more_than(0, partial(saved, database)), process)
        assert stopped(process, signal.SIGINT) == Ended(130, "", GOES_ON)
    kept = saved(database)
    with started(*command) as process:
        wait_until(more_than(kept, partial(saved, database)), process)
        process.kill()
        ending(process)
    assert rows(database, "PRAGMA integrity_check") == [("ok",)]
    kept = saved(database)
    with started("learn", "--resume", "--workers", "2", "--db", database) as process:
        wait_until(more_than(kept, partial(saved, database)), process)
        os.kill(children_of(process.pid, "serve")[0], signal.SIGKILL)
        ended = ending(process)
    assert ended.code == 0
    assert "a worker process died" in ended.err
    done(*command)
    done(*SEVERAL, "2000", "--db", alone)
    assert by_key(database) == by_key(alone)


@pytest.mark.fault(3)
@pytest.mark.parametrize("delay", [0.0, 0.3, 0.6])
def test_ctrl_c_reaches_workers_that_are_just_starting(delay: float, tmp_path: Path) -> None:
    """A terminal sends it to the whole group; the parent alone has something to say."""
    command = ("reproduce", "--robots", "9", "--workers", "2", "--db", tmp_path / "my.db")
    with started(*command) as process:
        wait_until(partial(handles_signals, process.pid), process)
        wait_until(lambda: len(children_of(process.pid)) > 1, process)
        time.sleep(delay)
        os.killpg(process.pid, signal.SIGINT)
        assert ending(process, SOON) == Ended(130, "", GOES_ON)


def children_of(pid: int, doing: str = "") -> list[int]:
    """Return the processes that a process began, those with `doing` in their command line."""
    command = ["/bin/ps", "-A", "-ww", "-o", "pid=,ppid=,args="]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    split = (line.split(maxsplit=2) for line in listed.splitlines())
    return [int(child) for child, parent, *args in split if int(parent) == pid and doing in args[0]]


def test_a_worker_that_died_is_named_and_replaced(tmp_path: Path) -> None:
    """As the system kills one when memory runs out."""
    database, config = tmp_path / "my.db", tmp_path / "slow.toml"
    config.write_text("[motion]\nhold = 5.0\n[trial]\nmax_steps = 6\n")
    command = ("reproduce", "--robots", "6", "--workers", "2", "--config", config)
    with started(*command, "--db", database) as process:
        wait_until(more_than(0, partial(robots, database)), process)
        os.kill(children_of(process.pid, WORKER)[0], signal.SIGKILL)
        ended = ending(process)
    assert ended.code == 0
    assert "a worker process died" in ended.err
    assert robots(database) == 6


@pytest.mark.fault(3)
def test_solving_keeps_the_steps_before_it_was_stopped(learned: Path) -> None:
    """Counters and steps stay together, and nothing is promised that is not so."""
    with started("solve", "--goal", "1", "--tool", "stick", "--db", learned) as process:
        wait_until(lambda: bool(rows(learned, "SELECT 1 FROM step LIMIT 1")), process)
        ended = stopped(process, signal.SIGINT)
    if ended.err.startswith("trials 1 to 4 saved"):
        # It was done already: what was left of it was Python's own leaving.
        assert ended.code in {0, -signal.SIGINT}
    else:
        assert (ended.code, ended.err) == (130, "affcli: stopped; what was saved is kept\n")
    uses = "SELECT sum(times_used - 1), sum(times_successful - 1) FROM affordance"
    steps = "SELECT count(*), sum(replicated) FROM step"
    assert rows(learned, uses) == rows(learned, steps)


@pytest.mark.fault(3)
def test_a_break_that_was_stopped_says_to_run_it_again(learned: Path) -> None:
    with started("break-tool", "--db", learned) as process:
        wait_until(lambda: bool(rows(learned, "SELECT 1 FROM trial LIMIT 1")), process)
        ended = stopped(process, signal.SIGINT)
    if not ended.err.startswith("trials 1 to 32 saved"):
        says = "and not all was done: run affcli break-tool again, which begins anew"
        assert ended == Ended(130, "", f"affcli: stopped; what was saved is kept, {says}\n")
