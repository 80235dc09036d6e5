"""The behaviors by name and the wrist paths they give (§5)."""

from itertools import product

import pytest
from affcli.behaviors.registry import paper_behaviors
from hypothesis import given, settings

from affcli.behaviors.moving import (
    CONTRACT_ARM,
    DIRECTIONS,
    EXTEND_ARM,
    SLIDE_ARM_LEFT,
    SLIDE_ARM_RIGHT,
)
from affcli.core.behavior import GRASP, POSITION_WRIST, BehaviorCall, BehaviorName
from affcli.core.geometry import Point
from affcli.core.workspace import Workspace
from tests.factories import observation, places

WORKSPACE = Workspace()
MOTION = WORKSPACE.motion
REGISTRY = paper_behaviors(WORKSPACE.arm, MOTION, WORKSPACE.tools)
MOVING = (EXTEND_ARM, CONTRACT_ARM, SLIDE_ARM_LEFT, SLIDE_ARM_RIGHT)


def test_babbling_draws_from_four_moving_behaviors_with_2_and_5_inches_each() -> None:
    """§5: "The first four behaviors move the arm in the indicated direction ... Two different
    values for this parameter were used (2 and 5 inches)". Departs from the paper: position wrist,
    its fifth behavior, goes before each of them and is not drawn by itself."""
    calls = {(call.name, call.params) for call in REGISTRY.exploratory}
    assert calls == {
        (name, (("offset_distance", distance),)) for name, distance in product(MOVING, (2.0, 5.0))
    }
    assert len(REGISTRY.exploratory) == 8


def test_the_one_binding_behavior_is_a_grasp_at_the_lower_part_of_the_handle() -> None:
    """§5.1: "It takes as a parameter the location of a single grasp point"."""
    assert REGISTRY.binding.name == GRASP
    assert REGISTRY.binding["grasp_point"] == WORKSPACE.tools.handle_below_grasp
    assert [name for name, _ in REGISTRY.binding.params] == ["grasp_point"]


def test_every_call_has_a_path_and_every_path_a_name_of_the_paper() -> None:
    assert set(REGISTRY.paths) == {GRASP, POSITION_WRIST, *MOVING}
    assert {call.name for call in (*REGISTRY.exploratory, REGISTRY.binding)} <= set(REGISTRY.paths)


@pytest.mark.parametrize(
    ("name", "x", "y"),
    [
        (EXTEND_ARM, 0.0, 1.0),
        (CONTRACT_ARM, 0.0, -1.0),
        (SLIDE_ARM_LEFT, -1.0, 0.0),
        (SLIDE_ARM_RIGHT, 1.0, 0.0),
    ],
)
@pytest.mark.parametrize("distance", [2.0, 5.0])
@settings(deadline=None)
@given(wrist=places)
def test_each_moving_behavior_slides_the_tool_its_way_by_its_parameter(
    name: BehaviorName, x: float, y: float, distance: float, wrist: Point
) -> None:
    """§5: "a single parameter which determines how far the arm will travel relative to its current
    position". Extend is +y, contract -y, left -x, right +x of the table."""
    call = BehaviorCall.of(name, {"offset_distance": distance})
    path = REGISTRY.paths[name](call, wrist, observation())
    assert path.end == (wrist.x + x * distance, wrist.y + y * distance)
    assert not path.lifted
    assert DIRECTIONS[name] == (x, y)


@settings(deadline=None)
@given(places, places, places)
def test_position_wrist_brings_the_attractor_to_its_offset_from_the_wrist(
    wrist: Point, at: Point, offset: Point
) -> None:
    """§5: "moves the manipulator such that the centroid of the attractor is at offset (x, y)
    relative to the wrist", by the latest observation; lifted, so that it touches nothing."""
    call = BehaviorCall.of(POSITION_WRIST, {"x": offset.x, "y": offset.y})
    path = REGISTRY.paths[POSITION_WRIST](call, wrist, observation(at, wrist=wrist))
    assert (at.x - path.end.x, at.y - path.end.y) == offset
    assert path.lifted


def test_position_wrist_without_an_observation_is_refused() -> None:
    call = BehaviorCall.of(POSITION_WRIST, {"x": 0.0, "y": 8.0})
    with pytest.raises(ValueError, match="observe first"):
        REGISTRY.paths[POSITION_WRIST](call, Point(0.0, 10.0), None)


@settings(deadline=None)
@given(places)
def test_grasping_takes_its_time_and_moves_nothing(wrist: Point) -> None:
    path = REGISTRY.paths[GRASP](REGISTRY.binding, wrist, None)
    assert path.end == wrist
    assert path.dwell == MOTION.grasp_time
