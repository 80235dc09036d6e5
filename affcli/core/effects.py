"""What a behavior did to the attractor, counted over all that was tried: which tool pulls?"""

from enum import StrEnum
from typing import NamedTuple

from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point


class Way(StrEnum):
    """Where to an attractor is moved, as the robot sees it."""

    NEARER = "nearer"
    FARTHER = "farther"
    LEFT = "left"
    RIGHT = "right"

    @property
    def direction(self) -> Point:
        """The unit vector (table frame): x to the right, y away from the robot."""
        return {
            Way.NEARER: Point(0.0, -1.0),
            Way.FARTHER: Point(0.0, 1.0),
            Way.LEFT: Point(-1.0, 0.0),
            Way.RIGHT: Point(1.0, 0.0),
        }[self]


class Effect(NamedTuple):
    """How often a behavior moved the attractor so far, in one learning run.

    Args:
        call: the behavior, with its parameters.
        tried: how often it was executed.
        moved: how often it moved the attractor the way that is asked about by more than so much.
        rows: how many rows it made.
        alive: how many of these have a replication probability greater than 1/2.
    """

    call: BehaviorCall
    tried: int
    moved: int
    rows: int
    alive: int
