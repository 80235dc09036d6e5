"""The picture that the camera takes of a scene: perspective, lens, light, blur and noise (§4).

Pictures are OpenCV's: (height, width, 3), 8 bits, blue green red.
"""

from collections.abc import Sequence
from functools import cache
from itertools import islice

import cv2
import numpy as np
from numpy.typing import NDArray

from affcli.core.geometry import ConvexPolygon
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.workspace import Workspace
from affcli.perception.camera import Array
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.palette import GOAL_COLOR
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
        self._tables: dict[GoalRegion | None, tuple[Picture, Picture]] = {}

    def take(self, scene: Scene, rng: np.random.Generator) -> Picture:
        """Return the picture of a scene; `rng` decides the noise."""
        plain, lit = self._table(scene.goal)
        layers = layers_of(scene, self._workspace, self._camera)
        return self._noisy(self._with(layers, lit.copy(), plain), rng)

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
            _fill(picture, self._seen(outline, 0.0), shaded(color, 1.0))
        plain = _coarse(picture)
        return self._noisy(self._lit(plain, self._whole), rng)

    @property
    def _size(self) -> tuple[int, int]:
        """Width and height of a picture (px)."""
        return self._camera.sensor.width_px, self._camera.sensor.height_px

    @property
    def _whole(self) -> tuple[slice, slice]:
        """The region that is the whole picture."""
        width, height = self._size
        return slice(0, height), slice(0, width)

    def _with(self, layers: Sequence[Sequence[Prism]], lit: Picture, plain: Picture) -> Picture:
        """Draw layers of prisms over the empty table.

        Args:
            layers: see `solids.layers_of`.
            lit, plain: the table as lit, which is drawn upon, and in even light.
        """
        prisms = [prism for layer in layers for prism in layer]
        corners, ends = self._corners(prisms)
        seen = np.isfinite(corners).all(axis=1)
        region = self._region(corners[seen])
        if region is None:
            return lit
        rows, columns = region
        fine = _finer(plain[region])
        corner = np.array([columns.start, rows.start])
        pieces = np.split(corners, ends)
        shapes = iter(zip(prisms, pieces[: len(prisms)], pieces[len(prisms) :], strict=True))
        for layer in layers:
            # What lies behind the camera has no corners.
            drawn = [s for s in islice(shapes, len(layer)) if np.isfinite((s[1], s[2])).all()]
            for prism, bottom, top in drawn:
                if prism.top > prism.bottom:
                    both = np.concatenate([bottom, top]).astype(np.float32)
                    hull = cv2.convexHull(both)[:, 0] - corner
                    _fill(fine, hull, shaded(prism.color, SIDE_SHADE))
            for prism, _, top in drawn:
                _fill(fine, top - corner, shaded(prism.color, 1.0))
        lit[region] = self._lit(_coarse(fine), region)
        return lit

    def _corners(self, prisms: Sequence[Prism]) -> tuple[Array, Array]:
        """Return the pixels of the outlines of prisms: of all bottoms, then of all tops.

        All at once, for that takes a third of the time of one after the other.

        Returns:
            (n, 2), px, and at which rows the second and all later outlines begin.
        """
        outlines = [prism.outline for prism in prisms]
        counts = [len(outline) for outline in outlines]
        heights = np.array([(prism.bottom, prism.top) for prism in prisms])
        each = np.concatenate([height.repeat(counts) for height in heights.T])
        corners = self._seen(np.concatenate([*outlines, *outlines]), each)
        return corners, np.cumsum([*counts, *counts])[:-1]

    def _seen(self, outline: Array, height: float | Array) -> Array:
        """Return the pixels (n, 2) of points (n, 2) at one height or at (n,) heights (in)."""
        return self._camera.project(
            np.column_stack([outline, np.broadcast_to(height, len(outline))])
        )

    def _region(self, pixels: Array) -> tuple[slice, slice] | None:
        """Return the rows and columns around `pixels` that lie in the picture, None when none."""
        if not len(pixels):
            return None
        width, height = self._size
        low = np.floor(pixels.min(axis=0)).astype(int) - MARGIN
        high = np.ceil(pixels.max(axis=0)).astype(int) + MARGIN + 1
        left, top = max(0, int(low[0])), max(0, int(low[1]))
        right, bottom = min(width, int(high[0])), min(height, int(high[1]))
        if left >= right or top >= bottom:
            return None
        return slice(top, bottom), slice(left, right)

    def _table(self, goal: GoalRegion | None) -> tuple[Picture, Picture]:
        """Return the table without tool and puck, in even light and as lit; made once a goal."""
        if goal not in self._tables:
            picture = self._bare()
            if goal is not None:
                (x, y), half = goal.center, goal.half_width
                square = ConvexPolygon.box(x - half, y - half, x + half, y + half)
                _fill(picture, self._seen(along_edges(square), 0.0), shaded(GOAL_COLOR, 1.0))
            plain = _coarse(picture)
            self._tables[goal] = plain, self._lit(plain, self._whole)
        return self._tables[goal]

    def _bare(self) -> Picture:
        """Return the bare table on the floor, drawn fine."""
        width, height = self._size
        picture = np.empty((FINE * height, FINE * width, 3), np.uint8)
        picture[:] = shaded(FLOOR, 1.0)
        table = self._workspace.table
        box = ConvexPolygon.box(-table.half_width, table.near, table.half_width, table.far)
        _fill(picture, self._seen(along_edges(box), 0.0), shaded(TABLE, 1.0))
        return picture

    def _lit(self, plain: Picture, region: tuple[slice, slice]) -> Picture:
        """Return part of a picture in the uneven light, blurred."""
        lit = cv2.multiply(plain, self._light[region], dtype=cv2.CV_8U)
        if self._settings.blur_px > 0.0:
            lit = cv2.GaussianBlur(lit, (0, 0), self._settings.blur_px)
        return np.asarray(lit, np.uint8)

    def _noisy(self, picture: Picture, rng: np.random.Generator) -> Picture:
        """Return the picture with noise: a part of a large sheet of it, at a random place."""
        more, less = _noise(self._settings.grey_noise, *self._size)
        x, y, turned = rng.integers([SHEET_MARGIN, SHEET_MARGIN, 2]).tolist()
        width, height = self._size
        region = slice(y, y + height), slice(x, x + width)
        first, second = (less, more) if turned else (more, less)
        noisy = cv2.subtract(cv2.add(picture, first[region]), second[region])
        return np.asarray(noisy, np.uint8)


def _fill(picture: Picture, corners: Array, color: tuple[float, float, float]) -> None:
    """Fill a polygon whose corners (n, 2) are given in pixels of the picture that is not fine."""
    # Of a table of miles a corner may lie where the lens's model has no place for it.
    fine = np.nan_to_num(np.clip((corners + 0.5) * FINE - 0.5, -FARTHEST, FARTHEST), nan=FARTHEST)
    fixed = np.rint(fine * 2**FRACTION_BITS).astype(np.int32)
    cv2.fillPoly(picture, [fixed], color, cv2.LINE_8, FRACTION_BITS)


def _finer(plain: Picture) -> Picture:
    """Return a picture with FINE by FINE pixels for each."""
    return np.asarray(
        cv2.resize(plain, None, fx=FINE, fy=FINE, interpolation=cv2.INTER_NEAREST), np.uint8
    )


def _coarse(fine: Picture) -> Picture:
    """Return a picture that was drawn fine in its own pixels."""
    # Twice by two: OpenCV has a fast way for that and none for four.
    for _ in range(FINE.bit_length() - 1):
        half = cv2.resize(fine, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
        fine = np.asarray(half, np.uint8)
    return fine


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
