"""The motor schemas from which every behavior is composed (§5)."""

from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.behaviors.motor_schemas import hold, move_lifted, move_straight
from affcli.core.geometry import Point
from affcli.core.workspace import ArmGeometry, MotionTiming
from tests.factories import eighths, places

MOTION, ARM = MotionTiming(), ArmGeometry()


@settings(deadline=None)
@given(places, st.floats(0.0, 60.0))
def test_holding_leaves_the_wrist_where_it_is_for_a_while(wrist: Point, seconds: float) -> None:
    path = hold(wrist, seconds)
    assert path.end == wrist
    assert path.dwell == seconds
    assert not path.lifted


@settings(deadline=None)
@given(places, eighths, eighths)
def test_a_straight_move_slides_on_the_table_by_what_is_asked(
    wrist: Point, dx: float, dy: float
) -> None:
    """§5: "keeping the wrist perpendicular to the table on which the tool slides"."""
    path = move_straight(wrist, dx, dy, MOTION)
    assert path.end == (wrist.x + dx, wrist.y + dy)
    assert not path.lifted
    assert (path.speed, path.acceleration) == (MOTION.push_speed, MOTION.push_acceleration)
    assert path.dwell == MOTION.hold


@settings(deadline=None)
@given(places)
def test_a_lifted_move_goes_up_over_and_down_and_stands_still_for_the_look_that_follows(
    target: Point,
) -> None:
    path = move_lifted(target, MOTION, ARM)
    assert path.end == target
    assert path.lifted
    assert (path.speed, path.acceleration) == (
        MOTION.transfer_speed,
        MOTION.transfer_acceleration,
    )
    up_and_down = 2.0 * ARM.lift_height / MOTION.lift_speed
    assert path.dwell == up_and_down + MOTION.hold
