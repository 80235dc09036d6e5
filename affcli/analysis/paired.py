"""Two conditions compared robot by robot: differences, their intervals, tests, effect sizes."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import fmean

import numpy as np

from affcli.analysis.statistics import deviation, exact_interval, mean_interval
from affcli.core.results import Cell, ConditionCounts

LEVEL = 0.05
"""A difference is significant when its corrected p is at most this."""

Counts = Mapping[int, tuple[int, int]]
"""By robot how many trials ended, and how many were solved."""

FIELDS = ("tool", "shape", "goal", "start")
"""The fields of `Cell` that trials of a protocol and task set can be told apart by."""


@dataclass(frozen=True, slots=True)
class Difference:
    """What one condition solved less what the other did, over the robots that are in both.

    Args:
        condition: which is compared.
        cell: over which trials.
        robots: how many are in both with as many trials.
        trials: of each.
        before, after: solved on average in the condition compared against, and in this one.
        changes: of each robot what it solves more, from the least to the most.
        interval: 95 % of the mean difference, by Student's t; None where `mean_interval` has none.
        effect: mean over standard deviation of the differences (Cohen's d of pairs); None where
            all differences are the same.
        better, worse: how many robots solve more than before, or less.
        better_share: exact 95 % interval of the share of the better among those that differ.
        p: of the exact test (`sign_flip_p`).
        corrected: the same, corrected for all that is compared beside it (`holm`).
    """

    condition: str
    cell: Cell
    robots: int
    trials: float
    before: float
    after: float
    changes: tuple[int, ...]
    interval: tuple[float, float] | None
    effect: float | None
    better: int
    worse: int
    better_share: tuple[float, float]
    p: float
    corrected: float

    @classmethod
    def of(
        cls, condition: str, cell: Cell, pairs: Sequence[tuple[int, int]], trials: float
    ) -> "Difference":
        """Compare (before, after) of each robot, of which there is one at least."""
        differences = sorted(after - before for before, after in pairs)
        better, worse = sum(d > 0 for d in differences), sum(d < 0 for d in differences)
        spread = deviation(differences) if len(pairs) > 1 else 0.0
        p = sign_flip_p(differences)
        return cls(
            condition,
            cell,
            len(pairs),
            trials,
            fmean([before for before, _ in pairs]),
            fmean([after for _, after in pairs]),
            tuple(differences),
            mean_interval(differences, -trials, trials),
            fmean(differences) / spread if spread else None,
            better,
            worse,
            exact_interval(better, better + worse),
            *(p, p),
        )

    @property
    def mean(self) -> float:
        """The mean difference."""
        return self.after - self.before

    @property
    def agree(self) -> bool:
        """Every robot solves as many in both."""
        return not self.better and not self.worse

    @property
    def significant(self) -> bool:
        """Tell whether it is, after the correction."""
        return self.corrected <= LEVEL


@dataclass(frozen=True, slots=True)
class Comparison:
    """Conditions against one of them.

    Args:
        against: the one compared against.
        others: those compared with it.
        totals: over all trials of a protocol and task set that both conditions have.
        cells: by tool, goal or what else tells trials apart; none where nothing does.
        same: cells in which all robots agree: nothing to test, so nothing to correct for.
        left_out: by condition the robots that have not as many trials in both; all others pair.
        unshared: by condition what only it or the one compared against has, each the widest cell
            of which nothing is in both: nowhere in the differences, whatever tells trials apart.
    """

    against: ConditionCounts
    others: tuple[ConditionCounts, ...]
    totals: tuple[Difference, ...]
    cells: tuple[Difference, ...]
    same: tuple[Difference, ...]
    left_out: Mapping[str, tuple[int, ...]]
    unshared: Mapping[str, tuple[Cell, ...]]

    @classmethod
    def of(
        cls,
        against: ConditionCounts,
        others: Sequence[ConditionCounts],
        by: Sequence[str] = FIELDS,
    ) -> "Comparison":
        """Compare conditions with one; ValueError when one has no robot in common with it.

        Args:
            against, others: their cells by all of `FIELDS`: the trials that are in both are the
                same ones whatever they are told apart by.
            by: those of `FIELDS` that tell cells apart.
        """
        totals: list[Difference] = []
        cells: list[Difference] = []
        left_out: dict[str, tuple[int, ...]] = {}
        unshared: dict[str, tuple[Cell, ...]] = {}
        for other in others:
            if not in_common(against, other):
                raise ValueError(f"{against.name} and {other.name} have no robot in common")
            before, after = _shared(against.cells, other.cells), _shared(other.cells, against.cells)
            told = summed(before, by), summed(after, by)
            # Sums of sums: there are far fewer cells than trials.
            whole, unpaired = _compared(other.name, *map(summed, told))
            totals += whole
            without: set[int] = set()
            if by:
                found, without = _compared(other.name, *told)
                cells += found
            missing = unpaired | without | (against.robots ^ other.robots)
            if missing:
                left_out[other.name] = tuple(sorted(missing))
            alone = [cell for cell in (*against.cells, *other.cells) if cell not in before]
            if alone:
                unshared[other.name] = _widest(alone, before)
        return cls(
            against,
            tuple(others),
            holm(totals),
            holm([one for one in cells if not one.agree]),
            tuple(one for one in cells if one.agree),
            left_out,
            unshared,
        )


def in_common(one: ConditionCounts, other: ConditionCounts) -> frozenset[int]:
    """Return the robots that two conditions share: they have the same seed and number."""
    alike = one.session.spec.seed == other.session.spec.seed
    return one.robots & other.robots if alike else frozenset()


def _shared(own: Mapping[Cell, Counts], others: Mapping[Cell, Counts]) -> dict[Cell, Counts]:
    """Return those of a condition's cells that another has too."""
    return {cell: counts for cell, counts in own.items() if cell in others}


def _compared(
    condition: str, before: Mapping[Cell, Counts], after: Mapping[Cell, Counts]
) -> tuple[list[Difference], set[int]]:
    """Return the differences in the cells of two conditions, and the robots that do not pair."""
    found: list[Difference] = []
    unpaired: set[int] = set()
    for cell, own in before.items():
        theirs = after[cell]
        both = [robot for robot in sorted(own) if own[robot][0] == theirs.get(robot, (0, 0))[0]]
        unpaired |= (own.keys() | theirs.keys()) - set(both)
        if both:
            pairs = [(own[robot][1], theirs[robot][1]) for robot in both]
            trials = fmean([own[robot][0] for robot in both])
            found.append(Difference.of(condition, cell, pairs, trials))
    return found, unpaired


def _told_by(cell: Cell, by: Sequence[str]) -> Cell:
    """Return the cell that a cell is part of, told apart by fewer fields."""
    return Cell(cell.protocol, cell.task_set, **{field: getattr(cell, field) for field in by})


def _widest(alone: Sequence[Cell], shared: Iterable[Cell]) -> tuple[Cell, ...]:
    """Return for each cell that is not in both the widest one around it with nothing in both."""
    levels = ((), ("tool", "shape"), ("tool", "shape", "goal"), FIELDS)
    there = {_told_by(cell, by) for cell in shared for by in levels}
    around = ([_told_by(cell, by) for by in levels] for cell in alone)
    return tuple(dict.fromkeys(next(c for c in wide if c not in there) for wide in around))


def summed(
    cells: Mapping[Cell, Counts], by: Sequence[str] = ()
) -> dict[Cell, dict[int, tuple[int, int]]]:
    """Return what each robot solved of a protocol and task set, told apart by some of `FIELDS`."""
    sums: dict[Cell, dict[int, tuple[int, int]]] = defaultdict(dict)
    for cell, counts in cells.items():
        whole = sums[_told_by(cell, by)]
        for robot, (trials, solved) in counts.items():
            before = whole.get(robot, (0, 0))
            whole[robot] = before[0] + trials, before[1] + solved
    return sums


def all_tried(counts: Counts) -> list[int]:
    """Return what those robots solved that have as many trials as any: none of them invalid."""
    most = max(trials for trials, _ in counts.values())
    return [solved for trials, solved in counts.values() if trials == most]


def sign_flip_p(differences: Sequence[int]) -> float:
    """Return the two-sided p of paired differences by the exact sign-flip test (Fisher, 1935).

    If a condition makes no difference, each robot's two counts could as well be swapped: all signs
    are equally likely. p is the share of all signs whose sum is at least as far from 0; it is
    counted, not drawn, for any number of robots. Of differences of one size it is the sign test,
    of single trials McNemar's.
    """
    sizes = [abs(d) for d in differences if d]
    total = abs(sum(differences))
    if not total:
        return 1.0
    whole = sum(sizes)
    chances = np.zeros(whole + 1)
    chances[0] = 1.0
    for size in sizes:
        # Half of all ways leave this one out of the sum of the positive ones, half take it in.
        chances[size:] = (chances[size:] + chances[: whole + 1 - size]) / 2.0
        chances[:size] /= 2.0
    return min(1.0, 2.0 * float(chances[(whole + total + 1) // 2 :].sum()))


def holm(differences: Sequence[Difference]) -> tuple[Difference, ...]:
    """Return differences with p corrected for their number (Holm, 1979).

    Of all that are no differences at all, one or more is called significant in 5 % of studies.
    Where all robots agree nothing can be significant: these are not counted, and keep their p of 1.
    """
    tested = [number for number, one in enumerate(differences) if not one.agree]
    corrected = {number: one.p for number, one in enumerate(differences)}
    ordered = sorted(tested, key=lambda number: differences[number].p)
    least = 0.0
    for rank, number in enumerate(ordered):
        least = max(least, min(1.0, (len(ordered) - rank) * differences[number].p))
        corrected[number] = least
    return tuple(
        replace(one, corrected=corrected[number]) for number, one in enumerate(differences)
    )
