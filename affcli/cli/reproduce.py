"""``affcli reproduce``: the whole paper on many robots (§7)."""

from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened, say_failed
from affcli.cli.options import (
    DEFAULT_PLANNER,
    AsJson,
    Binding,
    Changes,
    Config,
    Database,
    Explorer,
    Planner,
    Repertoire,
    Resume,
    Scheduler,
    Seed,
    Sensor,
    Workers,
    World,
    check_count,
    checked_pool,
)
from affcli.cli.terminal import progress, say, show_either
from affcli.config import load_settings, with_sensor
from affcli.core.limits import MOST_ROBOTS
from affcli.errors import UsageError
from affcli.lab.clock import now
from affcli.lab.suggesting import DEFAULT_DATABASE
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
            parser=check_count("--robots", MOST_ROBOTS),
        ),
    ] = None,
    seed: Seed = 0,
    repertoire: Repertoire = None,
    binding: Binding = None,
    explorer: Explorer = None,
    planner: Planner = DEFAULT_PLANNER,  # type: ignore[assignment]  # parsed like any other
    sensor: Sensor = None,
    world: World = None,
    resume: Resume = False,
    workers: Workers = None,
    scheduler: Scheduler = None,
    database: Database = DEFAULT_DATABASE,
    config: Config = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> int:
    """Reproduce the paper with many robots: five tools, 80 + 16 trials each.

    The result is the same for any number of workers. An interrupted reproduction goes on when the
    same command is given again, as does the latest one with --resume alone.
    """
    given = (robots, seed, sensor, config, changes, repertoire, binding, explorer, world)
    own = any(given) or str(planner) != DEFAULT_PLANNER
    if robots is None:
        robots = FEW_ROBOTS
    pool = checked_pool(workers, scheduler)
    settings = with_sensor(load_settings(config, changes or ()), sensor)
    chosen = lab.run_parts.RunParts.chosen(
        settings,
        repertoire=lab.inventing.repertoire_of(repertoire, database),
        binding=binding,
        explorer=explorer,
        world=world,
    )
    lab.believing.require_believable(planner, chosen)
    what = lab.reproduction.Reproduced(chosen, planner, seed)
    with opened(database, create=own or not resume, write=True) as store:
        if resume and not own:
            begun = [s for s in store.sessions.all("reproduce") if s.status == "running"]
            if not begun:
                raise UsageError(
                    f"nothing to resume in {database}; begin one: affcli reproduce --robots 20"
                )
            what, robots = lab.reproduction.reproduced_again(begun[-1].spec), begun[-1].spec.robots
        events = lab.reproduction.reproduce(store, what, robots, pool, now, say)
        session = next(events)
        with progress("reproducing", robots, "robots") as bar:
            for saved in events:
                bar(saved, "")
        result = lab.overview.reproduction_of(store, session)
    of_all = f"{robots}" if result.robots == robots else f"{result.robots} of {robots}"
    say(f"session {session}: {of_all} robots, seed {what.seed}, saved in {database}")
    show_either(
        as_json=as_json,
        results=lambda: [reproduction_json(result)],
        tables=lambda: reproduction_tables(result),
    )
    return say_failed(result.failed)
