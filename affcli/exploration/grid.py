"""Cells about the wrist: what an explorer remembers of places, and how that is written down."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from affcli.core.babbling_box import BabblingSettings

Cells = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Numbers of cells in x and in y."""
DIGITS = "0123456789abcdefghijklmnopqrstuvwxyz"


@dataclass(frozen=True, slots=True)
class Grid:
    """Square cells in the wrist's frame.

    Args:
        left, near: the corner of the first cell (in).
        cell: width of a cell (in).
        shape: how many cells in x and in y.
    """

    left: float
    near: float
    cell: float
    shape: tuple[int, int]

    @classmethod
    def about(cls, box: BabblingSettings, margin: float, cell: float, most: int) -> "Grid":
        """Return the cells of the box of babbling and of a margin about it (in).

        Args:
            most: cells along a side; where they do not suffice they are larger.
        """
        width = 2.0 * (box.offset_x_max + margin)
        depth = box.offset_y_max - box.offset_y_min + 2.0 * margin
        cell = max(cell, width / most, depth / most)
        shape = min(math.ceil(width / cell), most), min(math.ceil(depth / cell), most)
        return cls(-box.offset_x_max - margin, box.offset_y_min - margin, cell, shape)

    def cells(self, x: ArrayLike, y: ArrayLike) -> Cells:
        """Return the cells of places (in), of any shape; the nearest of those outside."""
        numbers = (
            np.clip((np.asarray(along) - first) / self.cell, 0.0, count - 1.0)
            for along, first, count in zip((x, y), (self.left, self.near), self.shape, strict=True)
        )
        i, j = (number.astype(np.intp) for number in numbers)
        return i, j


def written(values: NDArray[Any]) -> list[str]:
    """Return a table of numbers from 0 to 35 (n, m) as n texts, a digit a number."""
    return ["".join(DIGITS[value] for value in column) for column in values.tolist()]


def read(texts: Sequence[str], shape: tuple[int, int], most: int) -> NDArray[np.int64]:
    """Return the table that `written` gave; ValueError or TypeError for another one.

    Args:
        texts: what it gave.
        shape: of the table.
        most: no number is larger.
    """
    values = np.array([[int(digit, 36) for digit in text] for text in texts], dtype=np.int64)
    if values.shape != shape or values.max(initial=0) > most:
        raise ValueError(f"not {shape[0]} x {shape[1]} numbers up to {most}")
    return values
