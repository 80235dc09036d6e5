"""Tries that could be made next, and what is known of the way that each would take."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.choice import Reaches
from affcli.core.observation import Observation
from affcli.exploration.grid import Cells
from affcli.exploration.memory import Memory

Numbers = NDArray[np.float64]

STEP = MOVEMENT_THRESHOLD
"""Between two places of a way that are looked at (in): a push that begins one step before the end
is the shortest that T detects."""


@dataclass(frozen=True, slots=True)
class Tries:
    """Tries that could be made next, n of them, each looked at in k steps of its way.

    Args:
        call: which behavior, by its position (n,).
        x, y: where the attractor stands to the wrist when it begins (n,), in.
        travel: how the wrist would move (n, 2), in, table frame; 0 while that is not known.
        distance: of the steps from the beginning (k,), in.
        open: whether an attractor met there would be seen to move: the arm reaches on (n, k).
        cells: of the map of contacts, where the attractor is then (n, k).
    """

    call: NDArray[np.intp]
    x: Numbers
    y: Numbers
    travel: Numbers
    distance: Numbers
    open: NDArray[np.bool_]
    cells: Cells

    @classmethod
    def of(
        cls,
        call: NDArray[np.intp],
        place: Numbers,
        memory: Memory,
        seen: Observation,
        reaches: Reaches,
    ) -> "Tries":
        """Return tries with what the robot knows of their ways.

        Args:
            call: which behavior (n,).
            place: where the attractor would stand to the wrist (n, 2), in.
            memory: what the robot knows.
            seen: the latest observation.
            reaches: which wrist positions can be taken up.
        """
        travel, (x, y) = memory.travel[call], place.T
        length = np.hypot(*travel.T)
        distance = STEP * np.arange(int(length.max() / STEP) + 2.0)
        share = distance / np.where(length > 0.0, length, 1.0)[:, None]
        gone_x, gone_y = share * travel[:, :1], share * travel[:, 1:]
        wrist_x = (seen.object_x - x)[:, None] + gone_x
        wrist_y = (seen.object_y - y)[:, None] + gone_y
        x_on, y_on = wrist_x.ravel(), wrist_y.ravel()
        held = reaches(x_on, y_on, np.zeros(len(x_on))).reshape(share.shape)
        held = np.logical_and.accumulate(held, axis=1)
        on = np.zeros_like(held)
        on[:, :-1] = held[:, 1:] & (distance[1:] <= length[:, None] + 1e-9)
        cells = memory.contacts.grid.cells(x[:, None] - gone_x, y[:, None] - gone_y)
        return cls(call, x, y, travel, distance, on, cells)

    def effect(self, contact: Numbers) -> Numbers:
        """Return the probability that T = 1 (n,), from that of contact in each cell of the map."""
        effect: Numbers = 1.0 - self._missed(contact)[:, -1]
        return effect

    def movement(self, contact: Numbers) -> Numbers:
        """Return the movement of the attractor that is expected (n, 2) (in, table frame): on with
        the wrist, from where it is met, by the probability of contact in each cell of the map.
        """
        met = -np.diff(self._missed(contact), axis=1, prepend=1.0)
        length = np.hypot(*self.travel.T)
        left = np.cumsum(met * (length[:, None] - self.distance), axis=1)[:, -1]
        share: Numbers = left / np.where(length > 0.0, length, 1.0)
        moved: Numbers = self.travel * share[:, None]
        return moved

    def _missed(self, contact: Numbers) -> Numbers:
        """Return the probability that the attractor is not met up to each step (n, k)."""
        passed = np.where(self.open, 1.0 - contact[self.cells], 1.0)
        return np.multiply.accumulate(passed, axis=1)
