"""How the wrist goes in a behavior, and how an attractor that it passes by comes to stand to it."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from affcli.core.geometry import Point

ARM = 12.0
"""At this distance from the wrist a turn and a move count as equally long when they move the tool
as far (in): about where tools have their ends."""


class Way(NamedTuple):
    """How the wrist goes, by the joint encoders: evenly along a line while it turns evenly.

    Exact for a straight move and for a turn about the wrist. Choice: a behavior of several segments
    is taken for one that does all of them at once, as a robot knows it that looks at its wrist
    before and after.

    Args:
        travel: how far (in, table frame).
        turn: by how much the hand turns, counter-clockwise (rad).
    """

    travel: Point
    turn: float

    def longer_than(self, other: "Way") -> bool:
        """Tell whether the tool moves farther in it, about `ARM` from the wrist."""
        mine, others = (math.hypot(*way.travel) + ARM * abs(way.turn) for way in (self, other))
        return mine > others

    def length(self, place: Point) -> float:
        """Return how far the tool moves by an attractor that stands here to the wrist (in)."""
        return math.hypot(*self.travel) + abs(self.turn) * math.hypot(*place)

    def standing(
        self, place: Point, share: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where an attractor that stays stands to the hand after shares of the way.

        Args:
            place: where it stands to the wrist at the beginning (in).
            share: of the way, from 0 to 1, of any shape.

        Returns:
            x and y (in, frame of the hand), of that shape.
        """
        x, y = place.x - share * self.travel.x, place.y - share * self.travel.y
        return turned(x, y, -share * self.turn)


def turned(
    x: ArrayLike, y: ArrayLike, angle: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return places turned about the wrist by angles (rad), all of one shape."""
    x, y = np.asarray(x), np.asarray(y)
    cos, sin = np.cos(angle), np.sin(angle)
    return cos * x - sin * y, sin * x + cos * y
