"""How well a table predicts what pushes do (§6.1)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from rich.console import RenderableType

from affcli.core.observation import Movement, angle_between_degrees
from affcli.report.sheet import Sheet
from affcli.report.statistics import quantile, wilson

LEARNED_FROM = (5, 10, 20, 40, 80)
"""A table is also asked as it was when it had only so many rows."""


class Foretold(NamedTuple):
    """What one table says of one push.

    Args:
        by_row: the movement of the nearest row; no movement when none is near enough.
        by_mean: the mean movement of all rows of the behavior; no movement without rows.
    """

    by_row: Movement
    by_mean: Movement


class Push(NamedTuple):
    """One push, and what was foretold of it.

    Args:
        moved: the attractor was seen to move (T = 1).
        seen: by how much (in, table frame).
        wrist: how far the wrist went.
        foretold: by the table after its first rows, by how many.
    """

    moved: bool
    seen: Movement
    wrist: Movement
    foretold: Mapping[int, Foretold]


class Errors(NamedTuple):
    """How far off predictions were: median, and what 95 % stay below; None without any."""

    degrees: float | None
    degrees_95: float | None
    inches: float | None
    inches_95: float | None

    @classmethod
    def of(cls, pairs: Sequence[tuple[Movement, Movement]]) -> "Errors":
        """Compare movements foretold with those seen."""
        if not pairs:
            return cls(None, None, None, None)
        degrees = [angle_between_degrees(foretold, seen) for foretold, seen in pairs]
        inches = [math.dist(foretold, seen) for foretold, seen in pairs]
        return cls(
            *(quantile(values, share) for values in (degrees, inches) for share in (0.5, 0.95))
        )


@dataclass(frozen=True, slots=True)
class Score:
    """What a table was worth that was learned from so many rows.

    Args:
        rows: how many.
        moved, hits: pushes that moved the attractor; of these, foretold to.
        still, false_alarms: pushes that did not; of these, foretold to.
        by_row, by_mean, as_wrist: how far off the nearest row, the mean of the behavior's rows, and
            the wrist's own movement were, where the push moved the attractor and was foretold to.
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
        """Judge what a table foretold after its first `rows` rows."""
        moved = [push for push in pushes if push.moved]
        still = [push for push in pushes if not push.moved]
        hits = [push for push in moved if push.foretold[rows].by_row.distance > 0.0]
        return cls(
            rows=rows,
            moved=len(moved),
            hits=len(hits),
            still=len(still),
            false_alarms=sum(push.foretold[rows].by_row.distance > 0.0 for push in still),
            by_row=Errors.of([(push.foretold[rows].by_row, push.seen) for push in hits]),
            by_mean=Errors.of([(push.foretold[rows].by_mean, push.seen) for push in hits]),
            as_wrist=Errors.of([(push.wrist, push.seen) for push in hits]),
        )


def scores(pushes: Sequence[Push]) -> list[Score]:
    """Return what the table was worth as it grew; none without pushes."""
    stages = sorted({rows for push in pushes for rows in push.foretold})
    return [Score.of(pushes, rows) for rows in stages]


ERROR_COLUMNS = ("degrees", "degrees 95 %", "inches", "inches 95 %")

PREDICTORS = {
    "by_row": "the nearest row",
    "by_mean": "the mean of the behavior's rows",
    "as_wrist": "as the wrist moved",
}


def prediction_tables(
    title: str, radius: float, pushes: Sequence[Push]
) -> tuple[RenderableType, ...]:
    """Return how well the table predicts as it grows, and the whole of it beside simpler rules.

    Args:
        title: whose table.
        radius: how near a row must be to tell something (in).
        pushes: what was foretold, and what was seen.
    """
    growing = scores(pushes)
    moved = sum(push.moved for push in pushes)
    table = Sheet(
        ("rows", "hits", "false alarms", *ERROR_COLUMNS),
        title=f"{title}: what it predicts of {len(pushes)} fresh pushes, {moved} of which moved",
        caption="rows: the first so many that were learned, without excluded ones; hits, false "
        "alarms: of the pushes that "
        "moved the attractor, and of those that did not, the share of which a row within "
        f"{radius:g} in said they would, with its 95 % interval; degrees, inches: median error of "
        "the hits, and what 95 % of them stay below",
    )
    for score in growing:
        table.add(
            str(score.rows),
            _share(score.hits, score.moved),
            _share(score.false_alarms, score.still),
            *_cells(score.by_row),
        )
    beside = Sheet(
        ("predicted by", *ERROR_COLUMNS),
        title="The whole table beside simpler rules, on the same hits",
        left=("predicted by",),
    )
    for field, words in PREDICTORS.items():
        beside.add(words, *_cells(getattr(growing[-1], field)))
    return table, beside


def _share(count: int, of: int) -> str:
    """Return a share with its interval."""
    if not of:
        return "-"
    low, high = wilson(count, of)
    return f"{count / of:.2f} ({low:.2f} to {high:.2f})"


def _cells(errors: Errors) -> list[str]:
    """Return errors as cells of a table."""
    whole = ("-" if value is None else f"{value:.1f}" for value in errors[:2])
    return [*whole, *("-" if value is None else f"{value:.2f}" for value in errors[2:])]


def prediction_json(pushes: Sequence[Push]) -> list[dict[str, Any]]:
    """Return the scores of a growing table as JSON types."""
    return [
        {
            "rows": score.rows,
            "moved": score.moved,
            "hits": score.hits,
            "hit_rate_95": wilson(score.hits, score.moved),
            "still": score.still,
            "false_alarms": score.false_alarms,
            "false_alarm_rate_95": wilson(score.false_alarms, score.still),
            **{field: getattr(score, field)._asdict() for field in PREDICTORS},
        }
        for score in scores(pushes)
    ]
