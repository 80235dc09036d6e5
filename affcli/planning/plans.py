"""What planners that look ahead share: when a path is at the goal, and how a plan is told."""

import math

import numpy as np
from numpy.typing import NDArray

from affcli.core.choice import Move, Reason
from affcli.core.goal import Goal
from affcli.planning.row_model import Floats

INSIDE = 0.1
"""A path ends at the goal when it ends so far inside its outline (in), or 0.4 of the way to its
middle where the goal is small: what is seen and done is never exact."""
SMALL_GOAL = 0.4
STEPS_INSIDE = 0.05
"""Of two paths to the goal that are equally long the one is better that ends nearer to its middle:
an inch is worth so many steps."""
REPOSITIONING = 0.02
"""An inch that the wrist is carried to the first row is worth so many inches of distance: ties."""
FURTHER = 1.0
"""Steps that it costs on top to use a row whose behavior met the edge of the reach where it will
not: where that ends is not known, and a further step has to make up for it."""
CLOSE = 3
"""Plans told beside the one that is followed."""


class HalfPlanes:
    """A goal as what lies well inside each edge of its outline."""

    def __init__(self, goal: Goal) -> None:
        self._edges = []
        for a, b in goal.outline().edges:
            length = math.dist(a, b)
            nx, ny = (a.y - b.y) / length, (b.x - a.x) / length
            middle = nx * (goal.center.x - a.x) + ny * (goal.center.y - a.y)
            inside = min(INSIDE, SMALL_GOAL * middle)
            self._edges.append((nx, ny, nx * a.x + ny * a.y + inside))

    def hold(self, x: Floats, y: Floats) -> NDArray[np.bool_]:
        """Tell for each place (n,), (n,) (in, table frame) whether it lies in the goal."""
        held = np.ones(len(x), dtype=bool)
        for nx, ny, least in self._edges:
            held &= nx * x + ny * y >= least
        return held


def told(steps: float | None, moves: tuple[Move, ...], *, followed: bool) -> Reason:
    """Return a plan as a reason: what it is, and what it should cost to the goal in steps; or
    without a way there, which is None, how many moves it looks ahead.
    """
    if steps is not None:
        return Reason("plan" if followed else "other plan", None, steps, moves)
    name = "plan that ends short of the goal" if followed else "other plan that ends short"
    return Reason(name, None, None, moves)
