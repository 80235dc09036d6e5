"""Are the intervals, tests and powers that affcli states right? Measured on data like ours.

    .venv/bin/python experiments/intervals/measure.py [--studies N] [--seed N] [--json FILE]

Studies of 5 to 200 robots are drawn again and again from robots whose truth is known: the 120 of
experiments/camera/pairs.csv with their two conditions, and simulated ones, whose cells have the
mean of the 200 in experiments/extension_of_reach/results.json and vary as those of the pairs do.
Each is judged by the functions that the commands use.
"""

import argparse
import csv
import json
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.stats import betabinom, norm

from affcli.analysis.adaptation import share_interval
from affcli.analysis.paired import LEVEL, Difference, holm, sign_flip_p
from affcli.analysis.power import robots_needed
from affcli.analysis.statistics import exact_interval, mean_interval
from affcli.core.results import Cell

HERE = Path(__file__).parent
REACH, BROKEN = "extension of reach", "tool adaptation"
SIZES = (5, 10, 20, 50, 100, 200)
STARTS = 4
TOGETHER = 0.5
"""Correlation of a simulated robot's chances in two conditions; of the pairs' totals it is 0.47."""
Counts = NDArray[np.int64]
"""A row a robot, a column a cell."""
Study = tuple[Counts, Counts]
"""The same robots in two conditions."""


@dataclass(frozen=True, eq=False)
class World:
    """Robots whose truth is known.

    Args:
        cells: (protocol, tool, goal) of each column.
        pairs: counts of 4 of robots in two conditions.
        chance: of a success in each cell, simulated.
        alike: how much more a robot's four trials of a cell are alike than trials of any robots.
    """

    cells: list[tuple[str, str, str]]
    pairs: Study
    chance: NDArray[np.float64]
    alike: NDArray[np.float64]

    @classmethod
    def read(cls) -> "World":
        """Return the robots of the experiments."""
        found: dict[tuple[str, str, str], list[tuple[int, int]]] = {}
        with (HERE.parent / "camera" / "pairs.csv").open(encoding="utf-8") as file:
            for row in csv.DictReader(file):
                cell = row["protocol"], row["tool"], row["goal"]
                found.setdefault(cell, []).append((int(row["first"]), int(row["second"])))
        both = np.array([found[cell] for cell in found]).transpose(2, 1, 0)
        path = HERE.parent / "extension_of_reach" / "results.json"
        results = json.loads(path.read_text(encoding="utf-8"))["cells"]
        means = {(REACH, one["tool"], str(one["goal"])): one["mean"] for one in results}
        of_pairs = both.mean(axis=(0, 1))
        chance = np.array([means.get(c, m) for c, m in zip(found, of_pairs, strict=True)]) / STARTS
        spread = STARTS * (of_pairs / STARTS) * (1.0 - of_pairs / STARTS)
        vary = both.reshape(-1, len(found)).var(axis=0)
        more = np.divide(vary, spread, out=np.ones_like(vary), where=spread > 0.0) - 1.0
        return cls(list(found), (both[0], both[1]), chance, np.clip(more / 3.0, 0.0, 0.99))

    @property
    def reach(self) -> NDArray[np.bool_]:
        """The columns of the paper's 80 trials."""
        return np.array([cell[0] == REACH for cell in self.cells])

    def drawn(self, rng: np.random.Generator, robots: int) -> Study:
        """Return so many of the robots that were, each maybe several times."""
        chosen = rng.integers(0, len(self.pairs[0]), robots)
        return self.pairs[0][chosen], self.pairs[1][chosen]

    def swapped(self, rng: np.random.Generator, robots: int) -> Study:
        """Return the same with the two conditions of each robot swapped or not: no difference."""
        before, after = self.drawn(rng, robots)
        swap = rng.random(robots)[:, None] < 0.5
        return np.where(swap, after, before), np.where(swap, before, after)

    def simulated(
        self, shift: float, rng: np.random.Generator, robots: int, *, alike_after: float = 1.0
    ) -> Study:
        """Return robots that try the paper's cells in two conditions.

        Args:
            shift: by how much the log odds of a success are higher in the second.
            rng, robots: noise, how many.
            alike_after: over `alike`, how much a robot's trials are alike in the second.
        """
        shape = (robots, len(self.cells))
        common = rng.standard_normal(shape)
        own = TOGETHER * common + math.sqrt(1.0 - TOGETHER**2) * rng.standard_normal(shape)
        return (
            _at(norm.cdf(common), self._below(0.0, 1.0)),
            _at(norm.cdf(own), self._below(shift, alike_after)),
        )

    @lru_cache(maxsize=16)  # noqa: B019 there is one world
    def _below(self, shift: float, alike_after: float) -> list[NDArray[np.float64]]:
        """Return for each cell the chances of at most 0, 1, 2, 3 of 4 (beta-binomial)."""
        found = []
        for p, rho in zip(self.shifted(shift), alike_after * self.alike, strict=True):
            rest = (1.0 - max(rho, 1e-6)) / max(rho, 1e-6)
            inside = min(max(p, 1e-12), 1.0 - 1e-12)
            found.append(
                betabinom.cdf(np.arange(STARTS), STARTS, inside * rest, (1.0 - inside) * rest)
            )
        return found

    def shifted(self, shift: float) -> NDArray[np.float64]:
        """Return the chances with higher log odds; what never or always succeeds stays so."""
        odds = self.chance * math.exp(shift)
        return odds / (odds + 1.0 - self.chance)

    def shift_for(self, difference: float) -> float:
        """Return the shift with which the total of 80 differs by so much."""

        def off(shift: float) -> float:
            gain = STARTS * (self.shifted(shift) - self.chance)[self.reach].sum()
            return float(gain) - difference

        return float(brentq(off, -8.0, 8.0))


