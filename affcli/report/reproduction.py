"""The paper's results beside those of many robots: numbers for JSON, and the tables."""

from collections.abc import Mapping, Sequence
from typing import Any

from rich.text import Text

from affcli.analysis.paper import (
    BROKEN,
    BROKEN_TRIALS,
    EXTENSION_OF_REACH,
    GOALS,
    PLANNER,
    STARTS,
    TASK_SET,
    TOTAL,
    TRIALS,
    other_parts,
)
from affcli.analysis.reproduction import Reproduction, Solved
from affcli.analysis.statistics import ENOUGH_ROBOTS, Spread
from affcli.report.experiment import failed_json, failed_tables
from affcli.report.sheet import Sheet
from affcli.report.words import (
    few_robots_note,
    in_order,
    many,
    run_words,
    settings_words,
    spread_words,
)


def reproduction_json(result: Reproduction) -> dict[str, Any]:
    """Return the result as JSON types: the paper's cells and sums, other trials, failures."""
    return {
        "robots": result.robots,
        "seed": result.session.spec.seed,
        "session": result.session.id,
        "sensor": result.session.spec.sensor,
        "settings": settings_words(result.session.spec.settings),
        "parts": other_parts(result.session.spec),
        "cells": [
            {
                "tool": tool,
                "goal": goal,
                **_against(mine, EXTENSION_OF_REACH[tool, goal], STARTS),
                "p_paper": mine.count(EXTENSION_OF_REACH[tool, goal]) / len(mine),
            }
            for (tool, goal), mine in result.cells.items()
        ],
        "total": _against(result.totals, TOTAL, TRIALS) if result.totals else None,
        "broken": _against(result.broken, BROKEN, BROKEN_TRIALS) if result.broken else None,
        "others": [
            {**kind._asdict(), "goal": goal, "trials": solved.tried}
            | _spread(solved.counts, solved.tried / result.robots)
            for kind, goals in result.others.items()
            for goal, solved in goals.items()
        ],
        "failures": dict(result.failures),
        "trials": result.trials,
        "invalid": result.invalid,
        "tries_on_lost": result.tries_on_lost,
        "failed": failed_json(result.failed),
    }


def _against(counts: Sequence[int], paper: int, most: int) -> dict[str, Any]:
    """Return the spread of `counts`, each of at most `most`, beside the paper's count."""
    return {"paper": paper, **_spread(counts, most), "inside": Spread.of(counts).holds(paper)}


def _spread(counts: Sequence[int], most: float) -> dict[str, Any]:
    """Return the spread of `counts`, each of at most `most`, as JSON types."""
    spread = Spread.of(counts, most)
    return {
        "mean": spread.mean,
        "mean_ci": None if spread.mean_ci is None else list(spread.mean_ci),
        "low": spread.low,
        "high": spread.high,
    }


def reproduction_tables(result: Reproduction) -> list[Sheet]:
    """Return the paper's table with ours in its cells, the totals, other trials, the failures."""
    return [
        *([_cells_table(result)] if result.cells else []),
        *([_totals_table(result)] if result.totals or result.broken else []),
        *([_others_table(result)] if result.others else []),
        failures_table(result.failures, result.trials, result.invalid),
        *failed_tables(result.failed),
    ]


def _cells_table(result: Reproduction) -> Sheet:
    """Return the paper's table: in each cell its count, our mean and central 95 % of robots."""
    columns = ("tool", *(f"goal {goal}" for goal in GOALS))
    table = Sheet(
        columns,
        title=f"Extension of reach: paper|{_of_robots(result.robots)}",
        caption=f"successes of 4 starts; {_note(result.robots)}\n{_session(result)}",
        left=columns,
    )
    for tool in dict.fromkeys(tool for tool, _ in result.cells):
        table.add(tool, *(_cell_beside(result, tool, goal) for goal in GOALS))
    return table


def _cell_beside(result: Reproduction, tool: str, goal: str) -> Text:
    """Return the paper's count and ours, - for ours where nothing was tried."""
    paper, counts = EXTENSION_OF_REACH[tool, goal], result.cells.get((tool, goal))
    return _marked(f"{paper}|{_cell(counts)}", counts, paper) if counts else Text(f"{paper}|-")


def _session(result: Reproduction) -> str:
    """Return which session it is, and what is not the usual in it."""
    spec = result.session.spec
    return f"session {result.session.id}, seed {spec.seed}, settings: {run_words(spec)}"


