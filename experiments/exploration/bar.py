"""What each condition solves of the 44 trials that an hour of random babbling solves nearly always.

    .venv/bin/python experiments/exploration/bar.py exploration.db [--json results.json]

They are those of T-hook, L-stick and stick, but for the stick at goal 1, where it cannot pull.
Prints the mean of the robots of each condition, and its difference, robot by robot, from the first
with the same planner, with 95 % intervals (Student's t). The JSON has each robot's successes, and
those with all tools.
"""

import argparse
import json
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from statistics import fmean
from typing import Any

from affcli.analysis.statistics import mean_interval
from affcli.core.results import Cell
from affcli.lab.conditions import counts_of, experiment_named
from affcli.store import open_store

EXPERIMENT = "exploration"
TOOLS = ("t-hook", "l-stick", "stick")
OF = 44.0


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("database", type=Path)
    parser.add_argument("--json", type=Path, help="write the figures there too")
    args = parser.parse_args()
    with open_store(args.database, create=False, write=False) as store:
        conditions = experiment_named(store, EXPERIMENT)
        counts = {one.name: counts_of(store, one).cells for one in conditions}
    spec = conditions[0].session.spec
    planner = {one.name: str(one.session.spec.planner) for one in conditions}
    firsts = {planner[name]: name for name in reversed(list(planner))}
    told = {name: summary(own, counts[firsts[planner[name]]]) for name, own in counts.items()}
    for name, one in told.items():
        line = f"{name:36} {one['mean']:5.1f} {within(one['interval'], '.1f')}"
        if name not in firsts.values():
            line += f"; {one['difference']:+.1f} {within(one['paired'], '+.1f')}"
        print(line)
    if args.json is not None:
        head = {"robots": spec.robots, "seed": spec.seed, "against": firsts}
        args.json.write_text(json.dumps({**head, "conditions": told}, indent=1) + "\n")


def within(interval: tuple[float, float] | None, form: str) -> str:
    """Return an interval in words."""
    if interval is None:
        return "(no interval)"
    low, high = interval
    return f"({low:{form}} to {high:{form}})"


def summary(cells: Mapping[Cell, Any], against: Mapping[Cell, Any]) -> dict[str, Any]:
    """Return what a condition solved of the 44, and of each tool's trials, robot by robot."""
    own, first = (of_44(each) for each in (cells, against))
    by_tool: dict[str, dict[int, int]] = defaultdict(lambda: defaultdict(int))
    for cell, robots in cells.items():
        for robot, (_, solved) in robots.items():
            by_tool[cell.tool][robot] += solved
    differences = [after - before for after, before in zip(own, first, strict=True)]
    return {
        "mean": fmean(own),
        "interval": mean_interval(own, 0.0, OF),
        "difference": fmean(differences),
        "paired": mean_interval(differences, -OF, OF),
        "solved": own,
        "of_each_tool": {
            tool: [robots[number] for number in sorted(robots)] for tool, robots in by_tool.items()
        },
    }


def of_44(cells: Mapping[Cell, Any]) -> list[int]:
    """Return how many of the 44 each robot solved, in the order of the robots."""
    solved: dict[int, int] = defaultdict(int)
    for cell, robots in cells.items():
        if cell.tool in TOOLS and (cell.tool, cell.goal) != ("stick", "1"):
            for robot, (_, count) in robots.items():
                solved[robot] += count
    return [solved[robot] for robot in sorted(solved)]


if __name__ == "__main__":
    main()
