"""The k smallest of many numbers, and columns of some rows: quick enough for a million rows."""

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance_table import Rows

BLOCK = 32_768
"""So many rows are computed at a time: a million at once would wait for the memory."""
ALL = slice(None)

LONG, SAMPLE, SPARSE = 8_192, 2_048, 128
"""From how many values on a sample is drawn; at least how large it is; at most one of how many."""

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
    low, found = _probably_small(values, k)
    smaller = values[found] if len(found) < len(values) else values
    limit = _kth(smaller, k, low)
    found = found[np.flatnonzero(smaller <= limit)]
    if len(found) > k:
        ties = np.flatnonzero(values[found] == limit)
        found = np.delete(found, ties[k - len(found) :])
    return found


def _probably_small(values: NDArray[np.float64], k: int) -> tuple[float, Rows]:
    """Return where at least the k smallest values stand, of many not many more; and a value that
    the k-th probably exceeds.
    """
    low = -math.inf
    if len(values) >= LONG:
        sample = np.sort(values[:: min(len(values) // SAMPLE, SPARSE)])
        at = k * len(sample) // len(values)
        # Three standard deviations of the k-th value's place in a random sample, at their widest.
        margin = math.ceil(1.5 * math.sqrt(len(sample)))
        if at + margin < len(sample):
            found = np.flatnonzero(values <= sample[at + margin])
            if len(found) >= k:  # else the sample misled
                return float(sample[at - margin]) if at >= margin else low, found
    return low, np.arange(len(values))


def _kth(values: NDArray[np.float64], k: int, low: float) -> float:
    """Return the k-th smallest value; quicker when it is no less than `low`, and few others are."""
    below = 0
    if low > -math.inf:
        within = values[np.flatnonzero(values >= low)]
        if len(values) - len(within) < k:
            below, values = len(values) - len(within), within
    return float(np.partition(values, k - below - 1)[k - below - 1])
