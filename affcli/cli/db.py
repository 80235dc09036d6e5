"""``affcli db``: the database file itself."""

from dataclasses import asdict

import typer

from affcli.cli.options import DEFAULT_DATABASE, AsJson, Database
from affcli.cli.terminal import say, show, show_json
from affcli.errors import UsageError, one_line

app = typer.Typer(help="The database file itself.", rich_markup_mode=None)


@app.callback(invoke_without_command=True)
def root(context: typer.Context) -> None:
    """The database file itself."""
    help_without_command(context)


def help_without_command(context: typer.Context) -> None:
    """Say which commands there are, on stderr, when none was given; that is a usage error (2)."""
    if context.invoked_subcommand is None:
        say(context.get_help())
        raise typer.Exit(UsageError.exit_code)


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
    from affcli.report.sheet import Sheet

    counts: dict[str, int] = facts.pop("counts")
    names = (*(name.replace("_", " ") for name in facts), *counts)
    table = Sheet(names, records=True)
    table.add(*(one_line(value) for value in (*facts.values(), *counts.values())))
    show(table)
