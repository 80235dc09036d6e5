"""``affcli camera``: calibrate it, find things with it, look at what it sees (§4)."""

import typer

from affcli.cli import camera_calibrate, camera_locate, camera_view
from affcli.cli.db import help_without_command

app = typer.Typer(help="The camera: calibrate it, find things with it.", rich_markup_mode=None)
app.command("calibrate")(camera_calibrate.calibrate)
app.command("locate")(camera_locate.locate)
app.command("view")(camera_view.view)


@app.callback(invoke_without_command=True)
def root(context: typer.Context) -> None:
    """The camera: calibrate it, find things with it, look at what it sees."""
    help_without_command(context)
