"""The picture that the camera takes of a scene: perspective, lens, light, blur and noise (§4).

Pictures are OpenCV's: (height, width, 3), 8 bits, blue green red.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import accumulate, islice, pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from affcli.core.geometry import ConvexPolygon
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.workspace import Workspace
from affcli.perception.camera import Array
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.palette import GOAL_COLOR, LEAST_SATURATION
from affcli.perception.regions import Region, surrounding, within
from affcli.perception.solids import SIDE_SHADE, Prism, along_edges, layers_of, shaded

Picture = NDArray[np.uint8]

FINE = 4
"""Shapes are drawn this many times finer than the picture, so their edges are anti-aliased."""
FARTHEST = 2.0**20
"""Pixels of the fine picture beyond which nothing is drawn: OpenCV's numbers end at 2**25."""
FRACTION_BITS = 6
"""Corners are drawn to 1/64 of such a fine pixel."""
MARGIN = 4
"""Pixels around what is drawn anew, for the blur."""
SHEET_MARGIN = 64
"""The sheet of noise is larger than a picture by this."""

FLOOR = (96.0, 94.0, 92.0)
TABLE = (206.0, 197.0, 182.0)
"""Of the table top (red, green, blue): bare wood."""


@dataclass(frozen=True, slots=True)
class Detail:
    """The part of a picture outside of which no pixel has a colour.

    Args:
        picture: the part.
        left, top: its corner in the whole picture (px).
        width, height: of the whole picture (px).
    """

    picture: Picture
    left: int
    top: int
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class Table:
    """The table without tool and puck.

    Args:
        plain: in even light, with a fourth component that means nothing: OpenCV makes four finer
            and coarser in half the time that it takes for three.
        lit: as lit, and blurred.
        colored: the region of `lit` in which noise may make a pixel one that has a colour.
    """

    plain: Picture
    lit: Picture
    colored: Region | None


@dataclass(frozen=True, slots=True)
class _Shape:
    """What the camera sees of a prism.

    Args:
        prism: it.
        hull, top: corners of its outline in the picture, and of its top; see `_fixed`.
        box: the region around it.
    """

    prism: Prism
    hull: NDArray[np.int32]
    top: NDArray[np.int32]
    box: Region


