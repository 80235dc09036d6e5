"""The parts of the registry as tables and as JSON types (``affcli list``)."""

from collections.abc import Iterator, Mapping
from typing import Any

from affcli import __version__
from affcli.core.identity import package_text, shown
from affcli.core.part import Kind, Part
from affcli.report.sheet import Sheet

Registered = Mapping[Kind, Mapping[str, Part]]
"""Parts by name, by kind."""


def parts_tables(registered: Registered) -> Iterator[Sheet]:
    """Yield for each kind a table of its parts, and one of their parameters if they have any."""
    for kind, parts in registered.items():
        heads = (kind, "what it is", "source", "package")
        known = Sheet(heads, left=heads)
        for name, part in parts.items():
            known.add(name, part.summary, part.source, part.package or "affcli")
        yield known
        left = ("parameter of", "name", "unit", "limits", "meaning")
        params = Sheet((*left[:2], "default", *left[2:]), left=left)
        for name, part in parts.items():
            for key, one in part.params.items():
                params.add(name, key, shown(one.default), one.unit, one.limits, one.meaning)
        if any(part.params for part in parts.values()):
            yield params


def parts_json(registered: Registered) -> list[dict[str, Any]]:
    """Return the same as JSON types."""
    return [
        {
            "kind": kind,
            "name": part.name,
            "version": part.version,
            "summary": part.summary,
            "source": part.source,
            "package": part.package or package_text("affcli", __version__),
            "parameters": [
                {
                    "name": key,
                    "default": one.default,
                    "unit": one.unit or None,
                    "low": one.low,
                    "high": one.high,
                    "meaning": one.meaning,
                }
                for key, one in part.params.items()
            ],
        }
        for kind, parts in registered.items()
        for part in parts.values()
    ]
