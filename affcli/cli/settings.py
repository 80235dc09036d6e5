"""``affcli settings``: every setting with its default, unit, limits and meaning."""

from typing import Annotated

import typer

from affcli.cli.options import AsJson, Changes, Config
from affcli.cli.terminal import say, show, show_json, show_text
from affcli.config import DEFAULTS, known_settings, load_settings
from affcli.errors import UsageError
from affcli.report.settings import settings_json, settings_tables, settings_toml


def settings(
    *,
    config: Config = None,
    changes: Changes = None,
    as_toml: Annotated[
        bool, typer.Option("--toml", help="Write a file that --config reads to stdout.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Show all settings: what each means, its default, its unit and what it may be.

    With --config or --set only those that differ from the defaults.
    """
    if as_toml and as_json:
        raise UsageError("give --toml or --json, not both")
    chosen = config is not None or bool(changes)
    values = load_settings(config, changes or ()).values()
    shown = {
        name: (one, values[name])
        for name, one in known_settings().items()
        if not chosen or values[name] != one.default
    }
    if as_json:
        show_json(settings_json(shown))
    elif as_toml:
        show_text(settings_toml(shown, DEFAULTS))
    elif shown:
        show(*settings_tables(shown, values=chosen))
    else:
        say("nothing differs from the defaults")
