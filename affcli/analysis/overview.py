"""What a database holds: learned tools, trials, finished reproductions."""

import typing
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from affcli.analysis.breaking import parts_gained
from affcli.analysis.experiment import ExperimentResult
from affcli.analysis.paper import EXTENSION_OF_REACH, other_parts, papers_break, papers_cell
from affcli.analysis.reproduction import Reproduction
from affcli.core.records import LearningRunInfo, SessionInfo, TrialInfo
from affcli.core.results import BehaviorGroup
from affcli.core.specs import Protocol, TrialSpec
from affcli.core.trial import Outcome, is_counted


class Tried(typing.Protocol):
    """A trial, as it is stored or done again."""

    @property
    def run_id(self) -> int:
        """The learning run whose table it used."""

    @property
    def spec(self) -> TrialSpec:
        """Which trial."""

    @property
    def outcome(self) -> Outcome | None:
        """How it ended; None while running or when interrupted."""


class SolvedBy(NamedTuple):
    """Whose trials are counted together, goal by goal."""

    run: int
    tool: str
    sensor: str
    planner: str
    task_set: str


@dataclass(frozen=True, slots=True)
class GoalCounts:
    """Successes of one learning run's trials.

    Args:
        by: whose trials.
        papers: tool, goals, planner and the parts of learning are the paper's.
        goals: (solved, tried) by goal, in the order in which they were tried first.
    """

    by: SolvedBy
    papers: bool
    goals: Mapping[str, tuple[int, int]]

    def paper(self, goal: str) -> int | None:
        """Return the paper's successes of 4 at a goal; None where it has none."""
        return EXTENSION_OF_REACH.get((self.by.tool, goal)) if self.papers else None


@dataclass(frozen=True, slots=True)
class ProtocolCounts:
    """Counts over the trials of one protocol in one session.

    Args:
        trials, solved: how many, and how many of them were solved.
        mean_steps: of the solved; None when none was.
        tries_on_lost: tries of rows whose affordance was truly lost.
        rows_excluded: rows that fell to a probability of 1/2 or less in some trial.
    """

    trials: int
    solved: int
    mean_steps: float | None
    tries_on_lost: int
    rows_excluded: int

    @classmethod
    def of(cls, ended: Sequence[TrialInfo], losses: tuple[int, int]) -> "ProtocolCounts":
        """Count the trials that ended; `losses` as `store.results.Results.losses` gives them."""
        solved = [trial.steps or 0 for trial in ended if trial.outcome is Outcome.SOLVED]
        return cls(
            trials=len(ended),
            solved=len(solved),
            mean_steps=sum(solved) / len(solved) if solved else None,
            tries_on_lost=losses[0],
            rows_excluded=losses[1],
        )


@dataclass(frozen=True, slots=True)
class Breaking:
    """One session in which a tool broke: the broken tool's trials and the whole one's.

    Args:
        session, run, seed, tool, shape, sensor, planner, task_set: which.
        papers: tool, shape, tasks, planner and the parts of learning are the paper's.
        broken, whole: counts of its trials.
        grew: the shape has parts that the tool did not have.
        finished: all its trials were done; else it was interrupted, or goes on.
    """

    session: int
    run: int
    seed: int
    tool: str
    shape: str
    sensor: str
    planner: str
    task_set: str
    papers: bool
    broken: ProtocolCounts
    whole: ProtocolCounts
    grew: bool = False
    finished: bool = True


@dataclass(frozen=True, slots=True)
class Overview:
    """What a database holds.

    Args:
        learned: learning runs that stand for themselves, each with its behavior groups.
        solved: successes of their ``solve`` trials.
        breakings: the ``break-tool`` sessions, oldest first; of the same one done again, the last
            that was finished, or where none was, the last.
        failures: how often each kind of failure occurred in these sessions.
        trials: all trials of these sessions that count.
        reproductions: the finished ones, oldest first.
        invalid: how many trials of these sessions count for nothing: see `Outcome`.
        experiments: those that have robots, oldest first: they are reported by other commands.
    """

    learned: Sequence[tuple[LearningRunInfo, Sequence[BehaviorGroup]]]
    solved: Sequence[GoalCounts]
    breakings: Sequence[Breaking]
    failures: Mapping[str, int]
    trials: int
    reproductions: Sequence[Reproduction]
    invalid: int = 0
    experiments: Sequence[ExperimentResult] = ()


def goal_counts(results: Iterable[Tried], runs: Iterable[LearningRunInfo]) -> list[GoalCounts]:
    """Count successes by learning run, tool, sensor, planner and task set.

    Args:
        results: with whole tools; those that do not count are left out.
        runs: the learning runs whose tables were used.
    """
    as_the_paper = {run.id for run in runs if not other_parts(run.spec)}
    counts: dict[tuple[SolvedBy, bool], dict[str, tuple[int, int]]] = {}
    for trial in results:
        if not is_counted(trial.outcome):
            continue
        spec = trial.spec
        by = SolvedBy(trial.run_id, spec.tool, spec.sensor, str(spec.planner), spec.task_set)
        papers = trial.run_id in as_the_paper and papers_cell(spec)
        goals = counts.setdefault((by, papers), {})
        solved, tried = goals.get(spec.goal, (0, 0))
        goals[spec.goal] = solved + (trial.outcome is Outcome.SOLVED), tried + 1
    return [GoalCounts(by, papers, goals) for (by, papers), goals in counts.items()]


def breaking_of(
    session: SessionInfo,
    results: Sequence[TrialInfo],
    losses: Mapping[Protocol, tuple[int, int]],
) -> Breaking | None:
    """Return the counts of one ``break-tool`` session; None when no broken tool was tried in it."""
    of = {
        protocol: [t for t in results if t.spec.protocol is protocol and is_counted(t.outcome)]
        for protocol in Protocol
    }
    adapting = [trial.spec for trial in of[Protocol.TOOL_ADAPTATION]]
    if not adapting:
        return None
    counts = {
        protocol: ProtocolCounts.of(ended, losses[protocol]) for protocol, ended in of.items()
    }
    first = adapting[0]
    return Breaking(
        *(session.id, results[0].run_id, session.spec.seed, first.tool, first.shape),
        *(first.sensor, str(first.planner), first.task_set),
        papers=not other_parts(session.spec) and all(map(papers_break, adapting)),
        broken=counts[Protocol.TOOL_ADAPTATION],
        whole=counts[Protocol.EXTENSION_OF_REACH],
        grew=bool(parts_gained(results[0].learned.held, first.held)),
        finished=session.status == "done",
    )
