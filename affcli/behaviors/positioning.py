"""Position wrist: the tool is carried to where the attractor stands to the wrist as asked (§5)."""

import math

from affcli.core.behavior import POSITION_WRIST, BehaviorCall
from affcli.core.geometry import Point, Pose
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


def wrist_target(call: BehaviorCall, seen: Observation | None) -> Pose:
    """Return where the wrist goes: such that the attractor's centroid is at offset (x, y) from it
    (§5) (in, rad, table frame).
    """
    if seen is None:
        raise ValueError("position wrist aims by an observation; observe first")
    params = dict(call.params)
    angle = math.radians(params["angle"]) if "angle" in params else 0.0
    return Pose(seen.object_x - params["x"], seen.object_y - params["y"], angle)