class Renderer:
    """Takes pictures of scenes.

    Args:
        settings: the camera, the light and the noise.
        workspace: sizes of what stands on the table.
    """

    def __init__(self, settings: CameraSettings, workspace: Workspace) -> None:
        self._settings = settings
        self._workspace = workspace
        self._camera = settings.camera()
        self._light = _light(settings.uneven_light, *self._size)
        self._tables: dict[GoalRegion | None, Table] = {}

    def take(self, scene: Scene, rng: np.random.Generator) -> Picture:
        """Return the picture of a scene; `rng` decides the noise."""
        table = self._table(scene.goal)
        picture = _over(table.lit, self._things(scene, table.plain), self._whole)
        return self._noisy(picture, self._whole, rng)

    def take_detail(self, scene: Scene, rng: np.random.Generator) -> Detail:
        """Return of the same picture, with the same noise, only where colour may be.

        Mostly that is a tenth of it.
        """
        table = self._table(scene.goal)
        things = self._things(scene, table.plain)
        seen = [region for region in (things and things[0], table.colored) if region is not None]
        rows, columns = around = surrounding(seen) if seen else self._whole
        picture = self._noisy(_over(table.lit, things, around), around, rng)
        return Detail(picture, columns.start, rows.start, *self._size)

    def take_flat(
        self, shapes: Sequence[tuple[Array, tuple[float, ...]]], rng: np.random.Generator
    ) -> Picture:
        """Return the picture of flat shapes on the bare table.

        Args:
            shapes: each an outline (n, 2), in, table frame, and a colour (red, green, blue).
            rng: decides the noise.
        """
        picture = self._bare()
        for outline, color in shapes:
            _fill(picture, _fixed(self._seen(outline, 0.0)), shaded(color, 1.0))
        lit = self._lit(_coarse(picture), self._whole)
        return self._noisy(lit, self._whole, rng)

    @property
    def _size(self) -> tuple[int, int]:
        """Width and height of a picture (px)."""
        return self._camera.sensor.width_px, self._camera.sensor.height_px

    @property
    def _whole(self) -> Region:
        """The region that is the whole picture."""
        width, height = self._size
        return slice(0, height), slice(0, width)

    def _things(self, scene: Scene, plain: Picture) -> tuple[Region, Picture] | None:
        """Return the region with all that stands on the table, and its picture; None out of view.

        Args:
            scene: what stands where.
            plain: the table in even light.
        """
        layers = layers_of(scene, self._workspace, self._camera)
        corners, starts = self._corners([prism for layer in layers for prism in layer])
        seen = corners[np.isfinite(corners).all(axis=1)]
        region = self._region(*seen.min(axis=0), *seen.max(axis=0)) if len(seen) else None
        if region is None:
            return None
        corner = np.array([region[1].start, region[0].start])
        rough = corners.astype(np.float32)
        tops, hulls = _fixed(np.array([corners, rough]) - corner)
        shapes: list[list[_Shape]] = []
        ends = [f.reduceat(corners, starts[:-1]).tolist() for f in (np.minimum, np.maximum)]
        pieces = zip(pairwise(starts), *ends, strict=True)
        for layer in layers:
            shapes.append([])
            for prism, (rows, low, high) in zip(layer, islice(pieces, len(layer)), strict=True):
                box = self._region(*low, *high)
                if box is not None:
                    piece = slice(*rows)
                    hull = cv2.convexHull(rough[piece], returnPoints=False)[:, 0]
                    top = tops[piece][len(prism.outline) :]
                    box = within(region, box)
                    shapes[-1].append(_Shape(prism, hulls[piece][hull], top, box))
        return region, self._lit(self._drawn(shapes, plain[region]), region)

    def _drawn(self, layers: Sequence[Sequence[_Shape]], plain: Picture) -> Picture:
        """Draw layers of shapes over part of a picture and return it; see `solids.layers_of`."""
        picture = plain.copy()
        fine = self._fine_sheet(*picture.shape[:2])
        # Nothing but these boxes of it is made, or looked at.
        boxes = [shape.box for layer in layers for shape in layer]
        for box in boxes:
            _finer(picture[box], fine[_times(box)])
        for layer in layers:
            for shape in layer:
                if shape.prism.top > shape.prism.bottom:
                    _fill(fine, shape.hull, shaded(shape.prism.color, SIDE_SHADE))
            for shape in layer:
                _fill(fine, shape.top, shaded(shape.prism.color, 1.0))
        for box in boxes:
            picture[box] = _coarse(fine[_times(box)])
        return picture

    def _corners(self, prisms: Sequence[Prism]) -> tuple[Array, list[int]]:
        """Return the pixels of the outlines of prisms: of each the bottom, then the top.

        All at once, for that takes a third of the time of one after the other.

        Returns:
            (n, 2), px; at which rows the prisms begin, and n.
        """
        counts = [len(prism.outline) for prism in prisms for _ in range(2)]
        heights = [height for prism in prisms for height in (prism.bottom, prism.top)]
        outlines = np.concatenate([prism.outline for prism in prisms for _ in range(2)])
        corners = self._seen(outlines, np.repeat(heights, counts))
        return corners, [0, *accumulate(counts)][::2]

    def _fine_sheet(self, height: int, width: int) -> Picture:
        """Return a fine picture to be drawn upon, with anything on it; the next call takes it."""
        sheet = _sheet(*self._size)
        return sheet[: height * width * FINE**2].reshape(FINE * height, FINE * width, 4)

    def _seen(self, outline: Array, height: float | Array) -> Array:
        """Return the pixels (n, 2) of points (n, 2) at one height or at (n,) heights (in)."""
        return self._camera.project(
            np.column_stack([outline, np.broadcast_to(height, len(outline))])
        )

    def _region(self, left: float, top: float, right: float, bottom: float) -> Region | None:
        """Return the rows and columns around things that lie in the picture, None when none.

        None, too, when one of the ends (px) is NaN: it is behind the camera.
        """
        if math.isnan(left + top + right + bottom):
            return None
        width, height = self._size
        first, last = max(0, math.floor(left) - MARGIN), min(width, math.ceil(right) + MARGIN + 1)
        upper, lower = max(0, math.floor(top) - MARGIN), min(height, math.ceil(bottom) + MARGIN + 1)
        return (slice(upper, lower), slice(first, last)) if first < last and upper < lower else None

    def _table(self, goal: GoalRegion | None) -> Table:
        """Return the table without tool and puck; made once a goal."""
        if goal not in self._tables:
            picture = self._bare()
            if goal is not None:
                (x, y), half = goal.center, goal.half_width
                square = ConvexPolygon.box(x - half, y - half, x + half, y + half)
                corners = _fixed(self._seen(along_edges(square), 0.0))
                _fill(picture, corners, shaded(GOAL_COLOR, 1.0))
            plain = _coarse(picture)
            lit = self._lit(plain, self._whole)
            self._tables[goal] = Table(plain, lit, self._colored(lit))
        return self._tables[goal]

    def _colored(self, lit: Picture) -> Region | None:
        """Return the region of a picture in which noise may make a pixel one that has a colour."""
        more, less = (int(part.max()) for part in _noise(self._settings.grey_noise, *self._size))
        # What is added to one picture is taken from another.
        most = max(more, less)
        high = lit.max(axis=2).astype(float) + most
        low = np.maximum(lit.min(axis=2).astype(float) - most, 0.0)
        # OpenCV rounds the saturation, to 1 of 255.
        may = 1.0 - low / high >= LEAST_SATURATION - 1.0 / 255.0
        left, top, width, height = cv2.boundingRect(may.astype(np.uint8))
        return (slice(top, top + height), slice(left, left + width)) if width else None

    def _bare(self) -> Picture:
        """Return the bare table on the floor, drawn fine."""
        width, height = self._size
        picture = self._fine_sheet(height, width)
        picture[:] = (*shaded(FLOOR, 1.0), 0.0)
        table = self._workspace.table
        box = ConvexPolygon.box(-table.half_width, table.near, table.half_width, table.far)
        _fill(picture, _fixed(self._seen(along_edges(box), 0.0)), shaded(TABLE, 1.0))
        return picture

    def _lit(self, plain: Picture, region: Region) -> Picture:
        """Return a region, given in even light with a fourth component, as lit, and blurred."""
        three = cv2.cvtColor(plain, cv2.COLOR_BGRA2BGR)
        lit = cv2.multiply(three, self._light[region], dtype=cv2.CV_8U)
        if self._settings.blur_px > 0.0:
            lit = cv2.GaussianBlur(lit, (0, 0), self._settings.blur_px)
        return np.asarray(lit, np.uint8)

    def _noisy(self, picture: Picture, region: Region, rng: np.random.Generator) -> Picture:
        """Return a region with noise: a part of a large sheet of it, at a random place."""
        more, less = _noise(self._settings.grey_noise, *self._size)
        x, y, turned = rng.integers([SHEET_MARGIN, SHEET_MARGIN, 2]).tolist()
        rows, columns = region
        there = slice(y + rows.start, y + rows.stop), slice(x + columns.start, x + columns.stop)
        first, second = (less, more) if turned else (more, less)
        noisy = cv2.subtract(cv2.add(picture, first[there]), second[there])
        return np.asarray(noisy, np.uint8)


