"""What a robot made of a broken tool (§7.2)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from affcli.core.affordance import Affordance
from affcli.core.specs import TrialRecord
from affcli.core.tool import Tool, middle_x
from affcli.core.trial import Outcome, is_counted


@dataclass(frozen=True, slots=True)
class DeadRow:
    """A row that was excluded in at least one broken-tool trial.

    Args:
        row: the row.
        on_missing_side: the attractor lay, as seen from the wrist, on the side that is gone.
        lost: the affordance was truly lost.
        trials: in how many trials it was excluded.
    """

    row: Affordance
    on_missing_side: bool
    lost: bool
    trials: int


@dataclass(frozen=True, slots=True)
class Tally:
    """Counts over some trials.

    Args:
        trials, solved: how many, and how many of them were solved.
        steps: steps of the solved trials, in all.
        tries: steps in which a row was tried; replicated: of these, replications.
        tries_on_lost: tries of rows whose affordance was truly lost.
        trials_with_lost: trials with such tries.
        excluded: rows that fell to a probability of 1/2 or less.
    """

    trials: int
    solved: int
    steps: int
    tries: int
    replicated: int
    tries_on_lost: int
    trials_with_lost: int
    excluded: int

    @classmethod
    def of(cls, trials: Sequence[TrialRecord]) -> "Tally":
        """Count the trials that count."""
        trials = [t for t in trials if is_counted(t.end.outcome)]
        solved = [t for t in trials if t.end.outcome is Outcome.SOLVED]
        steps = [step for t in trials for step in t.steps]
        return cls(
            trials=len(trials),
            solved=len(solved),
            steps=sum(t.end.steps for t in solved),
            tries=len(steps),
            replicated=sum(step.record.replicated for step in steps),
            tries_on_lost=sum(bool(step.lost) for step in steps),
            trials_with_lost=sum(any(s.lost for s in t.steps) for t in trials),
            excluded=sum(step.record.died for step in steps),
        )

    @property
    def mean_steps(self) -> float | None:
        """Mean steps of the solved trials; None when none was."""
        return self.steps / self.solved if self.solved else None


def broken_and_whole(trials: Iterable[TrialRecord]) -> tuple[list[TrialRecord], list[TrialRecord]]:
    """Split trials into those with the broken tool and those with the whole one."""
    split: tuple[list[TrialRecord], list[TrialRecord]] = ([], [])
    for trial in trials:
        split[trial.spec.shape == trial.spec.tool].append(trial)
    return split


def missing_side(tool: Tool, left: Tool) -> float:
    """Return x of the middle of the parts that a tool lost (in, tool frame).

    It is 0 where there is no such side: none is missing, they lie on both, or a shape is not known.
    """
    return middle_x(tool.parts_missing_in(left)) if left.parts else 0.0


def parts_gained(tool: Tool, left: Tool) -> tuple[str, ...]:
    """Return the parts that a tool did not have before: with any, it grew rather than broke."""
    return tuple(part.name for part in left.parts_missing_in(tool)) if tool.parts else ()


def dead_rows(broken: Iterable[TrialRecord], side: float) -> list[DeadRow]:
    """Return the rows that were excluded in broken-tool trials that count, oldest first.

    Args:
        broken: the trials with the broken tool.
        side: x of the missing parts' middle in the tool frame (in).
    """
    died: dict[int, DeadRow] = {}
    for step in (step for t in broken if is_counted(t.end.outcome) for step in t.steps):
        if not step.record.died:
            continue
        row = step.record.row
        before = died.get(row.step)
        on_missing = row.start.wrist_to_object_x * side > 0.0
        count = before.trials + 1 if before else 1
        died[row.step] = DeadRow(row, on_missing, bool(step.lost), count)
    return [died[number] for number in sorted(died)]
