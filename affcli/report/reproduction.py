"""The paper's results beside those of many robots: numbers for JSON, and the table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich.text import Text

from affcli.report.paper import BROKEN_TOOL, EXTENSION_OF_REACH, TOTAL
from affcli.report.sheet import Sheet
from affcli.report.statistics import Spread

ENOUGH_ROBOTS = 20
"""With fewer, the central 95 % of robots is hardly more than their range: nothing is marked."""


@dataclass(frozen=True, slots=True)
class Reproduction:
    """What N robots gave.

    Args:
        robots: N.
        cells: successes of 4 of each robot, by (tool, goal).
        broken: successes of 16 of each robot with the broken tool.
        failures: how often each kind of failure occurred, over both experiments.
        trials: all trials of both experiments.
        tries_on_lost: tries on lost affordances with the broken tool, over all its trials.
        session: its number in the database.
        seed: shared by its robots.
        settings: how its settings differ from the defaults, in words.
    """

    robots: int
    cells: Mapping[tuple[str, int], Sequence[int]]
    broken: Sequence[int]
    failures: Mapping[str, int]
    trials: int
    tries_on_lost: int
    session: int
    seed: int
    settings: str

    @property
    def totals(self) -> list[int]:
        """Successes of 80 of each robot."""
        return [sum(column) for column in zip(*self.cells.values(), strict=True)]


def reproduction_json(result: Reproduction) -> dict[str, Any]:
    """Return the result as JSON types: 20 cells, the total, the broken tool, failures by kind."""
    cells = []
    for tool, counts in EXTENSION_OF_REACH.items():
        for goal, paper in enumerate(counts, start=1):
            mine = result.cells[tool, goal]
            cells.append(
                {
                    "tool": tool,
                    "goal": goal,
                    **_against(mine, paper),
                    "p_paper": sum(k == paper for k in mine) / len(mine),
                }
            )
    return {
        "robots": result.robots,
        "seed": result.seed,
        "session": result.session,
        "settings": result.settings,
        "cells": cells,
        "total": _against(result.totals, TOTAL),
        "broken": _against(result.broken, BROKEN_TOOL),
        "failures": dict(result.failures),
        "trials": result.trials,
        "tries_on_lost": result.tries_on_lost,
    }


def _against(counts: Sequence[int], paper: int) -> dict[str, Any]:
    """Return the spread of `counts` beside the paper's count."""
    spread = Spread.of(counts)
    return {
        "paper": paper,
        "mean": spread.mean,
        "mean_ci": list(spread.mean_ci),
        "low": spread.low,
        "high": spread.high,
        "inside": spread.holds(paper),
    }


def reproduction_tables(result: Reproduction) -> tuple[Sheet, Sheet, Sheet]:
    """Return the paper's table with ours in its cells, the totals, and the failures."""
    return (
        _cells_table(result),
        _totals_table(result),
        failures_table(result.failures, result.trials),
    )


def _cells_table(result: Reproduction) -> Sheet:
    """Return the paper's table: in each cell its count, our mean and central 95 % of robots."""
    robots = f"{result.robots} robot{'s' if result.robots != 1 else ''}"
    columns = ("tool", "goal 1", "goal 2", "goal 3", "goal 4")
    table = Sheet(
        columns,
        title=f"Extension of reach: paper|mean of {robots} [central 95 %]",
        caption=f"successes of 4 starts; {_note(result.robots)}\n"
        f"session {result.session}, seed {result.seed}, settings: {result.settings}",
        left=columns,
    )
    for tool, counts in EXTENSION_OF_REACH.items():
        cells = [_cell(result.cells[tool, goal], paper) for goal, paper in enumerate(counts, 1)]
        table.add(tool, *cells)
    return table


def _totals_table(result: Reproduction) -> Sheet:
    """Return the total and the broken tool's successes beside the paper's."""
    table = Sheet(
        ("all trials", "paper", "mean", "95 % interval of the mean", "central 95 %"),
        left=("all trials",),
    )
    for name, counts, paper in (
        ("extension of reach, of 80", result.totals, TOTAL),
        ("broken tool, of 16", result.broken, BROKEN_TOOL),
    ):
        spread = Spread.of(counts)
        low, high = spread.mean_ci
        robots = _marked(f"[{spread.low},{spread.high}]", counts, paper)
        table.add(name, str(paper), f"{spread.mean:.1f}", f"{low:.1f} to {high:.1f}", robots)
    return table


def _cell(counts: Sequence[int], paper: int) -> Text:
    """Return one cell: the paper's count, our mean, the central interval."""
    spread = Spread.of(counts)
    words = f"{paper}|{spread.mean:.1f} [{spread.low},{spread.high}]"
    return _marked(words, counts, paper)


def _marked(words: str, counts: Sequence[int], paper: int) -> Text:
    """Return the words of an interval, marked when enough robots leave the paper's count out."""
    outside = len(counts) >= ENOUGH_ROBOTS and not Spread.of(counts).holds(paper)
    return Text(f"{words}!", style="bold red") if outside else Text(words)


def _note(robots: int) -> str:
    """Return what the mark means, or that there are too few robots for one."""
    if robots < ENOUGH_ROBOTS:
        return f"too few robots for intervals: give --robots {ENOUGH_ROBOTS} or more"
    return "! = the paper's count lies outside"


def failures_table(failures: Mapping[str, int], trials: int) -> Sheet:
    """Return failures by kind, the commonest first.

    Args:
        failures: how often each kind of failure occurred.
        trials: how many trials there were, the solved ones included.
    """
    table = Sheet(
        ("kind", "trials", "share of all trials"), title="Failures by kind", left=("kind",)
    )
    for kind, count in sorted(failures.items(), key=lambda item: (-item[1], item[0])):
        table.add(kind, str(count), f"{100 * count / trials:.1f} %")
    if not failures:
        table.caption = f"no failures in {trials} trials"
    return table
