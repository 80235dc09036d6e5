"""``affcli check``: what a file is that a person wrote, or what is wrong in it and where."""

from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.files import require_new, save
from affcli.cli.options import FIGURE_ENDINGS, AsJson, Changes, Config, Force
from affcli.cli.terminal import say, show_either
from affcli.config import load_settings
from affcli.errors import UsageError, one_line
from affcli.lab.drawing import require_figures
from affcli.report import figures
from affcli.report.checked import checked_json, checked_table


def check(
    file: Annotated[
        Path,
        typer.Argument(
            help="A TOML file: a tool, a map of a log, an experiment, or settings.",
            metavar="FILE.toml",
            readable=False,
        ),
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Draw a tool: *.png, *.svg or *.pdf.", metavar="FILE"),
    ] = None,
    force: Force = False,
    config: Config = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> None:
    """Say what a file of yours is, or what is wrong in it and where.

    Of a tool also whether babbling and a camera can do with it; --out draws it.
    """
    if out is not None:
        require_new(out, force=force, endings=FIGURE_ENDINGS)
        require_figures()
    settings = load_settings(config, changes or ())
    found = lab.checking.checked(file, settings)
    if out is not None:
        if found.tool is None:
            raise UsageError(f"--out draws tools; {one_line(file)} is of {found.kind}")
        radius = settings.workspace.puck.radius
        drawn = figures.tools.tools_figure([found.tool], None, radius)
        save(out, figures.canvas.encoded(drawn, out.suffix, title="", caption="", dpi=300))
        say(f"{found.name}, to scale: {one_line(out)}")
    said = (found.kind, found.name, found.facts)
    show_either(
        as_json=as_json,
        results=lambda: [{"file": str(file), **checked_json(*said)}],
        tables=lambda: [checked_table(*said)],
    )
