"""Binding and exploratory behaviors: names, calls, and the wrist paths they give (§3.2, §5)."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import NewType

from affcli.core.geometry import Point

BehaviorName = NewType("BehaviorName", str)

GRASP = BehaviorName("grasp")
POSITION_WRIST = BehaviorName("position wrist")
EXTEND_ARM = BehaviorName("extend arm")
CONTRACT_ARM = BehaviorName("contract arm")
SLIDE_ARM_LEFT = BehaviorName("slide arm left")
SLIDE_ARM_RIGHT = BehaviorName("slide arm right")

OFFSET_DISTANCES = (2.0, 5.0)
"""The two values of offset_distance used in the paper (in, §5)."""


@dataclass(frozen=True, slots=True)
class BehaviorCall:
    """A behavior with specific parameter values (the paper's tilde).

    Args:
        name: which behavior.
        params: its parameters by name, in inches (grasp: grasp_point, measured along the handle
            from its lower end; position wrist: x, y; the others: offset_distance).
    """

    name: BehaviorName
    params: tuple[tuple[str, float], ...]

    @classmethod
    def of(cls, name: BehaviorName, params: Mapping[str, float]) -> "BehaviorCall":
        """Build a call from a mapping, keeping its order."""
        return cls(name, tuple(params.items()))

    def __getitem__(self, param: str) -> float:
        """Return one parameter by name; KeyError when the behavior has no such parameter."""
        return dict(self.params)[param]

    def __str__(self) -> str:
        """Write the call as a person would: ``contract arm 5``."""
        return " ".join([self.name, *(f"{value:g}" for _, value in self.params)])


@dataclass(frozen=True, slots=True)
class WristPath:
    """What a behavior asks of the wrist: where to go, how, and how long that takes.

    Args:
        end: where the path leads (in, table frame).
        lifted: the tool is lifted on the way, so it touches nothing.
        speed: cruise speed (in/s).
        acceleration: in/s^2 at both ends of the trapezoid.
        dwell: stillness before and after, and lifting and lowering, in all (s).
    """

    end: Point
    lifted: bool
    speed: float
    acceleration: float
    dwell: float


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
        wrist_start: where the wrist was before (in, table frame; joint encoders).
        wrist_end: where the wrist was after.
        duration: robot seconds it took.
    """

    call: BehaviorCall
    status: ExecutionStatus
    wrist_start: Point
    wrist_end: Point
    duration: float
