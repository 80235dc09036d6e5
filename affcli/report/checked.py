"""What a person's file is, as a table and as JSON types (``affcli check``)."""

from collections.abc import Mapping
from typing import Any

from affcli.report.sheet import Sheet


def checked_table(kind: str, name: str, facts: Mapping[str, str]) -> Sheet:
    """Return what a file says: a fact a line."""
    table = Sheet((kind, name), left=(kind, name))
    for what, said in facts.items():
        table.add(what, said)
    return table


def checked_json(kind: str, name: str, facts: Mapping[str, str]) -> dict[str, Any]:
    """Return the same as JSON types."""
    return {"kind": kind, "name": name, "facts": dict(facts)}
