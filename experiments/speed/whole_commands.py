"""Commands as whole processes: how long they take, and how much memory."""

import os
import re
import sqlite3
import sys
import tempfile
from contextlib import closing
from pathlib import Path
from statistics import median
from typing import Any

from measuring import AFFCLI, ROUNDS, Scale, bar, command, ratios, verdict

IMPORTS = "import numpy, sqlalchemy, pymunk, rich, typer"
MB = 1e6

Rows = dict[str, list[tuple[object, ...]]]


def bench_learn(scale: Scale) -> dict[str, Any]:
    """`--help`, `report` and `learn` as whole processes against importing what they stand on."""
    behaviors = ("--behaviors", "20") if scale.tiny else ()
    wall: dict[str, list[float]] = {}
    memory = 0
    with tempfile.TemporaryDirectory() as folder:
        there = Path(folder) / "there.db"
        learn = (AFFCLI, "learn", "--tool", "t-hook", *behaviors)
        command(*learn, "--seed", "0", "--db", there)
        command(AFFCLI, "solve", "--goal", "2", "--db", there)
        # The first round warms the file cache and the byte code.
        for i in range(1, scale.of(ROUNDS, 1) + 2):
            commands: dict[str, tuple[str | Path, ...]] = {
                "imports": (sys.executable, "-c", IMPORTS),
                "help": (AFFCLI, "--help"),
                "report": (AFFCLI, "report", "--db", there),
                "learned already": (*learn, "--seed", "0", "--db", there),
                "new hour": (*learn, "--seed", str(i), "--db", there),
                "new database": (*learn, "--db", f"{folder}/{i}.db"),
            }
            for name, given in commands.items():
                ended = command(*given)
                wall.setdefault(name, []).append(ended.wall)
                if name == "new database":
                    memory = max(memory, ended.peak)
    times = {name: values[1:] for name, values in wall.items()}
    base = 1000.0 * median(times["imports"])
    found: dict[str, Any] = {"imports_ms": base}
    for name, most in (("help", 250.0), ("report", 600.0)):
        took, against = 1000.0 * median(times[name]), ratios(times[name], times["imports"])
        held = bar(took, most=most)
        words = "affcli --help" if name == "help" else "affcli report on a small database"
        print(
            f"learn: {words}: {took:.0f} ms, {against} of the imports "
            f"({verdict(held, ' ms', least=False)})"
        )
        found[name] = {"ms": took, **held, **against.json()}
    for name, words in (
        ("learned already", "on an existing database that has the run already"),
        ("new hour", "on an existing database, one new robot hour"),
        ("new database", "one robot hour, new database"),
    ):
        against = ratios(times[name], times["imports"])
        held = bar(against.median, most=2.0) if name != "new database" else {"bar": None}
        end = verdict(held, least=False) if held["bar"] else "no bar"
        print(
            f'learn: learn --tool t-hook {words}: {against} of "{IMPORTS}" ({base:.0f} ms; {end})'
        )
        found[name] = {**against.json(), **held}
    held = bar(memory / MB, most=200.0)
    print(f"learn: memory of one hour: {memory / MB:.0f} MB ({verdict(held, ' MB', least=False)})")
    found["memory"] = {"mb": memory / MB, **held}
    return found


def reproduce(robots: int, workers: int, database: Path) -> Any:
    """Run `reproduce` as a whole process."""
    words = ("--robots", str(robots), "--workers", str(workers), "--seed", "1")
    return command(AFFCLI, "reproduce", *words, "--db", database)


def bench_reproduce(scale: Scale) -> dict[str, Any]:
    """Seconds, bytes and memory of `reproduce`, on two workers, for growing numbers of robots."""
    counts = (1, 2) if scale.tiny else (10, 40, 200, 1_000) if scale.full else (10, 40)
    figures: dict[int, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for robots in counts:
            database = Path(folder) / f"{robots}.db"
            ended = reproduce(robots, 2, database)
            size = database.stat().st_size / robots
            figures[robots] = {
                "seconds": ended.wall,
                "a_robot": ended.wall / robots,
                "cpu_a_robot": ended.cpu / robots,
                "bytes": size,
                "peak_mb": ended.peak / MB,
            }
            print(
                f"reproduce: {robots} robots on 2 workers ({os.cpu_count()} cores): "
                f"{ended.wall:.0f} s, {ended.wall / robots:.2f} s and {size / MB:.2f} MB a robot; "
                f"memory of the largest process {ended.peak / MB:.0f} MB"
                + (" (bar: 180 s)" if robots == 200 else "")
            )
    few, many = figures[counts[0]], figures[counts[-1]]
    growth = many["cpu_a_robot"] / few["cpu_a_robot"]
    memory = many["peak_mb"] / few["peak_mb"]
    bars = {"time": bar(growth, most=1.2), "memory": bar(memory, most=1.1)}
    print(
        f"reproduce: from {counts[0]} to {counts[-1]} robots: time of the processor a robot "
        f"{growth:.2f}x ({verdict(bars['time'], least=False)}), memory {memory:.2f}x "
        f"({verdict(bars['memory'], least=False)})"
    )
    return {
        "robots": figures,
        "growth": {"ratio": growth, **bars["time"]},
        "memory": {"ratio": memory, **bars["memory"]},
    }


def bench_workers(scale: Scale) -> dict[str, Any]:
    """Two workers against one: how much sooner `reproduce` ends, and whether the rows are equal."""
    robots = scale.of(12, 2, 40)
    one, two, equal = [], [], True
    with tempfile.TemporaryDirectory() as folder:
        for i in range(scale.of(2, 1, 4)):
            first, second = Path(folder) / f"{i}.1.db", Path(folder) / f"{i}.2.db"
            one.append(reproduce(robots, 1, first).wall)
            two.append(reproduce(robots, 2, second).wall)
            equal &= rows_of(first) == rows_of(second)
    against = ratios(one, two)
    held = bar(against.median, least=1.7)
    print(
        f"workers: two end {against} as soon as one ({robots} robots, {os.cpu_count()} cores, rows "
        f"{'identical' if equal else 'NOT IDENTICAL'}; {verdict(held)})"
    )
    return {**against.json(), **held, "identical": equal}


def rows_of(database: Path) -> Rows:
    """Return every row of every table, in order, without when it was written."""
    rows: Rows = {}
    with closing(sqlite3.connect(database)) as connection:
        tables = connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
        for (table,) in tables.fetchall():
            if not re.fullmatch(r"\w+", table):
                raise ValueError(f"a table named {table}")
            columns = [row[1] for row in connection.execute(f'PRAGMA table_info("{table}")')]
            kept = [f'"{name}"' for name in columns if not name.endswith("_at")]
            wanted = f'SELECT {", ".join(kept)} FROM "{table}"'  # noqa: S608
            rows[table] = sorted(connection.execute(wanted).fetchall(), key=repr)
    return rows
