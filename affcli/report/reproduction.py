"""The paper's results beside those of many robots: numbers for JSON, and the table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich.text import Text

from affcli.report.paper import BROKEN_TOOL, EXTENSION_OF_REACH, TOTAL
from affcli.report.sheet import Sheet
from affcli.report.statistics import Spread


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
    """

    robots: int
    cells: Mapping[tuple[str, int], Sequence[int]]
    broken: Sequence[int]
    failures: Mapping[str, int]
    trials: int
    tries_on_lost: int

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
        caption="successes of 4 starts; ! = the paper's count lies outside",
        left=columns,
    )
    for tool, counts in EXTENSION_OF_REACH.items():
        cells = [_cell(result.cells[tool, g], p) for g, p in enumerate(counts, start=1)]
        table.add(tool, *cells)
    return table


def _totals_table(result: Reproduction) -> Sheet:
    """Return the total and the broken tool's successes beside the paper's."""
    table = Sheet(
        ("all trials", "paper", "mean", "95 % of the mean", "central 95 %"),
        left=("all trials",),
    )
    for name, counts, paper in (
        ("extension of reach, of 80", result.totals, TOTAL),
        ("broken tool, of 16", result.broken, BROKEN_TOOL),
    ):
        spread = Spread.of(counts)
        low, high = spread.mean_ci
        robots = _marked(f"[{spread.low},{spread.high}]", inside=spread.holds(paper))
        table.add(name, str(paper), f"{spread.mean:.1f}", f"{low:.1f} to {high:.1f}", robots)
    return table


def _cell(counts: Sequence[int], paper: int) -> Text:
    """Return one cell: the paper's count, our mean, the central interval."""
    spread = Spread.of(counts)
    words = f"{paper}|{spread.mean:.1f} [{spread.low},{spread.high}]"
    return _marked(words, inside=spread.holds(paper))


def _marked(words: str, *, inside: bool) -> Text:
    """Return the words of an interval, marked when the paper's count is not inside."""
    return Text(words) if inside else Text(f"{words}!", style="bold red")


def failures_table(failures: Mapping[str, int], trials: int) -> Sheet:
    """Return failures by kind, the commonest first.

    Args:
        failures: how often each kind of failure occurred.
        trials: how many trials there were, the solved ones included.
    """
    table = Sheet(("kind", "trials", "share of all"), title="Failures by kind", left=("kind",))
    for kind, count in sorted(failures.items(), key=lambda item: (-item[1], item[0])):
        table.add(kind, str(count), f"{100 * count / trials:.1f} %")
    if not failures:
        table.add("none", "0", "0.0 %")
    return table
