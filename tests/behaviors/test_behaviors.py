"""The paper's behaviors by name, and the motions they give (§5)."""

import math
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.behaviors.grasping import grasp
from affcli.behaviors.moving import (
    CONTRACT_ARM,
    DIRECTIONS,
    EXTEND_ARM,
    OFFSET_DISTANCES,
    SLIDE_ARM_LEFT,
    SLIDE_ARM_RIGHT,
    moving,
    paper_repertoire,
    sliding,
)
from affcli.behaviors.positioning import position_wrist, wrist_target
from affcli.behaviors.turning import turn_and_pull, turn_and_slide, turn_wrist
from affcli.core.behavior import (
    GRASP,
    POSITION_WRIST,
    BehaviorName,
    repertoire_from_json,
    repertoire_json,
)
from affcli.core.geometry import Point, Pose
from affcli.core.motion import Slide, Turn
from affcli.core.tool import Hold, hold_of
from affcli.core.workspace import ToolGeometry
from affcli.report.words import call_words
from tests.factories import observation, places

GEOMETRY = ToolGeometry()
MOVING = (EXTEND_ARM, CONTRACT_ARM, SLIDE_ARM_LEFT, SLIDE_ARM_RIGHT)


def test_babbling_draws_from_four_moving_behaviors_with_2_and_5_inches_each() -> None:
    """§5: "The first four behaviors move the arm in the indicated direction ... Two different
    values for this parameter were used (2 and 5 inches)". Departs from the paper: position wrist,
    its fifth behavior, goes before each of them and is not drawn by itself."""
    assert OFFSET_DISTANCES == (2.0, 5.0)
    calls = [(one.call.name, one.call.params) for one in paper_repertoire()]
    assert calls == [
        (name, (("offset_distance", distance),)) for name, distance in product(MOVING, (2.0, 5.0))
    ]


def test_the_one_binding_behavior_is_a_grasp_at_the_lower_part_of_the_handle() -> None:
    """§5.1: "It takes as a parameter the location of a single grasp point"."""
    binding = grasp(GEOMETRY)
    assert (binding.name, binding.params) == (
        GRASP,
        (("grasp_point", GEOMETRY.handle_below_grasp),),
    )
    assert hold_of(binding) == Hold(GEOMETRY.handle_below_grasp)


def test_a_turned_grasp_keeps_its_angle_in_degrees_and_holds_in_radians() -> None:
    binding = grasp(GEOMETRY, grasp_point=3.0, angle=-90.0)
    assert binding.params == (("grasp_point", 3.0), ("angle", -90.0))
    assert hold_of(binding) == Hold(3.0, -math.pi / 2.0)


@pytest.mark.parametrize(
    ("name", "x", "y"),
    [
        (EXTEND_ARM, 0.0, 1.0),
        (CONTRACT_ARM, 0.0, -1.0),
        (SLIDE_ARM_LEFT, -1.0, 0.0),
        (SLIDE_ARM_RIGHT, 1.0, 0.0),
    ],
)
@pytest.mark.parametrize("distance", [2.0, 5.0, 0.25])
def test_each_moving_behavior_slides_the_tool_its_way_by_its_parameter(
    name: BehaviorName, x: float, y: float, distance: float
) -> None:
    """§5: "a single parameter which determines how far the arm will travel relative to its current
    position". Extend is +y, contract -y, left -x, right +x of the table."""
    (behavior,) = moving(name, distance)
    assert behavior.motion == (Slide(x * distance, y * distance),)
    assert DIRECTIONS[name] == (x, y)


def test_a_repertoire_is_the_same_after_its_json() -> None:
    repertoire = paper_repertoire()
    assert repertoire_from_json(repertoire_json(repertoire)) == repertoire


@given(places, places, places, st.one_of(st.just(0.0), st.floats(-3.0, 3.0)))
def test_position_wrist_brings_the_attractor_to_its_offset_from_the_wrist(
    wrist: Point, at: Point, offset: Point, angle: float
) -> None:
    """§5: "moves the manipulator such that the centroid of the attractor is at offset (x, y)
    relative to the wrist", by the latest observation; lifted, so that it touches nothing."""
    call = position_wrist(offset, angle)
    target = wrist_target(call, observation(at, wrist=wrist))
    assert (at.x - target.x, at.y - target.y) == offset
    assert target.angle == pytest.approx(angle)


def test_position_wrist_names_no_angle_when_it_is_0() -> None:
    """So a call of the paper's stays what it was before wrists could turn."""
    call = position_wrist(Point(-1.5, 12.0))
    assert (call.name, call.params) == (POSITION_WRIST, (("x", -1.5), ("y", 12.0)))
    assert wrist_target(call, observation(Point(0.0, 24.0))) == Pose(1.5, 12.0, 0.0)


def test_position_wrist_without_an_observation_is_refused() -> None:
    with pytest.raises(ValueError, match="observe first"):
        wrist_target(position_wrist(Point(0.0, 8.0)), None)


def test_the_arm_slides_in_any_direction_of_the_table() -> None:
    (diagonal,), (left,) = sliding(45.0, 5.0), sliding(180.0, 2.0)
    (slide,) = diagonal.motion
    assert isinstance(slide, Slide)
    assert (slide.dx, slide.dy) == pytest.approx((5.0 / math.sqrt(2.0),) * 2)
    assert left.motion == moving(SLIDE_ARM_LEFT, 2.0)[0].motion
    assert [call_words(one.call) for one in (diagonal, left)] == [
        "slide arm 45 deg 5",
        "slide arm 180 deg 2",
    ]


def test_turning_behaviors_turn_and_then_slide_the_tool_at_the_angle() -> None:
    """§7.1: "turn-the-wrist-at-an-angle-and-then-pull"."""
    (turn,), (pull,) = turn_wrist(30.0), turn_and_pull(-60.0, 5.0)
    (slide,) = turn_and_slide(45.0, 2.0, 180.0)
    assert turn.motion == (Turn(30.0),)
    assert pull.motion == (Turn(-60.0), Slide(0.0, -5.0))
    assert slide.motion == (Turn(45.0), Slide(-2.0, 0.0))
    names = [call_words(one.call) for one in (turn, pull, slide)]
    assert names == [
        "turn wrist 30 deg",
        "turn and pull -60 deg 5",
        "turn and slide 45 deg 2 180 deg",
    ]
    for one in (turn, pull, slide):
        assert repertoire_from_json(repertoire_json((one,))) == (one,)
