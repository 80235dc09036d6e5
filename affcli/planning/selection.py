"""The k smallest of many numbers, and columns of some rows: quick enough for a million rows."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance_table import Rows

BLOCK = 32_768
"""So many rows are computed at a time: a million at once would wait for the memory."""
ALL = slice(None)

Value = TypeVar("Value", np.float64, np.bool_)


def blocks(n: int) -> list[slice]:
    """Cut n rows into blocks whose intermediate results stay in the processor's cache."""
    return [slice(a, a + BLOCK) for a in range(0, n, BLOCK)]


def of(column: NDArray[Value], rows: Rows, block: slice = ALL) -> NDArray[Value]:
    """Return a column's values of some rows, or of a block of these; a view when they are all.

    Sound because rows are distinct and ascending: as many as the column is long, they are all.
    """
    return column[block] if len(rows) == len(column) else column[rows[block]]


def those(rows: Rows, kept: NDArray[np.bool_]) -> Rows:
    """Return the rows that are kept."""
    if kept.all():
        return rows
    # Finding positions first is several times quicker than indexing by a scattered mask.
    return rows[np.flatnonzero(kept)]


def smallest(values: NDArray[np.float64], k: int) -> Rows:
    """Return where the k smallest values stand (k,), ascending; of equal values the first."""
    limit = np.partition(values, k - 1)[k - 1]
    found = np.flatnonzero(values <= limit)
    if len(found) > k:
        ties = np.flatnonzero(values[found] == limit)
        found = np.delete(found, ties[k - len(found) :])
    return found
