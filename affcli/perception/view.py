"""What the camera sees beside what the robot makes of it: the pictures of Figs. 3 and 4."""

import os
import tempfile
from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np

from affcli.errors import BadInputError, one_line
from affcli.perception.palette import Role
from affcli.perception.rendering import Picture
from affcli.perception.segmentation import Segmentation
from affcli.perception.solids import shaded

GROUND = (28, 28, 28)
"""Colour of pixels without a class, blue green red."""
WHITE = (245, 245, 245)
GAP_PX = 8
BAND_PX = 30
"""Height of the band under the two pictures in which they are named."""
LONG_ARM, SHORT_ARM, LARGE_BLOB = 6, 3, 200
"""Pixels of the arms of a cross, the long ones on blobs of more pixels than that."""
CODECS = {".mp4": "mp4v", ".avi": "MJPG"}


def side_by_side(seen: Segmentation, title: str) -> Picture:
    """Return the frame and, to its right, its segmentation, with a caption under each.

    Args:
        seen: the frame and what was found in it.
        title: what the frame shows.
    """
    captions = (title, "colour segmentation, with the centroids of what is located")
    left, right = seen.picture, segmentation_picture(seen)
    height, width = left.shape[:2]
    page = np.full((height + BAND_PX, 2 * width + GAP_PX, 3), 255, np.uint8)
    for caption, picture, x in zip(captions, (left, right), (0, width + GAP_PX), strict=True):
        page[:height, x : x + width] = picture
        _write(page, caption, (x + 6, height + BAND_PX - 9), 0.5, (30, 30, 30), outline=None)
    return page


def segmentation_picture(seen: Segmentation) -> Picture:
    """Return the classes of all pixels in their colours, with the centroids that were found."""
    colors = np.full((256, 1, 3), GROUND, np.uint8)
    for k, one in enumerate(seen.classes):
        colors[k, 0] = np.rint(shaded(one.color, 1.0))
    labels = cv2.cvtColor(seen.labels, cv2.COLOR_GRAY2BGR)
    picture = np.asarray(cv2.LUT(labels, np.ascontiguousarray(colors.reshape(1, 256, 3))), np.uint8)
    for one, blobs in zip(seen.classes, seen.blobs, strict=True):
        if not blobs:
            continue
        left = min(blob.left for blob in blobs)
        bottom = max(blob.top + blob.height for blob in blobs)
        # Of a tool only the colour is used: no centroid.
        if one.role is not Role.TOOL:
            # A goal that something lies across is seen in pieces; their centroid is one.
            area = sum(blob.area for blob in blobs)
            x = sum(blob.x * blob.area for blob in blobs) / area
            y = sum(blob.y * blob.area for blob in blobs) / area
            each = [(x, y)] if one.role is Role.GOAL else [(blob.x, blob.y) for blob in blobs]
            arm = LONG_ARM if area > LARGE_BLOB * len(blobs) else SHORT_ARM
            for center in each:
                _cross(picture, *center, arm)
        _write(picture, one_line(one.name, 30), (left, bottom + 14), 0.42, WHITE, outline=(0, 0, 0))
    return picture


def video(pictures: Iterable[Picture], ending: str, rate: float) -> bytes:
    """Return pictures as the bytes of a video.

    OpenCV writes videos to files alone, takes some names for addresses, and does not say when the
    disk is full: so to a file of a plain name, which is then read again.

    Args:
        pictures: all of one size, at least one.
        ending: of the name of such a file: a key of `CODECS`.
        rate: pictures a second.

    Raises:
        BadInputError: it cannot be made.
    """
    # What OpenCV has to say of files goes into one line of ours.
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    count = 0
    writer: cv2.VideoWriter | None = None
    try:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"video{ending}"
            for picture in pictures:
                if writer is None:
                    fourcc = cv2.VideoWriter.fourcc(*CODECS[ending])
                    size = (picture.shape[1], picture.shape[0])
                    writer = cv2.VideoWriter(str(path), fourcc, rate, size)
                writer.write(picture)
                count += 1
            if writer is not None:
                writer.release()
            if not (path.exists() and _frames_in(path) == count):
                raise BadInputError(
                    "the video could not be made; make room on the disk, or try *.avi"
                )
            return path.read_bytes()
    except OSError as error:
        raise BadInputError(f"the video could not be made: {error.strerror}; make room") from error
    finally:
        if writer is not None:
            writer.release()


def _frames_in(path: Path) -> int:
    """Return how many frames of a video can be read."""
    reader = cv2.VideoCapture(str(path))
    count = 0
    while reader.grab():
        count += 1
    reader.release()
    return count


def _cross(picture: Picture, x: float, y: float, arm_px: int) -> None:
    """Draw a cross at a centroid, to a sixteenth of a pixel."""
    shift = 4
    cx, cy, arm = round(x * 16), round(y * 16), arm_px * 16
    for color, thickness in (((0, 0, 0), 3), (WHITE, 1)):
        for dx, dy in ((arm, 0), (0, arm)):
            ends = (cx - dx, cy - dy), (cx + dx, cy + dy)
            cv2.line(picture, *ends, color, thickness, cv2.LINE_AA, shift)


def _write(
    picture: Picture,
    text: str,
    place: tuple[int, int],
    size: float,
    color: tuple[int, int, int],
    outline: tuple[int, int, int] | None,
) -> None:
    """Write a line of text, its baseline beginning at `place`."""
    font = cv2.FONT_HERSHEY_SIMPLEX
    if outline is not None:
        cv2.putText(picture, text, place, font, size, outline, 3, cv2.LINE_AA)
    cv2.putText(picture, text, place, font, size, color, 1, cv2.LINE_AA)
