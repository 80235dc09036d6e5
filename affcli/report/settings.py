"""All settings as tables, as a TOML file, and as JSON types."""

import json
import textwrap
from collections.abc import Iterator, Mapping
from itertools import groupby
from typing import Any

from affcli.core.setting import Setting, Value
from affcli.report.sheet import Sheet

Settings = Mapping[str, tuple[Setting, Value]]
"""What each setting is and its value, by its name, ``section.key``."""


def settings_tables(settings: Settings, *, values: bool) -> Iterator[Sheet]:
    """Yield a table for each section.

    Args:
        settings: those to be shown.
        values: show their values beside the defaults.
    """
    left = ("unit", "limits", "meaning")
    for section, entries in _by_section(settings):
        columns = (section, *(("value",) if values else ()), "default", *left)
        sheet = Sheet(columns, left=(section, *left))
        for key, one, value in entries:
            own = (_word(value),) if values else ()
            sheet.add(key, *own, _word(one.default), one.unit, one.limits, one.meaning)
        yield sheet


def settings_toml(settings: Settings, defaults: int) -> str:
    """Return a file of settings, each with its meaning, unit, limits and default before it.

    Args:
        settings: those to be written.
        defaults: the number of the defaults.
    """
    lines = [
        f"# Settings of affcli, defaults number {defaults}; --config reads this file.",
        "# Keep the lines that you change.",
    ]
    for section, entries in _by_section(settings):
        lines += ["", f"[{section}]"]
        for key, one, value in entries:
            unit = f" {one.unit}" if one.unit else ""
            about = f"{one.meaning} {one.limits}{unit}; default {_word(one.default)}."
            lines += textwrap.wrap(about, 98, initial_indent="# ", subsequent_indent="# ")
            lines.append(f"{key} = {json.dumps(value)}")
    return "\n".join(lines) + "\n"


def settings_json(settings: Settings) -> list[dict[str, Any]]:
    """Return each setting with its value, default, unit, limits and meaning."""
    return [
        {
            "setting": name,
            "value": value,
            "default": one.default,
            "unit": one.unit or None,
            "low": None if one.choices else one.low,
            "high": None if one.choices else one.high,
            "choices": list(one.choices) or None,
            "meaning": one.meaning,
        }
        for name, (one, value) in settings.items()
    ]


def _by_section(settings: Settings) -> Iterator[tuple[str, list[tuple[str, Setting, Value]]]]:
    for section, names in groupby(settings, lambda name: name.split(".")[0]):
        yield section, [(name.split(".")[1], *settings[name]) for name in names]


def _word(value: Value) -> str:
    return value if isinstance(value, str) else format(value, "g")
