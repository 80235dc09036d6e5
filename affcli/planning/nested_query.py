"""The four nested searches of §6.2, each by its name.

"Each successive search is performed only on the rows that were not eliminated by the previous
searches." A row is known by its position in the table: a lower position is an older row.
"""

import math
from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance_table import AffordanceTable, Rows
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.ports import Robot
from affcli.core.task import GoalRegion
from affcli.core.trial import Survivors

BLOCK = 32_768
"""So many rows are computed at a time: a million at once would wait for the memory."""
ALL = slice(None)

LONG, SAMPLE, SPARSE = 8_192, 2_048, 128
"""From how many values on a sample is drawn; at least how large it is; at most one of how many."""

Value = TypeVar("Value", np.float64, np.bool_)

TOP_SHARE = 0.2
"""Search 4 chooses "from the top 20% of the sorted rows"."""


class Choice(NamedTuple):
    """The row chosen (its position in the table), None when no row is left; and the survivors."""

    position: int | None
    survivors: Survivors


Choose = Callable[[AffordanceTable, Observation, GoalRegion, Robot], Choice]
"""What `choose_row` does, for whoever wants to look on while it does."""


class Candidate(NamedTuple):
    """A row that search 4 weighed.

    Args:
        position: its position in the table.
        expected_distance: how far from the goal's centre it expects to leave the attractor (in).
        repositioning: how far the wrist would travel to use it (in).
    """

    position: int
    expected_distance: float
    repositioning: float


def consistent_with_colors(table: AffordanceTable, seen: Observation) -> Rows:
    """Search 1: "all rows that have observation vectors consistent with the colors of the current
    tool and object". Consistent: within `COLOR_TOLERANCE`.
    """
    return table.with_colors_of(seen)


def likely_to_succeed(table: AffordanceTable, rows: Rows) -> Rows:
    """Search 2: "only those rows that have a replication probability greater than 1/2"."""
    return _those(rows, _of(table.probable, rows))


def wrist_within_reach(table: AffordanceTable, rows: Rows, seen: Observation, robot: Robot) -> Rows:
    """Keep the rows whose wrist position the arm can take up.

    Not in the paper's list, yet its robot could not use such rows either. It stands before the sort
    so that the top 20 % are of rows that can be used.
    """
    reached = np.empty(len(rows), dtype=bool)
    for block in _blocks(len(rows)):
        x = seen.object_x - _of(table.offset_x, rows, block)
        y = seen.object_y - _of(table.offset_y, rows, block)
        reached[block] = robot.reaches(x, y)
    return _those(rows, reached)


def top_by_expected_distance(
    table: AffordanceTable, rows: Rows, seen: Observation, goal: GoalRegion
) -> Rows:
    """Search 3: "sort the remaining rows (in increasing order) based on the expected distance
    between the attractor object and the goal region", cut to the top 20 % of search 4.

    The expected place is where the attractor is seen plus the row's movement; the distance is taken
    to the region's centre. Of n rows max(1, ceil(0.2 n)) are kept; of rows at the same distance the
    older go first. Returned by age, not by distance.
    """
    if not len(rows):
        return rows
    squared = np.empty(len(rows))
    for block in _blocks(len(rows)):
        dx = _of(table.movement_x, rows, block) + (seen.object_x - goal.center.x)
        dy = _of(table.movement_y, rows, block) + (seen.object_y - goal.center.y)
        dx *= dx
        dy *= dy
        np.add(dx, dy, out=squared[block])
    # 0.2 n in whole numbers: a fifth of 5 rows is 1, not the 2 that ceil(0.2 * 5.000000001) gives.
    kept = max(1, math.ceil(len(rows) * round(TOP_SHARE * 100) / 100))
    return rows[_smallest(squared, kept)]


def least_repositioning(
    table: AffordanceTable, rows: Rows, seen: Observation, wrist: Point
) -> int | None:
    """Search 4: the row "which minimizes the re-positioning of the tool relative to its current
    location": the distance the wrist would travel. Of equal rows the older; None of none.
    """
    if not len(rows):
        return None
    dx = table.offset_x[rows] - (seen.object_x - wrist.x)
    dy = table.offset_y[rows] - (seen.object_y - wrist.y)
    return int(rows[np.argmin(dx * dx + dy * dy)])


def _blocks(n: int) -> list[slice]:
    """Cut n rows into blocks whose intermediate results stay in the processor's cache."""
    return [slice(a, a + BLOCK) for a in range(0, n, BLOCK)]


