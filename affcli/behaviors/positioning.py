"""Position wrist: the tool is carried to where the attractor stands to the wrist as asked (§5)."""

import math

from affcli.behaviors.motor_schemas import move_lifted
from affcli.core.behavior import POSITION_WRIST, BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.core.motion import Motion
from affcli.core.observation import Observation


def position_wrist(offset: Point, wrist_angle: float = 0.0) -> BehaviorCall:
    """Return the call after which the attractor stands at `offset` from the wrist.

    Args:
        offset: attractor minus wrist (in, table frame).
        wrist_angle: the wrist's angle then (rad); the paper's is always 0.
    """
    params = {"x": offset.x, "y": offset.y}
    if wrist_angle:
        params["angle"] = math.degrees(wrist_angle)
    return BehaviorCall.of(POSITION_WRIST, params)


def positioning_motion(call: BehaviorCall, seen: Observation | None) -> Motion:
    """Move such that the attractor's centroid is at offset (x, y) relative to the wrist (§5)."""
    if seen is None:
        raise ValueError("position wrist aims by an observation; observe first")
    target = seen.wrist_for(Point(call["x"], call["y"]))
    return move_lifted(Pose(target.x, target.y, math.radians(call.get("angle", 0.0))))
