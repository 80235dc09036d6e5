"""Tasks: bring the attractor from a start over a goal region (§7.1, Fig. 8)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.observation import Observation

ALL_STARTS = "all"
"""Asks for a task from each start; no start has this name."""


@dataclass(frozen=True, slots=True)
class GoalRegion:
    """A colour-coded square on the table; a `Goal` of `core.goal`.

    Args:
        name: what the goal is called: ``1`` to ``4`` as in Fig. 8, or another name.
        center: of the square (in, table frame).
        half_width: half its side (in).
    """

    name: str
    center: Point
    half_width: float

    def contains(self, point: Point) -> bool:
        """Tell whether `point` (in, table frame) lies inside the square or on its edge."""
        return (
            abs(point.x - self.center.x) <= self.half_width
            and abs(point.y - self.center.y) <= self.half_width
        )

    def reached(self, seen: Observation) -> bool:
        """Tell whether the attractor is seen over the region."""
        return self.contains(seen.object_position)

    def squared_distance(
        self, at: Point, dx: NDArray[np.float64], dy: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return the squared distances to the region's centre of the places `at` + (dx, dy).

        Choice: the paper's "distance between the attractor object and the goal region" (§6.2) is
        taken to the region's centre.

        Args:
            at: a place (in, table frame).
            dx, dy: movements from there (n,), (n,) (in).

        Returns:
            (n,), in^2.
        """
        x = dx + (at.x - self.center.x)
        y = dy + (at.y - self.center.y)
        x *= x
        y *= y
        x += y
        return x

    def outline(self) -> ConvexPolygon:
        """Return the region's outline (in, table frame)."""
        (x, y), h = self.center, self.half_width
        return ConvexPolygon.box(x - h, y - h, x + h, y + h)


@dataclass(frozen=True, slots=True)
class Task:
    """One task: a goal, and where the attractor begins.

    Args:
        task_set: the set it is one of: ``extension-of-reach``.
        goal: the region to bring the attractor over.
        start_name: what the start is called: ``1`` to ``4`` as in Fig. 8, or another name.
        start: where the attractor begins (in, table frame).
    """

    task_set: str
    goal: GoalRegion
    start_name: str
    start: Point


def tasks_json(tasks: tuple[Task, ...]) -> list[list[Any]]:
    """Return tasks by value as JSON types."""
    return [
        [t.task_set, t.goal.name, *t.goal.center, t.goal.half_width, t.start_name, *t.start]
        for t in tasks
    ]