def _of(column: NDArray[Value], rows: Rows, block: slice = ALL) -> NDArray[Value]:
    """Return a column's values of some rows, or of a block of these; a view when they are all.

    Sound because rows are distinct and ascending: as many as the column is long, they are all.
    """
    return column[block] if len(rows) == len(column) else column[rows[block]]


def _those(rows: Rows, kept: NDArray[np.bool_]) -> Rows:
    """Return the rows that are kept."""
    if kept.all():
        return rows
    # Finding positions first is several times quicker than indexing by a scattered mask.
    return rows[np.flatnonzero(kept)]


def _smallest(values: NDArray[np.float64], k: int) -> Rows:
    """Return where the k smallest values stand (k,), ascending; of equal values the first."""
    low, found = _probably_small(values, k)
    smaller = values[found] if len(found) < len(values) else values
    limit = _kth(smaller, k, low)
    found = found[np.flatnonzero(smaller <= limit)]
    if len(found) > k:
        ties = np.flatnonzero(values[found] == limit)
        found = np.delete(found, ties[k - len(found) :])
    return found


def _probably_small(values: NDArray[np.float64], k: int) -> tuple[float, Rows]:
    """Return where at least the k smallest values stand, of many not many more; and a value that
    the k-th probably exceeds.
    """
    low = -math.inf
    if len(values) >= LONG:
        sample = np.sort(values[:: min(len(values) // SAMPLE, SPARSE)])
        at = k * len(sample) // len(values)
        # Three standard deviations of the k-th value's place in a random sample, at their widest.
        margin = math.ceil(1.5 * math.sqrt(len(sample)))
        if at + margin < len(sample):
            found = np.flatnonzero(values <= sample[at + margin])
            if len(found) >= k:  # else the sample misled
                return float(sample[at - margin]) if at >= margin else low, found
    return low, np.arange(len(values))


def _kth(values: NDArray[np.float64], k: int, low: float) -> float:
    """Return the k-th smallest value; quicker when it is no less than `low`, and few others are."""
    below = 0
    if low > -math.inf:
        within = values[np.flatnonzero(values >= low)]
        if len(values) - len(within) < k:
            below, values = len(values) - len(within), within
    return float(np.partition(values, k - below - 1)[k - below - 1])


def choose_row(table: AffordanceTable, seen: Observation, goal: GoalRegion, robot: Robot) -> Choice:
    """Run the nested searches in the paper's order and say how many rows each left.

    Args:
        table: what the robot learned, with its counters as they are now.
        seen: the latest observation.
        goal: the goal region as observed.
        robot: asked where its wrist is and what it reaches.
    """
    nearest, left = _first_three(table, seen, goal, robot)
    return Choice(least_repositioning(table, nearest, seen, robot.wrist), left)


def candidates(
    table: AffordanceTable, seen: Observation, goal: GoalRegion, robot: Robot
) -> tuple[Candidate, ...]:
    """Return the rows that search 4 chooses from, the one it chooses first, then the next best.

    Args:
        table, seen, goal, robot: as for `choose_row`.
    """
    nearest, _ = _first_three(table, seen, goal, robot)
    dx = table.offset_x[nearest] - (seen.object_x - robot.wrist.x)
    dy = table.offset_y[nearest] - (seen.object_y - robot.wrist.y)
    travel = dx * dx + dy * dy
    ends_x = table.movement_x[nearest] + (seen.object_x - goal.center.x)
    ends_y = table.movement_y[nearest] + (seen.object_y - goal.center.y)
    distance = np.hypot(ends_x, ends_y)
    return tuple(
        Candidate(int(nearest[i]), float(distance[i]), math.sqrt(travel[i]))
        for i in np.argsort(travel, kind="stable")
    )


def _first_three(
    table: AffordanceTable, seen: Observation, goal: GoalRegion, robot: Robot
) -> tuple[Rows, Survivors]:
    """Run searches 1 to 3 and the arm's reach; return what is left, and how many each left."""
    consistent = consistent_with_colors(table, seen)
    probable = likely_to_succeed(table, consistent)
    reachable = wrist_within_reach(table, probable, seen, robot)
    nearest = top_by_expected_distance(table, reachable, seen, goal)
    return nearest, Survivors(len(consistent), len(probable), len(reachable), len(nearest))
