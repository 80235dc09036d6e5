"""How large the next physics steps may be.

Only the moment of contact needs small steps: there the tool penetrates the puck by as much as it
moves in one step. While tool and puck move on together, and no other part of the tool is near,
steps twice as long end in the same place, to some thousandths of an inch. What the pace is depends
on where puck and tool are, so a push that is started just before contact takes the same steps.
"""

import math
from collections.abc import Sequence

from affcli.core.geometry import ConvexPolygon, Point
from affcli.simulation.wrist_motion import STEP

STRIDE = 2
"""A long step is this many short ones."""
LOOK_AGAIN = 16
"""After at most this many short steps the distances are measured again."""
SETTLE = 8
"""A contact must last this many short steps before long ones: the impulse of the impact, from which
the engine starts the next step, has to fade."""
DEEP = 0.005
"""With more overlap than this (in) steps stay short, so that it is corrected before it can grow."""
MARGIN = 1.5
"""Puck and tool approach each other at most this much faster than the tool moves."""


class Pace:
    """Chooses step sizes during one push.

    Args:
        parts: convex parts of the tool (in, tool frame).
        radius: of the puck (in).
    """

    def __init__(self, parts: Sequence[ConvexPolygon], radius: float) -> None:
        # A box is its own bounding box; the distance to a part that is none takes longer to find.
        self._parts = [(*part.bounds, None if part.is_box else part) for part in parts]
        self._radius = radius
        self._touched = False

    def next(self, center: tuple[float, float], speed: float, left: int) -> tuple[int, int]:
        """Return how many short steps the next step takes, and how many such steps to make.

        Args:
            center: of the puck, from the tool's grasp point (in, tool frame).
            speed: no point of the tool moves faster (in/s).
            left: short steps left at this speed.
        """
        overlap, clearance = self._distances(*center)
        lasting, self._touched = overlap > 0.0 and self._touched, overlap > 0.0
        if overlap > DEEP or (overlap > 0.0 and not lasting):
            return 1, min(SETTLE, left)
        free = int(min(clearance / (MARGIN * speed * STEP), LOOK_AGAIN, left))
        if lasting and free >= STRIDE:
            return STRIDE, free // STRIDE
        return 1, max(1, free)

    def _distances(self, x: float, y: float) -> tuple[float, float]:
        """Return how deep the puck overlaps a part, 0 if none; how far the nearest other is (in).

        Of two parts that it overlaps, the second is no distance away.
        """
        overlap, clearance, radius = 0.0, math.inf, self._radius
        for left, bottom, right, top, slanted in self._parts:
            # `ConvexPolygon.box_distance`, written out: this is the innermost of our own loops.
            dx = left - x if x < left else x - right if x > right else 0.0
            dy = bottom - y if y < bottom else y - top if y > top else 0.0
            gap = math.hypot(dx, dy) - radius
            if gap < 0.0 and slanted is not None:
                gap = slanted.distance(Point(x, y)) - radius
            if gap < 0.0:
                clearance = 0.0 if overlap > 0.0 else clearance
                overlap = max(overlap, -gap)
            elif gap < clearance:
                clearance = gap
        return overlap, clearance
