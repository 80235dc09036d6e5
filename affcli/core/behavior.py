"""Binding and exploratory behaviors: names, calls, and how their execution ends (§3.2, §5)."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NewType

from affcli.core.geometry import Pose
from affcli.core.motion import Motion, motion_from_json, motion_json

BehaviorName = NewType("BehaviorName", str)

GRASP = BehaviorName("grasp")
POSITION_WRIST = BehaviorName("position wrist")
LONGEST_NAME, MOST_PARAMETERS = 100, 20
"""Letters of a behavior's name, and how many parameters it has; the paper's have one."""


@dataclass(frozen=True, slots=True)
class BehaviorCall:
    """A behavior with specific parameter values (the paper's tilde).

    Args:
        name: which behavior.
        params: its parameters by name, in inches and degrees (grasp: grasp_point, measured along
            the handle from its lower end, and angle; position wrist: x, y and angle; the paper's
            exploratory behaviors: offset_distance). An angle of 0 is left out.
    """

    name: BehaviorName
    params: tuple[tuple[str, float], ...]

    @classmethod
    def of(cls, name: BehaviorName, params: Mapping[str, float]) -> "BehaviorCall":
        """Build a call from a mapping, keeping its order; ValueError when nobody could read it."""
        if len(name) > LONGEST_NAME or len(params) > MOST_PARAMETERS:
            raise ValueError(f"a behavior of {len(name)} letters and {len(params)} parameters")
        return cls(name, tuple(params.items()))

    def __getitem__(self, param: str) -> float:
        """Return one parameter by name; KeyError when the behavior has no such parameter."""
        return dict(self.params)[param]

    def get(self, param: str, default: float) -> float:
        """Return one parameter by name, or the default when the call leaves it out."""
        return dict(self.params).get(param, default)

    def __str__(self) -> str:
        """Write the call as a person would: ``contract arm 5``."""
        return " ".join([self.name, *(f"{value:g}" for _, value in self.params)])


@dataclass(frozen=True, slots=True)
class ExploratoryBehavior:
    """An exploratory behavior by value: what it is called, and the motion it gives.

    Args:
        call: its name and parameters.
        motion: from where the wrist is when it begins.
    """

    call: BehaviorCall
    motion: Motion


Repertoire = tuple[ExploratoryBehavior, ...]
"""The exploratory behaviors that babbling draws from, in order."""


def repertoire_json(repertoire: Repertoire) -> list[dict[str, Any]]:
    """Return a repertoire as JSON types, each behavior with its parameters and its motion."""
    return [
        {
            "behavior": one.call.name,
            "params": dict(one.call.params),
            "motion": motion_json(one.motion),
        }
        for one in repertoire
    ]


def repertoire_from_json(value: Any) -> Repertoire:
    """Return the repertoire that `repertoire_json` wrote; ValueError or KeyError if it did not."""
    return tuple(
        ExploratoryBehavior(
            BehaviorCall.of(
                BehaviorName(one["behavior"]), {k: float(v) for k, v in one["params"].items()}
            ),
            motion_from_json(one["motion"]),
        )
        for one in value
    )


class ExecutionStatus(StrEnum):
    """How the execution of a behavior ended."""

    DONE = "done"
    TRUNCATED = "truncated"
    """Met the edge of the arm's reach and stopped there."""
    BLOCKED = "blocked"
    """Lowering the tool would have put it on the attractor; it stays lifted above it."""
    OUT_OF_REACH = "out of reach"
    """No joint angles bring the wrist there; it stays where it was."""


@dataclass(frozen=True, slots=True)
class Execution:
    """What the robot itself knows of a behavior it executed.

    Args:
        call: the behavior and its commanded parameters.
        status: how it ended.
        wrist_start: where the wrist was before (in, rad, table frame; joint encoders).
        wrist_end: where the wrist was after.
        duration: robot seconds it took.
    """

    call: BehaviorCall
    status: ExecutionStatus
    wrist_start: Pose
    wrist_end: Pose
    duration: float
