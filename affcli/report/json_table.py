"""Tables as JSON for other programs: a list of objects, one a line."""

import json
import math
from collections.abc import Iterable, Iterator, Sequence

from affcli.report.csv_table import Value


def json_lines(columns: Sequence[str], rows: Iterable[Sequence[Value]]) -> Iterator[str]:
    """Yield a table as JSON line by line: one object a row.

    A number that is not finite, which JSON does not know, becomes null; bytes become hexadecimal
    digits.

    Args:
        columns: the keys; no two alike.
        rows: as many values in each.
    """
    before = "[\n"
    for row in rows:
        values = dict(zip(columns, map(_plain, row), strict=True))
        yield before + json.dumps(values, allow_nan=False)
        before = ",\n"
    yield "[]\n" if before == "[\n" else "\n]\n"


def _plain(value: Value) -> Value:
    """Return a value as JSON knows it."""
    if isinstance(value, bytes):
        return value.hex()
    return None if isinstance(value, float) and not math.isfinite(value) else value
