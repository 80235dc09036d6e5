"""When does a tool first touch the puck? Without an engine: of a tool that moves straight in closed
form, of one that turns by going only as far as it surely does not touch.
"""

import math
from collections.abc import Sequence

from affcli.core.geometry import ConvexPolygon, Point

TOUCHING = 1e-9
"""A gap of no more than this (in) is rounding: the disc touches already."""
CLOSE = 0.005
"""A tool that turns past the disc with no more than this gap (in) may as well touch it."""


def travel_to_contact(
    parts: Sequence[ConvexPolygon], direction: Point, length: float, center: Point, radius: float
) -> float | None:
    """Return how far the parts travel before they touch a disc at rest.

    Args:
        parts: convex parts of the tool (in, tool frame).
        direction: unit vector of the motion.
        length: of the motion (in).
        center: of the disc as seen from where the tool is when the motion starts (in).
        radius: of the disc (in).

    Returns:
        The distance (in), 0 when they touch already, None when they never do.
    """
    nearest: float | None = None
    for part in parts:
        if _swept_box_misses(part, direction, length, center, radius):
            continue
        travel = _part_travel(part, direction, center, radius)
        if travel is not None and travel <= length and (nearest is None or travel < nearest):
            nearest = travel
    return nearest


def arc_to_contact(
    parts: Sequence[ConvexPolygon], lever: float, length: float, center: Point, radius: float
) -> float | None:
    """Return how far the parts surely turn before they touch a disc at rest.

    Seen from the tool the disc goes around the wrist, and its centre comes no nearer to a part than
    it travels: so it can go on by the gap, again and again (conservative advancement).

    Args:
        parts: convex parts of the tool where the turn begins, about the wrist (in).
        lever: at which the arc is told; below 0 the tool turns clockwise (in).
        length: of the arc (in).
        center: of the disc as seen from the wrist (in, the axes of the parts).
        radius: of the disc (in).

    Returns:
        An arc at whose end the gap is at most `CLOSE` (in); None when they never come so near.
    """
    distance, scale, arc = math.hypot(*center), abs(lever), 0.0
    while True:
        cos, sin = math.cos(arc / lever), math.sin(arc / lever)
        seen = Point(cos * center.x + sin * center.y, cos * center.y - sin * center.x)
        gap = min(part.distance(seen) for part in parts) - radius
        if gap <= CLOSE:
            return arc
        if gap * scale > distance * (length - arc):
            return None
        arc += gap * scale / distance


def _swept_box_misses(
    part: ConvexPolygon, direction: Point, length: float, center: Point, radius: float
) -> bool:
    """Tell whether the bounding box of the swept part, grown by `radius`, leaves `center` out."""
    dx, dy = direction.x * length, direction.y * length
    left, bottom, right, top = part.bounds
    return (
        center.x < left + min(dx, 0.0) - radius
        or center.x > right + max(dx, 0.0) + radius
        or center.y < bottom + min(dy, 0.0) - radius
        or center.y > top + max(dy, 0.0) + radius
    )


def _part_travel(
    part: ConvexPolygon, direction: Point, center: Point, radius: float
) -> float | None:
    """Return when the outline of the part, grown by `radius`, first passes over `center` (in)."""
    if part.distance(center) <= radius + TOUCHING:
        return 0.0
    found: list[float] = []
    for a, b in part.edges:
        found += _edge_travel(a, b, direction, center, radius)
        found += _corner_travel(a, direction, center, radius)
    return min(found, default=None)


def _edge_travel(a: Point, b: Point, direction: Point, center: Point, radius: float) -> list[float]:
    """Return the travel at which the edge, moved out by `radius`, meets the centre, if it does."""
    ex, ey = b.x - a.x, b.y - a.y
    length = math.hypot(ex, ey)
    nx, ny = ey / length, -ex / length
    closing = direction.x * nx + direction.y * ny
    if closing <= 0.0:
        return []
    px, py = center.x - a.x, center.y - a.y
    travel = (px * nx + py * ny - radius) / closing
    if travel < 0.0:
        return []
    along = ((px - travel * direction.x) * ex + (py - travel * direction.y) * ey) / length
    return [travel] if 0.0 <= along <= length else []


def _corner_travel(corner: Point, direction: Point, center: Point, radius: float) -> list[float]:
    """Return the travel at which the corner comes within `radius` of the centre, if it does."""
    px, py = center.x - corner.x, center.y - corner.y
    along = px * direction.x + py * direction.y
    discriminant = along**2 - (px**2 + py**2 - radius**2)
    if discriminant < 0.0:
        return []
    travel = along - math.sqrt(discriminant)
    return [travel] if travel >= 0.0 else []
