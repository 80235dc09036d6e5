"""Pictures one after the other as a GIF, written as they come: a long film fills no memory."""

import io
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageChops
from PIL.GifImagePlugin import getdata, getheader

Pixels = NDArray[np.uint8]
"""Rows x columns x red, green, blue."""

COLORS = 64
"""In the one palette that all pictures share."""
TICK_MS = 10
"""A GIF counts time in hundredths of a second."""
LONGEST = 65_535
"""Ticks; no picture of a GIF can be shown for longer."""


def gif(pictures: Iterable[Pixels], frame_ms: float, colors: Pixels | None = None) -> bytes:
    """Return pictures as the bytes of a GIF that repeats; the same pictures give the same bytes.

    A picture like the one before it becomes a longer stillness, up to 655 s; of any other only the
    rectangle that changed is kept.

    Args:
        pictures: all of one size, at least one.
        frame_ms: how long each is shown (ms); kept on average, in whole hundredths of a second.
        colors: a picture that has every colour that matters; None for the first.

    Raises:
        ValueError: there are none.
    """
    coming = iter(pictures)
    first = next(coming, None)
    if first is None:
        raise ValueError("a GIF of no pictures")
    sample = first if colors is None else colors
    palette = Image.fromarray(sample).quantize(COLORS, dither=Image.Dither.NONE)

    def of_palette(picture: Pixels) -> Image.Image:
        """Return a picture in the nearest colours."""
        return Image.fromarray(picture).quantize(palette=palette, dither=Image.Dither.NONE)

    whole = change = of_palette(first)
    header, _ = getheader(whole, info={"loop": 0})
    page = io.BytesIO(b"".join(header))
    page.seek(0, io.SEEK_END)
    corner, began, number = (0, 0), 0, 0

    def show_until(end: int) -> None:
        """Write the latest change; it is seen until picture `end`."""
        # Rounded so that no error adds up.
        ticks = round(end * frame_ms / TICK_MS) - round(began * frame_ms / TICK_MS)
        shown_ms = TICK_MS * min(ticks, LONGEST)
        page.writelines(getdata(change, corner, duration=shown_ms))

    for number, picture in enumerate(coming, 1):
        image = of_palette(picture)
        box = ImageChops.subtract_modulo(image, whole).getbbox(alpha_only=False)
        if box is not None:
            show_until(number)
            whole, change, corner, began = image, image.crop(box), box[:2], number
    show_until(number + 1)
    return page.getvalue() + b";"
