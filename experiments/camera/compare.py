"""Do two reproductions agree? Paired differences, robot by robot, from their databases.

    .venv/bin/python experiments/camera/compare.py CAMERA.db NOISY.db [--json FILE]

Both are of the same seed and differ in one thing, here the sensor; robots that only one of them has
are left out. Prints the mean difference of the successes in each cell and in the total, first less
second, with its 95 % interval (normal, over robots).
"""

import argparse
import csv
import json
import math
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

CELL_BAR, TOTAL_BAR = 0.5, 2.0
"""The intervals are to lie within these."""

SOLVED = """
select t.tool, t.goal, t.robot, sum(t.outcome = 'solved')
from trial t join session s on s.id = t.session_id
where s.kind = 'reproduce' and t.protocol = ? group by t.tool, t.goal, t.robot
"""


def main() -> None:
    """Compare and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("first", type=Path)
    parser.add_argument("second", type=Path)
    parser.add_argument("--json", type=Path, help="write the figures there too")
    parser.add_argument("--pairs", type=Path, help="write each robot's successes there, as CSV")
    args = parser.parse_args()
    first, second = successes(args.first), successes(args.second)
    robots = robots_of(first) & robots_of(second)
    if first.keys() != second.keys() or len(robots) < 2:
        parser.error(
            "the two databases must have two robots or more in common, and all their trials"
        )
    differences = {
        cell: np.array(
            [first[cell][robot] - second[cell][robot] for robot in sorted(robots)], float
        )
        for cell in first
    }
    rows = {cell: interval(found) for cell, found in differences.items()}
    paper = [cell for cell in rows if cell[0] == "extension of reach"]
    total = interval(sum(differences[cell] for cell in paper))
    broken = interval(sum(found for cell, found in differences.items() if cell not in paper))
    for (protocol, tool, goal), (mean, low, high) in rows.items():
        if protocol == "extension of reach":
            inside = low >= -CELL_BAR and high <= CELL_BAR
            print(
                f"{tool:8} goal {goal}: {mean:+.3f} ({low:+.3f} to {high:+.3f})"
                + ("" if inside else f"  NOT within +-{CELL_BAR}")
            )
    for name, (mean, low, high) in (("total of 80", total), ("broken, of 16", broken)):
        print(f"{name}: {mean:+.3f} ({low:+.3f} to {high:+.3f})")
    cells = {f"{tool}, goal {goal}": rows[p, tool, goal] for p, tool, goal in paper}
    result: dict[str, Any] = {
        "robots": len(robots),
        "cells": cells,
        "total": total,
        "broken": broken,
        "all_within_bars": all(abs(x) <= CELL_BAR for c in cells.values() for x in c[1:])
        and all(abs(x) <= TOTAL_BAR for x in total[1:]),
    }
    print(f"{result['robots']} robots; all within the bars: {result['all_within_bars']}")
    if args.pairs:
        write_pairs(args.pairs, first, second, sorted(robots))
    if args.json:
        args.json.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")


def successes(path: Path) -> dict[tuple[str, str, str], dict[int, int]]:
    """Return the successes of each robot, by protocol, tool and goal."""
    found: dict[tuple[str, str, str], dict[int, int]] = {}
    with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as database:
        for protocol in ("extension of reach", "tool adaptation"):
            for tool, goal, robot, solved in database.execute(SOLVED, (protocol,)):
                found.setdefault((protocol, tool, goal), {})[robot] = solved
    return found


def robots_of(found: dict[tuple[str, str, str], dict[int, int]]) -> set[int]:
    """Return the robots that have successes in every cell."""
    return set.intersection(*map(set, found.values())) if found else set()


def write_pairs(
    path: Path,
    first: dict[tuple[str, str, str], dict[int, int]],
    second: dict[tuple[str, str, str], dict[int, int]],
    robots: list[int],
) -> None:
    """Write the successes of each robot in each cell, in both databases."""
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("protocol", "tool", "goal", "robot", "first", "second"))
        for protocol, tool, goal in first:
            cell = (protocol, tool, goal)
            rows.writerows(
                (*cell, robot, first[cell][robot], second[cell][robot]) for robot in robots
            )


def interval(differences: NDArray[np.float64] | float) -> tuple[float, float, float]:
    """Return the mean and its 95 % interval."""
    values = np.asarray(differences)
    mean = float(values.mean())
    half = 1.96 * float(values.std(ddof=1)) / math.sqrt(values.size)
    return mean, mean - half, mean + half


if __name__ == "__main__":
    main()
