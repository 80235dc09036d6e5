"""``affcli invent``: a robot composes behaviors that nobody wrote, and keeps a few (§7.1, §8)."""

from typing import Annotated

import typer

from affcli import lab, registry
from affcli.cli.database import opened
from affcli.cli.learn import Note, begun_runs, learned_runs_of
from affcli.cli.options import (
    AsJson,
    Binding,
    Changes,
    Config,
    Database,
    Repertoire,
    Seed,
    Sensor,
    World,
    check_if_given,
    checked_minutes,
    checked_tool,
    names_of,
)
from affcli.cli.terminal import say, show_either
from affcli.config import load_settings, with_sensor
from affcli.errors import UsageError
from affcli.lab.suggesting import DEFAULT_DATABASE, with_database
from affcli.report.inventing import invented_words, inventions_json, inventions_table
from affcli.report.learning import run_json

OneTool = Annotated[
    str | None,
    typer.Option(
        "--tool",
        help="With which tool.",
        metavar="NAME",
        callback=check_if_given(checked_tool),
        autocompletion=names_of("tools"),
    ),
]
Minutes = Annotated[
    float,
    typer.Option(
        "--minutes",
        help="Robot minutes, for all of it.",
        metavar="M",
        callback=check_if_given(checked_minutes),
    ),
]


def invent(
    *,
    tool: OneTool = None,
    minutes: Minutes = 60.0,
    seed: Seed = 0,
    repertoire: Repertoire = None,
    binding: Binding = None,
    sensor: Sensor = None,
    world: World = None,
    note: Note = None,
    database: Database = DEFAULT_DATABASE,
    config: Config = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> None:
    """Let a robot compose behaviors, and keep the few that bring something new.

    It babbles with what it can do for half of the time and composes turns and straight moves for a
    third. Then it tries again what moved the attractor as nothing else does, and keeps what gives
    the same. All of it is a learning run; the same command goes on after an interruption.
    """
    if tool is None:
        raise UsageError(f"which tool? give --tool {'|'.join(registry.parts('tools'))}")
    settings = with_sensor(load_settings(config, changes or ()), sensor)
    parts = lab.run_parts.RunParts.chosen(
        settings,
        repertoire=lab.inventing.repertoire_of(repertoire, database),
        binding=binding,
        explorer=lab.inventing.explorer(minutes),
        world=world,
    )
    spec = parts.spec(tool, seed, 0, minutes / 60.0)
    with opened(database, create=True, write=True) as store:
        runs, _ = begun_runs(store, [spec], note, all_or_none=True)
        (run,) = learned_runs_of(store, runs, 1)
        inventions = store.inventions.of_run(run.id)
    show_either(
        as_json=as_json,
        results=lambda: [
            {
                **run_json(run),
                "new": runs[0].status != "done",
                "inventions": inventions_json(inventions),
            }
        ],
        tables=lambda: [inventions_table(run, inventions)] if inventions else [],
    )
    say(invented_words(inventions))
    if any(one.kept for one in inventions):
        both = f"--repertoire paper --repertoire invented:run={run.id}"
        using = with_database(f"affcli learn --tool {run.spec.tool} {both}", database)
        say(f"to use them: {using}")
    else:
        say(f"the {run.spec.tool} may need none, or more time: --minutes {2.0 * minutes:g}")
