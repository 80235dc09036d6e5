"""Conditions compared robot by robot: tables, and the same as rows and JSON."""

from collections.abc import Iterable, Sequence
from typing import Any

from rich.text import Text

from affcli.analysis.paired import LEVEL, Comparison, Difference
from affcli.analysis.paper import TASK_SET, trials_words
from affcli.analysis.power import Plan, Untold
from affcli.core.results import Cell, ConditionCounts
from affcli.errors import one_line
from affcli.report.sheet import Sheet
from affcli.report.words import fixed, many, run_words

METHOD = (
    "95 % interval: of the mean change, Student's t; - where too few robots differ for one",
    "d: mean over standard deviation of the changes",
    "+/-: robots better and worse",
    "p: exact sign-flip test, corrected by Holm in each table ({tests} tests)",
    "* = significant at 5 %",
)
FIELDS = ("protocol", "task_set", "tool", "shape", "goal", "start")
COLUMNS = (
    *("condition", "against", *FIELDS, "robots", "trials", "before", "after", "difference"),
    *("low", "high", "effect", "better", "worse", "better_low", "better_high"),
    *("p", "p_corrected", "significant"),
)
"""Of a comparison as rows, in JSON and CSV."""


def comparison_tables(result: Comparison) -> list[Sheet]:
    """Return for each condition all trials and the cells that differ; then those that do not."""
    tables = []
    for other in result.others:
        for label, differences in (("all trials", result.totals), ("", result.cells)):
            own = [one for one in differences if one.condition == other.name]
            if own:
                tables.append(_table(result, other, own, label))
    return [
        *tables,
        *([_same_table(result.same)] if result.same else []),
        _conditions_table(result),
    ]


def _table(
    result: Comparison, other: ConditionCounts, differences: Sequence[Difference], label: str
) -> Sheet:
    """Return a table of differences: a row for all trials of a protocol, or for a cell."""
    cells = [one.cell for one in differences]
    headings, words = cell_words(cells)
    robots = many(max(one.robots for one in differences), "pair") + " of robots"
    if label:
        headings, words = (label,), [(one_line(trials_words(*cell[:2]), 60),) for cell in cells]
    each = sorted({one.trials for one in differences})
    of = f"{each[0]:g}" if len(each) == 1 else f"{each[0]:g} to {each[-1]:g}"
    whole = f"{other.name} against {result.against.name}: {robots}, "
    if label and len(each) > 1:
        parts = (f"{w} of {one.trials:g}" for (w,), one in zip(words, differences, strict=True))
        whole += ", ".join(parts) + " trials"
    else:
        whole += f"of {of} trials"
    table = Sheet(
        (*headings, result.against.name, other.name, "change", "95 % interval", "d", "+/-", "p"),
        title=whole if label else f"Cells of {of} trials",
        left=headings,
    )
    for one, cell in zip(differences, words, strict=True):
        table.add(
            *(*cell, fixed(one.before, 2), fixed(one.after, 2), signed(one.mean)),
            *(interval_words(one), "-" if one.effect is None else signed(one.effect)),
            *(f"{one.better}/{one.worse}", p_words(one)),
        )
    return table


def title(result: Comparison) -> str:
    """Return who is compared with whom."""
    *first, last = (other.name for other in result.others)
    names = f"{', '.join(first)} and {last}" if first else last
    robots = max((one.robots for one in result.totals), default=0)
    return f"{names} against {result.against.name}: {many(robots, 'pair')} of robots"


def _same_table(same: Sequence[Difference]) -> Sheet:
    """Return the cells in which all robots agree."""
    headings, words = cell_words([one.cell for one in same])
    several = len({one.condition for one in same}) > 1
    left = (*headings, *(("condition",) if several else ()))
    table = Sheet((*left, "solved"), left=left, title="The same in all robots, so not tested")
    for one, cell in zip(same, words, strict=True):
        of = f"{fixed(one.before, 2)} of {one.trials:g}"
        table.add(*cell, *((one.condition,) if several else ()), of)
    return table


