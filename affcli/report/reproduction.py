"""The paper's results beside those of many robots: numbers for JSON, and the table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich.table import Table
from rich.text import Text

from affcli.report.paper import BROKEN_TOOL, EXTENSION_OF_REACH, TOTAL
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


def reproduction_table(result: Reproduction) -> Table:
    """Return the paper's table: in each cell its count, our mean and central 95 % of robots."""
    robots = f"{result.robots} robot{'s' if result.robots != 1 else ''}"
    table = Table(
        title=f"Extension of reach: paper | mean of {robots} [central 95 %]",
        caption="successes of 4 starts; ! = the paper's count lies outside",
        title_justify="left",
        caption_justify="left",
    )
    table.add_column("tool")
    for goal in (1, 2, 3, 4):
        table.add_column(f"goal {goal}", justify="right")
    for tool, counts in EXTENSION_OF_REACH.items():
        cells = [_cell(result.cells[tool, g], p, 1) for g, p in enumerate(counts, start=1)]
        table.add_row(tool, *cells)
    table.add_section()
    table.add_row("total of 80", _cell(result.totals, TOTAL, 1))
    table.add_row("broken of 16", _cell(result.broken, BROKEN_TOOL, 1))
    return table


def _cell(counts: Sequence[int], paper: int, digits: int) -> Text:
    """Return one cell: the paper's count, our mean, the central interval, ! when outside."""
    spread = Spread.of(counts)
    inside = spread.holds(paper)
    words = f"{paper} | {spread.mean:.{digits}f} [{spread.low},{spread.high}]"
    return Text(words if inside else f"{words}!", style="" if inside else "bold red")


def failures_table(failures: Mapping[str, int], trials: int) -> Table:
    """Return failures by kind, the commonest first.

    Args:
        failures: how often each kind of failure occurred.
        trials: how many trials there were, the solved ones included.
    """
    table = Table(title="Failures by kind", title_justify="left")
    table.add_column("kind")
    table.add_column("trials", justify="right")
    table.add_column("share of all", justify="right")
    for kind, count in sorted(failures.items(), key=lambda item: (-item[1], item[0])):
        table.add_row(kind, str(count), f"{100 * count / trials:.1f} %")
    if not failures:
        table.add_row("none", "0", "0.0 %")
    return table
