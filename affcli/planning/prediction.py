"""The table as a predictive model: what a behavior will do to the attractor (§6.1).

§6.1: "This affordance representation can also be interpreted as a *predictive* model of the results
of the exploratory behaviors."
"""

import math
from collections.abc import Iterable

import numpy as np

from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.core.observation import Movement

RADIUS = 1.5
"""How far from the attractor's place in a row, as seen from the wrist, the row still tells what
will happen (in). Choice, for the paper names no rule: on robots of seed 100, all five tools
together, the fewest answers are wrong at 1.25, and hits exceed false alarms by most at 2
(``experiments/verification``)."""

_Asked = tuple[BehaviorCall, BehaviorCall | None]
"""A behavior, and how the tool is held: None however it is."""

NO_MOVEMENT = Movement(0.0, 0.0, 0.0)


class TablePredictor:
    """Predicts by the nearest row, as a robot could that has nothing but its table.

    Args:
        rows: what was learned.
        radius: a row that starts farther away predicts nothing (in).
    """

    def __init__(self, rows: Iterable[Affordance], radius: float = RADIUS) -> None:
        self._radius = radius
        by_call: dict[_Asked, list[Affordance]] = {}
        for row in rows:
            for held in (row.binding, None):
                by_call.setdefault((row.exploratory, held), []).append(row)
        self._tables = {call: AffordanceTable(some) for call, some in by_call.items()}
        self._steps = {
            call: np.array([row.step for row in table]) for call, table in self._tables.items()
        }

    def predict(
        self,
        call: BehaviorCall,
        offset: Point,
        without: int | None = None,
        held: BehaviorCall | None = None,
    ) -> Movement:
        """Return the movement of the nearest row of this behavior and parameter.

        Args:
            call: what will be executed.
            offset: the attractor as seen from the wrist (in).
            without: the row of this step is not asked; None to ask all: a borrowed row
                can have step 0.
            held: how the tool is held: only rows that were made so are asked; None for all.

        Returns:
            No movement when no row is near enough; of equally near rows the older one's.
        """
        table = self._tables.get((call, held))
        if table is None:
            return NO_MOVEMENT
        dx, dy = table.offset_x - offset.x, table.offset_y - offset.y
        squared = dx * dx + dy * dy
        if without is not None:
            squared[self._steps[call, held] == without] = math.inf
        nearest = int(squared.argmin())
        if math.sqrt(float(squared[nearest])) > self._radius:
            return NO_MOVEMENT
        return table.row(nearest).expected_movement

    def mean_movement(
        self,
        call: BehaviorCall,
        without: int | None = None,
        held: BehaviorCall | None = None,
    ) -> Movement:
        """Return the mean movement of all rows of this behavior and parameter: wherever it lies.

        No movement when there are none. `without` and `held` are as in `predict`.
        """
        table = self._tables.get((call, held))
        if table is None:
            return NO_MOVEMENT
        steps = self._steps[call, held]
        asked = np.ones(len(steps), dtype=bool) if without is None else steps != without
        if not asked.any():
            return NO_MOVEMENT
        columns = (table.movement_x, table.movement_y, table.movement_z)
        return Movement(*(float(column[asked].mean()) for column in columns))
