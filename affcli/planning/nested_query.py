"""The four nested searches of §6.2, each by its name.

"Each successive search is performed only on the rows that were not eliminated by the previous
searches." A row is known by its position in the table: a lower position is an older row.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import PROBABILITY_THRESHOLD, REPLICATION_ANGLE_DEGREES
from affcli.core.affordance_table import AffordanceTable, Rows
from affcli.core.choice import Candidate, Choice, Reaches, Reason, Reasons, Situation
from affcli.core.geometry import Pose
from affcli.core.goal import Goal
from affcli.core.observation import Observation
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.planning.selection import blocks, of, smallest, those

TOP_SHARE = 0.2
"""Search 4 chooses "from the top 20% of the sorted rows"."""
REGRASP = 3.0
"""How much re-positioning a new grasp counts for (in). Choice, for the paper has one grasp: by its
time it would be a hundred, and no other grasp would ever be taken. Of 0, 3, 10 and 30 it solves
nearly as much as 0 in less time (seeds 120 to 150, ``experiments/grasps``)."""


def consistent_with_colors(table: AffordanceTable, seen: Observation) -> Rows:
    """Search 1: "all rows that have observation vectors consistent with the colors of the current
    tool and object". Consistent: within `COLOR_TOLERANCE`.
    """
    return table.with_colors_of(seen)


def likely_to_succeed(
    table: AffordanceTable, rows: Rows, threshold: float = PROBABILITY_THRESHOLD
) -> Rows:
    """Search 2: "only those rows that have a replication probability greater than 1/2"."""
    return those(rows, of(table.more_probable_than(threshold), rows))


def wrist_within_reach(
    table: AffordanceTable, rows: Rows, seen: Observation, reaches: Reaches
) -> Rows:
    """Keep the rows whose wrist position the arm can take up.

    Not in the paper's list, yet its robot could not use such rows either. It stands before the sort
    so that the top 20 % are of rows that can be used.
    """
    reached = np.empty(len(rows), dtype=bool)
    for block in blocks(len(rows)):
        x = seen.object_x - of(table.offset_x, rows, block)
        y = seen.object_y - of(table.offset_y, rows, block)
        reached[block] = reaches(x, y, of(table.wrist_angle, rows, block))
    return those(rows, reached)


def usable_rows(situation: Situation, threshold: float) -> tuple[Rows, Rows, Reasons]:
    """Run searches 1 and 2, and keep of these rows those whose wrist position is within reach.

    Args:
        situation: where the robot stands.
        threshold: as in `likely_to_succeed`.

    Returns:
        The rows that searches 1 and 2 leave, those of them within reach, and how many each left.
    """
    table, seen = situation.table, situation.seen
    consistent = consistent_with_colors(table, seen)
    probable = likely_to_succeed(table, consistent, threshold)
    reachable = wrist_within_reach(table, probable, seen, situation.reaches)
    reasons = (
        Reason("consistent", len(consistent)),
        Reason("probable", len(probable), threshold),
        Reason("reachable", len(reachable)),
    )
    return probable, reachable, reasons


def nearer_to_goal(
    table: AffordanceTable, rows: Rows, seen: Observation, goal: Goal, least: float
) -> Rows:
    """Keep the rows that are expected to leave the attractor more than `least` (in) nearer to the
    goal than it is; all when there are none.

    Not in the paper's list. Without it search 4 may take a row that leads away: the top 20 % of a
    table that has few rows for a place are not all good ones.
    """
    moved = table.movement_x[rows], table.movement_y[rows]
    then = np.sqrt(goal.squared_distance(seen.object_position, *moved))
    still = np.zeros(1)
    now = math.sqrt(goal.squared_distance(seen.object_position, still, still)[0])
    nearer = now - then > least
    return those(rows, nearer) if nearer.any() else rows


def top_by_expected_distance(
    table: AffordanceTable, rows: Rows, seen: Observation, goal: Goal, share: float = TOP_SHARE
) -> Rows:
    """Search 3: "sort the remaining rows (in increasing order) based on the expected distance
    between the attractor object and the goal region", cut to the top 20 % of search 4.

    The expected place is where the attractor is seen plus the row's movement. Of n rows
    max(1, ceil(share n)) are kept; of rows at the same distance the older go first. Returned by
    age, not by distance.
    """
    if not len(rows):
        return rows
    squared = np.empty(len(rows))
    for block in blocks(len(rows)):
        dx = of(table.movement_x, rows, block)
        dy = of(table.movement_y, rows, block)
        squared[block] = goal.squared_distance(seen.object_position, dx, dy)
    # Rounded first: 0.07 of 100 rows is 7, not the 8 that ceil(7.000000000000001) gives.
    kept = max(1, math.ceil(round(len(rows) * share, 6)))
    return rows[smallest(squared, kept)]


def least_repositioning(
    table: AffordanceTable,
    rows: Rows,
    seen: Observation,
    wrist: Pose,
    anew: NDArray[np.float64] | None = None,
) -> int | None:
    """Search 4: the row "which minimizes the re-positioning of the tool relative to its current
    location": the distance the wrist would travel. Of equal rows the older; None of none.

    Args:
        table, rows, seen: as in the other searches.
        wrist: where it is (in, rad, table frame).
        anew: what it costs to take the tool as each row wants it (n,) (in), as `regrasping` says.
    """
    if not len(rows):
        return None
    dx, dy = carrying(table, rows, seen, wrist)
    squared = dx * dx + dy * dy
    return int(rows[np.argmin(squared if anew is None else np.sqrt(squared) + anew)])


def carrying(
    table: AffordanceTable, rows: Rows | slice, seen: Observation, wrist: Pose
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how far the wrist is carried to begin each row (n,), (n,) (in, along x and y)."""
    dx = table.offset_x[rows] - (seen.object_x - wrist.x)
    dy = table.offset_y[rows] - (seen.object_y - wrist.y)
    return dx, dy


