"""Learning end to end with the store, and storing alone: rows a second."""

import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any

from measuring import ROUNDS, Scale, Took, bar, took, verdict

from affcli.config import Settings
from affcli.core.specs import LearningSpec, LearningStep
from affcli.lab.learning import CHUNK, learn
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import Store, open_store

PARTS = RunParts.chosen(Settings())
NOW = "2026-01-01T00:00:00+00:00"


def bench_hours(scale: Scale) -> dict[str, Any]:
    """Robot hours a wall second of learning, with the store, on one core."""
    hours, behaviors = (None, 20) if scale.tiny else (1.0, None)
    times: list[Took] = []
    lived, done, touches = 0.0, 0, 0
    by_tool: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(scale.of(4, 1, 20)):
            path = Path(folder) / f"{seed}.db"
            with open_store(path, create=True, write=True) as store:
                for tool in TOOL_PARTS:
                    spec = PARTS.spec(tool, seed, 0, hours, behaviors)
                    times.append(took(learn, store, spec, lambda: NOW)[0])
                    by_tool[tool] = by_tool.get(tool, 0.0) + times[-1].wall
                lived += sum(run.robot_seconds for run in store.learning.runs()) / 3600.0
                done += sum(run.behaviors for run in store.learning.runs())
                touches += touched(store)
    wall, cpu = sum(t.wall for t in times), sum(t.cpu for t in times)
    held = bar(lived / wall, least=10.0)
    share = touches / done
    print(
        f"hours: {lived / wall:.1f} robot hours a wall second of learning with the store "
        f"({lived / cpu:.1f} a second of the processor; {done} behaviors of the five tools, "
        f"{100 * share:.1f} % touch, {1e6 * wall / done:.0f} us each; {verdict(held, '')})"
    )
    return {
        "hours_a_second": lived / wall,
        "hours_a_cpu_second": lived / cpu,
        "touch_share": share,
        "seconds_by_tool": by_tool,
        **held,
    }


def touched(store: Store) -> int:
    """Return how many behaviors truly moved the attractor."""
    # By the driver: no call of the store counts them.
    moved = "true_start_x <> true_end_x OR true_start_y <> true_end_y"
    with store.database.reading() as connection:
        rows = connection.exec_driver_sql(f"SELECT count(*) FROM behavior WHERE {moved}")  # noqa: S608
        return int(rows.scalar_one())


def bench_storing(scale: Scale) -> dict[str, Any]:
    """Rows a second by the call that `learn` saves a chunk with, mapping and commit included."""
    spec = PARTS.spec("t-hook", 0, 0, None, scale.of(5_000, 20))
    steps = list(LearningRun(spec).steps())
    made = sum(record.affordance is not None for record, _ in steps)
    rates: dict[str, list[float]] = {"bulk": [], "chunks": []}
    with (
        tempfile.TemporaryDirectory() as folder,
        open_store(Path(folder) / "rows.db", create=True, write=True) as store,
    ):
        for i in range(scale.of(ROUNDS, 1)):
            for j, (name, size) in enumerate((("bulk", len(steps)), ("chunks", CHUNK))):
                seconds = store_all(store, replace(spec, seed=2 * i + j), steps, size)
                rates[name].append((len(steps) + made) / seconds)
    rate, chunked = median(rates["bulk"]), median(rates["chunks"])
    held = bar(rate, least=50_000.0)
    print(
        f"storing: {rate:,.0f} rows/s in bulk [{min(rates['bulk']):,.0f} to "
        f"{max(rates['bulk']):,.0f}] ({len(steps)} behaviors and {made} rows of the table in one "
        f"transaction; {verdict(held, '/s')}); in chunks of {CHUNK}, each on the disk before the "
        f"next: {chunked:,.0f} rows/s"
    )
    return {"rows_a_second": rate, "in_chunks": chunked, **held}


def store_all(store: Store, spec: LearningSpec, steps: Sequence[LearningStep], size: int) -> float:
    """Store a run, `size` behaviors at a time; return the seconds it took."""
    info = store.learning.begin(spec, {}, NOW)
    start = time.perf_counter()
    for at in range(0, len(steps), size):
        store.learning.append(
            info.id,
            at,
            steps[at : at + size],
            None,
            robot_seconds=0.0,
            done=at + size >= len(steps),
            now=NOW,
        )
    return time.perf_counter() - start


def bench_growth(scale: Scale) -> dict[str, Any]:
    """Time a behavior from a thousand behaviors on; a million with --full."""
    counts: tuple[int, ...] = (20, 40) if scale.tiny else (1_000, 10_000, 100_000)
    counts += (1_000_000,) if scale.full and not scale.tiny else ()
    each: dict[int, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        for count in counts:
            # The few as often as it takes to be as exact.
            repeats = max(1, 10_000 // count) if not scale.tiny else 1
            path = Path(folder) / f"{count}.db"
            cpu = 0.0
            with open_store(path, create=True, write=True) as store:
                for seed in range(repeats):
                    spec = PARTS.spec("t-hook", seed, 0, None, count)
                    cpu += took(learn, store, spec, lambda: NOW)[0].cpu
            each[count] = 1e6 * cpu / (repeats * count)
    growth = each[counts[-1]] / each[counts[0]]
    held = bar(growth, most=1.2)
    words = ", ".join(f"{count:,}: {us:.0f} us" for count, us in each.items())
    print(
        f"growth: time of the processor a behavior, by the length of the run: {words}; "
        f"{growth:.2f}x ({verdict(held, least=False)})"
    )
    return {"us_a_behavior": each, "ratio": growth, **held}
