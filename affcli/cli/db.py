"""``affcli db``: the database file itself."""

from dataclasses import asdict

import typer

from affcli.cli.options import DEFAULT_DATABASE, AsJson, Database
from affcli.cli.terminal import say, show, show_json

app = typer.Typer(help="The database file itself.", no_args_is_help=True, rich_markup_mode=None)


@app.command("upgrade")
def upgrade(*, database: Database = DEFAULT_DATABASE) -> None:
    """Bring the schema of an older database up to date; all or nothing."""
    from affcli.store import upgrade as upgrade_store

    upgrade_store(database)
    say(f"{database} is up to date")


@app.command("info")
def info(*, database: Database = DEFAULT_DATABASE, as_json: AsJson = False) -> None:
    """Say what the file is: schema revision, size, journal mode, rows of each table."""
    from affcli.store import database_info

    found = asdict(database_info(database))
    facts = {**found, "path": str(database)}
    if as_json:
        show_json(facts)
        return
    from rich.table import Table

    table = Table(show_header=False)
    counts: dict[str, int] = facts.pop("counts")
    for name, value in {**facts, **counts}.items():
        table.add_row(name, str(value))
    show(table)
