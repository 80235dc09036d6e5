"""How a picture was taken, as its file says (EXIF): what a calibration holds for, and is kept with.

A calibration is of the picture as its pixels are stored. The orientation says how to turn them for
a person to look at; a phone that looks down on a table guesses it anew for each picture, while
sensor and lens stay in their place.
"""

import math
import struct
from contextlib import suppress
from typing import Any

from PIL import ExifTags, Image

from affcli.errors import BadInputError, one_line

Capture = dict[str, str | float]

ORIENTATION = "orientation"
UPRIGHT = 1
SETTINGS = {
    "camera": "camera",
    "lens": "lens",
    "focal_length_mm": "focal length (mm)",
    "focal_length_35mm": "focal length for 35 mm film",
    "digital_zoom": "digital zoom",
    "captured_px": "size when it was taken",
}
"""What must be alike in two pictures where both tell, and in words."""
UNREADABLE = (
    *(OSError, SyntaxError, ValueError, TypeError, AttributeError, KeyError, IndexError),
    *(ArithmeticError, struct.error),
)
"""What Pillow raises for notes about a picture that make no sense."""
LONGEST = 100
"""Letters of a name that are kept."""
ALIKE = 1e-3
"""Two numbers that differ by less than this share are the same setting."""


def capture_of(image: Image.Image) -> Capture:
    """Return what the notes in an opened picture say of how it was taken: nothing, often.

    ``orientation`` is 1 to 8, as EXIF counts them; the others are the keys of `SETTINGS`.
    """
    base = ExifTags.Base
    own: dict[int, Any] = {}
    with suppress(*UNREADABLE):
        exif = image.getexif()
        own = {**exif, **exif.get_ifd(ExifTags.IFD.Exif)}
    width, height = (_number(own.get(tag)) for tag in (base.ExifImageWidth, base.ExifImageHeight))
    known: Capture = {
        "camera": " ".join(filter(None, (_text(own.get(base.Make)), _text(own.get(base.Model))))),
        "lens": _text(own.get(base.LensModel)),
        "focal_length_mm": _number(own.get(base.FocalLength)),
        "focal_length_35mm": _number(own.get(base.FocalLengthIn35mmFilm)),
        # EXIF: 0 says that it was not used.
        "digital_zoom": base.DigitalZoomRatio in own
        and (_number(own[base.DigitalZoomRatio]) or 1.0),
        "captured_px": f"{width:g}x{height:g}" if width and height else "",
    }
    capture = {name: value for name, value in known.items() if value}
    orientation = own.get(base.Orientation)
    if isinstance(orientation, int) and 1 <= orientation <= 8:
        capture[ORIENTATION] = orientation
    return capture


def checked_capture(value: Any) -> Capture | None:
    """Return what a calibration's file says of how its picture was taken; None for nothing.

    Raises:
        ValueError: it was not written by affcli.
    """
    if value is None:
        return None
    if not isinstance(value, dict) or not all(
        isinstance(v, str | int | float) for v in value.values()
    ):
        raise ValueError("capture must be an object of texts and numbers")
    if value.get(ORIENTATION, UPRIGHT) not in range(1, 9):
        raise ValueError("capture.orientation must be 1 to 8")
    return value


def orientation_for(own: Capture, kept: Capture | None, shown: str) -> int:
    """Return the orientation that turns a picture as that of a calibration was turned.

    Args:
        own: how the picture was taken.
        kept: how the picture of the calibration was taken; None when the calibration does not say.
        shown: the picture's name, for the message.

    Raises:
        BadInputError: the pictures were not taken alike, or it cannot be told whether they were.
    """
    before = kept or {}
    for name, words in SETTINGS.items():
        if name in own and name in before and not _alike(own[name], before[name]):
            raise BadInputError(
                f"{shown}: {words} {one_line(own[name], 60)}, but that of the calibration's "
                f"picture was {one_line(before[name], 60)}; take both pictures alike"
            )
    ours, theirs = own.get(ORIENTATION), before.get(ORIENTATION)
    if (ours or theirs or UPRIGHT) != UPRIGHT and None in (ours, theirs):
        silent, other = (
            ("this", "the calibration's") if ours is None else ("the calibration's", "this")
        )
        raise BadInputError(
            f"{shown}: {other} picture was stored turned (EXIF orientation {ours or theirs}), and "
            f"{silent} does not say how; take both alike, as the camera writes them, and "
            "calibrate again"
        )
    return int(theirs or UPRIGHT)


def _alike(one: object, other: object) -> bool:
    if isinstance(one, float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=ALIKE)
    return one == other


def _text(value: object) -> str:
    """Return a name without blanks and NULs around it; empty when it is none."""
    return value.strip("\0 ")[:LONGEST] if isinstance(value, str) else ""


def _number(value: object) -> float:
    """Return a positive number; 0 when it is none."""
    with suppress(*UNREADABLE):
        number = round(float(value), 4)  # type: ignore[arg-type]  # a fraction of Pillow's
        return number if math.isfinite(number) and number > 0.0 else 0.0
    return 0.0
