"""The port of a goal: where the attractor is to be brought, as the robot sees it (§7.1)."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.observation import Observation


class Goal(Protocol):
    """A goal as the robot sees it."""

    @property
    def name(self) -> str:
        """What it is called."""

    @property
    def center(self) -> Point:
        """The place that distances are taken to (in, table frame)."""

    def reached(self, seen: Observation) -> bool:
        """Tell whether the attractor is seen where it is to be."""

    def squared_distance(
        self, at: Point, dx: NDArray[np.float64], dy: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return the squared distances (n,) (in^2) to the goal of the places `at` + (dx, dy)."""

    def outline(self) -> ConvexPolygon:
        """Return what to draw (in, table frame)."""
