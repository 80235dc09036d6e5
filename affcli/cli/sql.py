"""``affcli sql``: ask the database in plain SQL, read-only for certain."""

from typing import Annotated, Any

import typer

from affcli.cli.options import DEFAULT_DATABASE, AsJson, Database
from affcli.cli.terminal import say, show, show_json
from affcli.errors import one_line


def sql(
    query: Annotated[str, typer.Argument(help="One select statement.", metavar="QUERY")],
    *,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Ask the database one question in SQL.

    Tables: affordance, behavior, learning_run, session, trial, step; views: affordance_table,
    affordance_wide. Nothing can be written.
    """
    from affcli.store import run_sql

    result = run_sql(database, query)
    columns, rows = result.columns, result.rows
    if as_json:
        show_json([dict(zip(columns, map(_plain, row), strict=True)) for row in rows])
    else:
        from rich.table import Table

        table = Table()
        for column in columns:
            table.add_column(one_line(column), overflow="fold")
        for row in rows:
            table.add_row(*("" if value is None else one_line(_plain(value)) for value in row))
        show(table)
    if result.truncated:
        say(f"only the first {len(rows)} rows are shown; add a limit or a where")


def _plain(value: Any) -> Any:
    """Return a value as JSON knows it; bytes as their hexadecimal digits."""
    return value.hex() if isinstance(value, bytes) else value
