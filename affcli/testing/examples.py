"""Observations, rows and tables to ask a part about: made up, the same every time."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from affcli.behaviors.moving import DIRECTIONS
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import (
    GRASP,
    BehaviorCall,
    BehaviorName,
    Execution,
    ExecutionStatus,
    composed_motion,
)
from affcli.core.behavior import POSITION_WRIST as POSITION
from affcli.core.change_detection import change_detected
from affcli.core.choice import Reaches, Situation
from affcli.core.geometry import Point, Pose
from affcli.core.motion import Slide, Turn
from affcli.core.observation import Observation
from affcli.core.task import GoalRegion
from affcli.core.trial import BabblingRecord

OBJECT, TOOL, FOREIGN = (240.0, 120.0, 20.0), (40.0, 160.0, 70.0), (10.0, 10.0, 250.0)
"""Colours: of the attractor, of the tool, and of a tool that no row was made with."""
BINDING = BehaviorCall.of(GRASP, {"grasp_point": 1.0})
CALLS = tuple(
    BehaviorCall.of(BehaviorName(name), {"offset_distance": distance})
    for name in ("extend arm", "contract arm", "slide arm left", "slide arm right")
    for distance in (2.0, 5.0)
)


def observation(at: Point, wrist: Point, tool: tuple[float, float, float] = TOOL) -> Observation:
    """Return what is seen of an attractor and a wrist (in, table frame), without noise."""
    return Observation(*at, 0.0, at.x - wrist.x, at.y - wrist.y, 0.0, *OBJECT, *tool)


def rows(count: int, seed: int = 0) -> tuple[Affordance, ...]:
    """Return rows of random offsets and movements, as they are learned."""
    rng = np.random.default_rng(seed)
    made = []
    for step, (x, y, dx, dy) in enumerate(rng.uniform(-4.0, 4.0, (count, 4)).tolist(), start=1):
        at, wrist = Point(0.0, 22.0), Point(-x, 12.0 - y)
        made.append(
            Affordance(
                *(step, BINDING, CALLS[step % len(CALLS)], observation(at, wrist)),
                observation(Point(at.x + dx, at.y + dy), wrist),
            )
        )
    return tuple(made)


def anywhere(x: NDArray[np.float64], *_: object) -> NDArray[np.bool_]:
    """Say of every wrist position that the arm reaches it."""
    return np.ones(len(x), dtype=bool)


def nowhere(x: NDArray[np.float64], *_: object) -> NDArray[np.bool_]:
    """Say of no wrist position that the arm reaches it."""
    return np.zeros(len(x), dtype=bool)


def left_half(x: NDArray[np.float64], *_: object) -> NDArray[np.bool_]:
    """Say of the wrist positions on the left that the arm reaches them."""
    return x < 0.0


def situation(
    table: AffordanceTable,
    *,
    at: Point = Point(1.0, 21.0),
    wrist: Pose = Pose(0.5, 11.0),
    reaches: Reaches = anywhere,
    tool: tuple[float, float, float] = TOOL,
) -> Situation:
    """Return where a robot stands that has this table and a goal to its left."""
    goal = GoalRegion("left", Point(-6.0, 22.0), 2.0)
    return Situation(table, observation(at, wrist.point, tool), goal, wrist, reaches, BINDING)


def situations() -> Iterator[Situation]:
    """Yield situations with tables of 2 to 40 rows, a third of which have failed too often, and
    wrists and attractors here and there.
    """
    for count in (2, 5, 40):
        made = rows(count, seed=count)
        table = AffordanceTable(
            replace(row, times_used=9 if row.step % 3 == 1 else 1) for row in made
        )
        for x, wrist in ((0.0, Pose(0.0, 10.0)), (-3.0, Pose(6.0, 14.0))):
            for reaches in (anywhere, left_half):
                yield situation(table, at=Point(x, 22.0), wrist=wrist, reaches=reaches)


def _way(call: BehaviorCall) -> tuple[float, float]:
    """Return how far a behavior takes the wrist (in); for each degree of a turn 0.1 to the left."""
    if call.name in DIRECTIONS:
        x, y = DIRECTIONS[call.name]
        return x * call["offset_distance"], y * call["offset_distance"]
    motion = composed_motion(call) or ()
    slides = [segment for segment in motion if isinstance(segment, Slide)]
    turned = sum(segment.degrees for segment in motion if isinstance(segment, Turn))
    return sum(one.dx for one in slides) - 0.1 * turned, sum(one.dy for one in slides)


def record(step: int, place: Point, call: BehaviorCall, seen: Observation) -> BabblingRecord:
    """Return what is told of a behavior: it pushes the attractor before it in every other step, and
    meets the edge of the reach half-way in every fifth.

    Args:
        step: of the run.
        place: where the attractor stood to the wrist (in).
        call: what was tried.
        seen: what was seen before.
    """
    wrist = Pose(*seen.wrist_for(place))
    start = observation(seen.object_position, wrist.point)
    truncated = step % 5 == 0
    dx, dy = (part * (0.5 if truncated else 1.0) for part in _way(call))
    after, pushed = Pose(wrist.x + dx, wrist.y + dy), 0.6 * (step % 2)
    moved = Point(start.object_x + pushed * dx, start.object_y + pushed * dy)
    end = observation(moved, after.point)
    asked = BehaviorCall.of(POSITION, {"x": place.x, "y": place.y})
    placing = Execution(asked, ExecutionStatus.DONE, wrist, wrist, 2.0)
    status = ExecutionStatus.TRUNCATED if truncated else ExecutionStatus.DONE
    execution = Execution(call, status, wrist, after, 2.0)
    row = None
    if change_detected(start, end):
        row = Affordance(step, BINDING, call, start, end, truncated, travel=Point(dx, dy))
    return BabblingRecord(step, 4.0 * step, 0, 0, placing, execution, start, end, row)
