"""The ``affcli`` program: its commands."""

import typer

from affcli import __version__
from affcli.cli import (
    break_tool,
    camera,
    db,
    doctor,
    figure,
    learn,
    predict,
    replay,
    report,
    reproduce,
    settings,
    solve,
    sql,
    table,
    verify,
)
from affcli.cli.terminal import show_text

app = typer.Typer(
    name="affcli",
    help="A robot learns what tools are good for by playing with them (after Stoytchev, 2008).",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    add_completion=False,
)
app.command("learn")(learn.learn)
app.command("solve")(solve.solve)
app.command("break-tool")(break_tool.break_tool)
app.command("verify")(verify.verify)
app.command("predict")(predict.predict)
app.command("report")(report.report)
app.command("replay")(replay.replay)
app.command("reproduce")(reproduce.reproduce)
app.command("settings")(settings.settings)
app.command("sql")(sql.sql)
app.command("doctor")(doctor.doctor)
app.add_typer(camera.app, name="camera")
app.add_typer(db.app, name="db")
app.add_typer(figure.app, name="figure")
app.add_typer(table.app, name="table")


@app.callback(invoke_without_command=True)
def root(
    context: typer.Context,
    *,
    version: bool = typer.Option(False, "--version", help="Print the version and leave."),
) -> None:
    """A robot learns what tools are good for by playing with them (after Stoytchev, 2008)."""
    if version:
        show_text(f"affcli {__version__}\n")
        raise typer.Exit
    db.help_without_command(context)
