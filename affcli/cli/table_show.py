"""``affcli table show``: one row of an affordance table in full, with all that was tried of it."""

from typing import Annotated

import typer

from affcli import lab
from affcli.analysis.regions import region_of
from affcli.cli.database import opened
from affcli.cli.options import AsJson, Database, check_count
from affcli.cli.terminal import show_either
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.rows import row_json, row_tables


def show_row(
    row_id: Annotated[
        int,
        typer.Argument(help="Its id in the database.", metavar="ID", parser=check_count("row")),
    ],
    *,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Show one row in full.

    What was done and seen, what is expected of it, its counters, where it comes from, and every
    step of a trial and try of a verification that used it.
    """
    with opened(database) as store:
        stored = store.learning.row(row_id)
        run = store.learning.run(stored.run_id)
        history = lab.table.history_of(store, row_id)
        tries = store.verifications.of_row(row_id)
        line = store.logs.line(run.id, stored.row.step)
        borrowed = lab.transferring.whence(store, stored)
    region = region_of(run.spec.held, stored.row)
    found = (stored, region, run, history, tries, line, borrowed)
    show_either(
        as_json=as_json,
        results=lambda: [row_json(*found)],
        tables=lambda: row_tables(*found),
    )
