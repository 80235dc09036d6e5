"""What many robots gave: successes beside the paper's, and of what the paper has not (§7)."""

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from affcli.analysis.paper import EXTENSION_OF_REACH, other_parts, papers_break, papers_cell
from affcli.core.records import FailedRobot, SessionInfo
from affcli.core.results import SuccessCount
from affcli.core.specs import Protocol
from affcli.core.trial import Outcome, is_counted


class TrialKind(NamedTuple):
    """What trials have in common, but for robot, goal and start."""

    protocol: Protocol
    tool: str
    shape: str
    task_set: str
    planner: str


class Solved(NamedTuple):
    """Successes of one kind of trials at one goal.

    Args:
        counts: of each robot.
        tried: how many trials the robots ended, in all.
    """

    counts: Sequence[int]
    tried: int


@dataclass(frozen=True, slots=True)
class Reproduction:
    """What the robots of a session gave.

    Args:
        session: which.
        robots: how many of its robots are saved.
        cells: successes of 4 of each robot by the paper's (tool, goal), where it was tried; none
            when the robots learned or chose otherwise than the paper's, or did none of its tasks.
        broken: successes of 16 of each robot with the paper's broken tool; none likewise.
        others: what the paper has not, by goal.
        failures: how often each kind of failure occurred, over all trials that count.
        trials: how many they are.
        tries_on_lost: tries on lost affordances with broken tools, over all of them.
        invalid: how many trials count for nothing: see `Outcome`.
        failed: the robots that could not live.
    """

    session: SessionInfo
    robots: int
    cells: Mapping[tuple[str, str], Sequence[int]]
    broken: Sequence[int]
    others: Mapping[TrialKind, Mapping[str, Solved]]
    failures: Mapping[str, int]
    trials: int
    tries_on_lost: int
    invalid: int = 0
    failed: tuple[FailedRobot, ...] = ()

    @classmethod
    def of(
        cls,
        session: SessionInfo,
        robots: Collection[int],
        counts: Iterable[SuccessCount],
        outcomes: Mapping[Outcome, int],
        tries_on_lost: int,
        failed: tuple[FailedRobot, ...] = (),
    ) -> "Reproduction":
        """Sum up the trials of a session.

        Args:
            session: which.
            robots: the numbers of those that are saved.
            counts: successes by robot, kind of trial and goal.
            outcomes: how its trials ended.
            tries_on_lost: over all of them.
            failed: the robots that could not live.
        """
        papers = not other_parts(session.spec)
        solved: dict[tuple[str, str], Counter[int]] = defaultdict(Counter)
        broken: Counter[int] = Counter()
        others: dict[TrialKind, dict[str, list[SuccessCount]]] = {}
        for one in counts:
            if papers and papers_cell(one):
                solved[one.tool, one.goal][one.robot] += one.solved
            elif papers and papers_break(one):
                broken[one.robot] += one.solved
            else:
                kind = TrialKind(one.protocol, one.tool, one.shape, one.task_set, one.planner)
                others.setdefault(kind, {}).setdefault(one.goal, []).append(one)
        ends = failures_in(outcomes)
        return cls(
            session,
            len(robots),
            {
                cell: _by_robot(solved[cell], robots)
                for cell in EXTENSION_OF_REACH
                if cell in solved
            },
            _by_robot(broken, robots) if broken else (),
            {
                kind: {goal: _solved(some, robots) for goal, some in goals.items()}
                for kind, goals in others.items()
            },
            *(ends.kinds, ends.trials, tries_on_lost, ends.invalid),
            failed,
        )

    @property
    def totals(self) -> list[int]:
        """Successes of the paper's 80 of each robot; none unless each of its cells was tried."""
        if len(self.cells) < len(EXTENSION_OF_REACH):
            return []
        return [sum(column) for column in zip(*self.cells.values(), strict=True)]


class Failures(NamedTuple):
    """How trials failed.

    Args:
        kinds: how often each kind of failure occurred, the commonest first.
        trials: how many trials count, the solved ones included.
        invalid: how many count for nothing: see `Outcome`.
    """

    kinds: Mapping[str, int]
    trials: int
    invalid: int


def failures_in(outcomes: Mapping[Outcome, int]) -> Failures:
    """Return how trials failed, from how often they ended in each way."""
    counted = {one: number for one, number in outcomes.items() if is_counted(one)}
    kinds = {one.value: number for one, number in counted.items() if one is not Outcome.SOLVED}
    ordered = sorted(kinds.items(), key=lambda item: (-item[1], item[0]))
    trials = sum(counted.values())
    return Failures(dict(ordered), trials, sum(outcomes.values()) - trials)


def _solved(counts: Iterable[SuccessCount], robots: Iterable[int]) -> Solved:
    """Return the successes of each robot, and all trials."""
    by_robot: Counter[int] = Counter()
    tried = 0
    for one in counts:
        by_robot[one.robot] += one.solved
        tried += one.trials
    return Solved(_by_robot(by_robot, robots), tried)


def _by_robot(counts: Mapping[int, int], robots: Iterable[int]) -> list[int]:
    """Return one count for each robot, in the order of their numbers."""
    return [counts.get(robot, 0) for robot in sorted(robots)]
