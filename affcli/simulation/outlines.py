"""A polygon as a person draws it, cut into the convex parts that the engine takes."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pymunk import autogeometry

from affcli.core.geometry import ConvexPolygon, Point

LEAST_AREA = 0.01
"""A part smaller than this (in^2) is a slip of the pen."""
MOST_CORNERS = 500
"""Of one polygon; every edge is held against every other."""
ROUNDING = 1e-9
"""By how much parts may differ from the whole (of its area), and bend inwards (in^2)."""


def convex_parts(corners: Sequence[Point]) -> tuple[ConvexPolygon, ...]:
    """Return convex polygons, counter-clockwise, which together are a simple polygon.

    Args:
        corners: in order, either way round; the first may stand at the end again (in).

    Raises:
        ValueError: it has too few or too many corners, no area, crosses itself, or cannot be cut.
    """
    corners = [*corners[:-1]] if len(corners) > 1 and corners[0] == corners[-1] else [*corners]
    if not 3 <= len(corners) <= MOST_CORNERS:
        raise ValueError(f"{len(corners)} corners: give 3 to {MOST_CORNERS}")
    if len(set(corners)) < len(corners):
        raise ValueError("two corners at one place: leave one out")
    whole = ConvexPolygon(tuple(corners))
    if whole.area < 0.0:
        whole = ConvexPolygon(whole.vertices[::-1])
    crossing = _first_crossing(whole) if len(corners) > 3 else None
    if crossing:
        a, b = crossing
        raise ValueError(f"its edges {a} and {b} cross or touch: draw an outline without crossing")
    if whole.area < LEAST_AREA:
        raise ValueError(f"an area of {whole.area:.3g} square inches: give at least {LEAST_AREA}")
    if _is_convex(whole):
        return (whole,)
    closed = [*whole.vertices, whole.vertices[0]]
    cut = autogeometry.convex_decomposition([(x, y) for x, y in closed], 0.0)
    parts = tuple(ConvexPolygon(tuple(Point(*corner) for corner in part[:-1])) for part in cut)
    difference = abs(sum(part.area for part in parts) - whole.area)
    if difference > ROUNDING * whole.area or not all(map(_is_convex, parts)):
        raise ValueError("it cannot be cut into convex parts: draw it in parts that are convex")
    return parts


def _is_convex(polygon: ConvexPolygon) -> bool:
    """Tell whether a simple polygon, counter-clockwise, bends inwards nowhere."""
    following = polygon.edges[1:] + polygon.edges[:1]
    return all(
        (b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x) >= -ROUNDING
        for (a, b), (c, d) in zip(polygon.edges, following, strict=True)
    )


def _first_crossing(polygon: ConvexPolygon) -> tuple[int, int] | None:
    """Return two edges, counted from 1, that meet though they are not neighbours."""
    starts, ends = (np.array(points) for points in zip(*polygon.edges, strict=True))
    count = len(starts)

    def sides(points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return on which side of each edge (rows) each point (columns) lies."""
        along, to = ends - starts, points[None] - starts[:, None]
        return np.asarray(np.sign(along[:, :1] * to[..., 1] - along[:, 1:] * to[..., 0]))

    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    near = np.all((low[:, None] <= high[None]) & (low[None] <= high[:, None]), axis=2)
    parted = sides(starts) * sides(ends) <= 0.0
    number = np.arange(count)
    apart = np.abs(number[:, None] - number[None])
    strangers = (apart > 1) & (apart < count - 1)
    # Where an edge runs back over the one before, the next after it touches that, too.
    met = np.argwhere(near & parted & parted.T & strangers)
    return (int(met[0][0]) + 1, int(met[0][1]) + 1) if len(met) else None
