"""The row that is expected to leave the attractor nearest to the goal: search 3 without search 4.

Where the paper's search 4 trades distance to the goal for a short way of the wrist (§6.2), this
planner trades nothing.
"""

import math
from dataclasses import dataclass

import numpy as np

from affcli.core.affordance import PROBABILITY_THRESHOLD, REPLICATION_ANGLE_DEGREES
from affcli.core.affordance_table import AffordanceTable, Rows
from affcli.core.choice import Candidate, Choice, Reason, Reasons, Situation
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.planning.neighbours import smoothed
from affcli.planning.nested_query import JUDGING, REGRASP, carrying, regrasping, usable_rows
from affcli.planning.row_model import Floats, RowModel


@dataclass(frozen=True, slots=True)
class OneStep:
    """The least expected distance; a `Planner`. Of equally near rows the older, however far the
    wrist goes and whatever grasp it wants.

    Args:
        threshold, angle_degrees: as in `NestedQuery`.
    """

    threshold: float = PROBABILITY_THRESHOLD
    angle_degrees: float = REPLICATION_ANGLE_DEGREES

    def choose(self, situation: Situation) -> Choice:
        """Return the row of the least expected distance."""
        rows, distance, reasons = self._weighed(situation)
        if not len(rows):
            return Choice(None, reasons)
        nearest = int(distance.argmin())
        found = Reason("expected distance", None, float(distance[nearest]))
        return Choice(int(rows[nearest]), (*reasons, found))

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return the rows within reach, the nearest expected end first."""
        rows, distance, _ = self._weighed(situation)
        return candidates(situation, rows, distance, np.argsort(distance, kind="stable"))

    def _weighed(self, situation: Situation) -> tuple[Rows, Floats, Reasons]:
        """Return the rows that can be used, the distance each expects, and how many are left."""
        _, rows, reasons = usable_rows(situation, self.threshold)
        model = self._model(situation.table)
        moved = model.movement_x[rows], model.movement_y[rows]
        squared = situation.goal.squared_distance(situation.seen.object_position, *moved)
        # Of what is spread about a place, the mean of the squared distances is this sum.
        squared += model.spread[rows] ** 2
        return rows, np.sqrt(squared), reasons

    def _model(self, table: AffordanceTable) -> RowModel:
        """Return what rows are expected to do."""
        return RowModel.of(table)


@dataclass(frozen=True, slots=True)
class Robust(OneStep):
    """The least expected distance, where a row is believed as far as its neighbours bear it out.

    The more rows, the more of them were lucky: a puck that slipped off a corner just so. The least
    of many distances falls for those. Here the neighbours of a row, which are the rows of the same
    behavior from nearly the same place, give its expected movement and how far it is spread; the
    least root of the mean squared distance is chosen. A `Planner`.

    Args:
        radius: how far from a row's place, as seen from the wrist, its neighbours lie (in).
    """

    radius: float = 0.6

    def _model(self, table: AffordanceTable) -> RowModel:
        """Return what rows and their neighbours are expected to do."""
        return smoothed(table, self.radius)


def candidates(
    situation: Situation, rows: Rows, distance: Floats, order: Rows, regrasp: float = REGRASP
) -> tuple[Candidate, ...]:
    """Return rows as candidates.

    Args:
        situation: where the robot stands.
        rows: by their positions in the table (n,).
        distance: that each expects (n,) (in).
        order: which of them come first (m,).
        regrasp: a new grasp counts as so much re-positioning (in).
    """
    dx, dy = carrying(situation.table, rows, situation.seen, situation.wrist)
    anew = regrasping(situation, rows, regrasp)
    more = np.zeros(len(rows)) if anew is None else anew
    return tuple(
        Candidate(int(rows[i]), float(distance[i]), math.hypot(dx[i], dy[i]) + float(more[i]))
        for i in order
    )


PARTS = (
    Part(
        kind="planners",
        name="one-step",
        summary="the row whose expected end is nearest to the goal, however far the wrist goes",
        source="Stoytchev 2008, §6.2, without the fourth search",
        build=OneStep,
        params=JUDGING,
    ),
    Part(
        kind="planners",
        name="robust",
        summary="as one-step, but a row is believed as far as its neighbours bear it out",
        source="affcli",
        build=Robust,
        params={
            **JUDGING,
            "radius": Setting(
                *(0.6, "in"),
                "How far from a row's place, as seen from the wrist, its neighbours lie.",
                *(0.05, 5.0),
            ),
        },
    ),
)
