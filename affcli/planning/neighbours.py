"""What a row and its neighbours say together: their mean movement, and how far it is spread.

Neighbours are rows of the same behavior and parameter that were made with the attractor at nearly
the same place, as seen from the wrist.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from affcli.core.affordance_table import AffordanceTable, Rows
from affcli.planning.row_model import Floats, RowModel

BLOCK = 512
"""Rows whose neighbours are looked for at a time."""


def smoothed(table: AffordanceTable, radius: float) -> RowModel:
    """Return the model of a table in which each row does what it and its neighbours did on average.

    Neighbours weigh less the farther away they are (Epanechnikov's kernel). A row with few of them
    is taken to be spread as the rows of the table are on average: having no neighbours makes no row
    certain.

    Args:
        table: what was learned.
        radius: how far neighbours lie (in).
    """
    return table.once((smoothed, radius), lambda whole: _smoothed(whole, radius))


def _smoothed(table: AffordanceTable, radius: float) -> RowModel:
    model = RowModel.of(table)
    n = len(table)
    mean = np.zeros((n, 2))
    around, weight = np.zeros(n), np.ones(n)
    moved = np.column_stack((model.movement_x, model.movement_y))
    for rows, others, near in _weights(model, radius):
        there = moved[others]
        total = near.sum(axis=1)
        mean[rows] = (near @ there) / total[:, None]
        squared = (near @ (there**2).sum(axis=1)) / total
        around[rows] = np.maximum(0.0, squared - (mean[rows] ** 2).sum(axis=1))
        weight[rows] = total
    # One row alone has a weight of 1, that of itself.
    accompanied = weight > 1.0
    usual = float(around[accompanied].mean()) if accompanied.any() else 0.0
    variance = (weight * around + usual) / (weight + 1.0)
    return replace(
        model,
        movement_x=np.ascontiguousarray(mean[:, 0]),
        movement_y=np.ascontiguousarray(mean[:, 1]),
        spread=np.sqrt(variance),
    )


def _weights(model: RowModel, radius: float) -> Iterator[tuple[Rows, Rows, Floats]]:
    """Yield some rows (k,), the rows of the same behavior (m,), and how much each of these weighs
    as a neighbour (k, m): 1 at the same place, 0 from `radius` on.
    """
    for one in np.unique(model.kind):
        same = np.flatnonzero(model.kind == one)
        x, y = model.offset_x[same], model.offset_y[same]
        for first in range(0, len(same), BLOCK):
            part = slice(first, first + BLOCK)
            squared = (x[part, None] - x) ** 2 + (y[part, None] - y) ** 2
            yield same[part], same, np.maximum(0.0, 1.0 - squared / radius**2)
