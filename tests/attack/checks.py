"""What must hold of a database and of a command, whatever was done to them."""

import re
import sqlite3
from collections import Counter
from contextlib import closing
from pathlib import Path

from tests.attack.attacks import Attack
from tests.cli.forked import Finished
from tests.fuzz.running import check_ending

SAVED = (
    (re.compile(r"trials? (\d+)(?: to (\d+))? saved"), "SELECT id FROM trial"),
    (re.compile(r"learned \S+ \(run (\d+), seed"), "SELECT id FROM learning_run"),
    (re.compile(r"session (\d+): \d+ robots, .* saved"), "SELECT id FROM session"),
)
"""What is said of saved work, and what must be there then."""
CHANGING = {
    "affordance": {"times_used", "times_successful"},
    "learning_run": {
        *("status", "checkpoint", "finished_at", "behaviors", "rows", "resets", "redraws"),
        *("robot_seconds", "calibration", "note"),
    },
    "session": {"status", "finished_at"},
    "experiment": {"status", "finished_at"},
}
"""Columns that change after a record is saved; all the others stay for ever."""
FAILED = "failed_robot"
TRIED_ROBOTS = f"SELECT session_id, robot FROM {FAILED} UNION SELECT session_id, robot FROM trial"
"""A robot that failed is tried again: the note of it stays until the robot has lived."""
TRIED = "SELECT affordance_id, replicated FROM"
STORED = "(SELECT id FROM trial WHERE counters = 'stored')"
USES = (f"{TRIED} replication", f"{TRIED} step WHERE trial_id IN {STORED}")
"""Each use of a row that its counters count."""
PARTS = (("trial", "steps", "step"), ("learning_run", "behaviors", "behavior"))
"""A record, the column that says how many parts it has, and where these are."""
Contents = dict[str, set[tuple[object, ...]]]
ENDED_BY_HAND = {"SIGINT": {130, -2}, "SIGTERM": {143, -15}, "kill": {-9}, "kill at a call": {-9}}
"""How a command may end beside as it pleases; the second: by a signal that came before it began to
listen."""
LASTING = frozenset({"lock", "neighbour", "clock"})
"""What must not make a difference to a command."""


def check_end(attack: Attack, ended: Finished) -> None:
    """Check how a command ended that was attacked."""
    assert "Traceback" not in ended.err, ended.err
    assert "Traceback" not in ended.out.decode(errors="replace"), ended.out
    assert not ended.stopped, "it hangs"
    if ended.code in ENDED_BY_HAND.get(attack.fault, set()):
        lines = ended.err.splitlines()
        assert ended.code < 0 or lines[-1].startswith("affcli: stopped; "), ended
        return
    check_ending(attack.command, ended)
    if attack.fault in LASTING:
        assert ended.code != 3, ended


def contents(database: Path) -> Contents:
    """Return all records of a database, without what may change later."""
    held: Contents = {}
    with closing(sqlite3.connect(database)) as driver:
        wanted = "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%'"
        tables = driver.execute(wanted).fetchall()
        for (table,) in tables:
            about = driver.execute(f"PRAGMA table_info({table})").fetchall()
            kept = [name for _, name, *_ in about if name not in CHANGING.get(table, ())]
            query = TRIED_ROBOTS if table == FAILED else f"SELECT {', '.join(kept)} FROM {table}"
            held[table] = set(driver.execute(query))
    return held


def check_kept(before: Contents, after: Contents) -> None:
    """Check that no record is lost or altered."""
    for table, records in before.items():
        lost = records - after[table]
        assert not lost, (table, sorted(lost, key=repr)[:3])


def check_said(ended: Finished, database: Path) -> None:
    """Check that what a command said to be saved is there."""
    with closing(sqlite3.connect(database)) as driver:
        for words, query in SAVED:
            for first, *last in (found.groups() for found in words.finditer(ended.err)):
                there = {number for (number,) in driver.execute(query)}
                named = range(int(first), int((last and last[0]) or first) + 1)
                assert there.issuperset(named), (ended.err, sorted(there)[-3:])


def check_sound(database: Path) -> None:
    """Check pages, references, sums, and that the counters are what steps and tries made of them.

    §3.2: both counters of a row are 1 when it is made. Those of a log are what its repeats say, and
    no robot uses its rows.
    """
    used: Counter[int] = Counter()
    successful: Counter[int] = Counter()
    with closing(sqlite3.connect(database)) as driver:
        assert driver.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert driver.execute("PRAGMA foreign_key_check").fetchall() == []
        for query in USES:
            for row, replicated in driver.execute(query):
                used[row] += 1
                successful[row] += replicated
        for row, *counters in driver.execute(
            "SELECT id, times_used, times_successful FROM affordance"
            " WHERE learning_run_id NOT IN (SELECT learning_run_id FROM log)"
        ):
            assert counters == [1 + used[row], 1 + successful[row]], f"affordance {row}"
        for table, said, parts in PARTS:
            there = f"(SELECT count(*) FROM {parts} WHERE {table}_id = {table}.id)"
            wrong = f"SELECT id FROM {table} WHERE {said} <> {there}"
            assert driver.execute(wrong).fetchall() == [], wrong
