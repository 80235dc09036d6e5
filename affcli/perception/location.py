"""Where on the table a segmented picture shows the puck, the wrist and the goal (§4).

A pixel alone gives a line of sight; the height of what it shows makes it a place. The outline of
an upright cylinder is symmetric about the middle of its height, so the puck's centroid is taken
back to half its height; on the plane of the table, Z = 0, or of the puck's top, Z = 1 in, it would
be off by a quarter of an inch. The wrist's disc lies at the height of the flange, the goal on the
table.
"""

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from affcli.core.geometry import Point
from affcli.core.tool import Color
from affcli.core.workspace import PuckGeometry
from affcli.errors import NotSeenError
from affcli.perception.camera import Array, Camera
from affcli.perception.palette import ColorClass, Role
from affcli.perception.segmentation import ALIKE, NO_CLASS, Blob, Segmentation
from affcli.perception.solids import circle

COMPLETIONS = 4
"""How often the hidden part of the puck is filled in again from where it now seems to be."""
HIDDEN = 3
"""Pixels; fewer of another colour inside the puck's outline hide nothing."""
PAD = 3
"""Pixels around the puck's outline in which it is looked for."""
BEYOND, BEYOND_POINTS = 0.2, 24
"""How far beyond an edge of the goal (in), and at how many places, it is looked what covers it."""
LEAST_MISSING = 0.25
"""A goal shorter than it is wide by less than this (in, three pixels) is not covered at an edge."""


class Locator:
    """Takes blobs back to the table.

    Args:
        camera: as calibrated.
        puck: its size.
    """

    def __init__(self, camera: Camera, puck: PuckGeometry) -> None:
        self._camera = camera
        self._puck = puck

    def puck(self, seen: Segmentation) -> tuple[Point, Color]:
        """Return where the puck's centre stands over the table (in), and its colour as seen.

        Where tool or wrist hide part of the puck, its outline tells which pixels are missing.

        Raises:
            NotSeenError: there is none, or two.
        """
        position, blob = the_one(seen, Role.OBJECT)
        place = self._middle(blob.x, blob.y)
        over = [k for k, one in enumerate(seen.classes) if one.role in (Role.TOOL, Role.WRIST)]
        hiding = np.zeros(256, np.uint8)
        hiding[over] = 255
        for _ in range(COMPLETIONS):
            outline = self._outline(place)
            x, y, hidden = _completed_centroid(seen.labels, position, hiding, outline, blob)
            middle = _centroid_of_polygon(outline)
            place += self._middle(x, y) - self._middle(*middle)
            if hidden <= HIDDEN:
                break
        return Point(*place.tolist()), seen.color(position, blob)

    def wrist(self, seen: Segmentation) -> Point:
        """Return where the wrist is (in, table frame).

        Raises:
            NotSeenError: there is none, or two.
        """
        position, blob = the_one(seen, Role.WRIST)
        return place_of(blob, seen.classes[position], self._camera)

    def goal(self, seen: Segmentation) -> tuple[Point, float]:
        """Return the centre of the goal region, a square along the table's axes, and half its side.

        Tool and puck may hide some of it, in the middle or up to an edge. Of the two edges across
        the direction in which the square seems too short, that one is hidden beyond which most is
        covered.

        Raises:
            NotSeenError: no goal in view.
        """
        position = next(k for k, one in enumerate(seen.classes) if one.role is Role.GOAL)
        blobs = seen.blobs[position]
        if not blobs:
            raise NotSeenError("the camera sees no goal; bring it into view, uncovered")
        corners = np.concatenate([_hull_of(seen, position, blob) for blob in blobs])
        on_table = self._camera.back_project(corners)
        low, high = on_table.min(axis=0), on_table.max(axis=0)
        side = float((high - low).max())
        for axis in (0, 1):
            missing = side - float(high[axis] - low[axis])
            near, far = (self._covered(seen, low, high, axis, end) for end in (-1, 1))
            share = 0.5 if missing < LEAST_MISSING or near == far else float(far > near)
            high[axis] += share * missing
            low[axis] -= (1.0 - share) * missing
        return Point(*(0.5 * (low + high)).tolist()), 0.5 * side

    def _covered(self, seen: Segmentation, low: Array, high: Array, axis: int, end: int) -> int:
        """Return how many of some places just beyond one edge of a box show a colour.

        Args:
            seen: the picture.
            low, high: corners of the box (2,), in, table frame.
            axis: 0 for the left and right edge, 1 for the near and the far one.
            end: -1 for the left or near edge, 1 for the other.
        """
        along = np.linspace(low[1 - axis], high[1 - axis], BEYOND_POINTS)
        edge = high[axis] if end > 0 else low[axis]
        across = np.full(BEYOND_POINTS, edge + end * BEYOND)
        points = np.column_stack([across, along] if axis == 0 else [along, across])
        pixels = self._camera.project(np.column_stack([points, np.zeros(len(points))]))
        height, width = seen.labels.shape
        x, y = np.rint(np.clip(pixels, 0, (width - 1, height - 1))).astype(int).T
        return int(np.count_nonzero(seen.labels[y, x] != NO_CLASS))

    def tool_color(self, seen: Segmentation) -> Color:
        """Return the colour of the tool as seen: that of the tool colour with the most pixels.

        Raises:
            NotSeenError: no tool in view.
        """
        tools = [
            (blobs[0].area, k)
            for k, (one, blobs) in enumerate(zip(seen.classes, seen.blobs, strict=True))
            if one.role is Role.TOOL and blobs
        ]
        if not tools:
            raise NotSeenError("the camera sees no tool; bring one into its view")
        _, k = max(tools)
        return seen.color(k, seen.blobs[k][0])

    def _middle(self, x: float, y: float) -> Array:
        """Return where the line of sight of a pixel is at half the puck's height (2,), in."""
        pixel = np.array([[x, y]])
        place: Array = self._camera.back_project(pixel, 0.5 * self._puck.height)[0]
        return place

    def _outline(self, place: Array) -> Array:
        """Return the outline (n, 2), px, that a whole puck at `place` would show."""
        rim = circle(Point(*place.tolist()), self._puck.radius)
        heights = np.repeat([0.0, self._puck.height], len(rim))
        pixels = self._camera.project(np.column_stack([np.concatenate([rim, rim]), heights]))
        hull: Array = cv2.convexHull(pixels.astype(np.float32))[:, 0].astype(np.float64)
        return hull


