"""The affordance table in memory: rows in the order they were made, with columns for the query."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import PROBABILITY_THRESHOLD, Affordance, is_probable
from affcli.core.behavior import BehaviorCall
from affcli.core.observation import Observation

Rows = NDArray[np.intp]
"""Positions of rows in a table, in ascending order: lower is older."""

Made = TypeVar("Made")

COLOR_TOLERANCE = 45.0
"""Two colours are consistent when they differ by at most this much in RGB (Euclidean, 0 to 255).
Choice: more than the light makes of one thing's colour wherever it lies on the table (32, through
the camera), less than half the distance between the two most similar tools (57)."""


class AffordanceTable:
    """Affordances ordered by age, with numpy columns that the nested searches read.

    The columns of what was learned never change; the counters do. Colours are kept as classes: the
    first row of a new colour founds a class, later rows within `COLOR_TOLERANCE` join it.

    Attributes:
        movement_x, movement_y, movement_z: expected movement of each row (n,), in, table frame.
        offset_x, offset_y: attractor as seen from the wrist at the start of each row (n,), in.
        wrist_angle: the wrist's angle at the start of each row (n,), rad.
        times_used, times_successful: the counters (n,), int64.
        probable: whether the replication probability is greater than 1/2 (n,), kept up to date.
    """

    def __init__(self, rows: Iterable[Affordance] = ()) -> None:
        self._rows = sorted(rows, key=lambda row: row.step)
        movements = np.array([row.expected_movement for row in self._rows]).reshape(-1, 3)
        offsets = np.array([row.start.wrist_to_object for row in self._rows]).reshape(-1, 2)
        self.movement_x, self.movement_y, self.movement_z = np.ascontiguousarray(movements.T)
        self.offset_x, self.offset_y = np.ascontiguousarray(offsets.T)
        self.wrist_angle = np.array([row.wrist_angle for row in self._rows], dtype=np.float64)
        self.times_used = np.array([row.times_used for row in self._rows], dtype=np.int64)
        self.times_successful = np.array(
            [row.times_successful for row in self._rows], dtype=np.int64
        )
        self.probable = self.times_successful > PROBABILITY_THRESHOLD * self.times_used
        self._class_of, self._class_colors = _color_classes(self._rows)
        self._all = np.arange(len(self._rows))
        self._all.flags.writeable = False
        self._made: dict[object, Any] = {}

    def __len__(self) -> int:
        return len(self._rows)

    def __iter__(self) -> Iterator[Affordance]:
        return (self.row(i) for i in range(len(self)))

    def row(self, position: int) -> Affordance:
        """Return the row at `position` with its counters as they are now."""
        return replace(
            self._rows[position],
            times_used=int(self.times_used[position]),
            times_successful=int(self.times_successful[position]),
        )

    def as_learned(self) -> "AffordanceTable":
        """Return a table of the same rows whose counters can change without touching this one."""
        twin = object.__new__(AffordanceTable)
        twin.__dict__.update(self.__dict__)
        twin.times_used = self.times_used.copy()
        twin.times_successful = self.times_successful.copy()
        twin.probable = self.probable.copy()
        return twin

    def once(self, key: object, make: Callable[["AffordanceTable"], Made]) -> Made:
        """Return what is made of the columns of what was learned, which never change: made when it
        is first asked for, and shared by all tables of the same rows.

        Args:
            key: names it, with all else that it depends on.
            make: makes it; what it gives answers the same whenever it is asked, and no counter
                enters it but with a question.
        """
        if key not in self._made:
            self._made[key] = make(self)
        made: Made = self._made[key]
        return made

    def made_otherwise(self, holding: BehaviorCall | None) -> NDArray[np.bool_] | None:
        """Return whether each row was made with another grasp than this (n,); None when none was,
        or it is not known how the tool is held.
        """
        number, numbers = self.once("bindings", AffordanceTable._bindings)
        if holding is None or number.keys() <= {holding}:
            return None
        return np.asarray(numbers != number.get(holding, -1))

    def _bindings(self) -> tuple[dict[BehaviorCall, int], Rows]:
        """Number the binding behaviors of the rows; return these, and the number of each row (n,).

        Rows that were read share a few calls: to compare a million of them would take seconds.
        """
        calls = {id(row.binding): row.binding for row in self._rows}
        number = {call: n for n, call in enumerate(dict.fromkeys(calls.values()))}
        by_id = {key: number[call] for key, call in calls.items()}
        numbers = np.array([by_id[id(row.binding)] for row in self._rows], dtype=np.intp)
        return number, numbers

    def with_colors_of(self, seen: Observation) -> Rows:
        """Return the rows whose object and tool colours are consistent with `seen`, to be read."""
        fitting = np.array([_consistent(c, seen.colors) for c in self._class_colors], dtype=bool)
        if fitting.all():
            return self._all
        return np.flatnonzero(fitting[self._class_of])

    def count_use(self, position: int, *, success: bool) -> None:
        """Count one use of the row at `position`, as §3.2 does in testing trials."""
        self.times_used[position] += 1
        self.times_successful[position] += int(success)
        self.probable[position] = is_probable(
            int(self.times_successful[position]), int(self.times_used[position])
        )

    def more_probable_than(self, threshold: float) -> NDArray[np.bool_]:
        """Return whether each row's replication probability is greater than a threshold (n,)."""
        if threshold == PROBABILITY_THRESHOLD:
            return self.probable
        return np.asarray(self.times_successful > threshold * self.times_used)


def _consistent(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    """Tell whether two (object, tool) colour sextuples differ by little in each of the two.

    A colour that is not known (NaN) contradicts none.
    """
    pairs = [(x - y) ** 2 for x, y in zip(a, b, strict=True)]
    most = COLOR_TOLERANCE**2
    return not (sum(pairs[:3]) > most or sum(pairs[3:]) > most)


def _color_classes(rows: list[Affordance]) -> tuple[Rows, list[tuple[float, ...]]]:
    """Sort rows into colour classes; return each row's class (n,) and the founding colours."""
    founders: list[tuple[float, ...]] = []
    class_of = np.empty(len(rows), dtype=np.intp)
    for i, row in enumerate(rows):
        colors = row.start.colors
        found = next((k for k, c in enumerate(founders) if _consistent(c, colors)), None)
        if found is None:
            found = len(founders)
            founders.append(colors)
        class_of[i] = found
    return class_of, founders
