"""What robots solve of the 16 trials with each tool, and against an hour from scratch.

    .venv/bin/python experiments/carrying_over/bar.py carrying_over.db [--json results.json]

For each condition and tool the mean of the robots, and the mean difference, robot by robot, from
the first condition with the same planner, with 95 % intervals (Student's t); last of all tools.
"""

import argparse
import json
from collections import defaultdict
from pathlib import Path
from statistics import fmean
from typing import Any

from affcli.analysis.statistics import mean_interval
from affcli.store import open_store

OF = 16.0


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("database", type=Path)
    parser.add_argument("--experiment", default="carrying over")
    parser.add_argument("--json", type=Path, help="write the figures there too")
    args = parser.parse_args()
    first: dict[str, dict[str, list[int]]] = {}
    told: dict[str, Any] = {}
    with open_store(args.database, create=False, write=False) as store:
        chosen = next(one for one in store.experiments.all() if one.name == args.experiment)
        for name, session in chosen.conditions:
            planner = str(store.sessions.one(session).spec.planner)
            solved: dict[str, dict[int, int]] = defaultdict(lambda: defaultdict(int))
            for cell, robots in store.results.solved_by_cell(session, ("tool",)).items():
                for robot, (_, count) in robots.items():
                    solved[cell.tool][robot] += count
            own = {tool: [robots[n] for n in sorted(robots)] for tool, robots in solved.items()}
            own["all"] = [sum(robot) for robot in zip(*own.values(), strict=True)]
            against = first.setdefault(planner, own)
            told[name] = {
                tool: _summary(counts, against[tool], OF * (len(own) - 1 if tool == "all" else 1))
                for tool, counts in own.items()
            }
    for name, tools in told.items():
        print(f"{name}, {len(tools['all']['solved'])} robots")
        for tool, one in tools.items():
            line = f"  {tool:15} {one['mean']:7.2f} {one['difference']:+6.2f}"
            paired = "-" if one["paired"] is None else "{:+.2f} to {:+.2f}".format(*one["paired"])
            print(f"{line}  {paired:15} better/worse {one['better']}/{one['worse']}")
    if args.json is not None:
        args.json.write_text(json.dumps(told) + "\n")


def _summary(own: list[int], against: list[int], most: float) -> dict[str, Any]:
    """Return what a condition solved with a tool, and the difference from another, paired."""
    differences = [mine - theirs for mine, theirs in zip(own, against, strict=True)]
    return {
        "mean": fmean(own),
        "interval": mean_interval(own, 0.0, most),
        "difference": fmean(differences),
        "paired": mean_interval(differences, -most, most),
        "better": sum(one > 0 for one in differences),
        "worse": sum(one < 0 for one in differences),
        "solved": own,
    }


if __name__ == "__main__":
    main()
