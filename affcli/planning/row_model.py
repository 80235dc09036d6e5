"""What each row of a table would do to the attractor from any place: the model that planners ask.

A row says how the attractor moved when the wrist went all the way that it went then. Where the
reach ends sooner, the wrist stops there, and the attractor is moved by as much less.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance_table import AffordanceTable, Rows
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.choice import Reaches

CELL, LARGEST_CELL = 0.25, 16.0
"""The finest and the coarsest cells in which things near each other are taken for one (in)."""
HALVINGS = 6
"""Of a way that leaves the reach: its end is known to a 64th of the way, 0.08 of 5 in."""

BEYOND = 0.5
"""A wrist that can go so far (in) beyond the end of a truncated row's way will go on."""
SIDE = 1_000_003
"""More cells than lie side by side on any table."""

Floats = NDArray[np.float64]


class Ends(NamedTuple):
    """Where rows are expected to leave the attractor, each from each of some places.

    Args:
        place: from which of the places (n,).
        row: which row, by its position in the table (n,).
        x, y: where the attractor is expected to be then (n,) (in, table frame).
        further: the wrist will go on from where it met the edge of the reach when the row was made,
            and nobody knows what that does (n,).
    """

    place: Rows
    row: Rows
    x: Floats
    y: Floats
    further: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class RowModel:
    """The rows of a table as moves; equal tables have equal models, whatever their counters.

    Choice: what a row promises is never lengthened. A row that met the edge of the reach moved the
    attractor less than its behavior can; who takes it to do more from elsewhere plans with a
    movement that was never seen.

    Args:
        offset_x, offset_y: the attractor as seen from the wrist at the start (n,) (in).
        angle: the wrist's at the start (n,) (rad).
        movement_x, movement_y: expected movement (n,) (in).
        travel_x, travel_y: how far the wrist goes (n,) (in).
        kind: rows of the same behavior and parameter, held the same, have the same number (n,).
        truncated: the behavior met the edge of the reach and stopped there (n,).
        spread: how far movements differ from the expected one: root of the mean squared distance
            (n,) (in); 0 where it is not looked at.
    """

    offset_x: Floats
    offset_y: Floats
    angle: Floats
    movement_x: Floats
    movement_y: Floats
    travel_x: Floats
    travel_y: Floats
    kind: Rows
    truncated: NDArray[np.bool_]
    spread: Floats

    @classmethod
    def of(cls, table: AffordanceTable) -> "RowModel":
        """Return the model of a table, in which each row does what it did when it was made."""
        return table.once(cls, cls._made)

    @classmethod
    def _made(cls, table: AffordanceTable) -> "RowModel":
        rows = list(table)
        travel = np.array([row.travel for row in rows], dtype=np.float64).reshape(-1, 2)
        travel_x, travel_y = np.ascontiguousarray(travel.T)
        calls = [(row.exploratory, row.binding) for row in rows]
        number = {call: i for i, call in enumerate(dict.fromkeys(calls))}
        kind = np.array([number[call] for call in calls], dtype=np.intp)
        return cls(
            offset_x=table.offset_x,
            offset_y=table.offset_y,
            angle=table.wrist_angle,
            movement_x=table.movement_x,
            movement_y=table.movement_y,
            travel_x=travel_x,
            travel_y=travel_y,
            kind=kind,
            truncated=np.array([row.truncated for row in rows], dtype=bool),
            spread=np.zeros(len(rows)),
        )

    def thinned(self, rows: Rows, most: int) -> Rows:
        """Return at most so many rows, spread over behaviors and places: in cells of one behavior,
        so large that they are few enough, the oldest of each.
        """
        kept, cell = rows, CELL
        while len(kept) > most and cell < LARGEST_CELL:
            kept = rows[
                first_in_cells(cell, self.offset_x[rows], self.offset_y[rows], self.kind[rows])
            ]
            cell *= 2.0
        return kept[:most]

    def ends(
        self, rows: Rows, x: Floats, y: Floats, reaches: Reaches, slides: Reaches | None = None
    ) -> Ends:
        """Return what rows do from some places, as far as they can be used there.

        A row can be used where its wrist position is within reach and it is expected to move the
        attractor by more than T detects.

        Args:
            rows: which, by their positions in the table (m,).
            x, y: where the attractor would be (k,), (k,) (in, table frame).
            reaches: which wrist positions can be taken up.
            slides: where the wrist can slide; None for where it can be set down.

        Returns:
            Place by place, rows in the order given.
        """
        wrist_x = (x[:, None] - self.offset_x[rows]).ravel()
        wrist_y = (y[:, None] - self.offset_y[rows]).ravel()
        angle = np.tile(self.angle[rows], len(x))
        usable = np.flatnonzero(reaches(wrist_x, wrist_y, angle))
        place, column = np.divmod(usable, max(len(rows), 1))
        row, x_from, y_from = rows[column], wrist_x[usable], wrist_y[usable]
        slides = slides or reaches
        gone = self._share_gone(row, x_from, y_from, slides)
        whole = np.hypot(self.movement_x[row], self.movement_y[row])
        travel = np.hypot(self.travel_x[row], self.travel_y[row])
        length = whole - (1.0 - gone) * travel
        further = np.zeros(len(row), dtype=bool)
        cut = np.flatnonzero(self.truncated[row])
        on = 1.0 + BEYOND / np.maximum(travel[cut], BEYOND)
        further[cut] = slides(
            x_from[cut] + on * self.travel_x[row[cut]],
            y_from[cut] + on * self.travel_y[row[cut]],
            self.angle[row[cut]],
        )
        moved = np.flatnonzero(length > MOVEMENT_THRESHOLD)
        place, row, scale = place[moved], row[moved], length[moved] / whole[moved]
        return Ends(
            *(place, row),
            x[place] + scale * self.movement_x[row],
            y[place] + scale * self.movement_y[row],
            further[moved],
        )

    def _share_gone(self, row: Rows, x: Floats, y: Floats, reaches: Reaches) -> Floats:
        """Return which share of its way (n,) the wrist goes before the reach ends.

        Args:
            row: whose way (n,).
            x, y: where it begins, within reach (n,), (n,) (in).
            reaches: where the wrist can be.
        """
        dx, dy = self.travel_x[row], self.travel_y[row]
        gone = np.ones(len(row))
        cut = np.flatnonzero(~reaches(x + dx, y + dy, self.angle[row]))
        x, y, dx, dy, angle = x[cut], y[cut], dx[cut], dy[cut], self.angle[row[cut]]
        share, step = np.zeros(len(cut)), 1.0
        for _ in range(HALVINGS):
            step *= 0.5
            further = share + step
            held = reaches(x + further * dx, y + further * dy, angle)
            share[held] = further[held]
        # The edge lies somewhere in the last half: most likely in its middle.
        gone[cut] = share + 0.5 * step
        return gone


def first_in_cells(cell: float, x: Floats, y: Floats, kind: Rows) -> Rows:
    """Return where in each cell the first of some places stands, ascending.

    Args:
        cell: its side (in).
        x, y: the places (n,), (n,) (in).
        kind: places of different kinds are never in one cell (n,).
    """
    column = np.floor(x / cell).astype(np.int64)
    line = np.floor(y / cell).astype(np.int64)
    number = (kind * SIDE + column) * SIDE + line
    _, found = np.unique(number, return_index=True)
    return np.sort(found)
