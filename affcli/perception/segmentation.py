"""Colour segmentation: which pixels belong to which colour class, and the blobs they form (§4)."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from affcli.core.tool import Color
from affcli.perception.palette import LEAST_SATURATION, LEAST_VALUE, ColorClass, class_of_hue
from affcli.perception.rendering import Detail, Picture

NO_CLASS = 255
"""The label of a pixel that belongs to no class."""
SMALLEST_BLOB = 40
"""Pixels; smaller ones are edges between two colours that happen to mix to a third."""
ALIKE = 0.25
"""A second blob of at least this share of the largest one's pixels makes a thing doubled."""


@dataclass(frozen=True, slots=True)
class Blob:
    """Connected pixels of one class.

    Args:
        x, y: centroid (px).
        area: number of pixels.
        left, top, width, height: bounding box (px).
    """

    x: float
    y: float
    area: int
    left: int
    top: int
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class Segmentation:
    """What a picture shows, class by class.

    Args:
        detail: the part of the picture that was segmented; all else has no class.
        classes: what was looked for.
        labels: (height, width), 8 bits: the position of each pixel's class, or `NO_CLASS`.
        blobs: for each class its blobs of at least `SMALLEST_BLOB` pixels, largest first.
    """

    detail: Detail
    classes: tuple[ColorClass, ...]
    labels: NDArray[np.uint8]
    blobs: tuple[tuple[Blob, ...], ...]

    @property
    def picture(self) -> Picture:
        """That was segmented: the whole, unless it was a detail."""
        return self.detail.picture

    def mask(self, position: int, blob: Blob) -> NDArray[np.uint8]:
        """Return the pixels of a class within the bounding box of a blob: 255, and 0 elsewhere."""
        rows, columns = slice(blob.top, blob.top + blob.height), slice(blob.left, None)
        region = self.labels[rows, columns][:, : blob.width]
        return np.asarray(cv2.inRange(region, (position,), (position,)), np.uint8)

    def color(self, position: int, blob: Blob) -> Color:
        """Return the mean colour of a blob's inner pixels (red, green, blue).

        The pixels at its edge are left out, for they mix two colours.
        """
        mask = self.mask(position, blob)
        inner = cv2.erode(mask, np.ones((3, 3), np.uint8), borderValue=0)
        top, left = blob.top - self.detail.top, blob.left - self.detail.left
        picture = self.picture[top : top + blob.height, left : left + blob.width]
        blue, green, red, _ = cv2.mean(picture, inner if cv2.countNonZero(inner) else mask)
        return Color((red, green, blue))


class Segmenter:
    """Sorts pixels into colour classes by hue, which uneven light does not change.

    Args:
        classes: see `palette.palette`.
    """

    def __init__(self, classes: Sequence[ColorClass]) -> None:
        self.classes = tuple(classes)
        found = (class_of_hue(self.classes, 360.0 * hue / 256.0) for hue in range(256))
        self._class_of_hue = np.array([NO_CLASS if k is None else k for k in found], dtype=np.uint8)

    def segment(self, picture: Picture) -> Segmentation:
        """Return which pixels of a picture belong to which class.

        Args:
            picture: (height, width, 3), 8 bits, blue green red.
        """
        height, width = picture.shape[:2]
        return self.segment_detail(Detail(picture, 0, 0, width, height))

    def segment_detail(self, detail: Detail) -> Segmentation:
        """Return the same of a picture of which only the part that has colour is given."""
        hsv = np.asarray(cv2.cvtColor(detail.picture, cv2.COLOR_BGR2HSV_FULL), np.uint8)
        colored = colored_pixels(hsv)
        classes = cv2.LUT(cv2.extractChannel(hsv, 0), self._class_of_hue)
        labels = np.full((detail.height, detail.width), NO_CLASS, np.uint8)
        height, width = colored.shape
        part = labels[detail.top : detail.top + height, detail.left : detail.left + width]
        cv2.bitwise_or(classes, cv2.bitwise_not(colored), dst=part)
        left, top, width, height = cv2.boundingRect(colored)
        region = left + detail.left, top + detail.top, width, height
        counts = cv2.calcHist([part], [0], None, [256], [0, 256]).ravel()[: len(self.classes)]
        blobs = tuple(
            blobs_of(labels, k, region) if count >= SMALLEST_BLOB else ()
            for k, count in enumerate(counts.tolist())
        )
        return Segmentation(detail, self.classes, labels, blobs)


def colored_pixels(hsv: Picture) -> NDArray[np.uint8]:
    """Return which pixels have a colour: 255, and 0 for the others.

    Args:
        hsv: hue, saturation and value, each 0 to 255.
    """
    least = (0.0, 255.0 * LEAST_SATURATION, 255.0 * LEAST_VALUE)
    return np.asarray(cv2.inRange(hsv, least, (255.0, 255.0, 255.0)), np.uint8)


def blobs_of(
    labels: NDArray[np.uint8], position: int, region: Sequence[int], least: int = SMALLEST_BLOB
) -> tuple[Blob, ...]:
    """Return the blobs of one class, largest first.

    Args:
        labels: of all pixels.
        position: which class.
        region: where to look: left, top, width, height (px).
        least: pixels of the smallest blob that counts.
    """
    left, top, width, height = region
    if width == 0 or height == 0:
        return ()
    looked_at = labels[top : top + height, left : left + width]
    mask = cv2.inRange(looked_at, (position,), (position,))
    inner_left, inner_top, width, height = cv2.boundingRect(mask)
    if width * height < least:
        return ()
    mask = mask[inner_top : inner_top + height, inner_left : inner_left + width]
    _, _, stats, centers = cv2.connectedComponentsWithStats(mask, connectivity=4)
    left, top = left + inner_left, top + inner_top
    # The first is all that is not of the class.
    found = [
        Blob(x + left, y + top, area, x0 + left, y0 + top, w, h)
        for (x0, y0, w, h, area), (x, y) in zip(
            stats[1:].tolist(), centers[1:].tolist(), strict=True
        )
        if area >= least
    ]
    return tuple(sorted(found, key=lambda blob: -blob.area))
