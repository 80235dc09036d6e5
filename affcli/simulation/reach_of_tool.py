"""Can any behavior, from any wrist position, touch an attractor that lies there?

A tool held at wrist w touches a disc of radius R at p when p - w lies within R of the tool, that
is when w lies in the tool turned about and grown by R, put at p. A behavior slides the wrist
through its reach, so the attractor is out of reach when no such w lies in the reach.
"""

import math
from functools import lru_cache

from affcli.core.geometry import ConvexPolygon, Point
from affcli.simulation.arm import Reach

CORNER_VERTICES = 16
"""A corner grown by R is drawn with this many vertices a full turn, outside the true arc: too large
by at most R (1 / cos(pi / 16) - 1), 0.03 in for the puck."""


def touchable(
    outlines: tuple[ConvexPolygon, ...], reach: Reach, attractor: Point, radius: float
) -> bool:
    """Tell whether some wrist position within the reach makes the tool touch the attractor.

    Args:
        outlines: convex parts of the tool in the tool frame (in).
        reach: where the wrist can be with the tool on the table; at most half a ring.
        attractor: centre of the puck (in, table frame).
        radius: of the puck (in).
    """
    # Nearly always some point of the tool can be brought to the attractor's centre: the quick yes.
    x, y = attractor
    for p in _points(outlines):
        if reach.holds(Point(x - p.x, y - p.y)):
            return True
    return any(_part_touches(part, reach, attractor, radius) for part in outlines)


@lru_cache(maxsize=64)
def _points(outlines: tuple[ConvexPolygon, ...]) -> tuple[Point, ...]:
    """Return points on the tool's outline (in): the middles of the edges first, corners last."""
    shares = (0.5, 0.25, 0.75, 0.0)
    return tuple(
        Point(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y))
        for t in shares
        for part in outlines
        for a, b in part.edges
    )


def _part_touches(part: ConvexPolygon, reach: Reach, attractor: Point, radius: float) -> bool:
    """Tell whether one convex part can touch: whether a convex region of wrists meets the ring.

    A convex region is connected, so it meets the ring if it has a point as near as the outer edge
    and a point as far as the inner edge.
    """
    grown = _grown_box(part, attractor, radius)
    low, high = reach.waist_min, reach.waist_max
    grown = _clip(grown, -math.cos(low), -math.sin(low))
    grown = _clip(grown, math.cos(high), math.sin(high))
    if len(grown) < 3:
        return False
    wrists = ConvexPolygon(tuple(grown))
    nearest = wrists.distance(Point(0.0, 0.0))
    farthest = max(math.hypot(x, y) for x, y in grown)
    return nearest <= reach.outer and farthest >= reach.inner


def _grown_box(part: ConvexPolygon, attractor: Point, radius: float) -> list[Point]:
    """Return the hull of circles of `radius` about the vertices of the part turned about."""
    outer = radius / math.cos(math.pi / CORNER_VERTICES)
    points = [
        Point(
            attractor.x - v.x + outer * math.cos(2.0 * math.pi * (k + 0.5) / CORNER_VERTICES),
            attractor.y - v.y + outer * math.sin(2.0 * math.pi * (k + 0.5) / CORNER_VERTICES),
        )
        for v in part.vertices
        for k in range(CORNER_VERTICES)
    ]
    return _convex_hull(points)


def _convex_hull(points: list[Point]) -> list[Point]:
    """Return the convex hull, counter-clockwise (Andrew's monotone chain)."""
    points = sorted(set(points))

    def chain(ordered: list[Point]) -> list[Point]:
        hull: list[Point] = []
        for p in ordered:
            while len(hull) > 1 and _turn(hull[-2], hull[-1], p) <= 0.0:
                hull.pop()
            hull.append(p)
        return hull[:-1]

    return chain(points) + chain(points[::-1])


def _turn(a: Point, b: Point, c: Point) -> float:
    """Return twice the signed area of the triangle a, b, c."""
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)


def _clip(polygon: list[Point], nx: float, ny: float) -> list[Point]:
    """Keep what lies on the side of a line through the shoulder that (nx, ny) points to
    (Sutherland-Hodgman).

    Exact for a waist's range of up to 180 degrees in all, where the sector is convex.
    """
    kept: list[Point] = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        da, db = a.x * nx + a.y * ny, b.x * nx + b.y * ny
        if da >= 0.0:
            kept.append(a)
        if (da >= 0.0) != (db >= 0.0):
            t = da / (da - db)
            kept.append(Point(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)))
    return kept
