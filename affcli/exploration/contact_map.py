"""Where the attractor can be to the wrist and not be: what tries tell of the tool's contacts.

An occupancy grid (Moravec and Elfes 1985) in the frame of the hand. A cell is where the attractor's
centre is; "contact" means that a tool which comes on pushes it. The robot feels along the tool with
the attractor: it needs no shape.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from affcli.core.babbling_box import BabblingSettings
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point
from affcli.exploration.grid import Grid, read, written
from affcli.exploration.way import Way

UNKNOWN, CLEAR, NEAR, CONTACT = range(4)
"""What is known of a cell: nothing; the attractor was there and was not pushed; a contact is near;
there is contact."""
PROBABILITY = {CLEAR: 0.0025, NEAR: 0.2, CONTACT: 0.95}
"""Of contact, by what is known. Chosen on seeds 100 to 149."""
MARGIN = 6.0
"""How far the map goes beyond the box (in): a little farther than the paper's behaviors."""
DEPTH = 0.3
"""How far beyond where a push began its contact is marked (in)."""
AROUND_CONTACT, AROUND_BLOCKED = 1, 2
"""Cells on each side that are near to one with contact: the tool is as wide as the attractor where
it would have come down on it."""
MOST_CELLS = 120
"""Along a side."""


class ContactMap:
    """What is known of each cell about the wrist.

    Args:
        box: of babbling; the map is larger by `MARGIN`.
        cell: width of a cell (in).
        prior: the probability of contact in a cell of which nothing is known.
    """

    def __init__(self, box: BabblingSettings, cell: float, prior: float) -> None:
        self.grid = Grid.about(box, MARGIN, cell, MOST_CELLS)
        self._known = np.full(self.grid.shape, CLEAR, dtype=np.int64)
        # The rim stands for all that lies beyond, where no contact is looked for.
        self._known[1:-1, 1:-1] = UNKNOWN
        self._probability = np.array([prior, *PROBABILITY.values()])

    @property
    def contact(self) -> NDArray[np.float64]:
        """The probability of contact in each cell."""
        found: NDArray[np.float64] = self._probability[self._known]
        return found

    @property
    def occupied(self) -> NDArray[np.bool_]:
        """The cells where the tool is likely not to be lowered, for the attractor is there."""
        return self._known >= NEAR

    def blocked(self, place: Point) -> None:
        """Learn that the tool would have come down on an attractor here."""
        self._mark(place, AROUND_BLOCKED)
        self._known[self.grid.cells(*place)] = CONTACT

    def passed(self, place: Point, way: Way) -> None:
        """Learn from a behavior that did not move the attractor.

        Args:
            place: where the attractor stood to the wrist (in).
            way: how the wrist truly went.
        """
        self._clear(place, way, way.length(place) - MOVEMENT_THRESHOLD)

    def pushed(self, place: Point, way: Way, moved: float) -> None:
        """Learn from a behavior that moved the attractor by so much (in): it was met that long
        before the end.
        """
        length = way.length(place)
        gap = max(0.0, length - moved)
        self._clear(place, way, gap - MOVEMENT_THRESHOLD)
        if length > 0.0:
            x, y = way.standing(place, np.array((gap + DEPTH) / length))
            self._mark(Point(float(x), float(y)), AROUND_CONTACT)

    def state(self) -> list[str]:
        """Return what is known as texts."""
        return written(self._known)

    def restore(self, state: Sequence[str]) -> None:
        """Know what `state` said; ValueError or TypeError for anything else."""
        self._known = read(state, self.grid.shape, CONTACT)

    def _clear(self, place: Point, way: Way, far: float) -> None:
        """Learn that an attractor was not met in the first part of a way (in)."""
        length = way.length(place)
        if far >= 0.0 and length > 0.0:
            share = np.arange(0.0, far + 1e-9, self.grid.cell) / length
            self._known[self.grid.cells(*way.standing(place, share))] = CLEAR

    def _mark(self, place: Point, around: int) -> None:
        """Learn of contact in a cell and near it; what was found clear stays clear."""
        i, j = (int(number) for number in self.grid.cells(*place))
        near = self._known[max(i - around, 0) : i + around + 1, max(j - around, 0) : j + around + 1]
        near[near == UNKNOWN] = NEAR
        if self._known[i, j] != CLEAR:
            self._known[i, j] = CONTACT
