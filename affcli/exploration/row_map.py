"""Where rows start, behavior by behavior: a try there gives no new row."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from affcli.core.babbling_box import BabblingSettings
from affcli.core.geometry import Point
from affcli.exploration.grid import DIGITS, Grid, read, written

MOST_CELLS, LARGEST = 40, 50_000
"""Cells along a side; and those of all behaviors, so that the state has room in a database."""
MOST_ROWS = len(DIGITS) - 1
"""Of one behavior in one cell; more of them say nothing more."""
WHOLE = 100
"""A row counts as so many parts, so that sums are exact in whatever order they are made."""
TAIL = 2.5
"""A row counts as far as so many standard deviations."""


class RowMap:
    """How many rows of each behavior start near each place.

    Args:
        behaviors: how many there are.
        box: of babbling.
        cell: width of a cell (in).
        near: a row counts by a Gaussian of this standard deviation (in).
    """

    def __init__(self, behaviors: int, box: BabblingSettings, cell: float, near: float) -> None:
        most = max(1, min(MOST_CELLS, math.isqrt(LARGEST // behaviors)))
        self.grid = Grid.about(box, 0.0, cell, most)
        self._rows = np.zeros((behaviors, *self.grid.shape), dtype=np.int64)
        self._nearby = np.zeros_like(self._rows)
        reach = int(TAIL * near / self.grid.cell)
        along = np.exp(-0.5 * (np.arange(-reach, reach + 1) * self.grid.cell / near) ** 2)
        self._parts = np.rint(WHOLE * along[:, None] * along).astype(np.int64)

    def add(self, call: int, place: Point) -> None:
        """Count a row of a behavior that starts with the attractor here to the wrist (in)."""
        i, j = (int(number) for number in self.grid.cells(*place))
        if self._rows[call, i, j] < MOST_ROWS:
            self._count(call, i, j, 1)

    def near(
        self, call: NDArray[np.intp], x: NDArray[np.float64], y: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return how many rows of behaviors (n,) start near places (n,), (n,) (in)."""
        counted: NDArray[np.float64] = self._nearby[(call, *self.grid.cells(x, y))] / WHOLE
        return counted

    def state(self) -> list[list[str]]:
        """Return the rows of each behavior as texts; nothing for one that has none."""
        return [written(rows) if rows.any() else [] for rows in self._rows]

    def restore(self, state: Sequence[Sequence[str]]) -> None:
        """Count what `state` said; ValueError or TypeError for anything else."""
        self._rows[:] = self._nearby[:] = 0
        for call, (texts, _) in enumerate(zip(state, self._rows, strict=True)):
            if texts:
                rows = read(texts, self.grid.shape, MOST_ROWS)
                for i, j in np.argwhere(rows).tolist():
                    self._count(call, i, j, int(rows[i, j]))

    def _count(self, call: int, i: int, j: int, rows: int) -> None:
        """Count rows in a cell, and near it what of them counts there."""
        self._rows[call, i, j] += rows
        reach = len(self._parts) // 2
        (low, high, first), (near, far, nearest) = (
            (max(at - reach, 0), min(at + reach + 1, size), max(reach - at, 0))
            for at, size in zip((i, j), self.grid.shape, strict=True)
        )
        part = self._parts[first : first + high - low, nearest : nearest + far - near]
        self._nearby[call, low:high, near:far] += rows * part
