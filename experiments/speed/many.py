"""Many robots: in a cluster or by processes, in how much memory, for one process that writes."""

import pickle
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

from measuring import AFFCLI, Scale, bar, command, ratios, verdict

from affcli.core.specs import Keep
from affcli.lab.conducting import begin
from affcli.lab.definition import experiment_of
from affcli.lab.experiment import one_robot
from affcli.store import open_store, pack_robot

NOW = "2026-01-01T00:00:00+00:00"
VERSIONS: dict[str, str] = {}
SHORT = 'name = "short"\ntasks = ["extension-of-reach"]\n[base]\nminutes = 1\ntools = ["t-hook"]\n'
"""Robots that live a minute, and try each task for a step: some 0.05 s of a core each."""


def bench_cluster(scale: Scale) -> dict[str, Any]:
    """A LocalCluster of two workers against two workers, its start not counted."""
    from distributed import LocalCluster  # noqa: PLC0415  # an extra

    robots, minutes = scale.of(12, 2, 48), scale.of(60, 1)
    clustered, alone = [], []
    with (
        tempfile.TemporaryDirectory() as folder,
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
    ):
        file = Path(folder) / "paper.toml"
        file.write_text(
            f'[experiment]\nname = "paper"\nrobots = {robots}\n[base]\nminutes = {minutes}\n'
        )
        pools = (
            (clustered, ("--scheduler", cluster.scheduler_address)),
            (alone, ("--workers", "2")),
        )
        # The first round of each imports what workers need, and is not counted.
        for number in range(1 + scale.of(5, 1)):
            for name, (seconds, pool) in enumerate(pools):
                target = Path(folder) / f"{number}_{name}.db"
                went = command(AFFCLI, "experiment", file, *pool, "--db", target)
                seconds.extend([went.wall] if number else [])
    found = ratios(clustered, alone)
    held = bar(found.median, most=1.15)
    print(
        f"cluster: {robots} robots on a LocalCluster of two workers take {found} the time of "
        f"--workers 2 ({verdict(held, least=False)})"
    )
    return {"robots": robots, **found.json(), **held}


def bench_memory(scale: Scale) -> dict[str, Any]:
    """The largest process of an experiment, by how many robots it has."""
    counts = (2, 4) if scale.tiny else (100, 1_000, 10_000) if scale.full else (100, 1_000)
    peaks: dict[int, int] = {}
    for count in counts:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "short.toml"
            file.write_text(f"[experiment]\nrobots = {count}\n{SHORT}trial.max_steps = 1\n")
            words = ("--keep", "trials", "--workers", "2", "--db", Path(folder) / "short.db")
            peaks[count] = command(AFFCLI, "experiment", file, *words).peak
    growth = peaks[counts[-1]] / peaks[counts[0]]
    held = bar(growth, most=1.1)
    words_of = ", ".join(f"{count:,}: {peak / 1e6:.0f} MB" for count, peak in peaks.items())
    print(
        f"memory: largest process by the number of robots: {words_of}; {growth:.3f}x "
        f"({verdict(held, least=False)})"
    )
    return {"peak_bytes": peaks, "ratio": growth, **held}


def bench_writer(scale: Scale) -> dict[str, Any]:
    """How many cores that make robots one process keeps up with that saves them, by what is kept.

    Making is living and packing; saving is reading what comes through the pipe, and the transaction
    on the disk.
    """
    tables = {"experiment": {"name": "paper", "robots": 100}, "base": {}}
    if scale.tiny:
        tables["base"] = {"minutes": 1, "tools": ["t-hook"]}
    what = experiment_of(tables, "the benchmark")
    made: list[float] = []
    saved: dict[Keep, list[float]] = {keep: [] for keep in Keep}
    sizes: dict[Keep, float] = {}
    robots = scale.of(4, 1)
    lives = []
    for robot in range(robots):
        began = time.perf_counter()
        lives.append(one_robot(what, robot))
        made.append(time.perf_counter() - began)
    for keep in Keep:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "robots.db"
            with open_store(path, create=True, write=True) as store:
                sessions = [number for _, number in begin(store, what, lambda: NOW).conditions]
                empty = path.stat().st_size
                for life in lives:
                    sent = pickle.dumps(pack_robot(life, keep))
                    began = time.perf_counter()
                    packed = pickle.loads(sent)  # noqa: S301  # our own
                    store.sessions.save_robot(dict.fromkeys(sessions, VERSIONS), packed, NOW)
                    saved[keep].append(time.perf_counter() - began)
            sizes[keep] = (path.stat().st_size - empty) / robots
    cores = {keep: median(made) / median(seconds) for keep, seconds in saved.items()}
    words = "; ".join(
        f"--keep {keep}: {cores[keep]:.0f} cores, 100,000 robots are {sizes[keep] / 1e4:.3g} GB"
        for keep in Keep
    )
    print(f"writer: one process saves as fast as so many cores make the paper's robots: {words}")
    return {
        "cores": {keep.value: value for keep, value in cores.items()},
        "bytes_a_robot": {keep.value: size for keep, size in sizes.items()},
    }
