"""The four behaviors that move the arm, and the paper's repertoire of them (§5)."""

from functools import partial

from affcli.core.behavior import BehaviorCall, BehaviorName, ExploratoryBehavior, Repertoire
from affcli.core.motion import Slide
from affcli.core.part import Part
from affcli.core.setting import Setting

EXTEND_ARM = BehaviorName("extend arm")
CONTRACT_ARM = BehaviorName("contract arm")
SLIDE_ARM_LEFT = BehaviorName("slide arm left")
SLIDE_ARM_RIGHT = BehaviorName("slide arm right")

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


def moving(name: BehaviorName, offset_distance: float) -> Repertoire:
    """Return one behavior: the arm moves by `offset_distance` (in) in the behavior's direction."""
    x, y = DIRECTIONS[name]
    call = BehaviorCall.of(name, {"offset_distance": offset_distance})
    motion = (Slide(x * offset_distance, y * offset_distance),)
    return (ExploratoryBehavior(call, motion),)


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
            params={"offset_distance": Setting(5.0, "in", "How far the arm travels.", 0.1, 20.0)},
        )
        for name in DIRECTIONS
    ),
)
