"""Names that a user wrote, against those that are known."""

import difflib
from collections.abc import Iterable

from affcli.errors import UsageError, one_line


def one_of(kind: str, value: str, known: Iterable[str], hint: str = "") -> str:
    """Return `value` when it is known; else say which names are nearest.

    Args:
        kind: what it is the name of, for the message.
        value: what the user wrote.
        known: all names.
        hint: the end of the message.

    Raises:
        UsageError: it is not known.
    """
    names = list(known)
    if value in names:
        return value
    near = difflib.get_close_matches(value[:40].lower(), names, n=3, cutoff=0.4) or names
    raise UsageError(f"no {kind} {one_line(value, 60)!r}; did you mean {' or '.join(near)}?{hint}")
