"""What doing a stored trial or run again gives: scenes, and whether it equals its record."""

from dataclasses import dataclass
from typing import Any, NamedTuple

from affcli.core.affordance import Affordance
from affcli.core.goal import Goal
from affcli.core.observation import Observation
from affcli.core.scene import Scene
from affcli.core.specs import TrialSpec
from affcli.core.trial import BabblingRecord, Outcome, TrialEnd, TrialStep, Truth
from affcli.core.workspace import Workspace


class Difference(NamedTuple):
    """A value of the record that came out otherwise.

    Args:
        number: of the step or behavior; 0 for how a trial ended.
        column: which value.
        stored: what the record says.
        again: what came out; None where nothing did.
    """

    number: int
    column: str
    stored: Any
    again: Any


@dataclass(frozen=True, slots=True)
class Considered:
    """A row that the planner weighed (§6.2).

    Args:
        id: the row's number in the store.
        row: with its counters as they were then.
        expected_distance: how far from the goal's centre it expected to leave the attractor (in).
        repositioning: how far the wrist would have travelled to use it (in).
    """

    id: int
    row: Affordance
    expected_distance: float
    repositioning: float


@dataclass(frozen=True, slots=True)
class ReplayedStep:
    """One step of a trial, done again.

    Args:
        step: what the robot did and saw, and what truly happened.
        seen: the observation by which the row was chosen.
        goal: the goal region as the robot saw it.
        considered: the rows that came closest, the chosen one first.
        scenes: 15 a robot second, from the query to the end of the behavior.
        placed: how many of the scenes belong to the position wrist.
    """

    step: TrialStep
    seen: Observation
    goal: Goal
    considered: tuple[Considered, ...]
    scenes: tuple[Scene, ...]
    placed: int


@dataclass(frozen=True, slots=True)
class Replay:
    """A trial, done again.

    Args:
        trial_id, run_id: its number in the store, and that of the run whose table it used.
        spec: which trial.
        workspace: where it took place.
        opening: the table when it begins.
        steps: what was done: as many steps as the record holds.
        end: how it ended; None when the record does not say.
        differences: where it differs from the record; empty when it is the same to the bit.
    """

    trial_id: int
    run_id: int
    spec: TrialSpec
    workspace: Workspace
    opening: Scene
    steps: tuple[ReplayedStep, ...]
    end: TrialEnd | None
    differences: tuple[Difference, ...]

    @property
    def outcome(self) -> Outcome | None:
        """How it ended by its record, which counts; None when that does not say."""
        if self.end is None:
            return None
        kept = [d.stored for d in self.differences if (d.number, d.column) == (0, "outcome")]
        return Outcome(kept[0]) if kept else self.end.outcome


@dataclass(frozen=True, slots=True)
class ReplayedBehavior:
    """One behavior of a learning run, done again.

    Args:
        record: what the robot did and saw.
        truth: where the attractor truly was.
        scenes: 15 a robot second, from the position wrist to the end of the behavior; those of the
            first behavior begin with the grasp.
        differences: where it differs from the record; empty when it is the same to the bit.
    """

    record: BabblingRecord
    truth: Truth | None
    scenes: tuple[Scene, ...]
    differences: tuple[Difference, ...]
