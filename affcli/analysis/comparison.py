"""Our successes beside the paper's (§7.1, §7.2)."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from affcli.analysis.paper import (
    BROKEN,
    BROKEN_TRIALS,
    EXTENSION_OF_REACH,
    STARTS,
    TOTAL,
    TRIALS,
    papers_break,
    papers_cell,
    row_name,
)
from affcli.analysis.reproduction import Reproduction
from affcli.analysis.statistics import Spread
from affcli.core.records import SessionInfo, TrialInfo
from affcli.core.specs import LearningSpec, Protocol
from affcli.core.trial import Outcome, is_counted


@dataclass(frozen=True, slots=True)
class Beside:
    """Successes beside the paper's.

    Args:
        paper: the paper's count; None where the paper has none.
        counts: ours, one for each robot; none when nothing was tried.
        tried: out of how many.
    """

    paper: int | None
    counts: Sequence[int]
    tried: int

    @property
    def spread(self) -> Spread:
        """Mean and intervals over the robots; ValueError when nothing was tried."""
        return Spread.of(self.counts, self.tried)

    @property
    def outside(self) -> bool:
        """The paper's count does not lie in the central 95 % of robots, of which there are many."""
        if self.paper is None or not self.counts:
            return False
        return self.spread.holds(self.paper) is False


@dataclass(frozen=True, slots=True)
class Results:
    """All of the paper's counts with ours beside them.

    Args:
        session: the reproduction; None when each tool was learned by itself.
        robots: how many; 1 when each tool was learned by itself.
        runs: of single robots, the learning runs by the sensor of the trials, and by number.
        cells: by (tool, goal).
        total: of the paper's 80 trials, or where it has none of all; None when some were not done.
        broken: of the trials with the broken tool; None when they were not done.
    """

    session: SessionInfo | None
    robots: int
    runs: Mapping[str, Mapping[int, LearningSpec]]
    cells: Mapping[tuple[str, str], Beside]
    total: Beside | None
    broken: Beside | None


def results_of_many(result: Reproduction) -> Results:
    """Return the results of a reproduction; what the paper has not stands alone."""
    cells = {
        cell: Beside(EXTENSION_OF_REACH[cell], counts, STARTS)
        for cell, counts in result.cells.items()
    }
    total = Beside(TOTAL, result.totals, TRIALS) if result.totals else None
    broken = Beside(BROKEN, result.broken, BROKEN_TRIALS) if result.broken else None
    spec = result.session.spec
    for kind, goals in result.others.items():
        if (kind.task_set, kind.planner) != (spec.task_set, str(spec.planner)):
            continue
        alone = {
            goal: Beside(None, solved.counts, round(solved.tried / result.robots))
            for goal, solved in goals.items()
        }
        if kind.protocol is Protocol.EXTENSION_OF_REACH:
            cells |= {(kind.tool, goal): beside for goal, beside in alone.items()}
        elif broken is None:
            broken = _sum(alone.values())
    if not result.cells:
        total = _sum(cells.values())
    return Results(result.session, result.robots, {}, cells, total, broken)


def _sum(cells: Collection[Beside]) -> Beside | None:
    """Return the successes over some cells that the paper has nothing beside; None without any."""
    if not cells:
        return None
    counts = [sum(column) for column in zip(*(cell.counts for cell in cells), strict=True)]
    return Beside(None, counts, sum(cell.tried for cell in cells))


def results_of_single(
    solving: Iterable[TrialInfo], breaking: Iterable[TrialInfo]
) -> Results | None:
    """Return the results of robots that each learned a tool; of each start the latest trial counts.

    Args:
        solving: trials with whole tools of the learning runs in question, oldest first.
        breaking: trials with broken tools, likewise.

    Returns:
        The results: the paper's cells, if any of them was tried, then what the paper has not, with
        nothing beside it; None without trials with whole tools.
    """
    whole: dict[tuple[str, str, str], TrialInfo] = {}
    for trial in solving:
        if is_counted(trial.outcome):
            of = trial.spec
            name = row_name(of.tool, str(of.planner), of.task_set)
            whole[name, of.goal, of.start] = trial
    broken = {
        (t.spec.goal, t.spec.start): t
        for t in breaking
        if is_counted(t.outcome) and papers_break(t.spec)
    }
    if not whole:
        return None
    papers = any(papers_cell(trial.spec) for trial in whole.values())
    tried: dict[tuple[str, str], list[bool]] = {cell: [] for cell in EXTENSION_OF_REACH if papers}
    for (name, goal, _), trial in whole.items():
        tried.setdefault((name, goal), []).append(trial.outcome is Outcome.SOLVED)
    cells = {
        cell: Beside(EXTENSION_OF_REACH.get(cell), [sum(some)] if some else [], len(some))
        for cell, some in tried.items()
    }
    solved_broken = sum(trial.outcome is Outcome.SOLVED for trial in broken.values())
    runs: dict[str, dict[int, LearningSpec]] = {}
    for trial in sorted(whole.values(), key=lambda trial: (trial.spec.sensor, trial.run_id)):
        runs.setdefault(trial.spec.sensor, {})[trial.run_id] = trial.learned
    return Results(
        *(None, 1, runs, cells),
        _papers_total(cells) if papers else _sum(cells.values()),
        Beside(BROKEN, [solved_broken], len(broken)) if len(broken) == BROKEN_TRIALS else None,
    )


def _papers_total(cells: Mapping[tuple[str, str], Beside]) -> Beside | None:
    """Return what was solved of the paper's 80 trials; None when some were not done."""
    own = [cells[cell] for cell in EXTENSION_OF_REACH]
    if any(cell.tried < STARTS for cell in own):
        return None
    return Beside(TOTAL, [sum(sum(cell.counts) for cell in own)], TRIALS)
