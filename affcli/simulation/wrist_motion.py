"""Wrist motion, straight or turning, in steps of the physics clock.

Every length is kept on a grid of 2^-20 in (far below the arm's encoders) and every velocity times
the time step of 2^-9 s lies on that grid, so sums of displacements are exact in binary. That is
why a push can be started a moment before contact and still be the same to the last bit. A turn is
told as an arc at a lever that is a power of two (in), so its angles are exact, too; and so are the
ways of a slide along any line, whose direction is rounded like a length.
"""

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from affcli.core.geometry import ConvexPolygon, Point
from affcli.simulation.arm import Reach

STEP = 2.0**-9
"""Physics time step (s): at 5 in/s the tool moves 0.0098 in a step, the most it can penetrate."""

GRID = 2.0**-20
"""Resolution of the wrist's position (in)."""

STAIR = 8
"""Ramps change their speed after so many steps: where it changes at each, every step is its own."""


class Stretch(NamedTuple):
    """`steps` physics steps at one speed (in/s)."""

    speed: float
    steps: int


def on_grid(length: float) -> float:
    """Round a length to the wrist's resolution (in)."""
    return round(length / GRID) * GRID


@lru_cache(maxsize=1024)
def trapezoid(
    distance: float, speed: float, acceleration: float, stair: int = STAIR
) -> tuple[Stretch, ...]:
    """Return the stretches that cover `distance` exactly, speeding up, cruising, slowing down.

    Args:
        distance: how far (in), on the grid; 0 gives no stretches.
        speed: cruise speed (in/s).
        acceleration: in/s^2, rounded so that a ramp is a whole number of steps.
        stair: so many steps of a ramp have one speed, the mean of what theirs would be.

    What is left when the cruise is counted in whole steps makes all of them a little slower. Where
    that would make them slower than the ramp it is one more step while slowing down, where its
    speed belongs: a step out of order would be a jerk that throws the puck off the tool.
    """
    ramp_steps = max(1, round(speed / (acceleration * STEP)))
    gain = max(1, round(speed / ramp_steps * 2**10)) / 2**10
    ramp_steps = min(round(speed / gain), math.isqrt(int(distance / (gain * STEP))))
    edges = [*range(0, ramp_steps, stair), ramp_steps] if ramp_steps else []
    ramp = [Stretch(0.5 * gain * (a + b), b - a) for a, b in pairwise(edges)]
    rest = distance - gain * STEP * ramp_steps**2
    top = gain * ramp_steps if ramp_steps else speed
    cruise, remainder = divmod(rest, top * STEP)
    if remainder and cruise:
        slower, faster = divmod(round(rest / GRID), int(cruise) + 1)
        if not ramp or slower * GRID / STEP >= ramp[-1].speed:
            some = [Stretch((slower + 1) * GRID / STEP, faster)] if faster else []
            most = Stretch(slower * GRID / STEP, int(cruise) + 1 - faster)
            return (*ramp, *some, most, *reversed(ramp))
    middle = [Stretch(top, int(cruise))] if cruise else []
    last = [Stretch(remainder / STEP, 1)] if remainder else []
    return (*ramp, *middle, *sorted([*ramp, *last], reverse=True))


@lru_cache(maxsize=1024)
def duration(stretches: tuple[Stretch, ...]) -> float:
    """Return how long the stretches take (s)."""
    return sum(s.steps for s in stretches) * STEP


@lru_cache(maxsize=1024)
def distance_of(stretches: tuple[Stretch, ...]) -> float:
    """Return the distance that the stretches cover (in), exact."""
    return sum(s.speed * s.steps for s in stretches) * STEP


def skip(stretches: tuple[Stretch, ...], distance: float) -> tuple[float, tuple[Stretch, ...]]:
    """Drop the steps that surely end within `distance`.

    Returns:
        How far the dropped steps go (in, exact), and the stretches that are left.
    """
    gone = 0.0
    for i, stretch in enumerate(stretches):
        stride = stretch.speed * STEP
        if gone + stride * stretch.steps <= distance:
            gone += stride * stretch.steps
            continue
        steps = int((distance - gone) / stride)
        left = (Stretch(stretch.speed, stretch.steps - steps), *stretches[i + 1 :])
        return gone + stride * steps, left
    return gone, ()


