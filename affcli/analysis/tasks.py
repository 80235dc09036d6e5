"""What the trials of one tool came to over many tasks: solved, how long it took, how near it came.

Solved or not tells planners apart only where some of them fail. These numbers do so where all
succeed, and where all fail.
"""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, median

from affcli.core.choice import plan_followed
from affcli.core.goal import Goal
from affcli.core.specs import TrialSpec
from affcli.core.trial import Outcome, StepRecord, TrialEnd, is_counted

Trial = tuple[TrialSpec, TrialEnd, Sequence[StepRecord]]
"""A trial with its steps."""


@dataclass(frozen=True, slots=True)
class TaskSums:
    """What some trials came to; invalid ones are left out.

    Args:
        tried, solved: how many.
        steps: of a solved trial, on average; None when none is solved.
        seconds: robot seconds of a trial, on average; None when there is none.
        distance: from the goal's centre at the end, the median (in); None when there is none.
        error: how far from where it was expected a step left the attractor, on average (in); None
            without steps.
        failures: how often each kind of failure occurred.
    """

    tried: int
    solved: int
    steps: float | None
    seconds: float | None
    distance: float | None
    error: float | None
    failures: Mapping[Outcome, int]

    @classmethod
    def of(cls, trials: Sequence[Trial]) -> "TaskSums":
        """Sum up trials."""
        counted = [one for one in trials if is_counted(one[1].outcome)]
        solved = [end.steps for _, end, _ in counted if end.outcome is Outcome.SOLVED]
        errors = [error_of(step) for _, _, steps in counted for step in steps]
        failed = Counter(end.outcome for _, end, _ in counted)
        return cls(
            len(counted),
            len(solved),
            fmean(solved) if solved else None,
            fmean(end.clock for _, end, _ in counted) if counted else None,
            median(final_distance(spec, steps) for spec, _, steps in counted) if counted else None,
            fmean(errors) if errors else None,
            {kind: failed[kind] for kind in Outcome if failed[kind] and kind != Outcome.SOLVED},
        )


def final_distance(spec: TrialSpec, steps: Sequence[StepRecord]) -> float:
    """Return how far from the goal's centre the attractor was seen last (in); where it was put when
    there was no step.
    """
    goal: Goal = spec.task.goal
    return math.dist(steps[-1].end.object_position if steps else spec.task.start, goal.center)


def error_of(step: StepRecord) -> float:
    """Return how far from where it was expected a step left the attractor, as it was seen (in).

    Expected by the plan that was followed, where there is one; else by the row.
    """
    for move in plan_followed(step.reasons)[:1]:
        return math.dist((move.x, move.y), step.end.object_position)
    return math.dist(step.expected, step.seen)
