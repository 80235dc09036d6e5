"""Motor schemas (§5): the few ways of moving the wrist from which every behavior is composed."""

from affcli.core.geometry import Pose
from affcli.core.motion import Carry, Motion, Slide, Wait


def hold(seconds: float) -> Motion:
    """Keep the wrist where it is."""
    return (Wait(seconds),)


def move_straight(dx: float, dy: float) -> Motion:
    """Slide the tool on the table along a straight line (in, table frame)."""
    return (Slide(dx, dy),)


def move_lifted(target: Pose) -> Motion:
    """Lift the tool, carry it over the table to `target`, and lower it there."""
    return (Carry(target),)
