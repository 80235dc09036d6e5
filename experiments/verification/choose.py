"""How the constants of verification and prediction were settled: other values beside them.

    .venv/bin/python experiments/verification/choose.py [--robots N] [--seed N]

Prints, on robots that no result is reported on, what other shares told apart and other radii would
give, for all five tools at once.
"""

import argparse
import math
from collections.abc import Sequence
from itertools import product

from measure import CHANGED, INTACT, PUSHES, Life, hour_of, learned, lives, tested

from affcli.core.trial import BabblingRecord
from affcli.core.verification import BOUND
from affcli.lab.predicting import fresh_pushes
from affcli.planning.prediction import TablePredictor
from affcli.simulation.tools.paper import TOOL_PARTS

SHARES = tuple(product((0.02, 0.03, 0.05), (0.10, 0.15, 0.20)))
"""Pairs of failure rates told apart: intact, changed."""
RADII = (0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--robots", type=int, default=100)
    parser.add_argument("--seed", type=int, default=100)
    args = parser.parse_args()
    lived = lives(args.robots, args.seed, "noisy", 2)
    print(f"{args.robots} robots of seed {args.seed}; verdicts until the first, of all of them")
    for intact, changed in SHARES:
        print(f"{intact} against {changed}: tools as they were")
        show(lived, INTACT, intact, changed)
        print(f"{intact} against {changed}: tools that changed")
        show(lived, CHANGED, intact, changed)
    show_radii(range(args.robots // 5), args.seed)


def show(
    lived: Sequence[Life], pairs: Sequence[tuple[str, str]], intact: float, changed: float
) -> None:
    """Print how many robots come to which verdict, and after how many tries in the median."""
    for tool, shape in pairs:
        found = [
            first_verdict([one.replicated for one in life.tried[tool, shape]], intact, changed)
            for life in lived
        ]
        count = {word: sum(w == word for w, _ in found) for word in ("holds", "changed", "neither")}
        tries = sorted(n for word, n in found if word != "neither")
        print(f"  {tool:8} as {shape:8} {count}, median {tries[len(tries) // 2] if tries else '-'}")


def first_verdict(tries: Sequence[bool], intact: float, changed: float) -> tuple[str, int]:
    """Return the first verdict, and after which try."""
    evidence = 0.0
    for number, replicated in enumerate(tries, start=1):
        ratio = (1.0 - changed) / (1.0 - intact) if replicated else changed / intact
        evidence += math.log(ratio)
        if abs(evidence) >= BOUND:
            return ("changed" if evidence > 0.0 else "holds"), number
    return "neither", len(tries)


def show_radii(robots: range, seed: int) -> None:
    """Print hits, false alarms and right answers for each radius, over all tools."""
    asked = []
    for tool, robot in product(TOOL_PARTS, robots):
        run = hour_of(tool, seed, robot, "noisy")
        asked.append((learned(run), list(fresh_pushes(tested(run, tool, PUSHES), run))))
    print(f"{len(robots)} robots a tool, {PUSHES} pushes each")
    for radius in RADII:
        counts = [counted(TablePredictor(rows, radius), pushes) for rows, pushes in asked]
        moved, hits, still, alarms = map(sum, zip(*counts, strict=True))
        right = (hits + still - alarms) / (moved + still)
        print(
            f"  radius {radius}: hits {hits / moved:.3f}, false alarms {alarms / still:.3f}, "
            f"difference {hits / moved - alarms / still:.3f}, right answers {right:.3f}"
        )


def counted(table: TablePredictor, pushes: Sequence[BabblingRecord]) -> tuple[int, int, int, int]:
    """Return how many pushes moved, were predicted to; did not, were predicted to."""
    said = [
        (
            push.affordance is not None,
            table.predict(push.execution.call, push.start.wrist_to_object).distance > 0.0,
        )
        for push in pushes
    ]
    moved = [predicted for happened, predicted in said if happened]
    still = [predicted for happened, predicted in said if not happened]
    return len(moved), sum(moved), len(still), sum(still)


if __name__ == "__main__":
    main()
