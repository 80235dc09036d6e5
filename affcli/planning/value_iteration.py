"""Planning over the whole table as a stochastic model: what every place is worth.

§7.1 proposes to plan "2 or 3 moves ahead". A sparse table may hold no way of so few moves, and of
two rows that come as near to the goal one may leave the attractor where hardly any row can be used.
Here every place costs the steps that it is expected to take from there to the goal, and the row is
used that is expected to cost least.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import PROBABILITY_THRESHOLD, REPLICATION_ANGLE_DEGREES
from affcli.core.affordance_table import Rows
from affcli.core.choice import Candidate, Choice, Move, Reason, Reasons, Situation
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.planning.nested_query import JUDGING, carrying, usable_rows
from affcli.planning.one_step import candidates
from affcli.planning.plans import (
    CLOSE,
    FURTHER,
    REPOSITIONING,
    STEPS_INSIDE,
    HalfPlanes,
    told,
)
from affcli.planning.row_model import SIDE, Ends, Floats, RowModel

HOPELESS = 60.0
"""Steps that a place costs at most, and one from which no row can be used: those after which a
trial ends (§7.1)."""
FINEST, MOST_PLACES = 0.5, 16_000
"""Inches between places at least, and places whose worth is worked out at most: so fine a grid over
60 by 60 in, farther than an arm reaches."""
MOST_ROWS = 200
"""Rows that the worth of places is worked out with, of those alike the oldest, also when it is
excluded; the row to use is chosen among all."""
SWEEPS, SETTLED = 100, 0.01
"""How often the worths are worked out anew from each other at most, and the change of any (steps)
at which they are left."""
LONGEST_TOLD = 4
"""Moves that are told of the plan which is followed; of those that came close the first."""

Numbers = NDArray[np.int64]
Made = TypeVar("Made")


@dataclass(frozen=True, slots=True)
class ValueIteration:
    """The row that is expected to leave the fewest steps to the goal, however far it is; a
    `Planner`.

    Choice: a use of a row costs as many steps as it is tried until it does what it did, one over
    its replication probability. Whether it arrives is judged by where it is expected to end, as in
    `Lookahead`; the place from which it goes on is uncertain by 0.7 of a cell along each axis. A
    place from which no row can be used costs `HOPELESS` steps, and so does one that the rows do not
    lead to the goal from.

    Args:
        cell: how far apart the places lie whose worth is worked out (in); between them it is
            interpolated.
        threshold, angle_degrees: as in `NestedQuery`.
    """

    cell: float = 1.0
    threshold: float = PROBABILITY_THRESHOLD
    angle_degrees: float = REPLICATION_ANGLE_DEGREES

    def choose(self, situation: Situation) -> Choice:
        """Return the row of the least expected steps, with the plan, and those that came close."""
        outlook, reasons = self._outlook(situation)
        if outlook is None:
            # Of the rows within reach none should do anything: that is why there is no plan.
            return Choice(None, (*reasons, Reason("expected to move the attractor", 0)))
        best, *others = outlook.order()[: 1 + CLOSE]
        followed = told(*outlook.plan(best, LONGEST_TOLD), followed=True)
        close = (told(*outlook.plan(other, 1), followed=False) for other in others)
        return Choice(int(outlook.first.row[best]), (*reasons, followed, *close))

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return the rows that can be used, the one of the least expected steps first."""
        outlook, _ = self._outlook(situation)
        if outlook is None:
            return ()
        return candidates(situation, outlook.first.row, outlook.away, outlook.order())

    def _outlook(self, situation: Situation) -> tuple["_Outlook | None", Reasons]:
        """Return what can be done and what it leads to, None when nothing can; and how many rows
        could be used.
        """
        probable, _, reasons = usable_rows(situation, self.threshold)
        table = situation.table
        steps = np.full(len(table), np.inf)
        steps[probable] = table.times_used[probable] / table.times_successful[probable]
        at = situation.seen.object_position
        here = np.array([at.x]), np.array([at.y])
        arm = situation.reaches, situation.slides
        first = RowModel.of(table).ends(probable, *here, *arm)
        if not len(first.row):
            return None, reasons
        worths = table.once(("value iteration", self.cell), lambda _: _Worths(self.cell))
        return _Outlook(situation, first, steps, worths), reasons


class _Between(NamedTuple):
    """Places between those that are known.

    Args:
        about: the four known places about each (4, n): to the lower and the upper left, to the
            lower and the upper right.
        u, v: how far on from the first of them each lies along x and y (n,), in cells.
    """

    about: Rows
    u: Floats
    v: Floats


