"""Waiting for a lock, and for whom (fault 5): here the test itself holds it."""

import os
import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

from affcli.errors import BadInputError, DatabaseError
from affcli.store import check, database_info, open_store, run_sql, tell_of_waiting, waiting
from affcli.store.waiting import connected, lock_holder

PATIENCE = 0.6
"""Seconds, of which SQLite itself waits for some before it is asked again."""


def store(path: Path) -> None:
    with open_store(path, create=False, write=True, timeout=PATIENCE):
        pass


def query(path: Path) -> None:
    run_sql(path, "select 1", timeout=PATIENCE)


def info(path: Path) -> None:
    database_info(path, timeout=PATIENCE)


def checked(path: Path) -> None:
    check(path, timeout=PATIENCE)


@pytest.fixture
def locked(database: Path) -> Iterator[Path]:
    """A database that nobody else can read or write."""
    with closing(sqlite3.connect(database, isolation_level=None)) as driver:
        driver.execute("BEGIN EXCLUSIVE")
        yield database


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What is said of waiting."""
    said: list[str] = []
    monkeypatch.setattr(waiting, "_say", str)
    tell_of_waiting(said.append)
    return said


@pytest.mark.fault(5)
@pytest.mark.parametrize("way", [store, query, info, checked])
def test_a_lock_is_given_up_after_the_time_that_is_said(
    way: Callable[[Path], None], locked: Path
) -> None:
    began = time.monotonic()
    with pytest.raises(DatabaseError, match=r"locked for more than 0\.6 s by another process"):
        way(locked)
    assert time.monotonic() - began >= PATIENCE


@pytest.mark.fault(5)
def test_it_is_said_once_for_whom_one_waits(
    locked: Path, told: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(waiting, "SILENT", 0.1)
    with pytest.raises(DatabaseError):
        info(locked)
    (line,) = told
    assert line == f"waiting for another process, probably another affcli, which holds {locked}"


@pytest.mark.fault(5)
def test_of_a_short_wait_nothing_is_said(locked: Path, told: list[str]) -> None:
    with pytest.raises(DatabaseError):
        info(locked)
    assert told == []


@pytest.mark.fault(5)
@pytest.mark.skipif(not Path("/proc/locks").exists(), reason="the system does not tell")
def test_who_holds_the_lock_is_named(
    locked: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But for oneself, and who holds another file."""
    own = os.getpid()
    assert lock_holder(locked) == "another process, probably another affcli"
    monkeypatch.setattr(os, "getpid", lambda: own + 1)
    assert lock_holder(locked) == f"process {own}, probably another affcli"
    assert lock_holder(tmp_path / "other.db") == "another process, probably another affcli"


@pytest.mark.fault(4)
def test_what_a_signal_interrupts_holds_nothing_once_it_is_closed(database: Path) -> None:
    """Though its cursor lives on, as in a traceback that a notebook keeps."""
    driver = connected(database, "rw", PATIENCE)
    driver.execute("BEGIN IMMEDIATE")
    driver.execute("CREATE TABLE half (x)")
    cursor = driver.cursor()
    with pytest.raises(KeyboardInterrupt):
        cursor.executemany("INSERT INTO half VALUES (?)", interrupted())
    assert list(database.parent.glob(f"{database.name}-*"))
    driver.close()
    assert not list(database.parent.glob(f"{database.name}-*"))
    with pytest.raises(BadInputError, match="no such table: half"):
        run_sql(database, "SELECT * FROM half", timeout=PATIENCE)
    store(database)


def interrupted() -> Iterator[tuple[int]]:
    """Yield some rows, and then what ctrl-C raises."""
    yield from ((number,) for number in range(9))
    raise KeyboardInterrupt
