"""The mask of a tool: which places about the wrist its colour covers, as a camera sees it (§4).

It is all that a robot knows of a tool's shape: an observation, with the errors of one.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Grid = NDArray[np.bool_]
"""Cells (columns, rows): columns from left to right, rows away from the robot."""

Color = tuple[float, float, float]
"""Red, green and blue, each 0 to 255."""
SCALE = 0.1
"""Side of a cell (in). Choice: a pixel of the camera shows 0.07 in of the table."""
MOST_CELLS = 1_000_000
"""Of a mask that is read: a hundred inches in each direction."""


@dataclass(frozen=True)
class Mask:
    """Which cells about the wrist a tool covers, the wrist's angle 0.

    The cell of column i and row j is the square from (i, j) to (i + 1, j + 1) times `SCALE`, in
    the wrist frame: x to the right, y straight ahead.

    Args:
        column, row: of the cell at the near left corner of what is kept.
        columns, rows: how many cells are kept.
        cells: whether each is covered, packed into bits, column after column.
        color: of the tool, as seen.
    """

    column: int
    row: int
    columns: int
    rows: int
    cells: bytes
    color: Color

    @classmethod
    def of(cls, grid: Grid, column: int, row: int, color: Color) -> "Mask":
        """Return the mask of a grid, without the empty cells around it.

        Args:
            grid: which cells are covered.
            column, row: of its first cell.
            color: of the tool.

        Raises:
            ValueError: none is covered.
        """
        columns, rows = np.flatnonzero(grid.any(axis=1)), np.flatnonzero(grid.any(axis=0))
        if not len(columns):
            raise ValueError("a mask of nothing")
        left, right, near, far = columns[0], columns[-1] + 1, rows[0], rows[-1] + 1
        kept = grid[left:right, near:far]
        return cls(
            column=int(column + left),
            row=int(row + near),
            columns=kept.shape[0],
            rows=kept.shape[1],
            cells=np.packbits(kept).tobytes(),
            color=color,
        )

    def __post_init__(self) -> None:
        count = self.columns * self.rows
        fits = self.columns > 0 and self.rows > 0 and count <= MOST_CELLS
        if not (fits and len(self.cells) == -(-count // 8)):
            raise ValueError(f"a mask of {self.columns} by {self.rows} cells")

    @cached_property
    def grid(self) -> Grid:
        """Which of the kept cells are covered (columns, rows)."""
        bits = np.unpackbits(np.frombuffer(self.cells, np.uint8), count=self.columns * self.rows)
        found = bits.astype(bool).reshape(self.columns, self.rows)
        found.flags.writeable = False
        return found

    def window(self, column: int, row: int, columns: int, rows: int) -> Grid:
        """Return the cells (columns, rows) of a rectangle, wherever it lies."""
        found = np.zeros((columns, rows), dtype=bool)
        left, near = max(column, self.column), max(row, self.row)
        right = min(column + columns, self.column + self.columns)
        far = min(row + rows, self.row + self.rows)
        if left < right and near < far:
            found[left - column : right - column, near - row : far - row] = self.grid[
                left - self.column : right - self.column, near - self.row : far - self.row
            ]
        return found

    def mirrored(self) -> "Mask":
        """Return it with left and right exchanged."""
        return Mask.of(self.grid[::-1], -(self.column + self.columns), self.row, self.color)

    def grown(self, by: float) -> "Mask":
        """Return it as if the tool were so much larger on all sides (in): a mask that is wrong."""
        reach = round(by / SCALE)
        if not reach:
            return self
        wide = self.window(
            *(self.column - reach, self.row - reach),
            *(self.columns + 2 * reach, self.rows + 2 * reach),
        )
        found = wide.copy()
        for i in range(-reach, reach + 1):
            for j in range(-reach, reach + 1):
                if i * i + j * j <= reach * reach:
                    found |= np.roll(wide, (i, j), (0, 1))
        return Mask.of(found, self.column - reach, self.row - reach, self.color)

    def overlap(self, other: "Mask") -> float:
        """Return how much of what either covers both do: 1 for equal masks, 0 for apart."""
        left, near = min(self.column, other.column), min(self.row, other.row)
        right = max(self.column + self.columns, other.column + other.columns)
        far = max(self.row + self.rows, other.row + other.rows)
        one, two = (m.window(left, near, right - left, far - near) for m in (self, other))
        return float((one & two).sum() / (one | two).sum())