def regrasping(situation: Situation, rows: Rows, cost: float) -> NDArray[np.float64] | None:
    """Return what it costs to take the tool as each row wants it (n,) (in): 0 where it is held so;
    None where no row of the table wants it otherwise.
    """
    otherwise = situation.table.made_otherwise(situation.holding)
    return None if otherwise is None else np.where(otherwise[rows], cost, 0.0)


@dataclass(frozen=True, slots=True)
class NestedQuery:
    """The paper's planner: the nested searches in the paper's order; a `Planner`.

    Args:
        share: of the sorted rows that search 4 chooses from.
        threshold: search 2 keeps rows with a replication probability greater than this.
        angle_degrees: a use replicates when the movement seen is within this angle (§5.2).
        guard: search 3 sorts only rows that are expected to end more than this nearer to the goal
            (in); all when there are none, or when this is 0, as in the paper.
        regrasp: taking the tool anew for a row counts as so much re-positioning (in).
    """

    share: float = TOP_SHARE
    threshold: float = PROBABILITY_THRESHOLD
    angle_degrees: float = REPLICATION_ANGLE_DEGREES
    guard: float = 0.0
    regrasp: float = REGRASP

    def choose(self, situation: Situation) -> Choice:
        """Run the searches and say how many rows each left."""
        nearest, left = self._first_three(situation)
        seen, wrist = situation.seen, situation.wrist
        anew = regrasping(situation, nearest, self.regrasp)
        return Choice(least_repositioning(situation.table, nearest, seen, wrist, anew), left)

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return the rows that search 4 chooses from, the one it chooses first, then the next."""
        table, seen, goal = situation.table, situation.seen, situation.goal
        nearest, _ = self._first_three(situation)
        dx, dy = carrying(table, nearest, seen, situation.wrist)
        by = dx * dx + dy * dy
        travel = np.sqrt(by)
        if (anew := regrasping(situation, nearest, self.regrasp)) is not None:
            by = travel = travel + anew
        moved = table.movement_x[nearest], table.movement_y[nearest]
        distance = np.sqrt(goal.squared_distance(seen.object_position, *moved))
        return tuple(
            Candidate(int(nearest[i]), float(distance[i]), float(travel[i]))
            for i in np.argsort(by, kind="stable")
        )

    def _first_three(self, situation: Situation) -> tuple[Rows, Reasons]:
        """Run searches 1 to 3 and the arm's reach; return what is left, and how many each left."""
        table, seen, goal = situation.table, situation.seen, situation.goal
        _, rows, reasons = usable_rows(situation, self.threshold)
        if self.guard > 0.0:
            rows = nearer_to_goal(table, rows, seen, goal, self.guard)
            reasons = (*reasons, Reason("nearer", len(rows), self.guard))
        nearest = top_by_expected_distance(table, rows, seen, goal, self.share)
        return nearest, (*reasons, Reason("nearest", len(nearest), self.share))


REGRASPING = {
    "regrasp": Setting(
        *(REGRASP, "in"),
        "Taking the tool anew for a row counts as so much re-positioning.",
        *(0.0, 1000.0),
    ),
}
"""What a new grasp counts for: a parameter of planners that weigh re-positioning."""

JUDGING = {
    "threshold": Setting(
        *(PROBABILITY_THRESHOLD, ""),
        "Search 2 keeps rows with a replication probability greater than this.",
        *(0.0, 0.999),
    ),
    "angle_degrees": Setting(
        *(REPLICATION_ANGLE_DEGREES, "degrees"),
        "A use replicates when the movement seen is within this angle of the row's.",
        *(1.0, 180.0),
    ),
}
"""How a planner judges rows: parameters that all of them have."""

PARTS = (
    Part(
        kind="planners",
        name="nested-query",
        summary="the paper's four nested searches: colours, probability, distance to the goal, "
        "re-positioning",
        source="Stoytchev 2008, §6.2",
        build=NestedQuery,
        params={
            "share": Setting(
                TOP_SHARE, "", "Of the sorted rows that search 4 chooses from.", 0.001, 1.0
            ),
            **JUDGING,
            "guard": Setting(
                *(0.0, "in"),
                "Search 3 sorts only rows that should end so much nearer to the goal; 0: all.",
                *(0.0, 30.0),
            ),
            **REGRASPING,
        },
    ),
)
