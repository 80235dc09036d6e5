"""Pictures one after the other as a GIF."""

import io
from collections.abc import Iterable
from itertools import chain

import numpy as np
from numpy.typing import NDArray
from PIL import Image

COLORS = 64
"""In the one palette that all frames share."""
TICK_MS = 10
"""A GIF counts time in hundredths of a second."""


def gif(pictures: Iterable[NDArray[np.uint8]], frame_ms: float) -> bytes:
    """Return pictures as the bytes of a GIF that repeats; the same pictures give the same bytes.

    Args:
        pictures: rows x columns x red, green, blue, all of one size, at least one.
        frame_ms: how long each is shown (ms); kept on average, in whole hundredths of a second.

    Raises:
        ValueError: there are none.
    """
    images = map(Image.fromarray, pictures)
    first = next(images, None)
    if first is None:
        raise ValueError("a GIF of no pictures")
    palette = first.quantize(COLORS, dither=Image.Dither.NONE)
    frames = [
        image.quantize(palette=palette, dither=Image.Dither.NONE)
        for image in chain([first], images)
    ]
    # Rounded so that no error adds up.
    ends = [round((k + 1) * frame_ms / TICK_MS) for k in range(len(frames))]
    shown = [TICK_MS * (end - begin) for begin, end in zip([0, *ends], ends, strict=False)]
    page = io.BytesIO()
    frames[0].save(
        page, "GIF", save_all=True, append_images=frames[1:], duration=shown, loop=0, optimize=False
    )
    return page.getvalue()
