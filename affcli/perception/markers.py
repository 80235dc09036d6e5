"""Finding the markers of the calibration pattern in a picture and ordering them into its grid (§4).

The paper's pattern: 6 by 6 markers of one colour, 5 in apart, on a cardboard.
"""

import colorsys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import cv2
import numpy as np

from affcli.core.geometry import Point
from affcli.core.tool import Color
from affcli.errors import BadInputError
from affcli.perception.camera import Array
from affcli.perception.grid_search import grid_among
from affcli.perception.palette import (
    CLOSEST_HUES,
    ColorClass,
    Role,
    hue_distance,
    palette,
)
from affcli.perception.rendering import Picture
from affcli.perception.segmentation import Blob, Segmenter, blobs_of, colored_pixels

SMALLEST_MARKER = 8
"""Pixels; a smaller blob is noise."""
LEAP = 3.0
"""Sorted by size, a marker has at most this many times the area of the next: perspective makes the
nearest of them six times as large as the farthest, but in small steps."""
RARE = 0.001
"""A hue that holds less than this share of the pixels of the most frequent one is noise."""
HUES = 6
"""How many of the most frequent hues are tried when the colour of the markers is not given."""
OFF_GRID = 0.35
"""No marker may lie farther than this from its place in the grid (in spacings): the lens may bend
the grid by a tenth of that, and beyond a half the order would be a guess."""
MOST_CORNERS = 24
"""Of a hull; a pattern of 6x6 has 20 at the most."""
MOST_THINGS = 4
"""Times as many things as there are markers, among which a grid is looked for."""
OVER_EXPOSED = 0.5
"""Share of white pixels above which a picture is called over-exposed."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """A rectangular grid of markers on the plane of the table.

    Args:
        columns, rows: markers along x and along y.
        spacing: between neighbours (in).
        origin: the first marker (in, table frame).
        turn: how the pattern lies in the picture, 0, 90, 180 or 270 degrees counter-clockwise.
            Equal markers leave that open. Convention: with 0 the first marker is the lower left one
            in the picture and x runs along the picture's lower edge to the right; with 180 the
            camera looks from the other side.
    """

    columns: int = 6
    rows: int = 6
    spacing: float = 5.0
    origin: Point = Point(0.0, 0.0)
    turn: int = 0

    @property
    def places(self) -> Array:
        """Where the markers are (rows * columns, 2), in, table frame: row by row, x first."""
        y, x = np.mgrid[0 : self.rows, 0 : self.columns]
        grid = np.column_stack([x.ravel(), y.ravel()]) * self.spacing
        places: Array = grid + np.array(self.origin)
        return places


def find_markers(picture: Picture, pattern: Pattern, color: Color | None = None) -> Array:
    """Return the centroids of the pattern's markers in the order of `Pattern.places`.

    Other things of their colour may lie about: the grid is found among them.

    Args:
        picture: blue green red.
        pattern: what to look for.
        color: of the markers; None to take the colour that most blobs of like size share.

    Returns:
        (rows * columns, 2), px.

    Raises:
        BadInputError: too few markers, or no grid of them.
    """
    wanted = pattern.rows * pattern.columns
    groups = [_like_sized(blobs, wanted) for blobs in _blobs_by_hue(picture, color)]
    groups.sort(key=lambda group: (abs(len(group) - wanted), -len(group)))
    if not groups or len(groups[0]) < 3:
        white = float((picture.min(axis=2) >= 250).mean())
        why = (
            f"{white:.0%} of the picture is white, it is over-exposed"
            if white > OVER_EXPOSED
            else "paint them in one strong colour, or name it with --marker-color"
        )
        raise BadInputError(f"no markers found: {why}")
    height, width = picture.shape[:2]
    for group in groups:
        # A pattern that is whole in view does not touch the edge.
        whole = np.array([(b.x, b.y) for b in group if not _at_edge(b, width, height)])
        if len(whole) == wanted and group is groups[0]:
            return ordered(whole, pattern)
        if wanted <= len(whole) <= MOST_THINGS * wanted:
            grid = grid_among(whole, pattern.columns, pattern.rows)
            if grid is not None:
                return ordered(grid, pattern)
    raise _no_grid(groups[0], pattern, (width, height))


def _no_grid(blobs: Sequence[Blob], pattern: Pattern, size: tuple[int, int]) -> BadInputError:
    """Return what is wrong with blobs that hold no grid of the pattern."""
    wanted = pattern.rows * pattern.columns
    cut = [blob for blob in blobs if _at_edge(blob, *size)]
    found = len(blobs) - len(cut)
    if found > wanted:
        return BadInputError(
            f"{found} things of one colour found, and no grid of {pattern.columns}x{pattern.rows} "
            "among them; uncover all markers and nothing else of their colour, or name it with "
            "--marker-color"
        )
    if cut:
        return BadInputError(
            f"{found} markers found instead of {wanted}, and something of their colour at "
            f"({cut[0].x:.0f}, {cut[0].y:.0f}) px is cut off by the edge of the picture; bring the "
            "whole pattern into view"
        )
    return BadInputError(
        f"{found} markers found instead of {wanted}; uncover all of them and nothing else of their "
        "colour, or name it with --marker-color"
    )


def ordered(points: Array, pattern: Pattern) -> Array:
    """Return the markers (n, 2), px, in the order of `Pattern.places`, from any view of them.

    The four corners of the grid are the four points that span the largest area. They give the
    perspective, and each point its place.

    Raises:
        BadInputError: the points form no such grid.
    """
    corners = _counter_clockwise(_widest_four(points))
    right = np.radians(pattern.turn)
    direction = np.array([np.cos(right), -np.sin(right)])
    best: tuple[float, Array] | None = None
    for shift in range(4):
        found = _assigned(points, np.roll(corners, -shift, axis=0), pattern)
        if found is None:
            continue
        grid = found.reshape(pattern.rows, pattern.columns, 2)
        along_x = (grid[:, -1] - grid[:, 0]).mean(axis=0)
        fit = float(along_x @ direction / np.hypot(*along_x))
        if best is None or fit > best[0]:
            best = fit, found
    if best is None:
        raise BadInputError(
            f"the {len(points)} markers found form no grid of {pattern.columns}x{pattern.rows}; "
            "give --markers as they are, and uncover the whole pattern"
        )
    return best[1]


def _frequent_hues(picture: Picture) -> list[float]:
    """Return the most frequent hues among coloured pixels, degrees."""
    hsv = np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2HSV_FULL), np.uint8)
    hues = hsv[:, :, 0][colored_pixels(hsv) > 0]
    counts = np.bincount(hues, minlength=256).astype(float)
    kernel = np.ones(9)
    smooth = np.convolve(np.concatenate([counts[-4:], counts, counts[:4]]), kernel, "valid")
    peaks: list[int] = []
    for hue in np.argsort(-smooth, kind="stable").tolist():
        distances = [abs((hue - peak + 128) % 256 - 128) for peak in peaks]
        if smooth[hue] < RARE * smooth.max() or len(peaks) == HUES:
            break
        if min(distances, default=256) > 17:
            peaks.append(hue)
    return [360.0 * hue / 256.0 for hue in peaks]


def _hue(color: Color) -> float:
    """Return the hue of a colour, degrees; BadInputError when it is too grey or dark for one."""
    (checked,) = palette([ColorClass("the colour", color, Role.OBJECT)], "--marker-color")
    return checked.hue


def _blobs_by_hue(picture: Picture, color: Color | None) -> list[tuple[Blob, ...]]:
    """Return the blobs of each frequent hue; of the hue of `color` alone when it is given.

    The other hues take the pixels that are nearer to them: a wooden table is no red marker.
    """
    hues = _frequent_hues(picture)
    if color is not None:
        own = _hue(color)
        hues = [own, *(hue for hue in hues if hue_distance(hue, own) >= CLOSEST_HUES)]
    classes = [ColorClass("", _pure(hue), Role.OBJECT) for hue in hues]
    labels = Segmenter(classes).segment(picture).labels
    height, width = labels.shape
    looked_for = range(len(hues) if color is None else 1)
    return [blobs_of(labels, k, (0, 0, width, height), SMALLEST_MARKER) for k in looked_for]


def _pure(hue: float) -> Color:
    """Return the most saturated colour of a hue."""
    return Color(255.0 * c for c in colorsys.hsv_to_rgb(hue / 360.0, 1.0, 1.0))


def _like_sized(blobs: Sequence[Blob], wanted: int) -> list[Blob]:
    """Return those blobs, largest first, that form a group by size, of nearly `wanted` blobs."""
    groups: list[list[Blob]] = []
    for blob in blobs:
        if groups and groups[-1][-1].area <= LEAP * blob.area:
            groups[-1].append(blob)
        else:
            groups.append([blob])
    return min(groups, key=lambda group: abs(len(group) - wanted), default=[])


def _at_edge(blob: Blob, width: int, height: int) -> bool:
    """Tell whether a blob touches the edge of the picture."""
    return (
        blob.left == 0
        or blob.top == 0
        or blob.left + blob.width == width
        or blob.top + blob.height == height
    )


def _widest_four(points: Array) -> Array:
    """Return the four points (4, 2) that span the largest quadrilateral, in order around it."""
    hull = cv2.convexHull(points.astype(np.float32))[:, 0].astype(np.float64)
    if len(hull) < 4:
        raise BadInputError("the markers found lie on a line; bring the whole pattern into view")
    # The corners of the grid are where the hull turns most; dozens of others would take for ever.
    coarse = 0.005 * cv2.arcLength(hull.astype(np.float32), closed=True)
    while len(hull) > MOST_CORNERS:
        kept = cv2.approxPolyDP(hull.astype(np.float32), coarse, closed=True)
        hull, coarse = kept[:, 0].astype(np.float64), 1.5 * coarse
    fours = hull[np.array(list(combinations(range(len(hull)), 4)))]
    first, second = fours[:, 2] - fours[:, 0], fours[:, 3] - fours[:, 1]
    areas = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    widest: Array = fours[int(np.argmax(areas))]
    return widest


def _counter_clockwise(corners: Array) -> Array:
    """Return corners (4, 2) in counter-clockwise order as one sees them in the picture."""
    x, y = corners.T
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    # y points down in the picture.
    return corners if area < 0.0 else corners[::-1]


def _assigned(points: Array, corners: Array, pattern: Pattern) -> Array | None:
    """Return the points in the grid's order, given its corners; None when they do not fit it."""
    last = np.array([pattern.columns - 1, pattern.rows - 1])
    goal = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * last
    perspective = cv2.getPerspectiveTransform(corners.astype(np.float32), goal.astype(np.float32))
    homogeneous = np.column_stack([points, np.ones(len(points))]) @ perspective.T
    grid = homogeneous[:, :2] / homogeneous[:, 2:]
    nearest = np.rint(grid)
    if not (np.isfinite(grid).all() and np.abs(grid - nearest).max() <= OFF_GRID):
        return None
    places = (nearest[:, 1] * pattern.columns + nearest[:, 0]).astype(int)
    inside = (nearest >= 0).all() and (nearest <= last).all()
    if not inside or len(set(places.tolist())) != len(points):
        return None
    return points[np.argsort(places)]
