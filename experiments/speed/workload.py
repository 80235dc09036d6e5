"""The pushes that everything is measured with, always the same."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from affcli.config import Settings
from affcli.core.geometry import ConvexPolygon, Point, Pose, near_any
from affcli.core.tool import ToolName
from affcli.simulation.contact import travel_to_contact
from affcli.simulation.pushing import CONTACT_MARGIN, PushSimulator
from affcli.simulation.tools.paper import paper_tool
from affcli.simulation.wrist_motion import Stretch, distance_of, on_grid, trapezoid

WORKLOAD = 8_192
WORKLOAD_SEED = 20_080_219
DISTANCE = 5.0
"""How far the tool goes in the pushes that other engines do too (in)."""

SETTINGS = Settings()
OUTLINES: tuple[ConvexPolygon, ...] = paper_tool(
    ToolName("t-hook"), SETTINGS.workspace.tools
).outlines


class Push(NamedTuple):
    """One push: the puck at rest, the wrist, the way the tool goes."""

    puck: Pose
    wrist: Point
    direction: Point
    motion: tuple[Stretch, ...]


def simulator() -> PushSimulator:
    """Return a world with the T-hook in it."""
    workspace = SETTINGS.workspace
    return PushSimulator(OUTLINES, workspace.puck, workspace.friction, SETTINGS.physics)


def workload() -> list[Push]:
    """Return the fixed workload: random behaviors of the T-hook, about 12 % of which touch."""
    rng = np.random.default_rng(WORKLOAD_SEED)
    motion = SETTINGS.workspace.motion
    directions = (Point(0.0, 1.0), Point(0.0, -1.0), Point(-1.0, 0.0), Point(1.0, 0.0))
    pushes: list[Push] = []
    while len(pushes) < WORKLOAD:
        x, y, dx, dy = rng.random(4).tolist()
        wrist = Point(on_grid(-12.0 + 24.0 * x), on_grid(4.0 + 12.0 * y))
        offset = Point(-13.0 + 26.0 * dx, 2.0 + 24.0 * dy)
        direction = directions[int(rng.integers(4))]
        distance = (2.0, 5.0)[int(rng.integers(2))]
        if near_any(OUTLINES, offset, SETTINGS.workspace.puck.radius):
            continue
        stretches = trapezoid(distance, motion.push_speed, motion.push_acceleration)
        puck = Pose(wrist.x + offset.x, wrist.y + offset.y)
        pushes.append(Push(puck, wrist, direction, stretches))
    return pushes


def touching(pushes: Sequence[Push]) -> list[Push]:
    """Return those that touch the puck, each begun just before contact and 5 in long from there.

    So no engine gains by leaving out what comes before contact: all do the same work.
    """
    motion = SETTINGS.workspace.motion
    stretches = trapezoid(DISTANCE, motion.push_speed, motion.push_acceleration)
    found = []
    for push in pushes:
        travel = _travel(push)
        if travel is not None and travel > CONTACT_MARGIN:
            gone = travel - CONTACT_MARGIN
            start = Point(
                on_grid(push.wrist.x + gone * push.direction.x),
                on_grid(push.wrist.y + gone * push.direction.y),
            )
            found.append(push._replace(wrist=start, motion=stretches))
    return found


def _travel(push: Push) -> float | None:
    """Return how far the tool goes before it touches the puck (in), None if it never does."""
    center = Point(push.puck.x - push.wrist.x, push.puck.y - push.wrist.y)
    radius = SETTINGS.workspace.puck.radius
    return travel_to_contact(OUTLINES, push.direction, distance_of(push.motion), center, radius)
