"""How well a table predicts what pushes do: tables and JSON (§6.1)."""

from collections.abc import Sequence
from typing import Any

from rich.console import RenderableType

from affcli.analysis.prediction import Errors, Push, scores
from affcli.analysis.statistics import exact_interval
from affcli.report.sheet import Sheet

ERROR_COLUMNS = ("degrees", "degrees 95 %", "inches", "inches 95 %")

PREDICTORS = {
    "by_row": "the nearest row",
    "by_mean": "the mean of the behavior's rows",
    "as_wrist": "as the wrist moved",
}


def prediction_tables(
    title: str, radius: float, pushes: Sequence[Push], *, logged: bool = False
) -> tuple[RenderableType, ...]:
    """Return how well the table predicts as it grows, and the whole of it beside simpler rules.

    Args:
        title: whose table.
        radius: how near a row must start to predict a movement (in).
        pushes: what was predicted, and what was seen.
        logged: they are the trials of a log, not fresh.
    """
    growing = scores(pushes)
    what = "logged trials, each predicted by the others" if logged else "fresh pushes predicted"
    moved = sum(push.moved for push in pushes)
    table = Sheet(
        ("rows", "hits", "false alarms", *ERROR_COLUMNS),
        title=f"{title}: {len(pushes)} {what}, {moved} of which moved the attractor",
        caption="hits: of those that moved it; false alarms: of the others (95 % intervals)\n"
        "degrees, inches: half of the hits are off by less; 95 %: so many are\n"
        f"rows: the first learned; the nearest predicts, if it lies within {radius:g} in",
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


def predictions_table(tables: Sequence[tuple[str, str, Sequence[Push]]]) -> Sheet:
    """Return what whole tables predict, one row each.

    Args:
        tables: whose each is, of which tool, and what was predicted and seen.
    """
    table = Sheet(
        ("robot", "tool", "pushes", "moved", "hits", "false alarms", *ERROR_COLUMNS),
        title="Fresh pushes, predicted by the nearest row of the same behavior (affcli predict)",
        caption="hits, false alarms: of the pushes that moved the puck, and of those that did not, "
        "the share of which the table said they would, with its 95 % interval; degrees, inches: "
        "median error of the hits, and what 95 % of them stay below",
        left=("robot", "tool"),
    )
    for robot, tool, pushes in tables:
        whole = scores(pushes)[-1]
        table.add(
            *(robot, tool, str(len(pushes)), str(whole.moved)),
            _share(whole.hits, whole.moved),
            _share(whole.false_alarms, whole.still),
            *_cells(whole.by_row),
        )
    return table


def _share(count: int, of: int) -> str:
    """Return a share with its interval."""
    if not of:
        return "-"
    low, high = exact_interval(count, of)
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
            "hit_rate_95": exact_interval(score.hits, score.moved),
            "still": score.still,
            "false_alarms": score.false_alarms,
            "false_alarm_rate_95": exact_interval(score.false_alarms, score.still),
            **{field: getattr(score, field)._asdict() for field in PREDICTORS},
        }
        for score in scores(pushes)
    ]
