"""Motions: what an exploratory behavior asks of the wrist, as segments one after the other (§5).

A slide is told from where the wrist is when it begins, a carry by where it ends: a row with a carry
is done again at that place of the table alone. Directions are the table's axes, not those of the
hand: so are the offsets between wrist and attractor that the robot observes (o4 to o6,
§5.2), and a row can be done again from the same offset only when both are told in the same axes. A
row carries the wrist's angle, and position wrist restores it; at an equal angle the two choices say
the same.
"""

import math
from dataclasses import dataclass
from typing import Any

from affcli.core.geometry import Pose


@dataclass(frozen=True, slots=True)
class Slide:
    """Slide the tool on the table along a straight line, the wrist's angle held.

    Args:
        dx, dy: how far (in, table frame).
    """

    dx: float
    dy: float


@dataclass(frozen=True, slots=True)
class Turn:
    """Turn the tool on the table about the wrist, which stays.

    Args:
        degrees: by how much, counter-clockwise.
    """

    degrees: float


@dataclass(frozen=True, slots=True)
class Carry:
    """Lift the tool, carry it over the table, and lower it there.

    Args:
        to: where the wrist is to be (in, rad, table frame).
    """

    to: Pose


@dataclass(frozen=True, slots=True)
class Wait:
    """Keep the wrist where it is.

    Args:
        seconds: for how long.
    """

    seconds: float


Segment = Slide | Turn | Carry | Wait
Motion = tuple[Segment, ...]


def turned_by(motion: Motion) -> tuple[float, ...]:
    """Return how far the wrist is turned at the beginning of a motion and after each turn (rad).

    Counted from the angle that it begins at; a carry ends the count.
    """
    angles = [0.0]
    for segment in motion:
        if isinstance(segment, Carry):
            break
        if isinstance(segment, Turn):
            angles.append(angles[-1] + math.radians(segment.degrees))
    return tuple(angles)


def poses(motion: Motion, start: Pose) -> tuple[Pose, ...]:
    """Return where the wrist is when a motion begins and after each segment (in, rad), if nothing
    ends it before.
    """
    found = [start]
    for segment in motion:
        x, y, angle = found[-1]
        match segment:
            case Slide(dx, dy):
                found.append(Pose(x + dx, y + dy, angle))
            case Turn(degrees):
                found.append(Pose(x, y, angle + math.radians(degrees)))
            case Carry(to):
                found.append(to)
            case Wait():
                found.append(found[-1])
    return tuple(found)


def motion_json(motion: Motion) -> list[list[Any]]:
    """Return a motion as JSON types: ``[["slide", 0.0, 5.0], ["wait", 1.0]]``."""
    return [_segment_json(segment) for segment in motion]


def motion_from_json(value: Any) -> Motion:
    """Return the motion that `motion_json` wrote; ValueError for anything else."""
    made: list[Segment] = []
    for kind, *numbers in value:
        given = [float(number) for number in numbers]
        match kind, given:
            case "slide", [dx, dy]:
                made.append(Slide(dx, dy))
            case "turn", [degrees]:
                made.append(Turn(degrees))
            case "carry", [x, y, angle]:
                made.append(Carry(Pose(x, y, angle)))
            case "wait", [seconds]:
                made.append(Wait(seconds))
            case _:
                raise ValueError(f"no segment {kind!r} of {len(given)} numbers")
    return tuple(made)


def _segment_json(segment: Segment) -> list[Any]:
    """Return one segment as JSON types."""
    match segment:
        case Slide(dx, dy):
            return ["slide", dx, dy]
        case Turn(degrees):
            return ["turn", degrees]
        case Carry(to):
            return ["carry", *to]
        case Wait(seconds):
            return ["wait", seconds]
