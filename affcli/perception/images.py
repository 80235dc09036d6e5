"""Pictures in files: read with care, for anyone may have made them; written whole or not at all."""

import math
import struct
import warnings
from contextlib import suppress
from pathlib import Path

import cv2
import numpy as np
from PIL import ExifTags, Image, UnidentifiedImageError

from affcli.errors import BadInputError, one_line
from affcli.perception.camera import Array
from affcli.perception.rendering import Picture

FORMATS = ("PNG", "JPEG")
MOST_PIXELS = 25_000_000
TOO_MANY = f"too many pixels; make it smaller than {MOST_PIXELS // 1_000_000} megapixels"
ENOUGH_PIXELS = 3_000_000
LEAST_SIDE = 32
"""Pixels; nothing could be found in a smaller picture."""
UNREADABLE = (
    *(OSError, SyntaxError, ValueError, TypeError, AttributeError, KeyError, IndexError),
    *(ArithmeticError, struct.error),
)
"""What Pillow raises for notes about a picture (EXIF) that make no sense."""
TURNS = {
    2: Image.Transpose.FLIP_LEFT_RIGHT,
    3: Image.Transpose.ROTATE_180,
    4: Image.Transpose.FLIP_TOP_BOTTOM,
    5: Image.Transpose.TRANSPOSE,
    6: Image.Transpose.ROTATE_270,
    7: Image.Transpose.TRANSVERSE,
    8: Image.Transpose.ROTATE_90,
}
"""By the orientation that EXIF gives."""


def read_picture(path: Path) -> Picture:
    """Return the picture in a PNG or JPEG file, turned upright as its camera says.

    Transparency is ignored, 16 bits become 8, grey becomes a colourless picture.

    Raises:
        BadInputError: no such picture: missing, of another kind, damaged, too large or too small.
    """
    shown = one_line(path)
    try:
        with warnings.catch_warnings():
            # Pillow warns of what it mends and of bombs; sizes are checked before unpacking.
            warnings.simplefilter("ignore")
            with Image.open(path, formats=FORMATS) as image:
                _require_size(image, shown)
                upright = _upright(_eight_bits(image))
                rgb = np.asarray(upright.convert("RGB"), np.uint8)
    except Image.DecompressionBombError as error:
        raise BadInputError(f"{shown}: {TOO_MANY}") from error
    except UnidentifiedImageError as error:
        raise BadInputError(
            f"{shown}: not a PNG or JPEG picture that can be read; save it as one"
        ) from error
    except OSError as error:
        raise BadInputError(
            f"{shown}: {one_line(error.strerror or error)}; give a PNG or JPEG picture"
        ) from error
    except (SyntaxError, ValueError) as error:  # what Pillow raises for damaged chunks
        raise BadInputError(f"{shown}: damaged: {one_line(error)}; save it again") from error
    return np.ascontiguousarray(rgb[:, :, ::-1])


def shrunk(picture: Picture) -> tuple[Picture, int]:
    """Return a large picture with fewer pixels, each the mean of a square, and the square's side.

    A table is seen as well in three million pixels as in more, and four times as fast.
    """
    height, width = picture.shape[:2]
    side = max(1, math.ceil(math.sqrt(width * height / ENOUGH_PIXELS)))
    if side == 1:
        return picture, 1
    whole = picture[: height - height % side, : width - width % side]
    size = (width // side, height // side)
    return np.asarray(cv2.resize(whole, size, interpolation=cv2.INTER_AREA), np.uint8), side


def unshrunk(pixels: Array, side: int) -> Array:
    """Return where pixels (n, 2) of a picture that was shrunk are in the whole one."""
    whole: Array = (pixels + 0.5) * side - 0.5
    return whole


def _require_size(image: Image.Image, shown: str) -> None:
    """Refuse a picture that is too large or too small."""
    width, height = image.size
    if width * height > MOST_PIXELS:
        raise BadInputError(f"{shown}: {width}x{height} pixels: {TOO_MANY}")
    if min(width, height) < LEAST_SIDE:
        raise BadInputError(
            f"{shown}: {width}x{height} pixels are too few; give a picture of at least "
            f"{LEAST_SIDE} by {LEAST_SIDE}"
        )


def _upright(image: Image.Image) -> Image.Image:
    """Return a picture turned as the camera that took it says; as it is when that is unreadable."""
    orientation: object = 1
    with suppress(*UNREADABLE):
        orientation = image.getexif().get(ExifTags.Base.Orientation, 1)
    turn = TURNS.get(orientation) if isinstance(orientation, int) else None
    return image if turn is None else image.transpose(turn)


def _eight_bits(image: Image.Image) -> Image.Image:
    """Return a grey picture of 16 or 32 bits with 8; others as they are."""
    if not image.mode.startswith("I"):
        return image
    return Image.fromarray((np.asarray(image, np.uint32) >> 8).clip(0, 255).astype(np.uint8))


def png(picture: Picture) -> bytes:
    """Return a picture as the bytes of a PNG file; the same picture gives the same bytes."""
    written, data = cv2.imencode(".png", picture)
    if not written:
        raise ValueError(f"OpenCV could not encode a picture of shape {picture.shape}")
    return data.tobytes()