def _totals_table(result: Reproduction) -> Sheet:
    """Return the total and the broken tool's successes beside the paper's."""
    table = Sheet(
        (
            *("all trials", "paper", "mean", "95 % interval of the mean"),
            spread_words(result.robots),
        ),
        left=("all trials",),
        caption=few_robots_note(result.robots),
    )
    for name, counts, paper, most in (
        ("extension of reach", result.totals, TOTAL, TRIALS),
        ("broken tool", result.broken, BROKEN, BROKEN_TRIALS),
    ):
        if counts:
            spread = Spread.of(counts, most)
            interval = "-" if spread.mean_ci is None else "{:.1f} to {:.1f}".format(*spread.mean_ci)
            robots = _marked(f"[{spread.low},{spread.high}]", counts, paper)
            table.add(f"{name}, of {most}", str(paper), f"{spread.mean:.1f}", interval, robots)
    return table


def _others_table(result: Reproduction) -> Sheet:
    """Return successes of what the paper has not: kinds of trials by goal, and over all goals."""
    kinds = list(result.others)
    goals = in_order(goal for of_kind in result.others.values() for goal in of_kind)
    named = {
        "became": [kind.shape if kind.shape != kind.tool else "" for kind in kinds],
        "planner": [kind.planner for kind in kinds],
        "tasks": [kind.task_set for kind in kinds],
    }
    usual = {"became": "", "planner": PLANNER, "tasks": TASK_SET}
    more = {name: cells for name, cells in named.items() if set(cells) != {usual[name]}}
    tried = {solved.tried for own in result.others.values() for solved in own.values()}
    alike = f" of {tried.pop() / result.robots:g}" if len(tried) == 1 else ""
    columns = ("tool", *more, *(f"goal {goal}" for goal in goals), "all")
    table = Sheet(
        columns,
        title=f"Not in the paper: solved{alike}, {_of_robots(result.robots)}",
        caption="" if result.cells else _session(result),
        left=columns,
    )
    for number, kind in enumerate(kinds):
        own = result.others[kind]
        everything = Solved(
            [sum(counts) for counts in zip(*(s.counts for s in own.values()), strict=True)],
            sum(solved.tried for solved in own.values()),
        )
        cells = [
            "-" if goal not in own else _of(own[goal], 0 if alike else result.robots)
            for goal in goals
        ]
        named_cells = (values[number] for values in more.values())
        table.add(kind.tool, *named_cells, *cells, _of(everything, result.robots))
    return table


def _of(solved: Solved, robots: int) -> str:
    """Return the mean and the central 95 % of robots, and of how many trials of so many robots."""
    return _cell(solved.counts) + (f" of {solved.tried / robots:g}" if robots else "")


def _cell(counts: Sequence[int]) -> str:
    """Return the mean of counts and their central 95 %; of one robot its count."""
    spread = Spread.of(counts)
    return f"{spread.mean:.1f} [{spread.low},{spread.high}]" if len(counts) > 1 else str(spread.low)


def _of_robots(robots: int) -> str:
    """Return what the numbers of a cell are, of so many robots."""
    return f"mean of {robots} robots [{spread_words(robots)}]" if robots > 1 else "one robot"


def _marked(words: str, counts: Sequence[int], paper: int) -> Text:
    """Return the words of an interval, marked when enough robots leave the paper's count out."""
    outside = Spread.of(counts).holds(paper) is False
    return Text(f"{words}!", style="bold red") if outside else Text(words)


def _note(robots: int) -> str:
    """Return what the mark means, or how many robots it takes."""
    if robots < ENOUGH_ROBOTS:
        return f"! from {ENOUGH_ROBOTS} robots on: the paper's count lies outside"
    return "! = the paper's count lies outside"


def failures_table(failures: Mapping[str, int], trials: int, invalid: int = 0) -> Sheet:
    """Return failures by kind.

    Args:
        failures: how often each kind of failure occurred, the commonest first.
        trials: how many trials count, the solved ones included.
        invalid: how many count for nothing.
    """
    table = Sheet(
        ("kind", "trials", "share of all trials"), title="Failures by kind", left=("kind",)
    )
    for kind, count in failures.items():
        table.add(kind, str(count), f"{100 * count / trials:.1f} %")
    notes = [] if failures else [f"no failures in {many(trials, 'trial')}"]
    if invalid:
        notes.append(
            f"{many(invalid, 'invalid trial')} left out: the simulation or a plug-in failed"
        )
    table.caption = "; ".join(notes)
    return table
