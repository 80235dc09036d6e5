"""What is recorded of learning and of testing trials."""

from dataclasses import dataclass, fields
from enum import StrEnum
from typing import Any, NamedTuple

from affcli.core.affordance import Affordance, is_probable
from affcli.core.behavior import BehaviorCall, Execution
from affcli.core.choice import Reasons
from affcli.core.geometry import Pose
from affcli.core.observation import Movement, Observation


class Truth(NamedTuple):
    """Where the attractor truly was before and after a behavior; never for the robot."""

    start: Pose
    end: Pose


class Outcome(StrEnum):
    """How a testing trial ended.

    Where a planner chooses no row, the procedure looks whether one could be used: a row of the
    colours seen, of a probability above the planner's threshold, whose wrist position is within
    reach (`affcli.planning.nested_query.usable_rows`). What the planner is does not matter.
    """

    SOLVED = "solved"
    NO_ROW = "no row left"
    """No row could be used, so that none was chosen. The paper's query fails so, and no other way.
    In records from before schema revision 0010 it stands for `NO_PLAN` too."""
    NO_PLAN = "no plan found"
    """Rows could be used, but the planner chose none of them."""
    ATTRACTOR_OUT_OF_REACH = "attractor out of reach"
    STEP_LIMIT = "step limit"
    INVALID = "invalid"
    """The simulation diverged, or a part of another package failed: it counts for nothing."""


DIVERGED = "the simulation gave a number that is not finite"
"""Why a trial is invalid that no part of another package ended."""


def named_before(outcome: str | None) -> str | None:
    """Return the name of an outcome before schema revision 0010: `no row left` for `no plan found`.

    By it a record from before is held against what comes out now. It says no more: which of the two
    it was cannot be read from the reasons that a planner of another package gave.
    """
    return Outcome.NO_ROW if outcome == Outcome.NO_PLAN else outcome


def is_counted(outcome: Outcome | None) -> bool:
    """Tell whether a trial counts: not when it was interrupted, nor when its simulation failed."""
    return outcome not in (None, Outcome.INVALID)


@dataclass(frozen=True, slots=True)
class Attempt:
    """One use of a row: it was tried and judged.

    Args:
        row: the affordance tried, with its counters before.
        placing: the position wrist that went before.
        execution: the exploratory behavior; None when lowering the tool was blocked.
        start: observation before the exploratory behavior (before the placing when blocked).
        end: observation after it.
        expected: the movement the row predicts.
        seen: the movement observed.
        replicated: whether `seen` counts as a success of the row.
        regrasped: the tool was first grasped anew, as the row's binding asks.
        threshold: at this replication probability or below a row is out of consideration.
    """

    row: Affordance
    placing: Execution
    execution: Execution | None
    start: Observation
    end: Observation
    expected: Movement
    seen: Movement
    replicated: bool
    regrasped: bool
    threshold: float

    def by_name(self) -> dict[str, Any]:
        """Return the fields of an attempt by name: what a record of it is made from."""
        return {field.name: getattr(self, field.name) for field in fields(Attempt)}

    @property
    def live(self) -> bool:
        """The row was considered before this use: its probability exceeded the threshold."""
        return is_probable(self.row.times_successful, self.row.times_used, self.threshold)

    @property
    def times_used_after(self) -> int:
        """The row's counter of uses after this one."""
        return self.row.times_used + 1

    @property
    def times_successful_after(self) -> int:
        """The row's counter of successes after this use."""
        return self.row.times_successful + int(self.replicated)

    @property
    def died(self) -> bool:
        """This use left the row's probability at the threshold or below."""
        return not is_probable(self.times_successful_after, self.times_used_after, self.threshold)


@dataclass(frozen=True, slots=True)
class StepRecord(Attempt):
    """One step of a testing trial: a row was chosen, tried and judged.

    Args:
        number: 1, 2, 3, ... within the trial.
        clock: robot seconds when the step ended.
        reasons: what the planner went by.
    """

    number: int
    clock: float
    reasons: Reasons


@dataclass(frozen=True, slots=True)
class TrialEnd:
    """The end of a testing trial.

    Args:
        outcome: how it ended.
        steps: how many steps were taken.
        clock: robot seconds it took.
        last_reasons: what the planner went by when it chose no row; of an invalid trial which part
            of another package failed, and how; else None.
    """

    outcome: Outcome
    steps: int
    clock: float
    last_reasons: Reasons | None = None

    @property
    def failure(self) -> str:
        """Which part of another package ended the trial, and how; empty where none did."""
        failed = self.outcome is Outcome.INVALID and self.last_reasons
        return failed[0].name if failed else ""


@dataclass(frozen=True, slots=True)
class BabblingRecord:
    """One executed exploratory behavior of a learning run, with or without effect.

    Args:
        step: 1, 2, 3, ... within the run.
        clock: robot seconds when the step ended.
        resets: how often the attractor was put back by hand before this behavior.
        redraws: wrist positions drawn again because the tool would have come down on the attractor.
        placing: the position wrist that went before.
        execution: the exploratory behavior.
        start: observation before the exploratory behavior (O^s).
        end: observation after it (O^e).
        affordance: the row it made, None when T = 0.
        binding: how the tool was held, where the run has several bindings; None where it has one.
    """

    step: int
    clock: float
    resets: int
    redraws: int
    placing: Execution
    execution: Execution
    start: Observation
    end: Observation
    affordance: Affordance | None
    binding: BehaviorCall | None = None


class TrialStep(NamedTuple):
    """A step with what the robot cannot see.

    Args:
        record: what the robot did and saw.
        truth: where the attractor truly was; None in a world that does not tell.
        lost: whether the row tried was truly lost when the tool broke; None for a whole tool.
    """

    record: StepRecord
    truth: Truth | None
    lost: bool | None
