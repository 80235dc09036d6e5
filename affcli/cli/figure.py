"""``affcli figure``: pictures for a paper, one command each."""

import typer

from affcli.cli import figure_tested
from affcli.cli.db import help_without_command
from affcli.cli.figure_prediction import prediction

app = typer.Typer(help="Figures for a paper: PNG, SVG or PDF.", rich_markup_mode=None)


@app.callback(invoke_without_command=True)
def root(context: typer.Context) -> None:
    """Figures for a paper: PNG, SVG or PDF, by the ending of the file's name."""
    help_without_command(context)


app.command("trial")(figure_tested.trial)
app.command("results")(figure_tested.results)
app.command("adaptation")(figure_tested.adaptation)
app.command("prediction")(prediction)
