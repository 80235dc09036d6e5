"""``affcli db``: the database file itself."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from affcli.cli.files import require_new
from affcli.cli.options import DEFAULT_DATABASE, AsJson, Database, Force
from affcli.cli.terminal import say, show, show_json
from affcli.errors import DatabaseError, UsageError, one_line

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
    """Bring the schema of an older database up to date.

    All or nothing; a copy of the database as it was is made first.
    """
    from affcli.store import upgrade as upgrade_store

    upgrade_store(
        database, copied=lambda copy: say(f"a copy of it as it was: {one_line(copy, 1000)}")
    )
    say(f"{one_line(database, 1000)} is up to date")


@app.command("backup")
def backup(
    *,
    database: Database = DEFAULT_DATABASE,
    out: Annotated[
        Path | None, typer.Option("--out", help="The copy; beside it if not given.", metavar="FILE")
    ] = None,
    force: Force = False,
) -> None:
    """Write a checked copy of the database.

    As it is at one moment; others may go on reading and writing it.
    """
    copy = database.with_name(f"{database.name}.backup") if out is None else out
    require_new(copy, force=force)
    from affcli.store import backup as backup_store

    backup_store(database, copy)
    say(f"a copy of {one_line(database, 1000)}: {one_line(copy, 1000)}")


@app.command("check")
def check(*, database: Database = DEFAULT_DATABASE, as_json: AsJson = False) -> int:
    """Look whether everything in the database is as it must be.

    Pages, references, sums, and the counters against the steps that changed them. Exit code 3 when
    something is not.
    """
    from affcli.store import check as check_store

    findings = check_store(database)
    wrong = [finding for finding in findings if finding.wrong]
    if as_json:
        show_json([asdict(finding) for finding in findings])
    else:
        from affcli.report.sheet import Sheet

        table = Sheet(("what must hold", "does", "for example"), left=("what must hold",))
        for finding in findings:
            held = "yes" if not finding.wrong else f"{finding.wrong} times not"
            table.add(finding.what, held, one_line(finding.example))
        show(table)
    if wrong:
        say(f"{one_line(database, 1000)}: not as it must be; restore a copy of the file")
    return DatabaseError.exit_code if wrong else 0


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
