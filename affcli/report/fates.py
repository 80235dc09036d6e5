"""What became of the rows of an affordance table: between two tables, or in a trial."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from enum import StrEnum

from affcli.core.affordance import REPLICATION_ANGLE_DEGREES, Affordance
from affcli.core.geometry import Point
from affcli.core.observation import angle_between_degrees
from affcli.core.tool import Tool, ToolPart

MATCHING_DISTANCE = 1.5
"""Two rows can be of the same effect when their starts, from the wrist, lie at most this far apart
(in). Choice: the radius of the puck. Babbling tries places at random, so some rows have no partner
by chance: 8 % between two robots that learned the same tool for an hour (6 to 10 % by tool; 4
robots of seed 0), against 37 % of a T-hook's rows beside an L-hook's."""


class Fate(StrEnum):
    """What a row is in a figure."""

    ROW = "live"
    """It stands in the table, with a replication probability greater than 1/2."""
    KEPT = "kept"
    LOST = "lost"
    WON = "won"
    EXCLUDED = "excluded"
    """Its replication probability is 1/2 or below: the robot no longer considers it (§6.2)."""


@dataclass(frozen=True, slots=True)
class TableView:
    """An affordance table as a figure shows it: arrows over a tool.

    Args:
        heading: what stands over it; may be empty.
        parts: of the tool (in, tool frame).
        missing: parts that the tool has lost.
        puck_radius: of the attractor (in).
        rows: the rows, each with its fate.
    """

    heading: str
    parts: Sequence[ToolPart]
    missing: Sequence[ToolPart]
    puck_radius: float
    rows: Sequence[tuple[Affordance, Fate]]

    def count(self, fate: Fate) -> int:
        """Return how many of its rows have this fate."""
        return sum(its is fate for _, its in self.rows)


@dataclass(frozen=True, slots=True)
class RowView:
    """One row as a figure shows it: with what the robot held and what that pushed.

    Args:
        row: the row, with its counters as they are now.
        tool: the tool it was learned with.
        puck_radius: of the attractor (in).
    """

    row: Affordance
    tool: Tool
    puck_radius: float


def same_effect(one: Affordance, other: Affordance) -> bool:
    """Tell whether two rows tell of the same effect of a tool.

    Choice: the same exploratory behavior with the same parameters, starts at most
    `MATCHING_DISTANCE` apart as seen from the wrist, and movements within the 40 degrees that count
    as a replication (§5.2).
    """
    return (
        one.exploratory == other.exploratory
        and _apart(one.start.wrist_to_object, other.start.wrist_to_object) <= MATCHING_DISTANCE**2
        and angle_between_degrees(one.expected_movement, other.expected_movement)
        <= REPLICATION_ANGLE_DEGREES
    )


def now(rows: Sequence[Affordance]) -> list[Fate]:
    """Return for each row whether it still counts, by its counters."""
    return [Fate.ROW if row.replication_probability > 0.5 else Fate.EXCLUDED for row in rows]


def compared(
    before: Sequence[Affordance], after: Sequence[Affordance]
) -> tuple[list[Fate], list[Fate]]:
    """Return the fates of two tables' rows: what one has and the other lacks.

    A row is kept when the other table has a row of the same effect (`same_effect`), which several
    rows may share. Otherwise a row of `before` is lost and one of `after` won. Excluded rows are
    nobody's partners.

    Returns:
        One fate a row of `before`, and one a row of `after`.
    """
    live = [
        [row for row, fate in zip(rows, now(rows), strict=True) if fate is Fate.ROW]
        for rows in (before, after)
    ]
    return _against(before, live[1], Fate.LOST), _against(after, live[0], Fate.WON)


def around_trial(
    ids: Sequence[int], excluded_before: Collection[int], died: Collection[int]
) -> tuple[list[Fate], list[Fate]]:
    """Return the fates of a table's rows before a trial, and after it.

    Args:
        ids: of the rows.
        excluded_before: those that the trial found excluded.
        died: those whose probability fell to 1/2 or below in it.
    """
    before = [Fate.EXCLUDED if one in excluded_before else Fate.ROW for one in ids]
    after = [
        Fate.LOST if one in died else Fate.EXCLUDED if fate is Fate.EXCLUDED else Fate.KEPT
        for one, fate in zip(ids, before, strict=True)
    ]
    return before, after


def _against(rows: Sequence[Affordance], others: Sequence[Affordance], alone: Fate) -> list[Fate]:
    """Return `alone` for each row without a partner among the others."""
    return [
        fate
        if fate is Fate.EXCLUDED
        else Fate.KEPT
        if any(same_effect(row, other) for other in others)
        else alone
        for row, fate in zip(rows, now(rows), strict=True)
    ]


def _apart(a: Point, b: Point) -> float:
    """Return the squared distance of two points (in^2)."""
    return (a.x - b.x) ** 2 + (a.y - b.y) ** 2
