"""How well a table predicts what pushes do (§6.1)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from affcli.analysis.statistics import quantile
from affcli.core.observation import Movement, angle_between_degrees

STAGES = (5, 10, 20, 40, 80)
"""A table is also asked as it was when it had only so many rows."""


class Prediction(NamedTuple):
    """What one table says of one push.

    Args:
        by_row: the movement of the nearest row; no movement when none is near enough.
        by_mean: the mean movement of all rows of the behavior; no movement without rows.
    """

    by_row: Movement
    by_mean: Movement


class Push(NamedTuple):
    """One push, and what was predicted of it.

    Args:
        moved: the attractor was seen to move (T = 1).
        seen: by how much (in, table frame).
        wrist: how far the wrist went; NaN where a log does not say.
        predicted: by the table after its first rows, by how many.
    """

    moved: bool
    seen: Movement
    wrist: Movement
    predicted: Mapping[int, Prediction]


class Errors(NamedTuple):
    """How far off predictions were: median, and what 95 % stay below; None without any."""

    degrees: float | None
    degrees_95: float | None
    inches: float | None
    inches_95: float | None

    @classmethod
    def of(cls, pairs: Sequence[tuple[Movement, Movement]]) -> "Errors":
        """Compare movements predicted with those seen."""
        if not pairs:
            return cls(None, None, None, None)
        degrees = [angle_between_degrees(predicted, seen) for predicted, seen in pairs]
        inches = [math.dist(predicted, seen) for predicted, seen in pairs]
        return cls(
            *(quantile(values, share) for values in (degrees, inches) for share in (0.5, 0.95))
        )


@dataclass(frozen=True, slots=True)
class Score:
    """What a table was worth that was learned from so many rows.

    Args:
        rows: how many.
        moved, hits: pushes that moved the attractor; of these, predicted to.
        still, false_alarms: pushes that did not; of these, predicted to.
        by_row, by_mean, as_wrist: how far off the nearest row, the mean of the behavior's rows, and
            the wrist's own movement were, where the push moved the attractor and was predicted to.
    """

    rows: int
    moved: int
    hits: int
    still: int
    false_alarms: int
    by_row: Errors
    by_mean: Errors
    as_wrist: Errors

    @classmethod
    def of(cls, pushes: Sequence[Push], rows: int) -> "Score":
        """Judge what a table predicted after its first `rows` rows."""
        moved = [push for push in pushes if push.moved]
        still = [push for push in pushes if not push.moved]
        hits = [push for push in moved if push.predicted[rows].by_row.distance > 0.0]
        return cls(
            rows=rows,
            moved=len(moved),
            hits=len(hits),
            still=len(still),
            false_alarms=sum(push.predicted[rows].by_row.distance > 0.0 for push in still),
            by_row=Errors.of([(push.predicted[rows].by_row, push.seen) for push in hits]),
            by_mean=Errors.of([(push.predicted[rows].by_mean, push.seen) for push in hits]),
            as_wrist=Errors.of(
                [(push.wrist, push.seen) for push in hits if not math.isnan(push.wrist.dx)]
            ),
        )


def scores(pushes: Sequence[Push]) -> list[Score]:
    """Return what the table was worth as it grew; none without pushes."""
    stages = sorted({rows for push in pushes for rows in push.predicted})
    return [Score.of(pushes, rows) for rows in stages]
