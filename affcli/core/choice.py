"""What a planner is given, and what it answers: a row, and the reasons for it (§6.2)."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Pose
from affcli.core.goal import Goal
from affcli.core.observation import Observation

Reaches = Callable[
    [NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]], NDArray[np.bool_]
]
"""Tells for each wrist position (n,), (n,) (in, table frame), at an angle (n,) (rad), whether the
arm can set the tool down there."""


@dataclass(frozen=True, slots=True)
class Situation:
    """Where a robot stands when it chooses, or would stand after an imagined move.

    Args:
        table: what it learned, with its counters as they are now.
        seen: the latest observation.
        goal: as the robot saw it.
        wrist: where the wrist is (in, rad, table frame).
        reaches: which wrist positions can be taken up.
        holding: the binding behavior by which the tool is held; None when that is not known.
        slides: where the wrist can be while the tool slides on the table, which may be nearer than
            where it can be set down; None when that is not known.
    """

    table: AffordanceTable
    seen: Observation
    goal: Goal
    wrist: Pose
    reaches: Reaches
    holding: BehaviorCall | None = None
    slides: Reaches | None = None


class Move(NamedTuple):
    """One move of a plan: a row, and where it is expected to leave the attractor.

    Args:
        step: the step of the learning run that made the row.
        behavior: the row's exploratory behavior, as `BehaviorCall` writes it.
        x, y: where the attractor is expected to be then (in, table frame).
    """

    step: int
    behavior: str
    x: float
    y: float


class Reason(NamedTuple):
    """One thing that a planner went by, in the order in which it did.

    Args:
        name: what, in a word: ``probable``.
        rows: how many rows it left; None when it left none out.
        value: the number it went by, where there is one (in, steps, or a share).
        moves: a plan that it weighed, the move of this step first; empty where it weighed none.
    """

    name: str
    rows: int | None = None
    value: float | None = None
    moves: tuple[Move, ...] = ()

    def json(self) -> dict[str, Any]:
        """Return the reason as JSON types; without moves where there are none."""
        value = self._asdict()
        moves = [move._asdict() for move in value.pop("moves")]
        return {**value, "moves": moves} if moves else value

    @classmethod
    def from_json(cls, value: Mapping[str, Any]) -> "Reason":
        """Return the reason that `json` wrote; what a newer affcli says beside that is left out."""
        known = {name: value[name] for name in cls._fields if name in value}
        moves = tuple(Move(**{n: one[n] for n in Move._fields}) for one in known.pop("moves", ()))
        return cls(**known, moves=moves)


Reasons = tuple[Reason, ...]


def plan_followed(reasons: Reasons) -> tuple[Move, ...]:
    """Return the moves of the plan that a planner follows, that of this step first; none of a
    planner that does not look ahead.
    """
    return next((reason.moves for reason in reasons if reason.moves), ())


class Candidate(NamedTuple):
    """A row that a planner weighed.

    Args:
        position: its position in the table.
        expected_distance: how far from the goal's centre it expects to leave the attractor (in).
        repositioning: how far the wrist would travel to use it, and what taking the tool anew
            counts for (in).
    """

    position: int
    expected_distance: float
    repositioning: float


class Choice(NamedTuple):
    """What a planner answers.

    Args:
        position: of the row chosen in the table; None when it chooses none.
        reasons: what it went by, an open list; the first with moves is the plan that it follows,
            the others are those that came close.
    """

    position: int | None
    reasons: Reasons
