"""What the robots of each condition solved, in how many robot minutes, and how the others failed.

    .venv/bin/python experiments/better_robot/measure.py DB [--json results.json] [--out robots.png]

Prints a table in Markdown. Means have 95 % intervals by Student's t where they have one; shares of
robots have exact ones (Clopper and Pearson).
"""

import argparse
import json
import sqlite3
from collections import Counter
from collections.abc import Mapping
from contextlib import closing
from pathlib import Path
from statistics import fmean
from typing import Any, NamedTuple

from matplotlib.axes import Axes

from affcli.analysis.paired import all_tried, summed
from affcli.analysis.statistics import exact_interval, mean_interval
from affcli.core.specs import Protocol
from affcli.lab.conditions import Condition, counts_of, experiment_named
from affcli.lab.definition import experiment_of
from affcli.lab.experiment import Condition as Life
from affcli.report.figures.canvas import BLUE, FAINT, INK, PALE, TWO_COLUMNS, canvas, encoded
from affcli.store import Store, open_store

EXPERIMENT = "better-robot"
OF = {Protocol.EXTENSION_OF_REACH: 80, Protocol.TOOL_ADAPTATION: 16}
HEADS = (
    *("condition", "minutes", "of 80", "robots with 80", "of 16, broken", "robots with 16"),
    *("steps, s", "failed trials, of 96"),
)
FAILED = """
SELECT tool, shape, goal, outcome, COUNT(*) FROM trial
WHERE session_id = ? AND outcome <> 'solved' AND (shape <> tool) = (protocol = 'tool adaptation')
GROUP BY 1, 2, 3, 4 ORDER BY 5 DESC, 1, 2, 3, 4
"""
TRIALS = """
SELECT outcome, COUNT(*), SUM(steps), SUM(robot_seconds) FROM trial
WHERE session_id = ? AND protocol = ? AND (shape <> tool) = (protocol = 'tool adaptation')
GROUP BY 1
"""


class Told(NamedTuple):
    """What there is to tell of a condition.

    Args:
        name: of the condition.
        focus, invents, ahead: which ingredients it has.
        inventing, learning: robot minutes for these, with all tools.
        solved: by protocol, of each robot.
        failures: by protocol and outcome, in all.
        failed: by tool held and goal, with the outcome and how many, in all; most first.
        steps, seconds: of a solved trial of the extension of reach, mean.
    """

    name: str
    focus: bool
    invents: bool
    ahead: bool
    inventing: float
    learning: float
    solved: Mapping[str, list[int]]
    failures: Mapping[Protocol, Mapping[str, int]]
    failed: list[tuple[str, str, str, str, int]]
    steps: float
    seconds: float

    @property
    def minutes(self) -> float:
        """All robot minutes that it took to learn."""
        return self.inventing + self.learning

    def whole(self, protocol: str) -> int:
        """Return how many robots solved all of a protocol."""
        return sum(one == OF[Protocol(protocol)] for one in self.solved[protocol])


