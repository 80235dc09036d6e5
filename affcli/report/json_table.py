"""Values and tables as JSON for other programs."""

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from affcli.report.csv_table import Value

MOST_EXACT = 2**53 - 1
"""The largest whole number of which a double knows that it is no other."""


def json_lines(columns: Sequence[str], rows: Iterable[Sequence[Value]]) -> Iterator[str]:
    """Yield a table as JSON line by line: one object for each row.

    Args:
        columns: the keys; no two alike.
        rows: as many values in each; see `plain`.
    """
    before = "[\n"
    for row in rows:
        values = dict(zip(columns, map(plain, row), strict=True))
        yield before + json.dumps(values, allow_nan=False)
        before = ",\n"
    yield "[]\n" if before == "[\n" else "\n]\n"


def plain(value: Any) -> Any:
    """Return a value as any reader of JSON knows it.

    A number that is not finite becomes null, bytes become hexadecimal digits. A whole number beyond
    `MOST_EXACT` becomes text: readers that take all numbers for doubles, as JavaScript and jq do,
    would read another one, of a seed another robot.
    """
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, int) and abs(value) > MOST_EXACT:
        return str(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value
