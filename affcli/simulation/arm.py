"""Kinematics of the five-axis arm with its wrist perpendicular to the table (§4, §5).

Joints: waist (about z), shoulder, elbow, wrist pitch (all about the same horizontal axis) and wrist
roll. The wrist perpendicular to the table fixes the pitch; the roll undoes the waist and adds the
angle at which the tool is to lie in the table frame.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from affcli.core.geometry import Point, Pose
from affcli.core.workspace import ArmGeometry
from affcli.errors import BadInputError

Floats = NDArray[np.float64]

WRIST_PITCH_MAX = math.radians(110.0)
"""Published range of the arm's fourth axis, to both sides."""
WRIST_ROLL_MAX = math.radians(180.0)
"""Published range of the arm's fifth axis, to both sides. Choice: 0 is the tool straight ahead."""


@dataclass(frozen=True, slots=True)
class JointAngles:
    """The five joint angles (rad).

    waist: 0 straight ahead (+y), positive to the robot's left. shoulder: direction of the upper
    arm over the horizontal. elbow: bend of the forearm below the upper arm's direction. pitch: turn
    of the hand from the forearm's direction, positive downward. roll: about the vertical hand.
    """

    waist: float
    shoulder: float
    elbow: float
    pitch: float
    roll: float


@dataclass(frozen=True, slots=True)
class Reach:
    """The wrist positions the arm can hold at one height: part of a ring (in).

    Args:
        inner, outer: radii about the shoulder (in).
        waist_min, waist_max: how far the waist turns to the right and to the left (rad, positive to
            the left).
    """

    inner: float
    outer: float
    waist_min: float
    waist_max: float

    def holds(self, point: Point | Pose) -> bool:
        """Tell whether the ring holds `point` (in, table frame)."""
        x, y = point[0], point[1]
        if not self.inner <= math.hypot(x, y) <= self.outer:
            return False
        return self.waist_min <= math.atan2(-x, y) <= self.waist_max

    def at_angle(self, angle: float) -> "Reach":
        """Return the part of it where the roll can hold the wrist at an angle (rad, table frame).

        Turned far to one side the wrist must not lie far to the other: roll = angle - waist.
        """
        low, high = angle - WRIST_ROLL_MAX, angle + WRIST_ROLL_MAX
        if low <= self.waist_min and self.waist_max <= high:
            return self
        return replace(
            self, waist_min=max(self.waist_min, low), waist_max=min(self.waist_max, high)
        )


@dataclass(frozen=True, slots=True)
class ReachableWrists:
    """Tells for many wrist positions whether the arm can hold the tool there. Two are equal when
    they answer alike, so that what was worked out for one serves the other.

    Args:
        inner, outer: radii about the shoulder (in).
        waist_max: how far the waist turns to either side (rad).
    """

    inner: float
    outer: float
    waist_max: float

    def __call__(self, x: Floats, y: Floats, angle: Floats | float = 0.0) -> NDArray[np.bool_]:
        """Tell for each wrist position (n,), (n,) (in, table frame) whether it lies within the ring
        and the ranges of waist and roll, at an angle (rad): one for all, or one each (n,).
        """
        squared = x * x
        squared += y * y
        held = squared >= self.inner * self.inner
        held &= squared <= self.outer * self.outer
        # Within the waist's range of straight ahead: y >= r cos(waist), without an arc tangent.
        if self.waist_max >= math.radians(90.0):
            held &= y >= 0.0
        else:
            np.sqrt(squared, out=squared)
            squared *= math.cos(self.waist_max)
            held &= y >= squared
        # Up to this angle the roll can undo all that the waist turns.
        free = WRIST_ROLL_MAX - self.waist_max
        if abs(angle) > free if isinstance(angle, float) else np.any(np.abs(angle) > free):
            held &= np.abs(angle + np.arctan2(x, y)) <= WRIST_ROLL_MAX
        return held


