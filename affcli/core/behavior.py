"""Binding and exploratory behaviors: names, calls, and how their execution ends (§3.2, §5)."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from itertools import islice
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

SCHEMAS: Mapping[str, tuple[str, ...]] = {"slide": ("x", "y"), "turn": ("angle",)}
"""The motor schemas that behaviors are composed of, each with its parameters (in, degrees)."""


def composed(motion: Motion) -> ExploratoryBehavior:
    """Return the behavior that slides and turns make, called by what it does: ``turn 31``.

    Of several the name says the kinds in order, the parameters their numbers: ``turn, slide 31 0
    -4``. Whoever has the call has the motion, so that such a behavior is in no need of a repertoire
    to be known by.

    Raises:
        ValueError: it has other segments, none, or too many.
    """
    names: list[str] = []
    params: dict[str, float] = {}
    for number, (name, *values) in enumerate(motion_json(motion), 1):
        if name not in SCHEMAS:
            raise ValueError(f"a {name} is no motor schema")
        names.append(name)
        ending = f"_{number}" if number > 1 else ""
        params |= {f"{param}{ending}": v for param, v in zip(SCHEMAS[name], values, strict=True)}
    if not names:
        raise ValueError("a behavior of no segments")
    return ExploratoryBehavior(BehaviorCall.of(BehaviorName(", ".join(names)), params), motion)


def composed_motion(call: BehaviorCall) -> Motion | None:
    """Return the motion of a call that `composed` gives; None for any other."""
    names, values = call.name.split(", "), iter(value for _, value in call.params)
    if not set(names) <= SCHEMAS.keys():
        return None
    if sum(len(SCHEMAS[name]) for name in names) != len(call.params):
        return None
    motion = motion_from_json([name, *islice(values, len(SCHEMAS[name]))] for name in names)
    return motion if composed(motion).call == call else None


def motion_of(call: BehaviorCall, repertoire: Repertoire) -> Motion | None:
    """Return the motion of a call: the repertoire's, else that of the motor schemas it names; None
    when neither has it.
    """
    known = (one.motion for one in repertoire if one.call == call)
    found = next(known, None)
    return composed_motion(call) if found is None else found


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