def _conditions_table(result: Comparison) -> Sheet:
    """Return what each condition is, which of its robots do not pair, and what the tables say."""
    seed = result.against.session.spec.seed
    left_out = bool(result.left_out)
    columns = ("condition", "robots", "settings and parts", *(("left out",) if left_out else ()))
    tests = [sum(not one.agree for one in result.totals)] + [len(result.cells)] * bool(result.cells)
    notes = [note.format(tests=" and ".join(map(str, tests))) for note in METHOD]
    notes += ["left out: not in both, or not with as many trials"] * left_out
    for one in (result.against, *result.others):
        if one.failed:
            names = f"{many(len(one.failed), 'robot')} of {one.name}: {ranges(one.failed)}"
            notes.append(f"failed, so in no pair: {names}")
    for name, cells in result.unshared.items():
        words = "; ".join(map(whole_words, cells))
        notes.append(f"in {name} alone or in {result.against.name} alone: {words}")
    table = Sheet(columns, left=columns, title=f"Conditions, seed {seed}", caption="; ".join(notes))
    for one in (result.against, *result.others):
        missing = (ranges(result.left_out.get(one.name, ())),) if left_out else ()
        table.add(one.name, str(len(one.robots)), _what(one), *missing)
    return table


def cell_words(cells: Sequence[Cell]) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Return headings for what tells cells apart, and under them the words of each."""
    shown = {
        "protocol": [cell.protocol for cell in cells],
        "tasks": [cell.task_set for cell in cells],
        "tool": [held_words(cell) for cell in cells],
        "goal": [cell.goal for cell in cells],
        "start": [cell.start for cell in cells],
    }
    usual = {"protocol": "extension of reach", "tasks": TASK_SET}
    broken = all(cell.shape for cell in cells)  # then the tool says what the protocol would
    kept = {
        name: [one_line(word, 60) for word in words]
        for name, words in shown.items()
        if set(words) != {usual.get(name, "")} and not (name == "protocol" and broken)
    } or {"protocol": shown["protocol"]}
    return tuple(kept), list(zip(*kept.values(), strict=True))


def held_words(cell: Cell) -> str:
    """Return a tool, and what is left of it where it broke."""
    return cell.tool if cell.shape in ("", cell.tool) else f"{cell.tool} as {cell.shape}"


def whole_words(cell: Cell) -> str:
    """Return a cell in one line: ``t-hook as l-hook, goal 1``; `trials_words` if it is all of one.

    The tasks are named where they are not the paper's.
    """
    goal, start = (f"{n} {v}" if v else "" for n, v in (("goal", cell.goal), ("start", cell.start)))
    words = [word for word in (held_words(cell), goal, start) if word]
    if not words:
        return one_line(trials_words(*cell[:2]), 60)
    tasks = [] if cell.task_set == TASK_SET else [cell.task_set]
    return one_line(", ".join(words + tasks), 60)


def signed(value: float) -> str:
    """Return a difference with its sign and two digits."""
    return f"{round(value, 2) + 0.0:+.2f}" if round(value, 2) else "0.00"


def interval_words(one: Difference) -> str:
    """Return the interval of a difference; - where there is none."""
    return "-" if one.interval is None else " to ".join(map(signed, one.interval))


def p_words(one: Difference) -> Text:
    """Return a corrected p, marked where it is significant; - where there was nothing to test."""
    if one.agree:
        return Text("- ")
    words = "<0.001" if one.corrected < 0.001 else f"{one.corrected:.3f}"
    return Text(f"{words}*", style="bold") if one.significant else Text(f"{words} ")


def ranges(numbers: Iterable[int]) -> str:
    """Return numbers as ``3, 5 to 9``."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1][1:] = [number]
        else:
            runs.append([number])
    return ", ".join(" to ".join(map(str, run)) for run in runs)


def comparison_rows(result: Comparison) -> list[tuple[Any, ...]]:
    """Return all differences as rows under `COLUMNS`: all trials, cells, cells that agree."""
    return [
        (
            *(one.condition, result.against.name, *one.cell, one.robots, one.trials),
            *(one.before, one.after, one.mean, *(one.interval or (None, None)), one.effect),
            *(one.better, one.worse, *one.better_share),
            *((None, None, None) if one.agree else (one.p, one.corrected, int(one.significant))),
        )
        for one in (*result.totals, *result.cells, *result.same)
    ]


