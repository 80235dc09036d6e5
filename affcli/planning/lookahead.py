"""Planning ahead: paths of rows until the goal, of which the first row is used (§7.1).

§7.1: "If the robot plans the possible movements of the puck for 2 or 3 moves ahead these failures
will be eliminated."
"""

import math
from dataclasses import dataclass

import numpy as np

from affcli.core.affordance import PROBABILITY_THRESHOLD, REPLICATION_ANGLE_DEGREES
from affcli.core.affordance_table import Rows
from affcli.core.choice import Candidate, Choice, Move, Reason, Reasons, Situation
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.planning.neighbours import smoothed
from affcli.planning.nested_query import (
    JUDGING,
    REGRASP,
    REGRASPING,
    carrying,
    regrasping,
    usable_rows,
)
from affcli.planning.one_step import candidates
from affcli.planning.plans import (
    CLOSE,
    FURTHER,
    REPOSITIONING,
    STEPS_INSIDE,
    HalfPlanes,
    told,
)
from affcli.planning.row_model import CELL, LARGEST_CELL, Ends, Floats, RowModel, first_in_cells

DEEPEST, WIDEST = 8, 400
"""Limits of a search: moves ahead, and places from which each further move is looked for."""
MOST_ROWS = 400
"""Rows among which the second and further moves are looked for. The first is chosen among all: of a
later one it is enough to know that there is one like it, for it is planned anew."""
STEPS_TO_GO = 1.0
"""Steps that each inch to the goal is taken to cost a path that does not lead there: more than it
does, so that a path that comes nearer is worth its further moves."""
NO_WAY, DEAD_END = 1e3, 1e5
"""Steps that are added to a path that does not lead to the goal, and to one after which no row can
be used: both are more than any path has."""
LOOKED_AT = 40
"""Of the paths that do not lead to the goal so many are looked at for whether a row is left."""


@dataclass(frozen=True, slots=True)
class _Layer:
    """The paths of equally many moves, by what their last move is expected to do.

    Args:
        x, y: where each leaves the attractor (n,) (in, table frame).
        cost: steps that it is expected to take (n,).
        first, row: its first and its last row, by their positions in the table (n,).
        parent: which path of the layer before it goes on from (n,).
        worth: steps that it costs, all told, if it ends here (n,); the least is best.
    """

    x: Floats
    y: Floats
    cost: Floats
    first: Rows
    row: Rows
    parent: Rows
    worth: Floats


