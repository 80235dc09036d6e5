"""``affcli new``: a file to begin with."""

from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.files import require_new, save
from affcli.cli.options import Force
from affcli.cli.terminal import say
from affcli.config import load_settings
from affcli.errors import one_line
from affcli.tool_files import checked_name

TOOL = """\
# A tool of your own. Inches; x to the right, y along the handle, away from the robot.
# The robot holds it at x = 0, 1 in above its lower end (--binding grasp:grasp_point=3: at 3 in).
#   affcli check {file} --out {stem}.png     draws it, or says what is wrong
#   affcli learn --tool ./{file}             an hour of babbling with it
#   affcli solve --goal 1 --tool "{name}"
#   affcli break-tool --tool "{name}" --loses "left tine"

[tool]
name = "{name}"
color = [110, 230, 200]     # red, green, blue; unlike the other tools', by which robots know them

[[part]]                    # a tool breaks by the names of its parts
name = "handle"
outline = [[-0.4, 0], [0.4, 0], [0.4, 14], [-0.4, 14]]

[[part]]                    # any polygon that does not cross itself; it may bend inwards
name = "bar"
outline = [[-5, 13.2], [5, 13.2], [5, 14], [-5, 14]]

[[part]]
name = "left tine"
outline = [[-5, 9], [-4.2, 9], [-4.2, 13.2], [-5, 13.2]]

[[part]]
name = "right tine"
outline = [[4.2, 9], [5, 9], [5, 13.2], [4.2, 13.2]]
"""


def tool(
    name: Annotated[str, typer.Argument(help="What it is to be called.", metavar="NAME")],
    *,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="The file; NAME.toml if not given.", metavar="FILE"),
    ] = None,
    force: Force = False,
) -> None:
    """Write a tool to begin with: a rake, with what to change said beside it."""
    called = checked_name(name, "NAME")
    path = out or Path(f"{called.replace(' ', '-')}.toml")
    require_new(path, force=force, endings=(".toml",))
    save(path, TOOL.format(name=called, file=path.name, stem=path.stem).encode())
    lab.checking.checked(path, load_settings(None, ()))
    say(f"a tool to begin with: {one_line(path)}; see: affcli check {one_line(path)}")
