"""Our results beside the paper's, as a figure shows them (§7.1, §7.2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from affcli.core.task import START_NUMBERS
from affcli.report.paper import BROKEN_TOOL, EXTENSION_OF_REACH, TOTAL
from affcli.report.reproduction import ENOUGH_ROBOTS, Reproduction
from affcli.report.statistics import Spread

STARTS = len(START_NUMBERS)
"""The most successes in a cell."""


@dataclass(frozen=True, slots=True)
class SingleRobots:
    """What ``affcli solve`` and ``affcli break-tool`` gave, with one robot a tool.

    Args:
        cells: (solved, tried) by (tool, goal); of each start the latest trial counts.
        broken: (solved, tried) of the trials with the broken tool.
        title: whose trials they are, in words.
    """

    cells: Mapping[tuple[str, int], tuple[int, int]]
    broken: tuple[int, int]
    title: str


@dataclass(frozen=True, slots=True)
class Beside:
    """Successes beside the paper's.

    Args:
        paper: the paper's count; None where the paper has none.
        counts: ours, one a robot; none when nothing was tried.
        tried: out of how many.
    """

    paper: int | None
    counts: Sequence[int]
    tried: int

    @property
    def spread(self) -> Spread | None:
        """Intervals over the robots; None when there are too few of them."""
        return Spread.of(self.counts) if len(self.counts) >= ENOUGH_ROBOTS else None

    @property
    def mean(self) -> float:
        """Mean of our counts; ValueError when there are none."""
        return Spread.of(self.counts).mean

    @property
    def outside(self) -> bool:
        """The paper's count does not lie in the central 95 % of robots."""
        if self.spread is None or self.paper is None:
            return False
        return not self.spread.holds(self.paper)


@dataclass(frozen=True, slots=True)
class Results:
    """All that the figure shows.

    Args:
        title: whose results they are, in words.
        note: why there are no intervals; empty when there are.
        session: the reproduction; None when there is none.
        robots: how many; 1 when each tool was learned by itself.
        cells: by (tool, goal).
        total: of all trials of the extension of reach; None when some were not done.
        broken: of the 16 trials with the broken tool; None when they were not done.
    """

    title: str
    note: str
    session: int | None
    robots: int
    cells: Mapping[tuple[str, int], Beside]
    total: Beside | None
    broken: Beside | None


def results_of_many(result: Reproduction) -> Results:
    """Return the results of a reproduction."""
    robots = f"{result.robots} robot{'s' if result.robots != 1 else ''}"
    title = f"{robots}, seed {result.seed}, settings: {result.settings}"
    few = f"too few robots for intervals ({ENOUGH_ROBOTS} or more)"
    note = few if result.robots < ENOUGH_ROBOTS else ""
    cells = {
        (tool, goal): Beside(paper, result.cells[tool, goal], STARTS)
        for (tool, goal), paper in papers_counts().items()
    }
    total = Beside(TOTAL, result.totals, STARTS * len(cells))
    broken = Beside(BROKEN_TOOL, result.broken, STARTS**2)
    return Results(title, note, result.session, result.robots, cells, total, broken)


def results_of_single(single: SingleRobots) -> Results:
    """Return the results of robots that learned a tool each."""
    cells = {
        cell: _of_one(paper, *single.cells.get(cell, (0, 0)))
        for cell, paper in papers_counts().items()
    }
    all_tried = all(cell.tried == STARTS for cell in cells.values())
    solved = sum(sum(cell.counts) for cell in cells.values())
    total = Beside(TOTAL, [solved], STARTS * len(cells)) if all_tried else None
    solved, tried = single.broken
    broken = Beside(BROKEN_TOOL, [solved], tried) if tried == STARTS**2 else None
    return Results(single.title, "", None, 1, cells, total, broken)


def papers_counts() -> dict[tuple[str, int], int]:
    """Return the paper's successes of 4 by (tool, goal)."""
    return {
        (tool, goal): count
        for tool, counts in EXTENSION_OF_REACH.items()
        for goal, count in enumerate(counts, start=1)
    }


def _of_one(paper: int, solved: int, tried: int) -> Beside:
    """Return one robot's successes beside the paper's."""
    return Beside(paper, [solved] if tried else [], tried)
