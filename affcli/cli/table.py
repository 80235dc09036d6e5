"""``affcli table``: the rows of the affordance tables, to be looked at and taken out (§3.2)."""

import typer

from affcli.cli import table_export, table_list, table_show
from affcli.cli.db import help_without_command

app = typer.Typer(help="The rows of the affordance tables.", rich_markup_mode=None)
app.command("list")(table_list.list_rows)
app.command("show")(table_show.show_row)
app.command("export")(table_export.export)


@app.callback(invoke_without_command=True)
def root(context: typer.Context) -> None:
    """The rows of the affordance tables: look at them, take them out."""
    help_without_command(context)
