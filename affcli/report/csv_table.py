"""Tables as CSV for other programs: RFC 4180, and safe to open in a spreadsheet.

Standard library only, so that ``affcli sql --csv`` starts as fast as without it.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache

Value = str | int | float | bytes | None
"""A value as SQLite gives it."""

_ACTIVE = re.compile(r"[\t\r\n]|[\s\x00-\x1f\x7f-\x9f\ufeff]*[-=+@\uff0d\uff1d\uff0b\uff20]")
"""How text begins that a spreadsheet takes for a formula. Beside ``= + - @`` TAB and CR also LF and
the signs of double width, as OWASP names them ("CSV Injection"); and any of these after blanks and
control characters, for some programs drop those."""

_PLAIN = re.compile(r"\w(?:[\w. -]*\w)?")
"""Text that needs no quotes. RFC 4180 asks for quotes around a comma, a quote and a line's end
alone; but a spreadsheet may split at semicolons, tabs or bars too, and then a cell would begin in
the middle of this one."""


def csv_text(columns: Sequence[str], rows: Iterable[Sequence[Value]]) -> str:
    """Return a table as CSV, as `csv_lines` gives it line by line."""
    return "".join(csv_lines(columns, rows))


def csv_lines(columns: Sequence[str], rows: Iterable[Sequence[Value]]) -> Iterator[str]:
    """Yield a table as CSV: the headings, then each row, with CR LF at the end.

    Text that a spreadsheet would take for a formula gets a leading apostrophe, which makes it text
    there; numbers are left alone, negative ones too. A number is written so that reading it gives
    the same number. NULL is an empty cell, empty text is ``""``, bytes are hexadecimal digits.

    Args:
        columns: the headings.
        rows: as many values in each.
    """
    yield _line(columns)
    for row in rows:
        yield _line(row)


def _line(row: Sequence[Value]) -> str:
    """Return one row with its line's end."""
    line = ",".join(map(_cell, row))
    # A single NULL would leave an empty line, which readers skip.
    return f"{line}\r\n" if line else '""\r\n'


def _cell(value: Value) -> str:
    """Return one cell."""
    if isinstance(value, float | int):
        return repr(value)
    if isinstance(value, str):
        return _text(value)
    return "" if value is None else value.hex()


@lru_cache(maxsize=1024)
def _text(text: str) -> str:
    """Return a cell of text, quoted unless it is plain."""
    if _PLAIN.fullmatch(text):
        return text
    safe = f"'{text}" if _ACTIVE.match(text) else text
    return '"' + safe.replace('"', '""') + '"'
