"""``affcli figure``: pictures for a paper, one command each."""

import typer

from affcli.cli import figure_learned, figure_tested
from affcli.cli.db import help_without_command
from affcli.cli.figure_prediction import prediction

app = typer.Typer(help="Figures for a paper: PNG, SVG or PDF.", rich_markup_mode=None)
app.command("affordances")(figure_learned.affordances)
app.command("row")(figure_learned.row)
app.command("workspace")(figure_learned.workspace)
app.command("tools")(figure_learned.tools)
app.command("learning")(figure_learned.learning)


@app.callback(invoke_without_command=True)
def root(context: typer.Context) -> None:
    """Figures for a paper: PNG, SVG or PDF, by the ending of the file's name."""
    help_without_command(context)


app.command("trial")(figure_tested.trial)
app.command("results")(figure_tested.results)
app.command("adaptation")(figure_tested.adaptation)
app.command("prediction")(prediction)