def comparison_json(result: Comparison) -> dict[str, Any]:
    """Return a comparison as JSON types."""
    rows = [dict(zip(COLUMNS, row, strict=True)) for row in comparison_rows(result)]
    for row in rows:
        row["significant"] = None if row["significant"] is None else bool(row["significant"])
    totals, cells = len(result.totals), len(result.totals) + len(result.cells)
    return {
        "against": _condition_json(result.against),
        "conditions": [_condition_json(other) for other in result.others],
        "test": "exact sign-flip, two-sided; corrected by Holm",
        "totals": rows[:totals],
        "cells": rows[totals:cells],
        "same": rows[cells:],
        "left_out": {name: list(robots) for name, robots in result.left_out.items()},
        "unshared": {
            name: [cell._asdict() for cell in cells] for name, cells in result.unshared.items()
        },
    }


def _condition_json(one: ConditionCounts) -> dict[str, Any]:
    """Return who a condition is."""
    spec = one.session.spec
    return {
        "name": one.name,
        "session": one.session.id,
        "seed": spec.seed,
        "robots": len(one.robots),
        "failed": list(one.failed),
        "what": _what(one),
    }


def _what(one: ConditionCounts) -> str:
    """Return what a condition is, as far as it is not the usual."""
    own = run_words(one.session.spec)
    return ", ".join(filter(None, ("" if own == "defaults" and one.beside else own, one.beside)))


def power_tables(
    plans: Sequence[Plan],
    untold: Sequence[Untold],
    how: str,
    wanted: float,
    differences: Sequence[float],
) -> list[Sheet]:
    """Return how many robots it takes to see each difference.

    Args:
        plans: what it takes.
        untold: cells that tell nothing of it.
        how: from what it is known, in words.
        wanted: the chance to see a difference.
        differences: to be seen, in solved trials.
    """
    columns = ("trials", "deviation", *(f"of {one:g}" for one in differences), "seen by as many")
    table = Sheet(
        columns,
        left=("trials",),
        title="Robots needed to see a difference of so many solved trials "
        f"({100 * wanted:g} % power)",
        caption=f"{how}; deviation: standard deviation of the paired differences; seen by as many: "
        "the smallest difference that as many robots as there are would show" + _level_words(plans),
    )
    for one in plans:
        needed = ["-" if n is None else f"{n:,}" for n in one.needed.values()]
        visible = "-" if one.visible is None else fixed(one.visible, 2)
        table.add(whole_words(one.cell), fixed(one.spread, 2), *needed, visible)
    for why in dict.fromkeys(one.why for one in untold):
        names = "; ".join(whole_words(one.cell) for one in untold if one.why == why)
        table.caption += f"\nnot told, {why}: {names}"
    return [table]


def _level_words(plans: Sequence[Plan]) -> str:
    """Return at which level totals and cells are planned, as far as there are some."""
    levels = {
        f"{kind} at {100 * one.level:.2g} %": one.level < LEVEL
        for kind, told in (("all trials", False), ("a cell", True))
        for one in plans
        if any(one.cell[2:]) == told
    }
    first = " (of as many as there are, Holm's first)" if any(levels.values()) else ""
    return f"; two-sided: {', '.join(levels)}{first}" if levels else ""


def power_json(
    plans: Sequence[Plan], untold: Sequence[Untold], how: str, wanted: float
) -> dict[str, Any]:
    """Return what `power_tables` shows as JSON types."""
    return {
        "known_from": how,
        "power": wanted,
        "plans": [
            {
                **one.cell._asdict(),
                "robots": one.robots,
                "deviation": one.spread,
                "level": one.level,
                "needed": [{"difference": d, "robots": n} for d, n in one.needed.items()],
                "visible": one.visible,
            }
            for one in plans
        ],
        "not_told": [{**one.cell._asdict(), "why": one.why} for one in untold],
    }
