"""Pictures in files: read with care, for anyone may have made them; written whole or not at all."""

import warnings
from pathlib import Path

import cv2
import numpy as np
from PIL import Image, ImageOps, UnidentifiedImageError

from affcli.errors import BadInputError, one_line
from affcli.perception.rendering import Picture

FORMATS = ("PNG", "JPEG")
MOST_PIXELS = 25_000_000
"""A larger picture tells no more of a table, and takes seconds."""
LEAST_SIDE = 32
"""Pixels; nothing could be found in a smaller picture."""


def read_picture(path: Path) -> Picture:
    """Return the picture in a PNG or JPEG file, turned upright as its camera says.

    Transparency is ignored, 16 bits become 8, grey becomes a colourless picture.

    Raises:
        BadInputError: no such picture: missing, of another kind, damaged, too large or too small.
    """
    shown = one_line(path)
    try:
        with warnings.catch_warnings():
            # Pillow warns of bombs; the size is checked here before anything is unpacked.
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with Image.open(path, formats=FORMATS) as image:
                width, height = image.size
                if width * height > MOST_PIXELS:
                    raise BadInputError(
                        f"{shown}: {width}x{height} pixels are too many; make it smaller than "
                        f"{MOST_PIXELS // 1_000_000} megapixels"
                    )
                if min(width, height) < LEAST_SIDE:
                    raise BadInputError(
                        f"{shown}: {width}x{height} pixels are too few; give a picture of at least "
                        f"{LEAST_SIDE} by {LEAST_SIDE}"
                    )
                upright = ImageOps.exif_transpose(_eight_bits(image))
                rgb = np.asarray(upright.convert("RGB"), np.uint8)
    except (UnidentifiedImageError, Image.DecompressionBombError) as error:
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
