"""``affcli reproduce``: the whole paper on many robots (§7)."""

import os
from typing import Annotated

import typer

from affcli.cli.options import (
    DEFAULT_DATABASE,
    MOST_ROBOTS,
    MOST_WORKERS,
    AsJson,
    Config,
    Database,
    Seed,
    Sensor,
    checked_count,
    checked_seed,
    checked_sensor,
)
from affcli.cli.terminal import now, progress, say, show, show_json


def reproduce(
    *,
    robots: Annotated[int, typer.Option("--robots", help="How many robots.", metavar="N")] = 20,
    seed: Seed = 0,
    sensor: Sensor = None,
    workers: Annotated[
        int | None,
        typer.Option("--workers", help="Processes; one a core if not given.", metavar="N"),
    ] = None,
    database: Database = DEFAULT_DATABASE,
    config: Config = None,
    as_json: AsJson = False,
) -> None:
    """Let many robots learn the five tools and do the paper's 80 + 16 trials; compare.

    The result is the same for any number of workers. An interrupted reproduction goes on when the
    same command is given again.
    """
    checked_count("--robots", robots, MOST_ROBOTS)
    checked_seed(seed)
    kind = checked_sensor(sensor)
    if workers is None:
        workers = min(len(os.sched_getaffinity(0)), MOST_WORKERS) if _has_affinity() else 1
    checked_count("--workers", workers, MOST_WORKERS)

    from affcli.config import load_settings, with_sensor
    from affcli.lab.overview import reproduction_of
    from affcli.lab.reproduction import reproduce as run_reproduction
    from affcli.lab.sensing import require_sensor
    from affcli.report.reproduction import reproduction_json, reproduction_tables
    from affcli.store import open_store

    settings = with_sensor(load_settings(config), kind)
    require_sensor(settings)
    with open_store(database, create=True, write=True) as store:
        events = run_reproduction(store, settings, robots, seed, workers, now)
        session = next(events)
        with progress("reproducing", robots) as bar:
            for saved in events:
                bar.update(saved, f"{saved} of {robots} robots")
        result = reproduction_of(store, session, robots)
    say(f"session {session}: {robots} robots, seed {seed}, saved in {database}")
    if as_json:
        show_json(reproduction_json(result))
    else:
        show(*reproduction_tables(result))


def _has_affinity() -> bool:
    """Tell whether the system says which cores this process may use."""
    return hasattr(os, "sched_getaffinity")
