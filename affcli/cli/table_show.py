"""``affcli table show``: one row of an affordance table in full, with all that was tried of it."""

from typing import Annotated

import typer

from affcli.cli.options import DEFAULT_DATABASE, LARGEST_ID, AsJson, Database, checked_count
from affcli.cli.terminal import show, show_json


def show_row(
    row_id: Annotated[int, typer.Argument(help="Its id in the database.", metavar="ID")],
    *,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Show one row in full.

    What was done and seen, what is expected of it, its counters, where it comes from, and every
    step of a trial and try of a verification that used it.
    """
    checked_count("row", row_id, LARGEST_ID)

    from affcli.lab.table import history_of, region_of, tool_of
    from affcli.report.rows import row_json, row_tables
    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        stored = store.affordance(row_id)
        run = store.learning_run(stored.run_id)
        history = history_of(store, row_id)
        tries = store.row_tries(row_id)
    region = region_of(tool_of(run), stored)
    if as_json:
        show_json(row_json(stored, region, run, history, tries))
    else:
        show(*row_tables(stored, region, run, history, tries))
