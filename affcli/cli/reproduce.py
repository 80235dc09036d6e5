"""``affcli reproduce``: the whole paper on many robots (§7)."""

import os
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.options import (
    DEFAULT_DATABASE,
    MOST_WORKERS,
    AsJson,
    Config,
    Database,
    Resume,
    Seed,
    Sensor,
    check_count,
)
from affcli.cli.terminal import now, progress, say, show_either
from affcli.config import load_settings, settings_from_json, with_sensor
from affcli.core.trial import MOST_ROBOTS
from affcli.report.reproduction import reproduction_json, reproduction_tables

FEW_ROBOTS = 20


def reproduce(
    *,
    robots: Annotated[
        int | None,
        typer.Option(
            "--robots",
            help="How many robots; 20 if not given.",
            metavar="N",
            callback=check_count("--robots", MOST_ROBOTS),
        ),
    ] = None,
    seed: Seed = 0,
    sensor: Sensor = None,
    resume: Resume = False,
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers",
            help="Processes; one a core if not given.",
            metavar="N",
            callback=check_count("--workers", MOST_WORKERS),
        ),
    ] = None,
    database: Database = DEFAULT_DATABASE,
    config: Config = None,
    as_json: AsJson = False,
) -> None:
    """Let many robots learn the five tools and do the paper's 80 + 16 trials; compare.

    The result is the same for any number of workers. An interrupted reproduction goes on when the
    same command is given again, as does the latest one with --resume alone.
    """
    own = (robots, seed, sensor, config) != (None, 0, None, None)
    if robots is None:
        robots = FEW_ROBOTS
    if workers is None:
        workers = min(len(os.sched_getaffinity(0)), MOST_WORKERS) if _has_affinity() else 1

    settings = with_sensor(load_settings(config), sensor)
    lab.sensing.require_sensor(settings)
    with opened(database, create=True, write=True) as store:
        if resume and not own:
            begun = [s for s in store.sessions("reproduce") if s.status == "running"]
            if begun:
                settings = settings_from_json(begun[-1].settings)
                robots, seed = begun[-1].robots, begun[-1].seed
                lab.sensing.require_sensor(settings)
        events = lab.reproduction.reproduce(store, settings, robots, seed, workers, now)
        session = next(events)
        with progress("reproducing", robots) as bar:
            for saved in events:
                bar.update(saved, f"{saved} of {robots} robots")
        result = lab.overview.reproduction_of(store, session, robots)
    say(f"session {session}: {robots} robots, seed {seed}, saved in {database}")
    show_either(
        as_json=as_json,
        value=lambda: reproduction_json(result),
        tables=lambda: reproduction_tables(result),
    )


def _has_affinity() -> bool:
    """Tell whether the system says which cores this process may use."""
    return hasattr(os, "sched_getaffinity")
