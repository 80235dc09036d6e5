"""``affcli sql``: ask the database in plain SQL, read-only for certain."""

from typing import Annotated, Any

import typer

from affcli.cli.options import AsJson, Database
from affcli.cli.terminal import say, show_json, show_rows, show_text
from affcli.errors import UsageError, one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.csv_table import csv_text
from affcli.store import run_sql

MOST_CELLS = 20_000
"""Of a drawn table: these take 2 s; 10,000 rows of all columns of two tables would take minutes."""


def sql(
    query: Annotated[str, typer.Argument(help="One select statement.", metavar="QUERY")],
    *,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Write CSV to stdout.")] = False,
) -> None:
    """Ask the database one question in SQL.

    Tables: affordance, behavior, learning_run, session, trial, step, verification, replication;
    views: affordance_table, affordance_wide. Nothing can be written.
    """
    if as_json and as_csv:
        raise UsageError("give --json or --csv, not both")

    result = run_sql(database, query)
    columns, rows, cut = result.columns, result.rows, result.truncated
    if as_json:
        keys = result.names
        show_json([dict(zip(keys, map(_plain, row), strict=True)) for row in rows])
    elif as_csv:
        show_text(csv_text(result.names, rows))
    else:
        drawn = max(1, MOST_CELLS // len(columns))
        rows, cut = rows[:drawn], cut or len(rows) > drawn
        names = tuple(map(one_line, result.names))
        numbers = {
            name
            for name, values in zip(names, zip(*rows, strict=True), strict=False)
            if all(value is None or isinstance(value, int | float) for value in values)
        }
        show_rows(
            names,
            (["" if value is None else one_line(_plain(value)) for value in row] for row in rows),
            left=tuple(n for n in names if n not in numbers),
            wraps=False,
        )
    if not rows:
        say("no rows")
    if cut:
        more = ", or give --json or --csv" if len(rows) < len(result.rows) else ""
        say(f"only the first {len(rows)} rows are shown; add a limit or a where{more}")


def _plain(value: Any) -> Any:
    """Return a value as JSON knows it; bytes as their hexadecimal digits."""
    return value.hex() if isinstance(value, bytes) else value