def _at(quantiles: NDArray[np.float64], below: Sequence[NDArray[np.float64]]) -> Counts:
    """Return the counts at quantiles of the cells' distributions."""
    columns = [np.searchsorted(own, q) for own, q in zip(below, quantiles.T, strict=True)]
    return np.array(columns, dtype=np.int64).T


def covered(
    truth: float, intervals: Iterable[tuple[float, float] | None]
) -> dict[str, float | None]:
    """Return how many of 100 studies gave an interval, and how many of 100 of these were right."""
    all_of_them = list(intervals)
    given = [one for one in all_of_them if one is not None]
    right = [low - 1e-9 <= truth <= high + 1e-9 for low, high in given]
    return {
        "given": round(100.0 * len(given) / len(all_of_them), 1),
        "right": _percent(right) if given else None,
    }


def means(world: World, rng: np.random.Generator, studies: int, robots: int) -> dict[str, Any]:
    """Return how often intervals of means hold the truth: totals, differences, single cells."""
    reach, (before, after) = world.reach, world.pairs
    samples = [world.drawn(rng, robots) for _ in range(studies)]
    found: dict[str, Any] = {}
    for name, columns in (("of 80", reach), ("of 16", ~reach)):
        a, b = before[:, columns].sum(axis=1), after[:, columns].sum(axis=1)
        sums = [(x[:, columns].sum(axis=1), y[:, columns].sum(axis=1)) for x, y in samples]
        found[f"total {name}"] = covered(a.mean(), (mean_interval(x.tolist()) for x, _ in sums))
        differences = (mean_interval((y - x).tolist()) for x, y in sums)
        found[f"difference {name}"] = covered((b - a).mean(), differences)
    shift = world.shift_for(2.0)
    simulated = [world.simulated(shift, rng, robots) for _ in range(studies)]
    gains = [(y - x)[:, reach].sum(axis=1).tolist() for x, y in simulated]
    found["difference of 2, simulated"] = covered(2.0, map(mean_interval, gains))
    cells = []
    for column in range(len(world.cells)):
        one, other = before[:, column], after[:, column]
        own = (mean_interval(x[:, column].tolist()) for x, _ in samples)
        cells.append(covered(one.mean(), own))
        gained = (mean_interval((y - x)[:, column].tolist()) for x, y in samples)
        cells.append(covered((other - one).mean(), gained))
    given = sum(c["given"] or 0.0 for c in cells)
    wrong = [(c["given"] or 0.0) * (1.0 - (c["right"] or 0.0) / 100.0) for c in cells if c["given"]]
    found["single cells"] = {
        "given": round(given / len(cells), 1),
        "right": round(100.0 - 100.0 * sum(wrong) / given, 1) if given else None,
        "given and wrong, at most": round(max(wrong, default=0.0), 1),
    }
    return found


def shares(world: World, rng: np.random.Generator, studies: int, robots: int) -> dict[str, Any]:
    """Return how often intervals of shares hold the truth, and how often Wilson's would."""
    found: dict[str, list[float]] = {"exact": [], "Wilson": []}
    for truth in (0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.8, 0.9, 0.97):
        counts = rng.binomial(robots, truth, studies)
        for name, interval in (("exact", exact_interval), ("Wilson", wilson)):
            right = covered(truth, [interval(int(k), robots) for k in counts])["right"]
            found[name].append(right or 0.0)
    broken = world.pairs[0][:, ~world.reach].sum(axis=1)
    samples = (broken[rng.integers(0, len(broken), robots)] for _ in range(studies))
    alike = [share_interval([(int(k), 16) for k in sample]) for sample in samples]
    return {
        **{f"{name}, at least": min(rights) for name, rights in found.items()},
        "trials that share a robot": covered(broken.mean() / 16, alike),
    }


