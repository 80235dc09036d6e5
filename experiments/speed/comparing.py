"""Comparing conditions of many robots: `affcli compare` as a whole process."""

import sqlite3
import tempfile
from contextlib import closing
from pathlib import Path
from statistics import median
from typing import Any

from measuring import AFFCLI, Scale, bar, command, verdict

CONDITIONS = 5
SHORT = ("--set", "motion.hold=100", "--set", "trial.max_steps=2")
"""An hour of some twenty behaviors, and trials of two steps: a template of rows is wanted."""
SOLVED = 87
"""Of 100 trials; each condition two more than the one before."""


def bench_compare(scale: Scale) -> dict[str, Any]:
    """`affcli compare` on many robots in five conditions, made of one robot's rows."""
    robots = scale.of(1000, 5)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "many.db"
        one = ("--robots", "1", "--workers", "1", *SHORT)
        command(AFFCLI, "reproduce", *one, "--db", path)
        trials = multiply(path, robots)
        sessions = [word for n in range(1, CONDITIONS + 1) for word in ("--session", str(n))]
        rounds = [command(AFFCLI, "compare", *sessions, "--db", path) for _ in range(3)]
    seconds, cpu = (median(getattr(one, what) for one in rounds) for what in ("wall", "cpu"))
    held = bar(seconds, most=2.0)
    print(
        f"compare: {robots} robots x {CONDITIONS} conditions, {trials:,} trials: {seconds:.2f} s "
        f"({cpu:.2f} s of the processor); {verdict(held, ' s', least=False)}"
    )
    return {"robots": robots, "trials": trials, "s": seconds, "cpu_s": cpu, **held}


def multiply(path: Path, robots: int) -> int:
    """Let the one robot of a database stand for many in five conditions; return their trials.

    Which trials are solved is drawn anew for each, by arithmetic: the same rows each time.
    """
    with closing(sqlite3.connect(path)) as database, database:
        for condition in range(2, CONDITIONS + 1):
            copied(database, "session", {"id": condition, "key": f"'{condition}'"}, "id = 1")
        numbers = (
            f"WITH RECURSIVE r(robot) AS ({counting('robot', 'r', 0, robots - 1)}), "
            f"c(condition) AS ({counting('condition', 'c', 1, CONDITIONS)})"
        )
        draw = "(old.id * 7919 + r.robot * 104729 + old.id * r.robot * 31) % 1000"
        solved = f"{draw} < 10 * ({SOLVED} + 2 * c.condition)"
        first = "NOT (r.robot = 0 AND c.condition = 1)"
        changes = {"id": "NULL", "session_id": "c.condition", "robot": "r.robot"}
        keyed = {"key": "old.key || '-' || c.condition || '-' || r.robot"}
        copied(database, "learning_run", changes | keyed, first, ", r, c", numbers)
        ended = {
            "outcome": f"CASE WHEN {solved} THEN 'solved' ELSE 'step limit' END",
            "steps": "2",
            "last_reasons": "NULL",
        }
        copied(database, "trial", changes | ended, first, ", r, c", numbers)
        ((trials,),) = database.execute("SELECT count(*) FROM trial").fetchall()
    return int(trials)


def counting(name: str, table: str, first: int, last: int) -> str:
    """Return the query whose rows are the numbers from the first to the last."""
    more = f"SELECT {name} + 1 FROM {table} WHERE {name} < {last}"  # noqa: S608 no word of a user's
    return f"SELECT {first} UNION ALL {more}"


def copied(
    database: sqlite3.Connection,
    table: str,
    changes: dict[str, Any],
    where: str,
    beside: str = "",
    numbers: str = "",
) -> None:
    """Copy rows of a table with other values in some of their columns."""
    columns = [name for _, name, *_ in database.execute(f"PRAGMA table_info({table})")]
    values = ", ".join(str(changes.get(name, f"old.{name}")) for name in columns)
    chosen = f"SELECT {values} FROM {table} AS old{beside} WHERE {where}"  # noqa: S608
    into = f"INSERT INTO {table} ({', '.join(columns)})"
    database.execute(f"{numbers} {into} {chosen}")
