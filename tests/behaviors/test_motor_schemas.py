"""The motor schemas from which every behavior is composed (§5)."""

from affcli.behaviors.motor_schemas import hold, move_lifted, move_straight
from hypothesis import given
from hypothesis import strategies as st

from affcli.core.geometry import Point, Pose
from affcli.core.motion import Carry, Slide, Wait
from tests.factories import eighths, places


@given(st.floats(0.0, 60.0))
def test_holding_leaves_the_wrist_where_it_is_for_a_while(seconds: float) -> None:
    assert hold(seconds) == (Wait(seconds),)


@given(eighths, eighths)
def test_a_straight_move_slides_on_the_table_by_what_is_asked(dx: float, dy: float) -> None:
    """§5: "keeping the wrist perpendicular to the table on which the tool slides"."""
    assert move_straight(dx, dy) == (Slide(dx, dy),)


@given(places, st.floats(-3.0, 3.0))
def test_a_lifted_move_carries_the_tool_to_a_pose(target: Point, angle: float) -> None:
    pose = Pose(*target, angle)
    assert move_lifted(pose) == (Carry(pose),)
