"""Behaviors that turn the wrist: by itself, and before the arm moves (§7.1).

The paper's robot has no such behavior, and so cannot pull with a stick: §7.1 asks for one that does
"turn-the-wrist-at-an-angle-and-then-pull".
"""

from affcli.behaviors.moving import DIRECTION, slide_towards
from affcli.core.behavior import BehaviorCall, BehaviorName, ExploratoryBehavior, Repertoire
from affcli.core.motion import Slide, Turn
from affcli.core.part import Part
from affcli.core.setting import Setting

TURN_WRIST = BehaviorName("turn wrist")
TURN_AND_PULL = BehaviorName("turn and pull")
TURN_AND_SLIDE = BehaviorName("turn and slide")

ANGLE = Setting(
    *(30.0, "degrees"), "How far the wrist turns, positive to the left.", *(-180.0, 180.0)
)
DISTANCE = Setting(5.0, "in", "How far the arm travels then.", 0.1, 20.0)


def turn_wrist(angle: float) -> Repertoire:
    """Return one behavior: the tool turns on the table about the wrist (degrees)."""
    call = BehaviorCall.of(TURN_WRIST, {"angle": angle})
    return (ExploratoryBehavior(call, (Turn(angle),)),)


def turn_and_pull(angle: float, distance: float) -> Repertoire:
    """Return one behavior: turn (degrees), then contract the arm (in), the angle held."""
    call = BehaviorCall.of(TURN_AND_PULL, {"angle": angle, "distance": distance})
    return (ExploratoryBehavior(call, (Turn(angle), Slide(0.0, -distance))),)


def turn_and_slide(angle: float, distance: float, direction: float) -> Repertoire:
    """Return one behavior: turn, then slide in a direction of the table (degrees, in, degrees)."""
    params = {"angle": angle, "distance": distance, "direction": direction}
    motion = (Turn(angle), slide_towards(direction, distance))
    return (ExploratoryBehavior(BehaviorCall.of(TURN_AND_SLIDE, params), motion),)


PARTS = (
    Part(
        kind="behaviors",
        name="turn-wrist",
        summary="turn wrist: the tool turns on the table about the wrist",
        source="Stoytchev 2008, §7.1",
        build=turn_wrist,
        params={"angle": ANGLE},
    ),
    Part(
        kind="behaviors",
        name="turn-and-pull",
        summary="turn and pull: the tool turns, then the arm contracts",
        source="Stoytchev 2008, §7.1",
        build=turn_and_pull,
        params={"angle": ANGLE, "distance": DISTANCE},
    ),
    Part(
        kind="behaviors",
        name="turn-and-slide",
        summary="turn and slide: the tool turns, then slides in one direction of the table",
        source="affcli",
        build=turn_and_slide,
        params={"angle": ANGLE, "distance": DISTANCE, "direction": DIRECTION},
    ),
)
