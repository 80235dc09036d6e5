"""``push-planner`` and ``oracle``: planners on a dense table of pushes that was computed, not
learned.

§8: "the behavior-grounded approach should be compared experimentally with planners for pushing
objects." Both search as `lookahead` does. The one believes the tool that it is told, also when that
broke; the other is told the tool that is truly held.
"""

from affcli.core.affordance import PROBABILITY_THRESHOLD
from affcli.core.part import Part
from affcli.core.setting import Setting, Value
from affcli.planning.lookahead import PARTS as LOOKAHEAD
from affcli.planning.lookahead import Lookahead

PUSH_PLANNER, ORACLE = "push-planner", "oracle"
DENSE, FINEST, COARSEST = 0.5, 0.25, 2.0
"""Inches between the places of the attractor, as seen from the wrist, that pushes are computed for:
unless it is said otherwise, at least and at most."""


def on_pushes(
    depth: int, beam: int, angle_degrees: float, counters: int = 1, **_: Value
) -> Lookahead:
    """Return the search of a baseline; what else it is told, the table says that it is given.

    Args:
        depth, beam, angle_degrees: as in `Lookahead`.
        counters: 1 to exclude pushes that failed, as a robot excludes rows; 0 to believe what was
            computed whatever comes of it.
    """
    threshold = PROBABILITY_THRESHOLD if counters else 0.0
    return Lookahead(depth, beam, threshold, angle_degrees, certain=not counters)


SEARCH = {name: LOOKAHEAD[0].params[name] for name in ("depth", "beam", "angle_degrees")}
SPACING = {
    "spacing": Setting(
        *(DENSE, "in"),
        "Between the places of the attractor that pushes are computed for.",
        *(FINEST, COARSEST),
    ),
}
BELIEFS = {
    "counters": Setting(
        *(1, ""),
        "1: pushes that failed are excluded, as rows are; 0: believed whatever comes of them.",
        *(0, 1),
    ),
    "friction": Setting(
        *(0.0, ""),
        "Of tool and puck, as it believes; 0: as it truly is.",
        *(0.0, 10.0),
    ),
    "even": Setting(
        *(0, ""),
        "1: it believes that the puck's centre of mass is its middle, where it is not.",
        *(0, 1),
    ),
}
PARTS = tuple(
    Part(
        kind="planners",
        name=name,
        summary=summary,
        source="Stoytchev 2008, §8 (asked for there)",
        build=on_pushes,
        params={**SEARCH, **SPACING, **beliefs},
        told=True,
    )
    for name, beliefs, summary in (
        (
            *(PUSH_PLANNER, BELIEFS),
            "no robot's own: plans on computed pushes of the tool that it believes in",
        ),
        (
            *(ORACLE, dict[str, Setting]()),
            "no robot's own: plans on computed pushes of the tool that is truly held",
        ),
    )
)
