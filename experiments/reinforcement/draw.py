"""Draw results.jsonl: tasks solved against what was tried, for each learner.

.venv/reinforcement/bin/python experiments/reinforcement/draw.py
"""

import json
from collections import defaultdict
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from train import LEARNERS, PLANNERS, RESULTS

OUT = Path(__file__).parent / "learning.png"
TASKS = 16
NAMES = {
    "nested-query": "table, nested query",
    "lookahead": "table, lookahead",
    "rows": "PPO among the table's rows",
    "box": "PPO on places and behaviors",
}
COLORS = {"nested-query": "#0072b2", "lookahead": "#009e73", "rows": "#d55e00", "box": "#777777"}
MARKS = {"nested-query": "o", "lookahead": "s", "rows": "^", "box": "v"}


def main() -> None:
    """Draw each seed thin and their mean thick; print the means."""
    found: dict[str, dict[int, dict[int, int]]] = defaultdict(lambda: defaultdict(dict))
    for line in RESULTS.read_text().splitlines():
        one = json.loads(line)
        found[one["learner"]][one["seed"]][one["steps"]] = one["solved"]
    figure, axes = plt.subplots(figsize=(7.0, 4.2), layout="constrained")
    for learner in (*PLANNERS, *LEARNERS):
        seeds = found[learner]
        for one in seeds.values():
            axes.plot(*zip(*sorted(one.items()), strict=True), color=COLORS[learner], lw=0.5)
        steps = sorted(set.intersection(*(set(one) for one in seeds.values())))
        means = [sum(one[n] for one in seeds.values()) / len(seeds) for n in steps]
        marked = {"color": COLORS[learner], "marker": MARKS[learner], "label": NAMES[learner]}
        axes.plot(steps, means, lw=2.0, ms=5, **marked)
        print(f"{learner} ({len(seeds)} seeds):", dict(zip(steps, means, strict=True)))
    axes.set_ylim(0.0, TASKS + 0.3)
    axes.set_xscale("log")
    axes.set_xlim(20, 50_000)
    axes.set_xlabel("behaviors tried: by babbling, and by reinforcement learning")
    axes.set_ylabel("tasks of the T-hook solved, of 16")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0.02, 0.4))
    figure.savefig(OUT, dpi=130)


if __name__ == "__main__":
    main()