def _over(table: Picture, things: tuple[Region, Picture] | None, around: Region) -> Picture:
    """Return a region of the table with what stands on it.

    Args:
        table: as lit, the whole picture.
        things: a region within `around` and its picture; None if nothing is in view.
        around: the region.
    """
    if things is None:
        return table[around]
    region, drawn = things
    if region == around:
        return drawn
    picture = table[around].copy()
    picture[within(around, region)] = drawn
    return picture


def _times(box: Region) -> Region:
    """Return where a region is in the fine picture."""
    rows, columns = (slice(FINE * side.start, FINE * side.stop) for side in box)
    return rows, columns


def _fixed(corners: Array) -> NDArray[np.int32]:
    """Return where corners (..., 2), px, are in the fine picture, in OpenCV's fixed point."""
    # Of a table of miles a corner may lie where the lens's model has no place for it.
    fine = ((corners + 0.5) * FINE - 0.5).clip(-FARTHEST, FARTHEST)
    fine[np.isnan(fine)] = FARTHEST
    fixed: NDArray[np.int32] = np.rint(fine * 2**FRACTION_BITS).astype(np.int32)
    return fixed


def _fill(fine: Picture, corners: NDArray[np.int32], color: tuple[float, float, float]) -> None:
    """Fill a polygon in a fine picture; see `_fixed`."""
    cv2.fillPoly(fine, [corners], color, cv2.LINE_8, FRACTION_BITS)


def _finer(plain: Picture, fine: Picture) -> None:
    """Draw a picture with FINE by FINE pixels for each."""
    height, width = fine.shape[:2]
    cv2.resize(plain, (width, height), dst=fine, interpolation=cv2.INTER_NEAREST)


def _coarse(fine: Picture) -> Picture:
    """Return a picture that was drawn fine in its own pixels."""
    # Twice by two: OpenCV has a fast way for that and none for four.
    for _ in range(FINE.bit_length() - 1):
        half = cv2.resize(fine, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
        fine = np.asarray(half, np.uint8)
    return fine


@cache
def _sheet(width: int, height: int) -> Picture:
    """Return room for a fine picture, flat: new room for each takes longer than drawing on it."""
    return np.empty((width * height * FINE**2, 4), np.uint8)


@cache
def _light(uneven: float, width: int, height: int) -> NDArray[np.float32]:
    """Return how bright the light is at each pixel (height, width, 3), 1 in the mean.

    A lamp to the upper left of the picture, and what a lens loses toward its corners.
    """
    y, x = np.mgrid[-1.0 : 1.0 : height * 1j, -1.0 : 1.0 : width * 1j]
    slope = -0.7 * x - 0.3 * y
    corners = 0.5 - 0.75 * (x**2 + y**2)
    field = slope + 0.5 * corners
    field -= field.mean()
    light = (1.0 + uneven * field / np.abs(field).max()).astype(np.float32)
    return np.repeat(light[:, :, None], 3, axis=2)


@cache
def _noise(deviation: float, width: int, height: int) -> tuple[Picture, Picture]:
    """Return a sheet of Gaussian noise, its positive part and its negative part, 8 bits each.

    Drawn once: a million Gaussian numbers for each picture would take longer than all the rest.
    """
    rng = np.random.Generator(np.random.PCG64(36))
    size = (height + SHEET_MARGIN, width + SHEET_MARGIN, 3)
    noise = np.rint(rng.normal(0.0, deviation, size))
    return (
        np.clip(noise, 0.0, 255.0).astype(np.uint8),
        np.clip(-noise, 0.0, 255.0).astype(np.uint8),
    )