def place_of(blob: Blob, one: ColorClass, camera: Camera) -> Point:
    """Return where on the table the centroid of a blob lies (in), at the height of its class."""
    return Point(*camera.back_project(np.array([[blob.x, blob.y]]), one.height)[0].tolist())


@dataclass(frozen=True, slots=True)
class Place:
    """One blob of a colour class, taken back to the table.

    Args:
        name: of its class.
        point: where it is (in, table frame); NaN when its line of sight misses the table.
        blob: in the camera's picture, but for its box.
        color: as seen.
    """

    name: str
    point: Point
    blob: Blob
    color: Color


def places_of(seen: Segmentation, camera: Camera, side: int = 1) -> dict[str, list[Place]]:
    """Return for each class, by name, where its blobs are, largest first.

    A second blob counts when it is of like size. A class that is not seen has none.

    Args:
        seen: the segmented picture.
        camera: that took it.
        side: how many pixels of the camera's make one of the picture's, in each direction.
    """
    found: dict[str, list[Place]] = {}
    for k, (one, blobs) in enumerate(zip(seen.classes, seen.blobs, strict=True)):
        found[one.name] = []
        for blob in blobs:
            if blob.area >= ALIKE * blobs[0].area:
                x, y = ((v + 0.5) * side - 0.5 for v in (blob.x, blob.y))
                whole = replace(blob, x=x, y=y, area=blob.area * side**2)
                point = place_of(whole, one, camera)
                found[one.name].append(Place(one.name, point, whole, seen.color(k, blob)))
    return found


def the_one(seen: Segmentation, role: Role) -> tuple[int, Blob]:
    """Return the only class of a role and its only blob.

    Raises:
        NotSeenError: there is none, or a second one of like size.
    """
    position = next(k for k, one in enumerate(seen.classes) if one.role is role)
    return position, only_blob(seen.classes[position], seen.blobs[position])


def only_blob(one: ColorClass, blobs: tuple[Blob, ...]) -> Blob:
    """Return the blob of a class when there is just one of its size.

    Raises:
        NotSeenError: there is none, or a second one of like size.
    """
    if not blobs:
        raise NotSeenError(f"the camera sees no {one.name}; bring it into view, uncovered")
    if len(blobs) > 1 and blobs[1].area >= ALIKE * blobs[0].area:
        places = " and ".join(f"({b.x:.0f}, {b.y:.0f})" for b in blobs[:2])
        raise NotSeenError(
            f"the camera sees {one.name} twice, at {places} px; leave one, or uncover it whole"
        )
    return blobs[0]


def _completed_centroid(
    labels: NDArray[np.uint8],
    position: int,
    hiding: NDArray[np.uint8],
    outline: Array,
    blob: Blob,
) -> tuple[float, float, int]:
    """Return the centroid (px) of a class's pixels and of those that hide it inside an outline.

    Args:
        labels: of all pixels.
        position: the class.
        hiding: (256,), 255 for the classes that may hide it, 0 for the others.
        outline: where it is thought to be (n, 2), px.
        blob: its pixels that are seen.

    Returns:
        x, y, and how many pixels hide it.
    """
    height, width = labels.shape
    x, y = (math.floor(low) - PAD for low in outline.min(axis=0).tolist())
    left, top = max(0, min(x, blob.left)), max(0, min(y, blob.top))
    x, y = (math.ceil(high) + PAD + 1 for high in outline.max(axis=0).tolist())
    right = min(width, max(x, blob.left + blob.width))
    bottom = min(height, max(y, blob.top + blob.height))
    region = labels[top:bottom, left:right]
    inside = np.zeros(region.shape, np.uint8)
    cv2.fillConvexPoly(inside, np.rint(outline - (left, top)).astype(np.int32), 255)
    hidden = cv2.bitwise_and(cv2.LUT(region, hiding), inside)
    whole = cv2.bitwise_or(hidden, cv2.inRange(region, (position,), (position,)))
    moments = cv2.moments(whole, binaryImage=True)
    return (
        moments["m10"] / moments["m00"] + left,
        moments["m01"] / moments["m00"] + top,
        cv2.countNonZero(hidden),
    )


def _centroid_of_polygon(corners: Array) -> tuple[float, float]:
    """Return the centroid of a polygon (n, 2)."""
    x, y = corners.T
    next_x, next_y = np.concatenate([corners[1:], corners[:1]]).T
    cross = x * next_y - next_x * y
    area = 3.0 * float(cross.sum())
    return (
        float(((x + next_x) * cross).sum()) / area,
        float(((y + next_y) * cross).sum()) / area,
    )


def _hull_of(seen: Segmentation, position: int, blob: Blob) -> Array:
    """Return the pixels (n, 2) at the corners of a blob of a class."""
    hull = cv2.convexHull(cv2.findNonZero(seen.mask(position, blob)))[:, 0]
    corners: Array = hull.astype(np.float64) + np.array([blob.left, blob.top])
    return corners
