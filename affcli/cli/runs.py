"""``affcli runs``: what robots learned, run by run, with notes; and what is not wanted any more."""

from typing import Annotated

import typer

from affcli import lab, registry
from affcli.cli.database import opened
from affcli.cli.options import AsJson, Database, check_count, checked_note
from affcli.cli.table_choice import Tool
from affcli.cli.terminal import asked, interactive, say, show_either
from affcli.core.names import one_of
from affcli.core.specs import EXPERIMENT, REPRODUCE, Keep
from affcli.errors import UsageError, one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.learning import summary
from affcli.report.runs import (
    belongings_words,
    kept_json,
    run_in_full_json,
    run_tables,
    runs_table,
)

MANY = {REPRODUCE: "reproductions", EXPERIMENT: "experiments"}
"""Of what robots' runs are, by the kind of their session."""
RunId = Annotated[
    int, typer.Argument(help="Its id in the database.", metavar="ID", parser=check_count("run"))
]


def list_runs(
    *,
    tool: Tool = None,
    all_runs: Annotated[
        bool, typer.Option("--all-runs", help="The robots of reproductions and experiments too.")
    ] = False,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """List the learning runs, with their notes.

    Each with what it is of, how far it came, what in it differs from the defaults, and how many
    trials used it.
    """
    with opened(database) as store:
        every = lab.table.every_run(store)
        uses = store.runs.uses()
        kinds = {session.id: session.spec.kind for session in store.sessions.all()}
    if tool is not None:
        one_of(
            "tool", tool, dict.fromkeys([*registry.parts("tools"), *(r.spec.tool for r in every)])
        )
    shown = [run for run in every if tool in (None, run.spec.tool)]
    runs = [run for run in shown if all_runs or run.session_id is None]
    if runs or as_json:
        show_either(
            as_json=as_json,
            results=lambda: [kept_json(run, uses) for run in runs],
            tables=lambda: [runs_table(runs, uses)],
        )
    if not runs:
        say("no runs")
    if len(shown) > len(runs):
        hidden = [kinds[run.session_id] for run in shown if run.session_id is not None]
        many = " and ".join(MANY[kind] for kind in MANY if kind in hidden)
        say(f"and {len(hidden)} of robots of {many}: --all-runs")


def show_run(
    run_id: RunId, *, database: Database = DEFAULT_DATABASE, as_json: AsJson = False
) -> None:
    """Show one learning run in full, also one of which not all was kept."""
    with opened(database) as store:
        run = store.learning.run(run_id)
        groups = store.results.behavior_groups(run_id) if run.kept is Keep.ALL else None
        belongings, log = store.runs.belongings(run_id), store.logs.source(run_id)
        inventions = store.inventions.of_run(run_id)
        lent = lab.transferring.borrowed_of(store, run_id)
        found = run, belongings, groups, log, inventions, *lent
    if groups is None:
        say(f"its behaviors were not kept (--keep {run.kept})")
    show_either(
        as_json=as_json,
        results=lambda: [run_in_full_json(*found)],
        tables=lambda: run_tables(*found),
    )


def note_run(
    run_id: RunId,
    text: Annotated[
        str,
        typer.Argument(help="The note; '' takes it away.", metavar="TEXT", callback=checked_note),
    ],
    *,
    database: Database = DEFAULT_DATABASE,
) -> None:
    """Write a note on a learning run, in place of the one it has.

    A note changes nothing of what the run is.
    """
    with opened(database, write=True) as store:
        store.runs.note(run_id, text)
    say(f"run {run_id}: {one_line(text) or 'no note any more'}")


def delete_run(
    run_id: RunId,
    *,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    database: Database = DEFAULT_DATABASE,
) -> None:
    """Delete a learning run and all that belongs to it.

    That is what it did and learned, and the trials and verifications that used its table. It says
    how much that is, and asks. What other runs learned and did stays, and is replayed equal.
    """
    with opened(database, write=True) as store:
        run = store.learning.run(run_id)
        what = f"run {run_id} of the {run.spec.tool}"
        if not yes:
            known = belongings_words(store.runs.belongings(run_id))
            if not interactive():
                raise UsageError(f"{what} goes with {known}; to delete it, give --yes")
            say(f"{what}: {summary(run)}" + (f"; {one_line(run.note)}" if run.note else ""))
            if asked(f"Delete it, with {known}? y: yes > ") not in ("y", "Y", "yes"):
                say("nothing was deleted")
                return
        deleted = store.runs.delete(run_id)
    say(f"deleted {what}, with {belongings_words(deleted)}")
