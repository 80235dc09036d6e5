"""The status of rows of affordance tables: now, in another table too, or after a trial."""

import math
from collections.abc import Collection, Sequence
from enum import StrEnum

from affcli.core.affordance import REPLICATION_ANGLE_DEGREES, Affordance, is_probable
from affcli.core.geometry import Point
from affcli.core.observation import angle_between_degrees

MATCHING_DISTANCE = 1.5
"""Two rows can be of the same effect when their starts, from the wrist, lie at most this far apart
(in). Choice: the radius of the puck. Babbling tries places at random, so some rows have no partner
by chance: 8 % between two robots that learned the same tool for an hour (6 to 10 % by tool; 4
robots of seed 0), against 37 % of a T-hook's rows beside an L-hook's."""
SAME_WRIST_ANGLE = math.radians(1.0)
"""Two rows can be of the same effect when their wrists differ by at most this much (rad)."""


class RowStatus(StrEnum):
    """What a row is, in one table or beside another."""

    LIVE = "live"
    """It stands in the table, with a replication probability greater than 1/2."""
    KEPT = "kept"
    LOST = "lost"
    WON = "won"
    EXCLUDED = "excluded"
    """Its replication probability is 1/2 or below: the robot no longer considers it (§6.2)."""


def same_effect(one: Affordance, other: Affordance) -> bool:
    """Tell whether two rows tell of the same effect of a tool.

    Choice: the same exploratory behavior with the same parameters, the wrist at the same angle,
    starts at most `MATCHING_DISTANCE` apart as seen from it, and movements within the 40 degrees
    that count as a replication (§5.2).
    """
    return (
        one.exploratory == other.exploratory
        and not abs(one.wrist_angle - other.wrist_angle) > SAME_WRIST_ANGLE  # or not logged
        and _apart(one.start.wrist_to_object, other.start.wrist_to_object) <= MATCHING_DISTANCE**2
        and angle_between_degrees(one.expected_movement, other.expected_movement)
        <= REPLICATION_ANGLE_DEGREES
    )


def current(rows: Sequence[Affordance]) -> list[RowStatus]:
    """Return for each row whether it still counts, by its counters."""
    return [
        RowStatus.LIVE if is_probable(row.times_successful, row.times_used) else RowStatus.EXCLUDED
        for row in rows
    ]


def compared(
    before: Sequence[Affordance], after: Sequence[Affordance]
) -> tuple[list[RowStatus], list[RowStatus]]:
    """Return the statuses of two tables' rows: what one has and the other lacks.

    A row is kept when the other table has a row of the same effect (`same_effect`), which several
    rows may share. Otherwise a row of `before` is lost and one of `after` won. An excluded row of
    the other table does not count.

    Returns:
        A status for each row of `before`, and one for each of `after`.
    """
    live = [
        [row for row, status in zip(rows, current(rows), strict=True) if status is RowStatus.LIVE]
        for rows in (before, after)
    ]
    return _against(before, live[1], RowStatus.LOST), _against(after, live[0], RowStatus.WON)


def around_trial(
    ids: Sequence[int], excluded_before: Collection[int], died: Collection[int]
) -> tuple[list[RowStatus], list[RowStatus]]:
    """Return the statuses of a table's rows before a trial, and after it.

    Args:
        ids: of the rows.
        excluded_before: those that the trial found excluded.
        died: those whose probability fell to 1/2 or below in it.
    """
    before = [RowStatus.EXCLUDED if one in excluded_before else RowStatus.LIVE for one in ids]
    after = [
        RowStatus.LOST
        if one in died
        else RowStatus.EXCLUDED
        if status is RowStatus.EXCLUDED
        else RowStatus.KEPT
        for one, status in zip(ids, before, strict=True)
    ]
    return before, after


def _against(
    rows: Sequence[Affordance], others: Sequence[Affordance], alone: RowStatus
) -> list[RowStatus]:
    """Return `alone` for each row without a partner among the others."""
    return [
        status
        if status is RowStatus.EXCLUDED
        else RowStatus.KEPT
        if any(same_effect(row, other) for other in others)
        else alone
        for row, status in zip(rows, current(rows), strict=True)
    ]


def _apart(a: Point, b: Point) -> float:
    """Return the squared distance of two points (in^2)."""
    return (a.x - b.x) ** 2 + (a.y - b.y) ** 2
