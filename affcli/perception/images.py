"""Pictures in files: read with care, for anyone may have made them; written whole or not at all."""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import cv2
import numpy as np
from PIL import Image, UnidentifiedImageError

from affcli.bounded import file_bytes
from affcli.errors import BadInputError, one_line
from affcli.perception.camera import Array
from affcli.perception.capture import ORIENTATION, UPRIGHT, Capture, capture_of
from affcli.perception.rendering import Picture

FORMATS = ("PNG", "JPEG")
MOST_PIXELS = 25_000_000
REMEDY = "give a PNG or JPEG picture"
TOO_MANY = "too many pixels; make it smaller than 25 megapixels, or a drawing than 12"
ENOUGH_PIXELS = 3_000_000
LEAST_SIDE = 32
"""Pixels; nothing could be found in a smaller picture."""
PIXELS_A_BYTE = 12
"""A photograph has fewer; more, and more than `ENOUGH_FLAT`, are there to fill the memory."""
ENOUGH_FLAT = 12_000_000
START_OF_SCAN = b"\xff\xda"
MOST_SCANS = 64
"""Times that a JPEG goes over its pixels; cameras and programs write some ten."""
LARGEST_FILE = 200_000_000
"""Bytes; so many pixels of 16 bits take less without any compression."""
TURNS: dict[int, Callable[[Picture], Picture]] = {
    2: np.fliplr,
    3: lambda stored: np.rot90(stored, 2),
    4: np.flipud,
    5: lambda stored: stored.swapaxes(0, 1),
    6: lambda stored: np.rot90(stored, -1),
    7: lambda stored: np.rot90(stored, 2).swapaxes(0, 1),
    8: np.rot90,
}
"""How EXIF's orientations turn the pixels that are stored; 1 leaves them."""


@dataclass(frozen=True, slots=True)
class Photograph:
    """A picture from a file.

    Args:
        stored: its pixels as they are stored.
        capture: how it was taken, as far as the file says.
    """

    stored: Picture
    capture: Capture

    def turned(self, orientation: float) -> Picture:
        """Return the picture turned as an orientation of EXIF's says."""
        turn = TURNS.get(int(orientation))
        return self.stored if turn is None else np.ascontiguousarray(turn(self.stored))

    @property
    def upright(self) -> Picture:
        """The picture turned as its camera says that it was held."""
        return self.turned(float(self.capture.get(ORIENTATION, UPRIGHT)))


def read_photograph(path: Path) -> Photograph:
    """Return the picture in a PNG or JPEG file, and how it was taken.

    Transparency is ignored, 16 bits become 8, grey becomes a colourless picture.

    Raises:
        BadInputError: no such picture: missing, of another kind, damaged, too large or too small.
    """
    shown = one_line(path)
    try:
        with warnings.catch_warnings():
            # Pillow warns of what it mends and of bombs; sizes are checked before unpacking.
            warnings.simplefilter("ignore")
            data = file_bytes(path, shown, REMEDY, LARGEST_FILE)
            with Image.open(BytesIO(data), formats=FORMATS) as image:
                _require_size(image, data, shown)
                rgb = np.asarray(_eight_bits(image).convert("RGB"), np.uint8)
                capture = capture_of(image)
    except Image.DecompressionBombError as error:
        raise BadInputError(f"{shown}: {TOO_MANY}") from error
    except UnidentifiedImageError as error:
        raise BadInputError(
            f"{shown}: not a PNG or JPEG picture that can be read; save it as one"
        ) from error
    except OSError as error:
        raise BadInputError(f"{shown}: {one_line(error.strerror or error)}; {REMEDY}") from error
    except (SyntaxError, ValueError) as error:  # what Pillow raises for damaged chunks
        raise BadInputError(f"{shown}: damaged: {one_line(error)}; save it again") from error
    return Photograph(np.ascontiguousarray(rgb[:, :, ::-1]), capture)


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


def _require_size(image: Image.Image, data: bytes, shown: str) -> None:
    """Refuse a picture that is too large or too small, or would take very long to unpack."""
    width, height = image.size
    most = min(MOST_PIXELS, max(ENOUGH_FLAT, PIXELS_A_BYTE * len(data)))
    if width * height > most:
        raise BadInputError(f"{shown}: {width}x{height} pixels: {TOO_MANY}")
    if data.count(START_OF_SCAN) > MOST_SCANS and image.format == "JPEG":
        raise BadInputError(f"{shown}: in more than {MOST_SCANS} scans; save it again")
    if min(width, height) < LEAST_SIDE:
        raise BadInputError(
            f"{shown}: {width}x{height} pixels are too few; give a picture of at least "
            f"{LEAST_SIDE} by {LEAST_SIDE}"
        )


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
