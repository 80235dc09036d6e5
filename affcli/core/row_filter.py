"""Which rows of affordance tables are wanted, and what columns a table of them has."""

from dataclasses import dataclass
from typing import Literal, NamedTuple

from affcli.core.behavior import BehaviorCall

Relation = Literal["rows", "behaviors", "trials", "steps"]
"""What can be taken out of a store whole: rows of affordance tables, and what they are about."""

Comparison = Literal["<", "<=", ">", ">="]

Cell = str | int | float | bytes | None
"""A value in a column of a database."""


class Column(NamedTuple):
    """A column by name, and of what kind its values are where they are not NULL."""

    name: str
    kind: type[int] | type[float] | type[str]


@dataclass(frozen=True, slots=True)
class RowFilter:
    """Which rows of affordance tables are wanted.

    Args:
        runs: those of these learning runs; of all if None.
        tool: those learned with this tool; with any if None.
        behavior: those of this exploratory behavior, without parameters whatever they were.
        probability: bounds within which the replication probability lies.
        limit: no more than so many, the oldest; all if None.
    """

    runs: tuple[int, ...] | None = None
    tool: str | None = None
    behavior: BehaviorCall | None = None
    probability: tuple[tuple[Comparison, float], ...] = ()
    limit: int | None = None
