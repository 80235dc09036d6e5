"""How robots adapt to a broken tool step by step: tries on lost rows, probabilities (§7.2)."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from statistics import fmean

from affcli.analysis.statistics import FEWEST, exact_interval, mean_interval, t95
from affcli.core.records import LearningRunInfo, SessionInfo
from affcli.core.results import StepSums, TrialGroup


@dataclass(frozen=True, slots=True)
class Share:
    """The share of tries that were on lost affordances, at one step number.

    Args:
        number: which step.
        trials: how many trials took it: those still running.
        share: of them that tried a lost row.
        interval: 95 %; None where `share_interval` gives none.
    """

    number: int
    trials: int
    share: float
    interval: tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class MeanProbability:
    """Mean replication probability of the rows on the missing side, after one step number.

    Args:
        number: which step; 0 for the beginning.
        mean: over the rows, and over the trials.
        interval: 95 % of the mean; None where `mean_interval` gives none.
    """

    number: int
    mean: float
    interval: tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class AdaptationCourse:
    """How the robots of a session adapted to a broken tool.

    Args:
        session: whose trials they are.
        robots: how many robots did them.
        tool, shape: what the robots believed to hold, and what it was.
        trials: with the broken tool.
        shares: of the broken tool's trials, by step number.
        broken, whole: probabilities with the broken tool and with the whole one; none when there
            is no missing side, no row lies on it, or there are no such trials.
        run: the learning run whose table they used; None where each robot has its own.
    """

    session: SessionInfo
    robots: int
    tool: str
    shape: str
    trials: int
    shares: tuple[Share, ...]
    broken: tuple[MeanProbability, ...]
    whole: tuple[MeanProbability, ...]
    run: LearningRunInfo | None = None

    @classmethod
    def of(
        cls,
        session: SessionInfo,
        tool: str,
        shape: str,
        broken: Sequence[TrialGroup],
        whole: Sequence[TrialGroup],
        run: LearningRunInfo | None = None,
    ) -> "AdaptationCourse":
        """Sum up trials with the broken tool and with the whole one."""
        shares = shares_of(broken)
        last = shares[-1].number if shares else 0
        trials = sum(group.trials for group in broken)
        with_broken, with_whole = (probabilities_of(groups, last) for groups in (broken, whole))
        robots = len(broken) if run is None else 1
        return cls(session, robots, tool, shape, trials, shares, with_broken, with_whole, run)


def shares_of(groups: Sequence[TrialGroup]) -> tuple[Share, ...]:
    """Return the share of tries on lost affordances at each step number, among trials that run.

    The groups of one robot are its trials: intervals say what further trials of it would give.
    """
    steps: dict[int, list[StepSums]] = {}
    for sums in (sums for group in groups for sums in group.steps):
        steps.setdefault(sums.number, []).append(sums)
    shares = []
    for number in sorted(steps):
        trials = sum(sums.trials for sums in steps[number])
        lost = sum(sums.lost for sums in steps[number])
        pairs = [(sums.lost, sums.trials) for sums in steps[number]]
        shares.append(Share(number, trials, lost / trials, share_interval(pairs)))
    return tuple(shares)


def share_interval(groups: Sequence[tuple[int, int]]) -> tuple[float, float] | None:
    """Return a 95 % interval of a share from groups whose trials may be alike.

    The exact interval for as many independent trials as these tell as much as: trials of one robot
    share what it learned. Their number is divided by the design effect, how many times larger the
    variance between groups makes that of the share, which few groups tell badly (Korn and Graubard,
    1998; at least 1 in all).

    Args:
        groups: (of the kind in question, in all) in each group.

    Returns:
        The interval; None when fewer than `FEWEST` groups hold more than a trial each.
    """
    n = sum(m for _, m in groups)
    if n == len(groups):
        return exact_interval(sum(k for k, _ in groups), n)
    if len(groups) < FEWEST:
        return None
    kind = sum(k for k, _ in groups)
    share = kind / n
    alone = share * (1.0 - share) / n
    effect = 1.0
    if alone > 0.0:
        squares = sum((k - share * m) ** 2 for k, m in groups)
        between = len(groups) / (len(groups) - 1) * squares / n**2
        effect = max(1.0, between / alone * (t95(len(groups) - 1) / t95(n - 1)) ** 2)
    return exact_interval(kind / effect, n / effect)


def probabilities_of(groups: Sequence[TrialGroup], last: int) -> tuple[MeanProbability, ...]:
    """Return the mean probability on the missing side at the beginning and after each step.

    It begins at 1, for every trial starts from the table as learned. Choice: a trial that ended
    keeps its last value, as its table does; were it left out, the mean would be that of the trials
    that are hardest. Each group counts the same.

    Args:
        groups: of trials.
        last: up to which step number.

    Returns:
        In order; nothing when no trial has rows on the missing side.
    """
    courses = [_course(group, last) for group in groups if group.with_rows]
    if not courses:
        return ()
    return tuple(
        MeanProbability(number, fmean(values), mean_interval(values, 0.0, 1.0))
        for number, values in enumerate(zip(*courses, strict=True))
    )


def _course(group: TrialGroup, last: int) -> list[float]:
    """Return the mean probability of a group's trials at the beginning and after each step."""
    changes = {sums.number: sums.change / group.with_rows for sums in group.steps}
    return list(accumulate((changes.get(n, 0.0) for n in range(1, last + 1)), initial=1.0))
