"""Motor schemas (§5): the few ways of moving the wrist from which every behavior is composed."""

from affcli.core.behavior import WristPath
from affcli.core.geometry import Point
from affcli.core.workspace import ArmGeometry, MotionTiming


def hold(wrist: Point, seconds: float) -> WristPath:
    """Keep the wrist where it is."""
    return WristPath(wrist, lifted=False, speed=1.0, acceleration=1.0, dwell=seconds)


def move_straight(wrist: Point, dx: float, dy: float, motion: MotionTiming) -> WristPath:
    """Slide the tool on the table along a straight line, with a trapezoid of speed.

    Args:
        wrist: where the wrist is (in, table frame).
        dx, dy: how far to go (in).
        motion: speeds; the stillness before the observation that follows is added.
    """
    return WristPath(
        Point(wrist.x + dx, wrist.y + dy),
        lifted=False,
        speed=motion.push_speed,
        acceleration=motion.push_acceleration,
        dwell=motion.hold,
    )


def move_lifted(target: Point, motion: MotionTiming, arm: ArmGeometry) -> WristPath:
    """Lift the tool, carry it over the table to `target`, and lower it there."""
    return WristPath(
        target,
        lifted=True,
        speed=motion.transfer_speed,
        acceleration=motion.transfer_acceleration,
        dwell=2.0 * arm.lift_height / motion.lift_speed + motion.hold,
    )
