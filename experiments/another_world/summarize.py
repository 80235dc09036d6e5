"""Say what results.jsonl says: the share of resets solved within KinDER's budgets, as a table.

.venv/another-world/bin/python experiments/another_world/summarize.py
"""

import json
import statistics
from collections import Counter, defaultdict
from typing import Any

from evaluate import RESULTS

from affcli.analysis.statistics import exact_interval

BUDGETS = (200, 300, 3000)


def share(solved: int, tries: int) -> str:
    """Write a share with its exact 95 % interval: ``93 (86 to 97)``."""
    low, high = exact_interval(solved, tries)
    return f"{100 * solved / tries:.0f} ({100 * low:.0f} to {100 * high:.0f})"


def row(found: list[dict[str, Any]]) -> list[str]:
    """Return the cells of one planner in one variant."""
    steps = sorted(one["steps"] for one in found if one["solved"])
    within = [share(sum(s <= budget for s in steps), len(found)) for budget in BUDGETS]
    ended = Counter(one["ended"] for one in found if not one["solved"])
    others = ", ".join(f"{n} {end}" for end, n in sorted(ended.items())) or "none"
    median = f"{statistics.median(steps):.0f}" if steps else "-"
    return [str(len(found)), *within, median, others]


def main() -> None:
    """Write the table as Markdown."""
    found = defaultdict(list)
    for line in RESULTS.read_text().splitlines():
        one = json.loads(line)
        found[one["obstacles"], one["way"]].append(one)
    heads = [*(f"% within {budget} steps" for budget in BUDGETS), "median of solved", "not solved"]
    print("| variant | rows chosen by | resets |", " | ".join(heads), "|")
    print("|" + " --- |" * (3 + len(heads)))
    for (obstacles, way), episodes in found.items():
        print(f"| o{obstacles} | {way} |", " | ".join(row(episodes)), "|")


if __name__ == "__main__":
    main()
