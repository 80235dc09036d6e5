"""``affcli import``: the log of another robot becomes learning runs, one for each tool."""

from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.options import AsJson, Database, check_if_given, checked_note
from affcli.cli.terminal import say, show_either
from affcli.errors import one_line
from affcli.lab.clock import now
from affcli.lab.suggesting import DEFAULT_DATABASE, with_database
from affcli.logs.reading import Log
from affcli.report.importing import import_json, import_table, log_words
from affcli.report.words import many

MOST_NAMED = 5
"""So many lines that could not be read are named."""


def import_log(
    files: Annotated[
        list[str],
        typer.Argument(help="Files, or patterns in quotes: 'data/**/*.txt'.", metavar="LOG..."),
    ],
    *,
    how: Annotated[
        Path,
        typer.Option(
            "--map",
            help="What stands where in them, and in which units.",
            metavar="MAP.toml",
            readable=False,
        ),
    ],
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Say what it would give; write nothing.")
    ] = False,
    strict: Annotated[
        bool, typer.Option("--strict", help="Refuse the log if a line of it cannot be read.")
    ] = False,
    note: Annotated[
        str | None,
        typer.Option(
            "--note",
            help="What you want to remember of it.",
            metavar="TEXT",
            callback=check_if_given(checked_note),
        ),
    ] = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Import the log of a real robot: what it did with tools, and what moved.

    Each tool becomes a learning run. What the log lacks stays unknown. The same files by the same
    map again say that they are there.
    """
    log, runs = lab.importing.read(files, how)
    if strict:
        log.require_whole()
    done: list[lab.importing.Imported] = []
    if not dry_run:
        with opened(database, create=True, write=True) as store:
            done = lab.importing.import_runs(store, runs, now, note)
    _say_read(log)
    infos = {one.info.spec.tool: one.info for one in done}
    found = [(run, infos.get(run.spec.tool)) for run in runs]
    new = {one.info.id for one in done if one.new}
    show_either(
        as_json=as_json,
        results=lambda: [
            {**import_json(run, info, log), "new": info is not None and info.id in new}
            for run, info in found
        ],
        tables=lambda: [import_table(found)],
    )
    if dry_run:
        say("nothing was written (--dry-run)")
    elif not new:
        say("imported before, nothing to do")
    else:
        say(f"which tool pulls? {with_database('affcli which nearer', database)}")


def _say_read(log: Log) -> None:
    """Say what was read, and which lines could not be."""
    say(log_words(log))
    for line in log.bad[:MOST_NAMED]:
        say(f"left out: {one_line(line)}")
    more = log.left_out - MOST_NAMED
    if more > 0:
        say(f"left out: {many(more, 'line')} more")
