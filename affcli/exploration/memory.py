"""What a robot that explores with a purpose remembers of its tries; strategies share it."""

import math
from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import ExecutionStatus
from affcli.core.geometry import Point
from affcli.core.observation import movement
from affcli.core.trial import BabblingRecord
from affcli.exploration.contact_map import ContactMap
from affcli.exploration.row_map import RowMap
from affcli.exploration.way import Way

VERSION = 2
"""Of the state."""
LOOKS = 3
"""A behavior is tried until it was done whole, at most so often, to know how it moves the wrist."""
FARTHEST = 1e6
"""No wrist goes farther (in) or turns more (rad)."""


class Memory:
    """What a robot knows by its tries, and no more.

    Args:
        behaviors: how many exploratory behaviors there are; each is known by its position.
        box: of babbling.
        cell: width of a cell of the map of contacts (in).
        contact: the probability of contact in a cell of which nothing is known.
        near: how near rows make each other less new (in).
        place: width of the cells of the table in which the attractor's places are counted (in).

    Attributes:
        contacts: where the attractor can be to the wrist and not be.
        rows: where rows of each behavior start.
        ways: the longest way of the wrist in each behavior, by its position.
        looks: how often each is to be tried before its way is known (n,).
    """

    def __init__(
        self,
        behaviors: int,
        box: BabblingSettings,
        *,
        cell: float,
        contact: float,
        near: float,
        place: float,
    ) -> None:
        self.contacts = ContactMap(box, cell, contact)
        self.rows = RowMap(behaviors, box, cell, near)
        self.ways = [Way(Point(0.0, 0.0), 0.0)] * behaviors
        self.looks = np.full(behaviors, LOOKS)
        self._place = place
        self._places: Counter[tuple[int, int]] = Counter()

    def learn(self, call: int, record: BabblingRecord) -> None:
        """Remember what came of a behavior: how far the wrist truly went, and what was seen."""
        execution, place = record.execution, record.start.wrist_to_object
        before, after = execution.wrist_start, execution.wrist_end
        way = Way(Point(after.x - before.x, after.y - before.y), after.angle - before.angle)
        if way.longer_than(self.ways[call]):
            self.ways[call] = way
        done = execution.status is ExecutionStatus.DONE
        self.looks[call] = 0 if done else max(self.looks[call] - 1, 0)
        x, y = record.start.object_position
        self._places[math.floor(x / self._place), math.floor(y / self._place)] += 1
        if record.affordance is None:
            self.contacts.passed(place, way)
        else:
            self.rows.add(call, place)
            self.contacts.pushed(place, way, movement(record.start, record.end).distance)

    def visits(self, places: NDArray[np.float64]) -> NDArray[np.int64]:
        """Return how many behaviors began with the attractor about each place (n, 2) (in)."""
        cells = np.floor(places / self._place).astype(int).tolist()
        return np.array([self._places[i, j] for i, j in cells], dtype=np.int64)

    def state(self) -> dict[str, Any]:
        """Return all of it as JSON types."""
        return {
            "version": VERSION,
            "contacts": self.contacts.state(),
            "rows": self.rows.state(),
            "ways": [[*way.travel, way.turn] for way in self.ways],
            "looks": self.looks.tolist(),
            "places": sorted([*place, times] for place, times in self._places.items()),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Remember what `state` said; ValueError, KeyError or TypeError for anything else."""
        if state["version"] != VERSION:
            raise ValueError(f"state {state['version']!r}, not {VERSION}")
        ways, looks = np.array(state["ways"], dtype=float), np.array(state["looks"], dtype=int)
        if ways.shape != (len(self.ways), 3) or not (np.abs(ways) <= FARTHEST).all():
            raise ValueError("not a way of the wrist for each behavior")
        if looks.shape != self.looks.shape or not ((looks >= 0) & (looks <= LOOKS)).all():
            raise ValueError("not a number of looks for each behavior")
        self.contacts.restore(state["contacts"])
        self.rows.restore(state["rows"])
        self.ways = [Way(Point(x, y), turn) for x, y, turn in ways.tolist()]
        self.looks = looks
        self._places = Counter({(int(i), int(j)): int(n) for i, j, n in state["places"]})