def trapezoid_time(distance: float, speed: float, acceleration: float) -> float:
    """Return the time of a trapezoid of speed over `distance` (s), for moves without contact."""
    if distance >= speed * speed / acceleration:
        return distance / speed + speed / acceleration
    return 2.0 * math.sqrt(distance / acceleration)


def trapezoid_travel(elapsed: float, distance: float, speed: float, acceleration: float) -> float:
    """Return how far a trapezoid of speed over `distance` (in) has come after some seconds."""
    whole = trapezoid_time(distance, speed, acceleration)
    if elapsed >= whole:
        return distance
    top = min(speed, math.sqrt(distance * acceleration))
    ramp = top / acceleration
    if elapsed <= ramp:
        return 0.5 * acceleration * elapsed * elapsed
    if elapsed <= whole - ramp:
        return top * (elapsed - 0.5 * ramp)
    return distance - 0.5 * acceleration * (whole - elapsed) ** 2


def tip_of(outlines: Sequence[ConvexPolygon]) -> float:
    """Return how far the farthest corner of a tool is from the wrist (in)."""
    return max(math.hypot(*corner) for outline in outlines for corner in outline.vertices)


def lever_of(tip: float) -> float:
    """Return the lever at which turns of a tool are told (in), by how far its tip is."""
    return 2.0 ** math.floor(math.log2(tip))


def turning(
    arc: float, lever: float, tip: float, speed: float, acceleration: float
) -> tuple[Stretch, ...]:
    """Return the stretches of an arc at the lever: the tip speeds up as in a push and is no faster.

    Args:
        arc: how far (in), on the grid.
        lever, tip: as by `lever_of` (in).
        speed, acceleration: of a push (in/s, in/s^2).
    """
    top = speed * lever / tip
    # Such speeds are reached exactly, so no rounding makes the tip faster than it may be.
    top = math.floor(top * 16.0) / 16.0 or top
    return trapezoid(arc, top, acceleration * top / speed)


def stop_at_edge(reach: Reach, start: Point, end: Point) -> Point:
    """Return how far a straight motion from `start` toward `end` gets before the reach ends.

    Args:
        reach: where the wrist can be.
        start: within the reach (in, table frame).
        end: where the motion leads.
    """
    length = math.dist(start, end)
    if length == 0.0:
        return end
    ux, uy = (end.x - start.x) / length, (end.y - start.y) / length
    crossings = [0.0, *sorted(_crossings(reach, start, ux, uy, length)), length]
    free = 0.0
    for a, b in pairwise(crossings):
        middle = 0.5 * (a + b)
        if b > a and not reach.holds(Point(start.x + middle * ux, start.y + middle * uy)):
            break
        free = b
    if free == length:
        return end
    steps = math.floor(free / GRID) * GRID
    return Point(on_grid(start.x + steps * ux), on_grid(start.y + steps * uy))


def _crossings(reach: Reach, start: Point, ux: float, uy: float, length: float) -> list[float]:
    """Return where the line from `start` along (ux, uy) crosses an edge of the reach (in)."""
    found = []
    along = start.x * ux + start.y * uy
    for radius in (reach.inner, reach.outer):
        discriminant = along**2 - (start.x**2 + start.y**2 - radius**2)
        if discriminant >= 0.0:
            root = math.sqrt(discriminant)
            found += [-along - root, -along + root]
    for bearing in (reach.waist_max, reach.waist_min):
        ex, ey = -math.sin(bearing), math.cos(bearing)
        across = ux * ey - uy * ex
        if across != 0.0:
            found.append(-(start.x * ey - start.y * ex) / across)
    return [t for t in found if 0.0 < t < length]