class _Places:
    """The places of a grid that something is known of; all others count as one, the last.

    Args:
        number: their numbers, ascending (n,).
        cell: how far apart they lie (in).
    """

    def __init__(self, number: Numbers, cell: float) -> None:
        self._number, self._cell = number, cell
        self._left, self._right = self.index(number - SIDE), self.index(number + SIDE)
        self._below, self._above = self.index(number - 1), self.index(number + 1)

    def __len__(self) -> int:
        return len(self._number) + 1

    def index(self, number: Numbers) -> Rows:
        """Return which places these numbers are of (n,)."""
        at = np.minimum(np.searchsorted(self._number, number), len(self._number) - 1)
        return np.where(self._number[at] == number, at, len(self._number))

    def unknown(self, x: Floats, y: Floats) -> Numbers:
        """Return those that some places' worth depends on and that nothing is known of."""
        return np.setdiff1d(_around(x, y, self._cell), self._number)

    def between(self, x: Floats, y: Floats) -> _Between:
        """Return where places (n,), (n,) (in) lie."""
        across, along = x / self._cell, y / self._cell
        column, line = np.floor(across), np.floor(along)
        number = column.astype(np.int64) * SIDE + line.astype(np.int64)
        about = np.array([self.index(number + step) for step in (0, 1, SIDE, SIDE + 1)])
        return _Between(about, across - column, along - line)

    def expected(self, worth: Floats, place: _Between) -> Floats:
        """Return the mean worth about some places (n,), weighed 1, 2, 1 along each axis, from that
        of each place that is known.
        """
        spread = _weighed(_weighed(worth, self._left, self._right), self._below, self._above)
        left, upper_left, right, upper_right = spread[place.about]
        left += place.v * (upper_left - left)
        right += place.v * (upper_right - right)
        return np.asarray(left + place.u * (right - left))


def _weighed(worth: Floats, before: Rows, after: Rows) -> Floats:
    """Return the mean worth of each place, weighed 2, and of its neighbours on two sides; that of
    the last, which is all others, as it is.
    """
    mean = 0.25 * worth[before] + 0.5 * worth[:-1] + 0.25 * worth[after]
    return np.append(mean, worth[-1])


class _Ways:
    """What the rows of a table do from each place that they lead to, whatever the goal is: from
    where the attractor lay when they were made, and on.

    Args:
        situation: whose table and whose arm; nothing else of it counts.
        cell: as in `ValueIteration`.
        more: places to begin from, too, by their numbers.
    """

    def __init__(self, situation: Situation, cell: float, more: Numbers) -> None:
        table = situation.table
        self._model = RowModel.of(table)
        self.rows = self._model.thinned(np.arange(len(table)), MOST_ROWS)
        begun = np.array([row.start.object_position for row in table])
        new = np.union1d(more, _around(begun[:, 0], begun[:, 1], cell))
        known = np.zeros(0, dtype=np.int64)
        parts = []
        while len(new := new[: MOST_PLACES - len(known)]):
            known = np.union1d(known, new)
            x, y = (cell * part.astype(np.float64) for part in _decoded(new))
            ends = self.ends(situation, self.rows, x, y)
            parts.append((new[ends.place], *ends[1:]))
            new = np.setdiff1d(_around(ends.x, ends.y, cell), known)
        number, row, x, y, further = (np.concatenate(part) for part in zip(*parts, strict=True))
        self.places = _Places(known, cell)
        # The ends from one place stand together: where those of each begin, and which it is.
        order = np.argsort(number, kind="stable")
        self.row, self.further, self.x, self.y = (one[order] for one in (row, further, x, y))
        begun_from, self._begins = np.unique(number[order], return_index=True)
        self._from = self.places.index(begun_from)
        self._end = self.places.between(self.x, self.y)

    def ends(self, situation: Situation, rows: Rows, x: Floats, y: Floats) -> Ends:
        """Return what rows do from some places."""
        return self._model.ends(rows, x, y, situation.reaches, situation.slides)

    def worth(self, steps: Floats, goal: HalfPlanes) -> Floats:
        """Return the expected steps from each place to a goal; from all others, the last, they are
        hopeless.

        Args:
            steps: that a use of each row of the table costs (n,).
            goal: where none is left.
        """
        cost = steps[self.row] + FURTHER * self.further
        goes_on = ~goal.hold(self.x, self.y)
        worth = np.full(len(self.places), HOPELESS)
        for _ in range(SWEEPS if len(self._begins) else 0):
            whole = cost + goes_on * self.places.expected(worth, self._end)
            better = worth.copy()
            better[self._from] = np.minimum(np.minimum.reduceat(whole, self._begins), HOPELESS)
            change, worth = float(np.abs(better - worth).max()), better
            if change < SETTLED:
                break
        return worth


class _Latest:
    """Remembers what was made last: a trial asks for the same again and again."""

    def __init__(self) -> None:
        self._latest: tuple[object, object] | None = None

    def get(self, key: object, make: Callable[[], Made]) -> Made:
        """Return what was made for an equal key just before, or make it."""
        latest = self._latest
        if latest is None or latest[0] != key:
            # Key and value together: who asks meanwhile never finds the one without the other.
            self._latest = latest = key, make()
        made: Made = latest[1]  # type: ignore[assignment]
        return made


