"""Composed behaviors that were only tried in passing: tables and figures take them together."""

from collections import Counter
from collections.abc import Iterable

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, Repertoire, composed_motion

ENOUGH = 3
"""Rows of a composed behavior by which it stands for itself: found, and at least twice again."""


def in_passing(call: BehaviorCall, repertoire: Repertoire, rows: int) -> bool:
    """Tell whether a behavior was only tried in passing: composed, and none of the repertoire.

    Args:
        call: the behavior.
        repertoire: of its learning run.
        rows: how many it made there.
    """
    own = any(one.call == call for one in repertoire)
    return not own and rows < ENOUGH and composed_motion(call) is not None


def tried_in_passing(repertoire: Repertoire, rows: Iterable[Affordance]) -> set[BehaviorCall]:
    """Return the behaviors of rows that were only tried in passing."""
    made = Counter(row.exploratory for row in rows)
    return {call for call, count in made.items() if in_passing(call, repertoire, count)}
