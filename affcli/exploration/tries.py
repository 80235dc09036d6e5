"""Tries that could be made next, and what is known of the way that each would take."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.choice import Reaches
from affcli.core.observation import Observation
from affcli.exploration.grid import Cells
from affcli.exploration.memory import Memory
from affcli.exploration.way import turned

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
        turn: by how much it would turn (n,), rad; 0 while that is not known.
        length: how far the tool would move where the attractor stands (n,), in.
        distance: of the steps from the beginning (k,), in.
        open: whether an attractor met there would be seen to move: the arm reaches on (n, k).
        cells: of the map of contacts, where the attractor is then (n, k).
    """

    call: NDArray[np.intp]
    x: Numbers
    y: Numbers
    travel: Numbers
    turn: Numbers
    length: Numbers
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
        ways = np.array([[*way.travel, way.turn] for way in memory.ways])[call]
        travel, turn, (x, y) = ways[:, :2], ways[:, 2], place.T
        length = np.hypot(*travel.T) + np.abs(turn) * np.hypot(x, y)
        distance = STEP * np.arange(int(length.max() / STEP) + 2.0)
        share = distance / np.where(length > 0.0, length, 1.0)[:, None]
        gone_x, gone_y = share * travel[:, :1], share * travel[:, 1:]
        angle = share * turn[:, None]
        wrist_x = (seen.object_x - x)[:, None] + gone_x
        wrist_y = (seen.object_y - y)[:, None] + gone_y
        held = reaches(wrist_x.ravel(), wrist_y.ravel(), angle.ravel()).reshape(share.shape)
        held = np.logical_and.accumulate(held, axis=1)
        on = np.zeros_like(held)
        on[:, :-1] = held[:, 1:] & (distance[1:] <= length[:, None] + 1e-9)
        cells = memory.contacts.grid.cells(
            *turned(x[:, None] - gone_x, y[:, None] - gone_y, -angle)
        )
        return cls(call, x, y, travel, turn, length, distance, on, cells)

    def effect(self, contact: Numbers) -> Numbers:
        """Return the probability that T = 1 (n,), from that of contact in each cell of the map."""
        effect: Numbers = 1.0 - self._missed(contact)[:, -1]
        return effect

    def movement(self, contact: Numbers) -> Numbers:
        """Return the movement of the attractor that is expected (n, 2) (in, table frame): on with
        the wrist, from where it is met, by the probability of contact in each cell of the map.
        """
        met = -np.diff(self._missed(contact), axis=1, prepend=1.0)
        length = self.length
        left = np.cumsum(met * (length[:, None] - self.distance), axis=1)[:, -1]
        share: Numbers = left / np.where(length > 0.0, length, 1.0)
        moved: Numbers = self.travel * share[:, None]
        if self.turn.any():
            moved += self._swung(met)
        return moved

    def _swung(self, met: Numbers) -> Numbers:
        """Return how far the attractor is expected to be carried about the wrist by turns (n, 2)
        (in, table frame), by the probability that it is met at each step (n, k).
        """
        gone = self.distance / np.where(self.length > 0.0, self.length, 1.0)[:, None]
        x = self.x[:, None] - gone * self.travel[:, :1]
        y = self.y[:, None] - gone * self.travel[:, 1:]
        end_x, end_y = turned(x, y, (1.0 - gone) * self.turn[:, None])
        swung: Numbers = np.stack(
            [(met * (end - begin)).sum(axis=1) for end, begin in ((end_x, x), (end_y, y))], axis=1
        )
        return swung

    def _missed(self, contact: Numbers) -> Numbers:
        """Return the probability that the attractor is not met up to each step (n, k)."""
        passed = np.where(self.open, 1.0 - contact[self.cells], 1.0)
        return np.multiply.accumulate(passed, axis=1)