@dataclass(frozen=True, slots=True)
class Lookahead:
    """Searches paths of rows, fewest expected steps to the goal first; a `Planner`.

    A step costs one over the row's replication probability: as often as it fails it is tried again.
    Where no path leads to the goal, that is followed which ends nearest to it with some row left to
    use. After each step it is planned anew.

    Args:
        depth: moves ahead.
        beam: places from which each further move is looked for. Paths that end near each other
            count as one; how near is doubled until so few are left.
        threshold, angle_degrees: as in `NestedQuery`.
        smoothing: how far neighbours lie whose movements are averaged with a row's own (in); 0 for
            none.
        regrasp: taking the tool anew for the first row counts as so much re-positioning (in); later
            moves are planned anew.
        certain: every row is taken to do what it did, whatever its counters say.
    """

    depth: int = 2
    beam: int = 60
    threshold: float = PROBABILITY_THRESHOLD
    angle_degrees: float = REPLICATION_ANGLE_DEGREES
    smoothing: float = 0.0
    certain: bool = False
    regrasp: float = REGRASP

    def choose(self, situation: Situation) -> Choice:
        """Return the first row of the best path, with the path and those that came close."""
        search, reasons = self._searched(situation)
        first = search.first_rows(1 + CLOSE)
        if not len(first):
            # Of the rows within reach none should do anything: that is why there is no plan.
            return Choice(None, (*reasons, Reason("expected to move the attractor", 0)))
        plans = [search.plan(int(row)) for row in first]
        weighed = [told(*plan, followed=not number) for number, plan in enumerate(plans)]
        return Choice(int(first[0]), (*reasons, *weighed))

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return the first rows of paths, the best path first, each with where itself leads."""
        search, _ = self._searched(situation)
        first = search.first_rows()
        seen, goal = situation.seen.object_position, situation.goal
        x, y = search.first_ends(first)
        away = np.sqrt(goal.squared_distance(seen, x - seen.x, y - seen.y))
        return candidates(situation, first, away, np.arange(len(first)), self.regrasp)

    def _searched(self, situation: Situation) -> tuple["_Search", Reasons]:
        """Return the search from a situation, done, and how many rows could be used first."""
        probable, _, reasons = usable_rows(situation, self.threshold)
        table = situation.table
        model = smoothed(table, self.smoothing) if self.smoothing > 0.0 else RowModel.of(table)
        steps = np.ones(len(table))
        if not self.certain:
            steps = table.times_used / np.maximum(table.times_successful, 1)
        anew = regrasping(situation, np.arange(len(table)), self.regrasp)
        search = _Search(situation, model, probable, steps, anew, self.depth, self.beam)
        return search, reasons


class _Search:
    """The search for paths from one situation.

    Args:
        situation: where the robot stands.
        model: what rows do.
        rows: those that may be used, by their positions in the table.
        steps: how often each row of the table is expected to be tried until it does so (n,).
        anew: what taking the tool as each row of the table wants it adds to re-positioning (n,)
            (in); None for nothing.
        depth, beam: as in `Lookahead`.
    """

    def __init__(
        self,
        situation: Situation,
        model: RowModel,
        rows: Rows,
        steps: Floats,
        anew: Floats | None,
        depth: int,
        beam: int,
    ) -> None:
        self._situation, self._model, self._rows = situation, model, rows
        self._few = model.thinned(rows, MOST_ROWS)
        table, self._steps = situation.table, steps
        way = np.hypot(*carrying(table, slice(None), situation.seen, situation.wrist))
        self._carried = REPOSITIONING * (way if anew is None else way + anew)
        self._goal = HalfPlanes(situation.goal)
        self._layers = self._searched(depth, beam)
        self._avoid_dead_ends()
        self._least = np.full(len(table), np.inf)
        for layer in self._layers:
            np.minimum.at(self._least, layer.first, layer.worth)

    def first_rows(self, most: int | None = None) -> Rows:
        """Return the first rows of paths, the best path first; of equally good ones the older."""
        order = np.argsort(self._least, kind="stable")
        return order[: np.isfinite(self._least).sum()][:most]

    def first_ends(self, rows: Rows) -> tuple[Floats, Floats]:
        """Return where first rows lead, one move each."""
        begun = self._layers[0]
        where = np.empty(len(self._least), dtype=np.intp)
        where[begun.row] = np.arange(len(begun.row))
        return begun.x[where[rows]], begun.y[where[rows]]

    def plan(self, first: int) -> tuple[float | None, tuple[Move, ...]]:
        """Return the best path that begins with a row: the steps that it should take to the goal
        and what the inches beside its middle are worth; None when it does not lead there. And its
        moves.
        """
        worth = self._least[first]
        number, at = next(
            (number, int(found[0]))
            for number, layer in enumerate(self._layers)
            if len(found := np.flatnonzero((layer.first == first) & (layer.worth == worth)))
        )
        moves: list[Move] = []
        for layer in reversed(self._layers[: number + 1]):
            row = self._situation.table.row(int(layer.row[at]))
            place = float(layer.x[at]), float(layer.y[at])
            moves.append(Move(row.step, str(row.exploratory), *place))
            at = int(layer.parent[at])
        return (float(worth) if worth < NO_WAY else None), tuple(reversed(moves))

    def _searched(self, depth: int, beam: int) -> list[_Layer]:
        """Return the paths of one move, of two, and so on, until no longer one can be better."""
        seen, none = self._situation.seen, np.zeros(1, dtype=np.intp)
        place = np.array([seen.object_x]), np.array([seen.object_y])
        start = _Layer(*place, np.zeros(1), none, none, none, np.full(1, np.inf))
        layers = [self._longer(start, none, self._rows, begins=True)]
        best = float(layers[0].worth.min(initial=math.inf))
        while len(layers) < depth and best > len(layers) + 1.0:
            kept = _apart(layers[-1], beam, best)
            layers.append(self._longer(layers[-1], kept, self._few, begins=False))
            best = min(best, float(layers[-1].worth.min(initial=math.inf)))
        return layers

    def _longer(self, before: _Layer, kept: Rows, rows: Rows, *, begins: bool) -> _Layer:
        """Return the paths that are longer by one move.

        Args:
            before: the paths that they go on from.
            kept: which of these.
            rows: among which the move is looked for.
            begins: there are no moves yet.
        """
        place, row, x, y, further = self._ends(rows, before.x[kept], before.y[kept])
        parent = kept[place]
        first = row if begins else before.first[parent]
        cost = before.cost[parent] + self._steps[row] + FURTHER * further
        at = self._situation.seen.object_position
        away = np.sqrt(self._situation.goal.squared_distance(at, x - at.x, y - at.y))
        carried, arrived = self._carried[first], self._goal.hold(x, y)
        there = cost + STEPS_INSIDE * (away + carried)
        elsewhere = NO_WAY + cost + STEPS_TO_GO * (away + carried)
        worth = np.where(arrived, there, elsewhere)
        return _Layer(x, y, cost, first, row, parent, worth)

    def _ends(self, rows: Rows, x: Floats, y: Floats) -> Ends:
        """Return what rows do from some places."""
        here = self._situation
        return self._model.ends(rows, x, y, here.reaches, here.slides)

    def _avoid_dead_ends(self) -> None:
        """Find whether the best paths that do not lead to the goal leave a row to use."""
        worths = [layer.worth for layer in self._layers]
        whole = np.concatenate(worths)
        if not len(whole) or whole.min() < NO_WAY:
            return
        number = np.repeat(np.arange(len(worths)), [len(one) for one in worths])
        position = np.concatenate([np.arange(len(one)) for one in worths])
        best = np.argpartition(whole, min(LOOKED_AT, len(whole)) - 1)[:LOOKED_AT]
        x = np.array([self._layers[number[i]].x[position[i]] for i in best])
        y = np.array([self._layers[number[i]].y[position[i]] for i in best])
        living = self._ends(self._few, x, y).place
        for i in np.delete(best, np.unique(living)):
            worths[number[i]][position[i]] += DEAD_END


def _apart(layer: _Layer, beam: int, best: float) -> Rows:
    """Return which paths are gone on from: those that are not at the goal and may still be better
    than the best so far; of those that end in one cell the best, in cells so large that they are
    few enough.
    """
    open_ones = np.flatnonzero((layer.worth >= NO_WAY) & (layer.cost + 1.0 < best))
    order = open_ones[np.argsort(layer.worth[open_ones], kind="stable")]
    x, y, none = layer.x[order], layer.y[order], np.zeros(len(order), dtype=np.intp)
    cell = CELL
    found = first_in_cells(cell, x, y, none)
    while len(found) > beam and cell < LARGEST_CELL:
        cell *= 2.0
        found = first_in_cells(cell, x, y, none)
    kept: Rows = order[found[:beam]]
    return kept


PARTS = (
    Part(
        kind="planners",
        name="lookahead",
        summary="plans some moves ahead: the fewest expected steps to the goal, anew at each step",
        source="Stoytchev 2008, §7.1 (proposed there)",
        build=Lookahead,
        params={
            "depth": Setting(2, "", "Moves ahead.", 1, DEEPEST),
            "beam": Setting(
                *(60, ""),
                "Places from which each further move is looked for.",
                *(1, WIDEST),
            ),
            **JUDGING,
            **REGRASPING,
            "smoothing": Setting(
                *(0.0, "in"),
                "How far neighbours lie whose movements are averaged with a row's own; 0: none.",
                *(0.0, 5.0),
            ),
        },
    ),
)