def main() -> None:
    """Print the table; write and draw where asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("database", type=Path)
    parser.add_argument("--json", type=Path, help="write the figures there too")
    parser.add_argument("--out", type=Path, help="draw them there")
    args = parser.parse_args()
    driver = sqlite3.connect(f"file:{args.database}?mode=ro", uri=True)
    with open_store(args.database, create=False, write=False) as store, closing(driver):
        conditions = experiment_named(store, EXPERIMENT)
        lives = experiment_of(store.experiments.named(EXPERIMENT).definition, EXPERIMENT).conditions
        told = [
            told_of(store, driver, one, life) for one, life in zip(conditions, lives, strict=True)
        ]
    spec = conditions[0].session.spec
    print(f"| {' | '.join(HEADS)} |\n|{'---|' * len(HEADS)}")
    for one in told:
        print(row(one))
    if args.json is not None:
        head = {"robots": spec.robots, "seed": spec.seed}
        each = [{**one._asdict(), "whole": {p: one.whole(p) for p in one.solved}} for one in told]
        args.json.write_text(json.dumps({**head, "conditions": each}, indent=None) + "\n")
    if args.out is not None:
        args.out.write_bytes(drawn(told, spec.robots, spec.seed, args.out.suffix))


def told_of(store: Store, driver: sqlite3.Connection, condition: Condition, life: Life) -> Told:
    """Return what there is to tell of a condition."""
    session = condition.session
    solved = {
        cell.protocol: [int(value) for value in all_tried(own)]
        for cell, own in summed(broken_or_learned(store, condition)).items()
    }
    ends = {
        protocol: {end: sums for end, *sums in driver.execute(TRIALS, (session.id, protocol))}
        for protocol in OF
    }
    trials, steps, seconds = ends[Protocol.EXTENSION_OF_REACH]["solved"]
    failures = {
        protocol: {end: sums[0] for end, sums in own.items() if end != "solved"}
        for protocol, own in ends.items()
    }
    spec = session.spec
    return Told(
        condition.name,
        spec.explorer.name != "random",
        bool(life.inventing),
        spec.planner.name != "nested-query",
        sum(one.minutes for one in life.inventing),
        60.0 * life.hours * len(life.tools),
        solved,
        failures,
        driver.execute(FAILED, (session.id,)).fetchall(),
        steps / trials,
        seconds / trials,
    )


def broken_or_learned(store: Store, condition: Condition) -> dict[Any, Any]:
    """Return what robots solved, of the adaptation only with the tool that broke."""
    cells = counts_of(store, condition).cells
    whole_again = Protocol.TOOL_ADAPTATION
    return {
        cell: own
        for cell, own in cells.items()
        if cell.protocol != whole_again or cell.shape != cell.tool
    }


def row(one: Told) -> str:
    """Return a line of the table."""
    shown = [one.name, f"{one.inventing:.0f} + {one.learning:.0f}"]
    for protocol, most in OF.items():
        solved = one.solved[protocol]
        within = mean_interval(solved, 0.0, most)
        shown.append(
            f"{fmean(solved):.2f}" + (f" ({within[0]:.2f} to {within[1]:.2f})" if within else "")
        )
        low, high = exact_interval(whole := one.whole(protocol), len(solved))
        shown.append(f"{whole / len(solved):.1%} ({low:.1%} to {high:.1%})".replace("%", " %"))
    shown.append(f"{one.steps:.1f}, {one.seconds:.1f}")
    failed: Counter[str] = Counter()
    for ends in one.failures.values():
        failed.update(ends)
    robots = len(one.solved[Protocol.EXTENSION_OF_REACH])
    shown.append(", ".join(f"{end} {n / robots:.2f}" for end, n in failed.most_common()) or "none")
    return f"| {' | '.join(shown)} |"


def drawn(told: list[Told], robots: int, seed: int, ending: str) -> bytes:
    """Return the figure: a line of robots for each condition, by what they solved."""
    with canvas(TWO_COLUMNS, 0.28 * len(told) + 0.75) as figure:
        kinds, *panels = figure.subplots(
            1, 3, sharey=True, gridspec_kw={"width_ratios": [1.0, 2.4, 1.3]}
        )
        ingredients(kinds, told)
        for axes, protocol, first in zip(panels, OF, (40, 4), strict=True):
            for place, one in enumerate(told):
                strip(axes, place, one.solved[protocol])
            most = OF[protocol]
            axes.set_xlim(first, most + 0.06 * (most - first))
            axes.set_xticks(range(first, most + 1, most // 8 if most > 20 else 4))
            axes.grid(axis="x", color=PALE, linewidth=0.5)
            axes.set_axisbelow(True)
            axes.tick_params(axis="y", length=0.0)
        panels[0].set_xlabel("solved trials of 80, five tools")
        panels[1].set_xlabel("of 16, broken tool")
        kinds.set_ylim(len(told) - 0.4, -0.6)
        kinds.set_yticks(range(len(told)), [f"{one.name}  " for one in told])
    caption = (
        f"{robots} robots, seed {seed}. Each dot: robots that solved so many, by its area; bar: "
        "their mean. Filled squares: the robot has it. Minutes: robot time to learn."
    )
    return encoded(figure, ending, title="", caption=caption)


def ingredients(axes: Axes, told: list[Told]) -> None:
    """Draw which ingredients each condition has, and its minutes."""
    names = ("focus", "invention", "lookahead")
    for place, one in enumerate(told):
        for column, has in enumerate((one.focus, one.invents, one.ahead)):
            axes.scatter(column, place, s=22, marker="s", facecolor=INK if has else "white",
                         edgecolor=INK if has else FAINT, linewidth=0.6)  # fmt: skip
        axes.text(3.0, place, f"{one.minutes:.0f}", ha="center", va="center")
    axes.set_xlim(-0.6, 3.5)
    axes.set_xticks(range(4), [*names, "minutes"], rotation=60, ha="left")
    axes.xaxis.tick_top()
    axes.tick_params(length=0.0)
    axes.spines[:].set_visible(False)


def strip(axes: Axes, place: int, solved: list[int]) -> None:
    """Draw the robots of a condition by what they solved, and their mean."""
    for number, robots in Counter(solved).items():
        axes.scatter(number, place, s=130.0 * robots / len(solved) + 0.6, color=BLUE, alpha=0.55,
                     linewidth=0.0, clip_on=False)  # fmt: skip
    mean = fmean(solved)
    axes.plot([mean, mean], [place - 0.34, place + 0.34], color=INK, linewidth=1.2)


if __name__ == "__main__":
    main()