def free_turn(wrist: Pose, way: float) -> float:
    """Return how far the roll can still turn (rad): to the left for a `way` above 0, else right."""
    roll = wrist.angle - math.atan2(-wrist.x, wrist.y)
    return max(0.0, WRIST_ROLL_MAX - math.copysign(roll, roll * way))


def joint_angles(
    arm: ArmGeometry, wrist: Point, height: float, angle: float = 0.0
) -> JointAngles | None:
    """Inverse kinematics, elbow up, the hand straight down.

    Args:
        arm: links and joint limits.
        wrist: where the flange is to be on the table plane (in, table frame).
        height: of the flange over the table (in).
        angle: at which the tool is to lie (rad, table frame).

    Returns:
        The joint angles, or None when no angles within the limits bring the flange there.
    """
    radius = math.hypot(wrist.x, wrist.y)
    drop = height + arm.wrist_to_flange - arm.shoulder_height
    bend = (radius**2 + drop**2 - arm.upper_arm**2 - arm.forearm**2) / (
        2 * arm.upper_arm * arm.forearm
    )
    if not -1.0 <= bend <= 1.0 + 1e-12:
        return None
    elbow = math.acos(min(1.0, bend))
    shoulder = math.atan2(drop, radius) + math.atan2(
        arm.forearm * math.sin(elbow), arm.upper_arm + arm.forearm * math.cos(elbow)
    )
    pitch = math.pi / 2 + shoulder - elbow
    waist = math.atan2(-wrist.x, wrist.y)
    roll = angle - waist
    within = (
        elbow <= math.radians(arm.elbow_max_degrees) + 1e-12
        and math.radians(arm.shoulder_min_degrees)
        <= shoulder
        <= math.radians(arm.shoulder_max_degrees)
        and abs(pitch) <= WRIST_PITCH_MAX
        and abs(waist) <= math.radians(arm.waist_max_degrees) + 1e-12
        and abs(roll) <= WRIST_ROLL_MAX
    )
    return JointAngles(waist, shoulder, elbow, pitch, roll) if within else None


@lru_cache(maxsize=64)
def reach_at(arm: ArmGeometry, height: float) -> Reach:
    """Return the ring of wrist positions with the flange at `height` over the table (in).

    Links and elbow give the ring in closed form; shoulder and pitch limits may narrow it, which is
    found by bisection on the inverse kinematics.

    Raises:
        BadInputError: the arm reaches nothing at this height.
    """
    drop = height + arm.wrist_to_flange - arm.shoulder_height
    straight = arm.upper_arm + arm.forearm
    folded = math.sqrt(
        arm.upper_arm**2
        + arm.forearm**2
        + 2 * arm.upper_arm * arm.forearm * math.cos(math.radians(arm.elbow_max_degrees))
    )
    if abs(drop) >= straight:
        raise BadInputError(
            f"arm: links of {arm.upper_arm} + {arm.forearm} in cannot hold the flange at {height} "
            f"in from a shoulder at {arm.shoulder_height} in; lower arm.shoulder_height"
        )
    outer = math.sqrt(straight**2 - drop**2)
    inner = math.sqrt(max(0.0, folded**2 - drop**2))

    def possible(radius: float) -> bool:
        return joint_angles(arm, Point(0.0, radius), height) is not None

    grid = [inner + (outer - inner) * i / 64 for i in range(65)]
    inside = [radius for radius in grid if possible(radius)]
    if not inside:
        raise BadInputError(
            f"arm: the joint limits leave no reach with the flange at {height} in; widen "
            "arm.elbow_max_degrees, arm.shoulder_min_degrees or arm.shoulder_max_degrees"
        )
    waist = math.radians(arm.waist_max_degrees)
    return Reach(
        _bisect(possible, inner, inside[0]), _bisect(possible, outer, inside[-1]), -waist, waist
    )


def _bisect(possible: Callable[[float], bool], outside: float, inside: float) -> float:
    """Return the edge of what is possible between a radius outside and one inside (in)."""
    if possible(outside):
        return outside
    for _ in range(60):
        middle = 0.5 * (outside + inside)
        if possible(middle):
            inside = middle
        else:
            outside = middle
    return inside
