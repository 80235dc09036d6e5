"""Upright prisms on the table, and which of them a camera sees in front of which."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.scene import Scene
from affcli.core.tool import Color
from affcli.core.workspace import Workspace
from affcli.perception.camera import Array, Camera
from affcli.perception.palette import WRIST_COLOR

SIDE_SHADE = 0.7
"""A side is this bright where the top is 1: the light comes from above."""
WRIST_MARKER_RADIUS = 0.75
"""Of the coloured disc on the flange (in). The paper only says that the wrist is colour-coded."""
CIRCLE_POINTS = 48
"""A circle is drawn with this many corners: less than 0.004 in off for the puck."""
ANGLES = 2.0 * np.pi * np.arange(CIRCLE_POINTS) / CIRCLE_POINTS
UNIT_CIRCLE = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])
LONGEST_EDGE = 1.0
"""Edges are cut into pieces of at most this (in), for the lens bends them."""


@dataclass(frozen=True, slots=True)
class Prism:
    """An upright prism over a convex outline.

    Args:
        outline: (n, 2), in, table frame.
        bottom, top: heights over the table (in); equal for a flat disc.
        color: of its top.
    """

    outline: Array
    bottom: float
    top: float
    color: Color


def circle(center: Point, radius: float) -> Array:
    """Return the corners of a circle (CIRCLE_POINTS, 2)."""
    corners: Array = np.array(center) + radius * UNIT_CIRCLE
    return corners


def along_edges(polygon: ConvexPolygon) -> Array:
    """Return points along a polygon's edges (n, 2), at most `LONGEST_EDGE` apart."""
    counts = [max(1, math.ceil(math.dist(a, b) / LONGEST_EDGE)) for a, b in polygon.edges]
    ends = np.array(polygon.edges).repeat(counts, axis=0)
    share = _shares(*counts)
    points: Array = (1.0 - share) * ends[:, 0] + share * ends[:, 1]
    return points


@lru_cache(maxsize=256)
def _shares(*counts: int) -> Array:
    """Return for edges in as many pieces how far along its edge each piece begins (n, 1)."""
    return np.concatenate([np.arange(count) / count for count in counts])[:, None]


def layers_of(scene: Scene, workspace: Workspace, camera: Camera) -> list[list[Prism]]:
    """Return what stands on the table in layers, what the camera sees behind first.

    The puck comes after the parts of the tool that lie behind it and before those in front. Within
    a layer all sides come before all tops: parts of one height hide no top of each other.
    """
    puck_center, radius = scene.attractor.point, workspace.puck.radius
    puck = Prism(circle(puck_center, radius), 0.0, workspace.puck.height, scene.attractor_color)
    behind: list[Prism] = []
    before: list[Prism] = []
    for outline in scene.tool.outlines:
        part = outline.placed(scene.wrist)
        prism = Prism(
            along_edges(part), scene.lift, scene.lift + workspace.tools.thickness, scene.tool.color
        )
        lifted_over = scene.lift >= workspace.puck.height
        in_front = lifted_over or _in_front(part, puck_center, camera)
        (before if in_front else behind).append(prism)
    flange = workspace.arm.flange_height + scene.lift
    marker = Prism(circle(scene.wrist.point, WRIST_MARKER_RADIUS), flange, flange, WRIST_COLOR)
    return [behind, [puck], before, [marker]]


def _in_front(part: ConvexPolygon, puck: Point, camera: Camera) -> bool:
    """Tell whether the camera sees a part in front of the puck: a line between them shows it."""
    nearest = _nearest_point(part, puck)
    away = (puck.x - nearest.x, puck.y - nearest.y)
    x, y, _ = camera.position
    return (x - nearest.x) * away[0] + (y - nearest.y) * away[1] < 0.0


def _nearest_point(polygon: ConvexPolygon, point: Point) -> Point:
    """Return the point of a polygon's edge that is nearest to `point`."""
    found = []
    for a, b in polygon.edges:
        ex, ey = b.x - a.x, b.y - a.y
        along = ((point.x - a.x) * ex + (point.y - a.y) * ey) / (ex * ex + ey * ey)
        along = min(1.0, max(0.0, along))
        found.append(Point(a.x + along * ex, a.y + along * ey))
    return min(found, key=lambda p: math.dist(p, point))


def shaded(color: Sequence[float], light: float) -> tuple[float, float, float]:
    """Return a colour in this light, as OpenCV orders it: blue, green, red."""
    red, green, blue = (light * component for component in color)
    return blue, green, red
