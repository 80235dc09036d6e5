"""Names that a user wrote, against those that are known."""

import difflib
from collections.abc import Iterable
from typing import TypeVar

from affcli.errors import UsageError, one_line

Name = TypeVar("Name", bound=str)


def one_of(kind: str, value: str, known: Iterable[Name], hint: str = "") -> Name:
    """Return `value` when it is known; else say which names are nearest.

    Args:
        kind: what it is the name of, for the message.
        value: what the user wrote.
        known: all names.
        hint: the end of the message.

    Raises:
        UsageError: it is not known.
    """
    names: list[Name] = list(known)
    for name in names:
        if name == value:
            return name
    near = difflib.get_close_matches(value[:40].lower(), [*map(str, names)], n=3, cutoff=0.4)
    raise UsageError(
        f"no {kind} {one_line(value, 60)!r}; did you mean {' or '.join(near or names)}?{hint}"
    )
