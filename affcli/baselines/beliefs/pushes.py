"""A table of pushes as someone believes them who knows shapes and physics."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from affcli.behaviors.positioning import position_wrist
from affcli.core.affordance import Affordance
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import (
    BehaviorCall,
    Execution,
    ExecutionStatus,
    ExploratoryBehavior,
    Repertoire,
)
from affcli.core.change_detection import change_detected
from affcli.core.geometry import Point, Pose, near_any
from affcli.core.motion import Slide
from affcli.core.observation import Observation
from affcli.core.specs import LearningStep
from affcli.core.tool import PUCK_COLOR, Tool, hold_of
from affcli.core.trial import BabblingRecord, Truth
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.pushing import PushSimulator
from affcli.simulation.wrist_motion import on_grid, trapezoid

CLEAR = 0.02
"""So far the tool comes down from the attractor at least (in)."""


@dataclass(frozen=True, slots=True)
class Belief:
    """What someone believes of the table.

    Args:
        tool: the tool that is held.
        binding: how.
        repertoire: what can be done with it.
        workspace: sizes, frictions and speeds.
        physics: how finely to solve.
        box: where the attractor may stand to the wrist.
        spacing: between the places that pushes are computed for (in).
    """

    tool: Tool
    binding: BehaviorCall
    repertoire: Repertoire
    workspace: Workspace
    physics: PhysicsSettings
    box: BabblingSettings
    spacing: float

    def told(self, friction: float, *, even: bool) -> "Belief":
        """Return the same with another friction of tool and puck, which 0 leaves; and with a puck
        whose centre of mass lies in its middle.
        """
        place = self.workspace
        if friction:
            place = replace(place, friction=replace(place.friction, tool_puck=friction))
        if even:
            place = replace(place, puck=replace(place.puck, mass_offset=0.0))
        return replace(self, workspace=place)


@lru_cache(maxsize=32)
def pushes(belief: Belief) -> tuple[LearningStep, ...]:
    """Return every push that is believed to move the attractor, as if it had been babbled, without
    noise and in no time: one for each behavior and place of the attractor.

    Raises:
        BadInputError: a behavior is no straight slide, or nothing is believed to move.
    """
    simulator = PushSimulator(
        belief.tool.held(hold_of(belief.binding)).outlines,
        *(belief.workspace.puck, belief.workspace.friction, belief.physics),
    )
    places = tuple(_places(belief))
    found: list[LearningStep] = []
    for behavior in belief.repertoire:
        slide = _slide(behavior)
        length = math.hypot(slide.dx, slide.dy)
        timing = belief.workspace.motion
        motion = trapezoid(on_grid(length), timing.push_speed, timing.push_acceleration)
        direction = Point(slide.dx / length, slide.dy / length)
        for place in places:
            before = Pose(*place)
            after = simulator.push(before, Point(0.0, 0.0), direction, motion)
            step = _step(len(found) + 1, belief, behavior, slide, before, after)
            if step is not None:
                found.append((step, Truth(before, after)))
    if not found:
        raise BadInputError(
            f"the {belief.tool.name} is believed to move the attractor by nothing that can be done "
            "with it; choose another repertoire"
        )
    return tuple(found)


def _places(belief: Belief) -> Iterator[Point]:
    """Yield the places of the attractor, as seen from the wrist, that the tool leaves free."""
    outlines = belief.tool.held(hold_of(belief.binding)).outlines
    radius, box, spacing = belief.workspace.puck.radius + CLEAR, belief.box, belief.spacing
    for y in np.arange(box.offset_y_min, box.offset_y_max + 1e-9, spacing).tolist():
        for x in np.arange(-box.offset_x_max, box.offset_x_max + 1e-9, spacing).tolist():
            if not near_any(outlines, Point(x, y), radius):
                yield Point(x, y)


def _slide(behavior: ExploratoryBehavior) -> Slide:
    """Return the slide that a behavior is; BadInputError when it is anything else."""
    match behavior.motion:
        case (Slide() as slide,):
            return slide
    raise BadInputError(
        f"{behavior.call} is no straight slide: pushes are computed of those alone; leave it out"
    )


def _step(
    number: int,
    belief: Belief,
    behavior: ExploratoryBehavior,
    slide: Slide,
    before: Pose,
    after: Pose,
) -> BabblingRecord | None:
    """Return a push as the record of a behavior; None when it moves nothing that T detects."""
    start = _seen(belief.tool, before.point, Point(0.0, 0.0))
    end = _seen(belief.tool, after.point, Point(slide.dx, slide.dy))
    if not change_detected(start, end):
        return None
    row = Affordance(
        *(number, belief.binding, behavior.call, start, end),
        travel=Point(slide.dx, slide.dy),
    )
    wrist, there = Pose(0.0, 0.0), Pose(slide.dx, slide.dy)
    done = ExecutionStatus.DONE
    placing = Execution(position_wrist(before.point), done, wrist, wrist, 0.0)
    execution = Execution(behavior.call, done, wrist, there, 0.0)
    return BabblingRecord(number, 0.0, 0, 0, placing, execution, start, end, row)


def _seen(tool: Tool, at: Point, wrist: Point) -> Observation:
    """Return what would be seen without noise, the wrist's first place at the origin."""
    return Observation(*at, 0.0, at.x - wrist.x, at.y - wrist.y, 0.0, *PUCK_COLOR, *tool.color)
