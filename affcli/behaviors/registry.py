"""The behaviors by name: what the robot can be asked to do, and the paths they give.

A behavior is a function from the wrist, the latest observation and parameters to a wrist path. The
registry is handed to the robot, which executes paths, and to babbling, which draws from it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from affcli.behaviors.motor_schemas import hold, move_lifted, move_straight
from affcli.core.behavior import (
    CONTRACT_ARM,
    EXTEND_ARM,
    GRASP,
    OFFSET_DISTANCES,
    POSITION_WRIST,
    SLIDE_ARM_LEFT,
    SLIDE_ARM_RIGHT,
    BehaviorCall,
    BehaviorName,
    WristPath,
)
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.workspace import ArmGeometry, MotionTiming, ToolGeometry

PathMaker = Callable[[BehaviorCall, Point, Observation | None], WristPath]
"""(call, wrist, latest observation) -> the path the wrist is asked to take."""

DIRECTIONS: dict[BehaviorName, tuple[float, float]] = {
    EXTEND_ARM: (0.0, 1.0),
    CONTRACT_ARM: (0.0, -1.0),
    SLIDE_ARM_LEFT: (-1.0, 0.0),
    SLIDE_ARM_RIGHT: (1.0, 0.0),
}
"""Where each moving behavior goes in the table frame. Choice: the paper does not say whether extend
is away from the robot's body or along the arm; away from the body keeps the tool's orientation."""


@dataclass(frozen=True, slots=True)
class BehaviorRegistry:
    """All behaviors of a robot.

    Args:
        paths: how each behavior moves the wrist.
        binding: the binding behavior with its parameters.
        exploratory: the calls that babbling draws from: every moving behavior with every value of
            its parameter.
    """

    paths: Mapping[BehaviorName, PathMaker]
    binding: BehaviorCall
    exploratory: tuple[BehaviorCall, ...]


def paper_behaviors(
    arm: ArmGeometry, motion: MotionTiming, tools: ToolGeometry
) -> BehaviorRegistry:
    """Return the behaviors of §5: grasp, position wrist, and four moving ones of 2 or 5 in.

    Departs from the paper: position wrist is one of its exploratory behaviors; here it is a lifted
    move that goes before each of the other four and makes no row of its own.
    """
    paths: dict[BehaviorName, PathMaker] = {
        name: partial(_slide, direction, motion) for name, direction in DIRECTIONS.items()
    }
    paths[GRASP] = partial(_grasp, motion)
    paths[POSITION_WRIST] = partial(_position_wrist, motion, arm)
    return BehaviorRegistry(
        paths=paths,
        binding=BehaviorCall.of(GRASP, {"grasp_point": tools.handle_below_grasp}),
        exploratory=tuple(
            BehaviorCall.of(name, {"offset_distance": distance})
            for name in DIRECTIONS
            for distance in OFFSET_DISTANCES
        ),
    )


def _slide(
    direction: tuple[float, float],
    motion: MotionTiming,
    call: BehaviorCall,
    wrist: Point,
    seen: Observation | None,
) -> WristPath:
    """Move the arm by offset_distance in the behavior's direction (§5)."""
    distance = call["offset_distance"]
    return move_straight(wrist, direction[0] * distance, direction[1] * distance, motion)


def _position_wrist(
    motion: MotionTiming,
    arm: ArmGeometry,
    call: BehaviorCall,
    wrist: Point,
    seen: Observation | None,
) -> WristPath:
    """Move such that the attractor's centroid is at offset (x, y) relative to the wrist (§5)."""
    if seen is None:
        raise ValueError("position wrist aims by an observation; observe first")
    target = Point(seen.object_x - call["x"], seen.object_y - call["y"])
    return move_lifted(target, motion, arm)


def _grasp(
    motion: MotionTiming, call: BehaviorCall, wrist: Point, seen: Observation | None
) -> WristPath:
    """Close the gripper on the handle, at grasp_point from its lower end (§5.1)."""
    return hold(wrist, motion.grasp_time)
