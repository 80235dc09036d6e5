"""What a robot made of a broken tool (§7.2)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from affcli.core.affordance import Affordance
from affcli.core.trial import Outcome, TrialRecord
from affcli.report.paper import BROKEN_TOOL
from affcli.report.sheet import Sheet


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
    """Figures of 16 trials.

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
        """Count the trials."""
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


def broken_and_whole(
    shape: str, trials: Sequence[TrialRecord]
) -> tuple[list[TrialRecord], list[TrialRecord]]:
    """Split trials into those with the broken shape and those with the whole tool."""
    broken = [t for t in trials if t.spec.shape == shape]
    return broken, [t for t in trials if t.spec.shape == t.spec.tool]


def dead_rows(broken: Sequence[TrialRecord], missing_side: float) -> list[DeadRow]:
    """Return the rows that were excluded in broken-tool trials, oldest first.

    Args:
        broken: the trials with the broken tool.
        missing_side: x of the missing parts' middle in the tool frame (in).
    """
    died: dict[int, DeadRow] = {}
    for step in (step for t in broken for step in t.steps if step.record.died):
        row = step.record.row
        before = died.get(row.step)
        on_missing = row.start.wrist_to_object_x * missing_side > 0.0
        count = before.trials + 1 if before else 1
        died[row.step] = DeadRow(row, on_missing, bool(step.lost), count)
    return [died[number] for number in sorted(died)]


def broken_json(shape: str, missing_side: float, trials: Sequence[TrialRecord]) -> dict[str, Any]:
    """Return what `broken_tables` shows as JSON types."""
    broken, whole = broken_and_whole(shape, trials)
    value: dict[str, Any] = {
        "becomes": shape,
        "sensor": trials[0].spec.sensor,
        "paper": BROKEN_TOOL,
    }
    for name, some in (("broken", broken), ("whole", whole)):
        tally = Tally.of(some)
        value[name] = {
            **{field: getattr(tally, field) for field in Tally.__slots__},
            "mean_steps": tally.mean_steps,
        }
    value["excluded_rows"] = [
        {
            "row": dead.row.step,
            "behavior": str(dead.row.exploratory),
            "on_missing_side": dead.on_missing_side,
            "lost": dead.lost,
            "trials": dead.trials,
        }
        for dead in dead_rows(broken, missing_side)
    ]
    return value


def broken_tables(
    shape: str, missing_side: float, trials: Sequence[TrialRecord]
) -> tuple[Sheet, Sheet]:
    """Return the broken tool beside the whole one, and the rows that were excluded.

    Args:
        shape: what was left of the tool.
        missing_side: x of the missing parts' middle in the tool frame (in).
        trials: the 16 with the broken tool and the 16 with the whole one.
    """
    broken, whole = broken_and_whole(shape, trials)
    comparison = Sheet(
        ("16 trials each", f"broken: {shape}", "whole"),
        title="The broken tool beside the whole one",
        left=("16 trials each",),
        caption=f"seen through: {trials[0].spec.sensor}",
    )
    for label, left, right in zip(
        _LABELS, _figures(Tally.of(broken)), _figures(Tally.of(whole)), strict=True
    ):
        comparison.add(label, left, right)
    comparison.add("solved in the paper", f"{BROKEN_TOOL} of 16", "16 of 16")
    return comparison, _excluded_table(dead_rows(broken, missing_side))


_LABELS = (
    "solved",
    "mean steps of the solved",
    "tries replicated",
    "tries on lost affordances",
    "trials with such tries",
    "exclusions of rows",
)


def _figures(tally: Tally) -> tuple[str, ...]:
    """Return the figures of one column, in the order of the labels."""
    return (
        f"{tally.solved} of {tally.trials}",
        "-" if tally.mean_steps is None else f"{tally.mean_steps:.1f}",
        f"{tally.replicated} of {tally.tries}",
        str(tally.tries_on_lost),
        str(tally.trials_with_lost),
        str(tally.excluded),
    )


def _excluded_table(dead: Sequence[DeadRow]) -> Sheet:
    """Return the rows that died, by behavior and side; one by one they stand in the JSON."""
    missing = sum(row.on_missing_side for row in dead)
    table = Sheet(
        ("behavior", "side", "rows", "truly lost", "times"),
        title=f"Rows excluded with the broken tool: {len(dead)}, {missing} on the missing side",
        caption="side: where the attractor was; truly lost: the broken shape cannot do it; "
        "times: over the 16 trials; --json lists each row",
        left=("behavior", "side"),
    )
    groups: dict[tuple[str, bool], list[DeadRow]] = {}
    for row in dead:
        groups.setdefault((str(row.row.exploratory), row.on_missing_side), []).append(row)
    for (behavior, on_missing), rows in sorted(groups.items(), key=lambda g: (-len(g[1]), g[0])):
        table.add(
            behavior,
            "missing" if on_missing else "other",
            str(len(rows)),
            str(sum(row.lost for row in rows)),
            str(sum(row.trials for row in rows)),
        )
    return table
