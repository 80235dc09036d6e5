"""What a table looks like on a screen of so many columns."""

import io
from collections.abc import Iterable

from rich.console import Console, RenderableType


def drawn(tables: Iterable[RenderableType], columns: int) -> str:
    """Return tables as text; no line is wider than the screen."""
    file = io.StringIO()
    console = Console(file=file, width=columns, markup=False, highlight=False, emoji=False)
    for table in tables:
        console.print(table, "")
    lines = [line.rstrip() for line in file.getvalue().splitlines()]
    assert max(map(len, lines)) <= columns
    return "\n".join(lines)