class _Worths:
    """The ways of a table and the worths of places. The latest of each are remembered, and each
    answer is the one that nothing remembered would give.
    """

    def __init__(self, cell: float) -> None:
        self._cell = cell
        self._ways, self._wider, self._worth = _Latest(), _Latest(), _Latest()

    def of(
        self, situation: Situation, first: Ends, steps: Floats, goal: HalfPlanes
    ) -> tuple[_Ways, Floats]:
        """Return the ways, and what each of their places is worth: for that arm and that goal.

        Args:
            situation: where the robot stands.
            first: what can be done there.
            steps: that a use of each row costs (n,).
            goal: that of the situation.
        """
        arm, more = (situation.reaches, situation.slides), np.zeros(0, dtype=np.int64)
        ways = self._ways.get(arm, lambda: _Ways(situation, self._cell, more))
        if len(unknown := ways.places.unknown(first.x, first.y)):
            wider = (*arm, unknown.tobytes())
            ways = self._wider.get(wider, lambda: _Ways(situation, self._cell, unknown))
        key = (ways, situation.goal, steps.tobytes())
        return ways, self._worth.get(key, lambda: ways.worth(steps, goal))


class _Outlook:
    """What can be done in a situation, and how many steps each is expected to cost.

    Args:
        situation: where the robot stands.
        first: what the rows that may be used do.
        steps: that a use of each row of the table costs (n,); infinite for the others.
        worths: what remembers what places are worth.
    """

    def __init__(self, situation: Situation, first: Ends, steps: Floats, worths: _Worths) -> None:
        self._situation, self._steps = situation, steps
        self._goal = HalfPlanes(situation.goal)
        self._ways, self._worth = worths.of(situation, first, steps, self._goal)
        self._at = situation.seen.object_position
        self.first, self.away, self._cost = first, self._away(first), self._expected(first)
        carries = carrying(situation.table, first.row, situation.seen, situation.wrist)
        carried = REPOSITIONING * np.hypot(*carries)
        self._live = self._ways.rows[np.isfinite(steps[self._ways.rows])]
        self._whole = self._cost + STEPS_INSIDE * (self.away + carried)

    def order(self) -> Rows:
        """Return the first moves, that of the fewest steps first; of equally good ones the older
        row.
        """
        return np.argsort(self._whole, kind="stable")

    def plan(self, at: int, most: int) -> tuple[float | None, tuple[Move, ...]]:
        """Return where a first move should lead: the steps to the goal, None when it is hopeless,
        and the moves, so many at most.
        """
        ends, moves, cost = self.first, list[Move](), float(self._cost[at])
        while len(ends.row):
            row = self._situation.table.row(int(ends.row[at]))
            x, y = ends.x[at : at + 1], ends.y[at : at + 1]
            moves.append(Move(row.step, str(row.exploratory), float(x[0]), float(y[0])))
            if len(moves) == most or self._goal.hold(x, y).all():
                break
            ends = self._ways.ends(self._situation, self._live, x, y)
            if len(ends.row):
                at = int((self._expected(ends) + STEPS_INSIDE * self._away(ends)).argmin())
        return (cost if cost < HOPELESS else None), tuple(moves)

    def _away(self, ends: Ends) -> Floats:
        """Return how far from the goal's middle some ends lie (n,) (in)."""
        dx, dy = ends.x - self._at.x, ends.y - self._at.y
        return np.sqrt(self._situation.goal.squared_distance(self._at, dx, dy))

    def _expected(self, ends: Ends) -> Floats:
        """Return the steps that it is expected to take to the goal by some moves (n,)."""
        places = self._ways.places
        goes_on = ~self._goal.hold(ends.x, ends.y)
        left = goes_on * places.expected(self._worth, places.between(ends.x, ends.y))
        return np.asarray(self._steps[ends.row] + FURTHER * ends.further + left)


def _around(x: Floats, y: Floats, cell: float) -> Numbers:
    """Return the places of a grid that some places' worth depends on, by their numbers, ascending:
    the four about each, and their neighbours.
    """
    column, line = (np.floor(part / cell).astype(np.int64) for part in (x, y))
    below, near = np.unique(column * SIDE + line), np.arange(-1, 3)
    return np.unique(below[:, None, None] + near[:, None] * SIDE + near)


def _decoded(number: Numbers) -> tuple[Numbers, Numbers]:
    """Return the columns and lines of numbered places, in cells from the table frame's middle."""
    column = (number + SIDE // 2) // SIDE
    return column, number - column * SIDE


PARTS = (
    Part(
        kind="planners",
        name="value-iteration",
        summary="the fewest expected steps to the goal, from what every place is worth",
        source="Stoytchev 2008, §7.1 (planning ahead), over the whole table",
        build=ValueIteration,
        params={
            "cell": Setting(
                *(1.0, "in"),
                "How far apart the places lie whose worth is worked out.",
                *(FINEST, 10.0),
            ),
            **JUDGING,
        },
    ),
)
