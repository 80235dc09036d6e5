"""Rows of affordance tables as the command line gives them, and databases tampered with."""

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

from tests.cli.program import Arg, done

EVIL = {
    "a command": "=cmd|' /C calc'!A0",
    "a formula behind a line's end": "x\r\n=1+1",
    "a formula behind delimiters": 'x";=1+1,@SUM(A1)\t+1',
    "minus": "-2+3",
    "a page's code": "<script>alert(1)</script>",
    "an escape sequence": "\x1b[31mred\x07",
    "NUL": "x\x00=1",
    "right to left": "\u202e=1",
    "10 kB": "=" * 10_000,
    "markup": "[bold red]x[/]",
    "SQL": "x'); DROP TABLE affordance; --",
}
"""What somebody may put where affcli writes words."""


def tamper(database: Path, statement: str, *values: object) -> None:
    """Change a database behind affcli's back."""
    with closing(sqlite3.connect(database)) as driver, driver:
        driver.execute(statement, values)


def vary_counters(database: Path) -> None:
    """Give the rows all kinds of replication probabilities."""
    tamper(
        database,
        "UPDATE affordance SET times_used = 1 + id % 5, times_successful = id % (2 + id % 5)",
    )


def listed(database: Path, *args: Arg) -> list[dict[str, Any]]:
    """Return what ``table list`` gives."""
    found: list[dict[str, Any]] = done("table", "list", *args, "--json", "--db", database).results
    return found