def wilson(kind: int, n: int) -> tuple[float, float]:
    """Return Wilson's interval, for comparison."""
    share, z2 = kind / n, norm.ppf(0.975) ** 2
    middle = (share + z2 / (2 * n)) / (1 + z2 / n)
    half = math.sqrt(z2 * (share * (1 - share) / n + z2 / (4 * n * n))) / (1 + z2 / n)
    return middle - half, middle + half


def alarms(world: World, rng: np.random.Generator, studies: int, robots: int) -> dict[str, Any]:
    """Return in how many of 100 studies without a difference one is called significant.

    In the total of 80, and in any cell. `other spread`: equal means, but robots that vary less in
    the second condition, which a test of swapping may tell from none.
    """
    worlds: dict[str, Callable[[np.random.Generator, int], Study]] = {
        "conditions swapped": world.swapped,
        "simulated": partial(world.simulated, 0.0),
        "other spread": partial(world.simulated, 0.0, alike_after=0.3),
    }
    found: dict[str, Any] = {}
    for name, draw in worlds.items():
        judged = [_judged(world, draw(rng, robots)) for _ in range(studies)]
        found[name] = {
            "total": _percent(total.p <= LEVEL for total, _ in judged),
            "any cell": _percent(any(c.significant for c in cells) for _, cells in judged),
            "not corrected": _percent(any(c.p <= LEVEL for c in cells) for _, cells in judged),
        }
    return found


def _judged(world: World, study: Study) -> tuple[Difference, Sequence[Difference]]:
    """Return the differences of a study: in the total of 80, and cell by cell."""
    before, after = study
    total = [(int(x), int(y)) for x, y in zip(
        before[:, world.reach].sum(axis=1), after[:, world.reach].sum(axis=1), strict=True
    )]  # fmt: skip
    cells = [
        Difference.of("", Cell(*cell), list(zip(x, y, strict=True)), STARTS)
        for cell, x, y in zip(world.cells, before.T.tolist(), after.T.tolist(), strict=True)
    ]
    whole = Difference.of("", Cell(REACH, ""), total, 80)
    return whole, holm([one for one in cells if not one.agree])


def _percent(events: Iterable[bool]) -> float:
    """Return how many of 100."""
    happened = list(events)
    return round(100.0 * sum(happened) / len(happened), 1)


def powers(world: World, rng: np.random.Generator, studies: int) -> list[dict[str, Any]]:
    """Return how often as many robots as `affcli power` asks for see a difference.

    In the total of 80 at 5 %; and in a cell, at the level of the first of Holm's.
    """
    found = []
    wanted: list[tuple[str, float, float, float, Any]] = [
        ("total of 80", d, world.shift_for(d), LEVEL, world.reach) for d in (4.0, 2.0, 1.0)
    ]
    for number, cell in enumerate(world.cells):
        if cell in ((REACH, "l-stick", "2"), (REACH, "t-stick", "2")):
            before, level = world.chance[number], LEVEL / len(world.cells)
            after = before + 1.0 / STARTS
            shift = math.log(after / (1.0 - after) / (before / (1.0 - before)))
            wanted.append((f"{cell[1]}, goal {cell[2]}", 1.0, shift, level, [number]))
    for name, difference, shift, level, columns in wanted:

        def gains(robots: int, shift: float = shift, columns: Any = columns) -> Counts:
            before, after = world.simulated(shift, rng, robots)
            return np.asarray((after - before)[:, columns].sum(axis=1))

        robots = robots_needed(difference, float(gains(20_000).std()), level, 0.8) or 0
        seen = _percent(sign_flip_p(gains(robots).tolist()) <= level for _ in range(studies))
        found.append({"of": name, "difference": difference, "robots": robots, "seen": seen})
    return found


def measured(studies: int, seed: int, sizes: Sequence[int] = SIZES) -> dict[str, Any]:
    """Return all of it."""
    world, rng = World.read(), np.random.default_rng(seed)
    parts = (("means", means), ("shares", shares), ("alarms", alarms))
    return {
        "studies": studies,
        "seed": seed,
        **{
            name: {str(robots): part(world, rng, studies, robots) for robots in sizes}
            for name, part in parts
        },
        "powers": powers(world, rng, studies),
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--studies", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, help="write the figures there too")
    args = parser.parse_args()
    result = measured(args.studies, args.seed)
    print(json.dumps(result, indent=1))
    if args.json:
        args.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
