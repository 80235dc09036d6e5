"""Do two reproductions agree? Paired differences, robot by robot, from their databases.

    .venv/bin/python experiments/camera/compare.py CAMERA.db NOISY.db [--json FILE]

Both are of the same seed and number of robots, which differ in one thing, here the sensor. Prints
the mean difference of the successes in each cell and in the total, first less second, with its 95 %
interval (normal, over robots).
"""

import argparse
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
    args = parser.parse_args()
    first, second = successes(args.first), successes(args.second)
    if (
        first.keys() != second.keys()
        or len({len(v) for v in (*first.values(), *second.values())}) > 1
    ):
        parser.error("the two databases do not hold the same robots, tools and goals")
    rows = {cell: interval(first[cell] - second[cell]) for cell in first}
    paper = [cell for cell in first if cell[0] == "extension of reach"]
    total = interval(sum(first[cell] - second[cell] for cell in paper))
    broken = interval(sum(first[c] - second[c] for c in first if c not in paper))
    for (protocol, tool, goal), (mean, low, high) in rows.items():
        if protocol == "extension of reach":
            inside = low >= -CELL_BAR and high <= CELL_BAR
            print(
                f"{tool:8} goal {goal}: {mean:+.2f} ({low:+.2f} to {high:+.2f})"
                + ("" if inside else f"  NOT within +-{CELL_BAR}")
            )
    for name, (mean, low, high) in (("total of 80", total), ("broken, of 16", broken)):
        print(f"{name}: {mean:+.2f} ({low:+.2f} to {high:+.2f})")
    cells = {f"{tool}, goal {goal}": rows[p, tool, goal] for p, tool, goal in paper}
    result: dict[str, Any] = {
        "robots": len(next(iter(first.values()))),
        "cells": cells,
        "total": total,
        "broken": broken,
        "all_within_bars": all(abs(x) <= CELL_BAR for c in cells.values() for x in c[1:])
        and all(abs(x) <= TOTAL_BAR for x in total[1:]),
    }
    print(f"{result['robots']} robots; all within the bars: {result['all_within_bars']}")
    if args.json:
        args.json.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")


def successes(path: Path) -> dict[tuple[str, str, int], NDArray[np.float64]]:
    """Return the successes of each robot, by protocol, tool and goal."""
    found: dict[tuple[str, str, int], list[tuple[int, int]]] = {}
    with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as database:
        for protocol in ("extension of reach", "tool adaptation"):
            for tool, goal, robot, solved in database.execute(SOLVED, (protocol,)):
                found.setdefault((protocol, tool, goal), []).append((robot, solved))
    return {cell: np.array([s for _, s in sorted(pairs)], float) for cell, pairs in found.items()}


def interval(differences: NDArray[np.float64] | float) -> tuple[float, float, float]:
    """Return the mean and its 95 % interval."""
    values = np.asarray(differences)
    mean = float(values.mean())
    half = 1.96 * float(values.std(ddof=1)) / math.sqrt(values.size)
    return mean, mean - half, mean + half


if __name__ == "__main__":
    main()
