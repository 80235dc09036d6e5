"""The four nested searches of §6.2, each by its name.

"Each successive search is performed only on the rows that were not eliminated by the previous
searches." A row is known by its position in the table: a lower position is an older row.
"""

import math
from typing import NamedTuple

import numpy as np

from affcli.core.affordance_table import AffordanceTable, Rows
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.ports import Robot
from affcli.core.task import GoalRegion
from affcli.core.trial import Survivors

TOP_SHARE = 0.2
"""Search 4 chooses "from the top 20% of the sorted rows"."""


class Choice(NamedTuple):
    """The row chosen (its position in the table), None when no row is left; and the survivors."""

    position: int | None
    survivors: Survivors


def consistent_with_colors(table: AffordanceTable, seen: Observation) -> Rows:
    """Search 1: "all rows that have observation vectors consistent with the colors of the current
    tool and object". Consistent: within `COLOR_TOLERANCE`.
    """
    return table.with_colors_of(seen)


def likely_to_succeed(table: AffordanceTable, rows: Rows) -> Rows:
    """Search 2: "only those rows that have a replication probability greater than 1/2"."""
    return rows[2 * table.times_successful[rows] > table.times_used[rows]]


def wrist_within_reach(table: AffordanceTable, rows: Rows, seen: Observation, robot: Robot) -> Rows:
    """Keep the rows whose wrist position the arm can take up.

    Not in the paper's list, yet its robot could not use such rows either. It stands before the sort
    so that the top 20 % are of rows that can be used.
    """
    x = seen.object_x - table.offset_x[rows]
    y = seen.object_y - table.offset_y[rows]
    within: Rows = rows[robot.reaches(x, y)]
    return within


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
    dx = table.movement_x[rows] + (seen.object_x - goal.center.x)
    dy = table.movement_y[rows] + (seen.object_y - goal.center.y)
    squared = dx * dx + dy * dy
    # 0.2 n in whole numbers: a fifth of 5 rows is 1, not the 2 that ceil(0.2 * 5.000000001) gives.
    kept = max(1, math.ceil(len(rows) * round(TOP_SHARE * 100) / 100))
    limit = np.partition(squared, kept - 1)[kept - 1]
    nearer = squared < limit
    ties = np.flatnonzero(squared == limit)[: kept - int(np.count_nonzero(nearer))]
    nearer[ties] = True
    return rows[nearer]


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


def choose_row(table: AffordanceTable, seen: Observation, goal: GoalRegion, robot: Robot) -> Choice:
    """Run the nested searches in the paper's order and say how many rows each left.

    Args:
        table: what the robot learned, with its counters as they are now.
        seen: the latest observation.
        goal: the goal region as observed.
        robot: asked where its wrist is and what it reaches.
    """
    consistent = consistent_with_colors(table, seen)
    probable = likely_to_succeed(table, consistent)
    reachable = wrist_within_reach(table, probable, seen, robot)
    nearest = top_by_expected_distance(table, reachable, seen, goal)
    position = least_repositioning(table, nearest, seen, robot.wrist)
    survivors = Survivors(len(consistent), len(probable), len(reachable), len(nearest))
    return Choice(position, survivors)
