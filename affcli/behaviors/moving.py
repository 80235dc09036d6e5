"""Behaviors that move the arm: the paper's four, its repertoire of them (§5), and one beside."""

import math
from functools import partial

from affcli.core.behavior import BehaviorCall, BehaviorName, ExploratoryBehavior, Repertoire
from affcli.core.motion import Slide
from affcli.core.part import Part
from affcli.core.setting import Setting

EXTEND_ARM = BehaviorName("extend arm")
CONTRACT_ARM = BehaviorName("contract arm")
SLIDE_ARM_LEFT = BehaviorName("slide arm left")
SLIDE_ARM_RIGHT = BehaviorName("slide arm right")
SLIDE_ARM = BehaviorName("slide arm")
"""Departs from the paper: any direction, for repertoires richer than its own (§8)."""

OFFSET_DISTANCES = (2.0, 5.0)
"""The two values of offset_distance used in the paper (in, §5)."""

DIRECTIONS: dict[BehaviorName, tuple[float, float]] = {
    EXTEND_ARM: (0.0, 1.0),
    CONTRACT_ARM: (0.0, -1.0),
    SLIDE_ARM_LEFT: (-1.0, 0.0),
    SLIDE_ARM_RIGHT: (1.0, 0.0),
}
"""Where each moving behavior goes in the table frame. Choice: the paper does not say whether extend
is away from the robot's body or along the arm; away from the body keeps the tool's orientation."""

OFFSET_DISTANCE = Setting(5.0, "in", "How far the arm travels.", 0.1, 20.0)
DIRECTION = Setting(
    *(180.0, "degrees"),
    "Where the arm goes: 0 is to its right, 90 away from it, 180 to its left.",
    *(-360.0, 360.0),
)
DECIMALS = 9
"""Of a slide's parts (in), so that one along an axis of the table keeps to it."""


def moving(name: BehaviorName, offset_distance: float) -> Repertoire:
    """Return one behavior: the arm moves by `offset_distance` (in) in the behavior's direction."""
    x, y = DIRECTIONS[name]
    call = BehaviorCall.of(name, {"offset_distance": offset_distance})
    motion = (Slide(x * offset_distance, y * offset_distance),)
    return (ExploratoryBehavior(call, motion),)


def slide_towards(direction: float, distance: float) -> Slide:
    """Return the slide by `distance` (in) in a direction of the table frame (degrees)."""
    cos, sin = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    return Slide(round(distance * cos, DECIMALS), round(distance * sin, DECIMALS))


def sliding(direction: float, offset_distance: float) -> Repertoire:
    """Return one behavior: the arm moves by `offset_distance` (in) in a direction (degrees)."""
    params = {"direction": direction, "offset_distance": offset_distance}
    motion = (slide_towards(direction, offset_distance),)
    return (ExploratoryBehavior(BehaviorCall.of(SLIDE_ARM, params), motion),)


def paper_repertoire() -> Repertoire:
    """Return the exploratory behaviors of §5: four that move the arm, by 2 and by 5 in.

    Departs from the paper: position wrist is one of its exploratory behaviors; here it is a lifted
    move that goes before each of the others and makes no row of its own.
    """
    return tuple(
        behavior
        for name in DIRECTIONS
        for distance in OFFSET_DISTANCES
        for behavior in moving(name, distance)
    )


PARTS = (
    Part(
        kind="behaviors",
        name="paper",
        summary="the paper's eight: extend, contract, slide left and slide right, by 2 and by 5 in",
        source="Stoytchev 2008, §5",
        build=paper_repertoire,
    ),
    *(
        Part(
            kind="behaviors",
            name=name.replace(" ", "-"),
            summary=f"{name}: the wrist slides in one direction of the table",
            source="Stoytchev 2008, §5",
            build=partial(moving, name),
            params={"offset_distance": OFFSET_DISTANCE},
        )
        for name in DIRECTIONS
    ),
    Part(
        kind="behaviors",
        name="slide-arm",
        summary="slide arm: the wrist slides in any direction of the table, such as a diagonal",
        source="affcli",
        build=sliding,
        params={"direction": DIRECTION, "offset_distance": OFFSET_DISTANCE},
    ),
)
