"""Where the commands' words go: results to stdout, messages and progress to stderr."""

import json
import math
import sys
from contextlib import contextmanager
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.console import Console, RenderableType
    from rich.progress import Progress


def now() -> str:
    """Return the time as ISO text, for the record; no result depends on it."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def say(message: str) -> None:
    """Write a message to stderr."""
    sys.stderr.write(f"{message}\n")


def show(*renderables: "RenderableType") -> None:
    """Write tables and text to stdout."""
    console = _console(stderr=False)
    for renderable in renderables:
        console.print(renderable)


def show_json(value: Any) -> None:
    """Write JSON to stdout; a number that is not finite becomes null."""
    sys.stdout.write(json.dumps(_finite(value), indent=2) + "\n")


@contextmanager
def progress() -> "Iterator[Progress]":
    """Give a progress display on stderr that leaves nothing behind; silent without a terminal."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    console = _console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[status]}"),
        TimeRemainingColumn(),
    )
    with Progress(
        *columns, console=console, transient=True, disable=not console.is_terminal
    ) as shown:
        yield shown


def _console(*, stderr: bool) -> "Console":
    """Return a rich console; markup and highlighting are off, for names are users' own."""
    from rich.console import Console

    return Console(stderr=stderr, markup=False, highlight=False, emoji=False)


def _finite(value: Any) -> Any:
    """Return `value` with every number that is not finite replaced by None."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
