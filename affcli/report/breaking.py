"""What a robot made of a broken tool: tables and JSON (§7.2)."""

from collections.abc import Sequence
from typing import Any

from affcli.analysis.breaking import (
    DeadRow,
    Tally,
    broken_and_whole,
    dead_rows,
    missing_side,
    parts_gained,
)
from affcli.analysis.paper import BROKEN, PLANNER, papers_breaking
from affcli.core.records import LearningRunInfo
from affcli.core.specs import TrialRecord
from affcli.core.tool import Tool
from affcli.errors import one_line
from affcli.report.sheet import Sheet
from affcli.report.words import call_words, many, run_words


def broken_json(run: LearningRunInfo, trials: Sequence[TrialRecord]) -> dict[str, Any]:
    """Return what `broken_tables` shows as JSON types."""
    broken, whole = broken_and_whole(trials)
    spec = broken[0].spec
    value: dict[str, Any] = {
        "becomes": spec.shape,
        "parts_gained": parts_gained(run.spec.held, spec.held),
        "sensor": spec.sensor,
        "planner": str(spec.planner),
        "paper": BROKEN if papers_breaking(spec, run.spec) else None,
    }
    for name, some in (("broken", broken), ("whole", whole)):
        tally = Tally.of(some)
        value[name] = {
            **{field: getattr(tally, field) for field in Tally.__slots__},
            "mean_steps": tally.mean_steps,
        }
    value["excluded_rows"] = [
        {
            "step": dead.row.step,
            "behavior": str(dead.row.exploratory),
            "on_missing_side": dead.on_missing_side,
            "lost": dead.lost,
            "trials": dead.trials,
        }
        for dead in dead_rows(broken, missing_side(run.spec.held, spec.held))
    ]
    return value


def broken_tables(run: LearningRunInfo, trials: Sequence[TrialRecord]) -> tuple[Sheet, Sheet]:
    """Return the broken tool beside the whole one, and the rows that were excluded.

    Args:
        run: the learning run whose table was used.
        trials: those with the broken tool and those with the whole one.
    """
    broken, whole = broken_and_whole(trials)
    spec = broken[0].spec
    grew = growth_words(run.spec.held, spec.held)
    tallies = Tally.of(broken), Tally.of(whole)
    tried, beside = (tally.trials for tally in tallies)
    heading = f"{tried} trials each" if tried == beside else "trials"
    planner = "" if str(spec.planner) == PLANNER else f"; planner: {spec.planner}"
    own = run_words(run.spec)
    whose = "" if own == "defaults" else f"run {run.id}: {own}; "
    became, was = ("grown", "as it was") if grew else ("broken", "whole")
    comparison = Sheet(
        (heading, f"{became}: {spec.shape}", was),
        title=f"The {became} tool beside the {'one it was' if grew else 'whole one'}",
        left=(heading,),
        caption=f"{whose}seen through: {spec.sensor}{planner}{f'{chr(10)}{grew}' if grew else ''}",
    )
    for label, left, right in zip(_LABELS, *map(_figures, tallies), strict=True):
        comparison.add(label, left, right)
    if papers_breaking(spec, run.spec):
        comparison.add("solved in the paper", f"{BROKEN} of 16", f"{BROKEN} of 16")
    dead = dead_rows(broken, missing_side(run.spec.held, spec.held))
    return comparison, _excluded_table(dead, tried, became)


def growth_words(tool: Tool, left: Tool) -> str:
    """Return the line that says that a tool grew and did not break; empty when it did not grow."""
    gained = parts_gained(tool, left)
    if not gained:
        return ""
    more = " and ".join(f"a {name}" for name in gained)
    return one_line(f"The {tool.name} grew: the {left.name} has {more} more than it had.", 500)


_LABELS = (
    "solved",
    "mean steps of the solved",
    "tries replicated",
    "tries on lost affordances",
    "trials with such tries",
    "exclusions of rows",
)


def _figures(tally: Tally) -> tuple[str, ...]:
    """Return the figures of one column, in the order of the labels."""
    return (
        f"{tally.solved} of {tally.trials}",
        "-" if tally.mean_steps is None else f"{tally.mean_steps:.1f}",
        f"{tally.replicated} of {tally.tries}",
        str(tally.tries_on_lost),
        str(tally.trials_with_lost),
        str(tally.excluded),
    )


def _excluded_table(dead: Sequence[DeadRow], trials: int, became: str) -> Sheet:
    """Return how many rows were excluded, by behavior and side; the JSON lists each."""
    missing = sum(row.on_missing_side for row in dead)
    table = Sheet(
        ("behavior", "side", "rows", "truly lost", "times"),
        title=f"Rows excluded with the {became} tool: {len(dead)}, {missing} on the missing side",
        caption="side: where the attractor was; "
        f"truly lost: the {became} shape cannot do it; "
        f"times: over {many(trials, 'trial')}; --json lists each row",
        left=("behavior", "side"),
    )
    groups: dict[tuple[str, bool], list[DeadRow]] = {}
    for row in dead:
        groups.setdefault((call_words(row.row.exploratory), row.on_missing_side), []).append(row)
    for (behavior, on_missing), rows in sorted(groups.items(), key=lambda g: (-len(g[1]), g[0])):
        table.add(
            behavior,
            "missing" if on_missing else "other",
            str(len(rows)),
            str(sum(row.lost for row in rows)),
            str(sum(row.trials for row in rows)),
        )
    return table
