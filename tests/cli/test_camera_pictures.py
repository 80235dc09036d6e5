"""Pictures that people give to ``affcli camera``: another format, damaged, or of something else."""

import io
import os
import struct
import time
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from PIL import Image

from affcli.perception.rendering import Picture
from tests.cli.camera_table import AS_IT_LIES
from tests.cli.program import Arg, done, names_in, refused

CARDBOARD = (220, 226, 228)
RED = (40, 40, 200)
"""Blue green red, as all pictures here."""
DEADLINE = 10.0
"""Seconds for an answer; it takes a tenth of one. No test is about speed, but none shall hang."""


@pytest.fixture(scope="module")
def rendered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The simulated camera's picture of the pattern."""
    path = tmp_path_factory.mktemp("pictures") / "pattern.png"
    done("camera", "view", "--pattern", "--frame", "--out", path)
    return path


@pytest.fixture
def pattern(rendered: Path) -> Picture:
    """The pixels of that picture."""
    return read(rendered)


@pytest.fixture(scope="module")
def reference(rendered: Path) -> dict[str, Any]:
    """What that picture gives."""
    return calibrated(rendered)


@pytest.fixture(scope="module")
def calibration(rendered: Path) -> Path:
    """The same in a file."""
    path = rendered.with_name("calibration.json")
    done("camera", "calibrate", rendered, *AS_IT_LIES, "--out", path)
    return path


def read(path: Path) -> Picture:
    """Return the pixels of a picture."""
    return np.asarray(cv2.imread(str(path)), np.uint8)


def calibrated(path: Path) -> dict[str, Any]:
    """Return what a picture of the pattern gives."""
    ended = done("camera", "calibrate", path, *AS_IT_LIES, "--json")
    assert ended.err == ""
    value: dict[str, Any] = ended.result
    return value


def refused_soon(*args: Arg, cwd: Path) -> str:
    """Run a command that must refuse, with exit code 4 and one line, before long."""
    began = time.monotonic()
    line = refused(4, "camera", *args, cwd=cwd)
    assert time.monotonic() - began < DEADLINE
    return line


def png(picture: np.ndarray[Any, Any]) -> bytes:
    """Return pixels, 8 or 16 bits, grey or coloured, as a PNG file."""
    return cv2.imencode(".png", picture)[1].tobytes()


def saved(picture: Picture, kind: str, mode: str = "RGB", **options: Any) -> bytes:
    """Return pixels as a file of some kind."""
    file = io.BytesIO()
    image = Image.fromarray(np.ascontiguousarray(picture[:, :, ::-1]))
    image.convert(mode).save(file, kind, **options)
    return file.getvalue()


def plain(value: int, width: int = 640, height: int = 480) -> bytes:
    """Return a picture of one grey."""
    return png(np.full((height, width), value, np.uint8))


def brighter(picture: Picture, by: int) -> Picture:
    """Return a picture that was exposed longer."""
    return np.asarray(np.clip(picture.astype(int) + by, 0, 255), np.uint8)


def claiming(width: int, height: int) -> bytes:
    """Return a PNG file of 100 bytes that claims to hold a picture of any size."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        checksum = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + checksum

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    data = zlib.compress(bytes(1000))
    chunks = chunk(b"IHDR", header), chunk(b"IDAT", data), chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def first_row(picture: Picture) -> int:
    """Return the row of pixels through the middle of the highest marker."""
    blue, green, red = (picture[:, :, k].astype(int) for k in range(3))
    rows = np.flatnonzero(((red - green > 100) & (red - blue > 100)).any(axis=1))
    return int(rows[0]) + 5


def oriented(picture: Picture, orientation: int, turned: Callable[[Picture], Picture]) -> bytes:
    """Return a picture that is stored turned, and says how it was held."""
    exif = Image.Exif()
    exif[0x0112] = orientation
    return saved(turned(picture), "PNG", exif=exif)


NOT_A_PICTURE: dict[str, tuple[Callable[[Picture], bytes], str]] = {
    "text": (lambda _: b"I am a picture.\n", "not a PNG or JPEG picture"),
    "empty": (lambda _: b"", "not a PNG or JPEG picture"),
    "GIF": (lambda p: saved(p, "GIF"), "not a PNG or JPEG picture"),
    "TIFF": (lambda p: saved(p, "TIFF"), "not a PNG or JPEG picture"),
    "half a PNG": (lambda p: png(p)[:100_000], "truncated; give a PNG or JPEG picture"),
    "20 bytes of a PNG": (lambda p: png(p)[:20], "; give a PNG or JPEG picture"),
    "half a JPEG": (lambda p: saved(p, "JPEG")[:9000], "truncated"),
    "300 bytes of a JPEG": (lambda p: saved(p, "JPEG")[:300], "; give a PNG or JPEG picture"),
    "a bomb": (lambda _: claiming(20_000, 20_000), "my.png: too many pixels; make it"),
    "the largest bomb": (lambda _: claiming(2**31 - 1, 2**31 - 1), "my.png: "),
    "more than is read": (
        lambda _: claiming(6000, 5000),
        "6000x5000 pixels: too many pixels; make it",
    ),
    "huge": (
        lambda _: plain(9, 12_000, 9000),
        "12000x9000 pixels: too many pixels; make it smaller",
    ),
    "nothing": (lambda _: claiming(0, 0), "my.png: "),
    "8 by 8": (lambda p: png(p[:8, :8]), "8x8 pixels are too few; give a picture of at least 32"),
}

NO_PATTERN: dict[str, tuple[Callable[[Picture], bytes], str]] = {
    "white": (lambda _: plain(255), "100% of the picture is white, it is over-exposed"),
    "grey": (lambda _: plain(128), "no markers found: paint them in one strong colour, or name it"),
    "black": (lambda _: plain(0), "no markers found"),
    "all red": (lambda p: png(np.full_like(p, RED)), "no markers found"),
    "over-exposed": (lambda p: png(brighter(p, 200)), "white, it is over-exposed"),
    "8 bits of grey": (lambda p: png(p[:, :, 1]), "no markers found"),
    "16 bits of grey": (lambda p: png(p[:, :, 1].astype(np.uint16) * 257), "found: paint them"),
    "16 bits of white": (lambda p: png(np.full(p.shape[:2], 65535, np.uint16)), "is over-exposed"),
    "black and white": (lambda p: saved(p, "PNG", "1"), "no markers found"),
    "a row cut in half": (lambda p: png(p[first_row(p) :]), "is cut off by the edge of the pict"),
}

AS_GOOD: dict[str, Callable[[Picture], bytes]] = {
    "opaque": lambda p: saved(p, "PNG", "RGBA"),
    "transparent": lambda p: png(np.dstack([p, np.zeros(p.shape[:2], np.uint8)])),
    "16 bits a channel": lambda p: png(p.astype(np.uint16) * 257),
    "held upside down": lambda p: oriented(p, 3, lambda q: np.asarray(q[::-1, ::-1])),
    "held upright": lambda p: oriented(p, 6, lambda q: np.asarray(np.rot90(q))),
}
"""The same pixels in another file."""


def senseless() -> bytes:
    """Return notes about a picture (EXIF) in which its description is a number."""
    # Little-endian TIFF; one entry: ImageDescription (0x10E) of the type double, at byte 26.
    return b"Exif\0\0II*\0\x08\0\0\0\x01\0" + struct.pack("<HHII", 0x10E, 12, 1, 26) + bytes(12)


NEARLY_AS_GOOD: dict[str, Callable[[Picture], bytes]] = {
    "JPEG": lambda p: saved(p, "JPEG", quality=95),
    "progressive JPEG": lambda p: saved(p, "JPEG", quality=95, progressive=True),
    "for printing": lambda p: saved(p, "JPEG", "CMYK", quality=95),
    "a palette": lambda p: saved(p, "PNG", "P"),
    "a transparent palette": lambda p: saved(p, "PNG", "P", transparency=bytes(range(256))),
    "notes that make no sense": lambda p: saved(p, "JPEG", quality=95, exif=senseless()),
    "brighter": lambda p: png(brighter(p, 30)),
}


@pytest.mark.parametrize(("make", "says"), NOT_A_PICTURE.values(), ids=NOT_A_PICTURE.keys())
def test_what_is_no_picture_is_named(
    make: Callable[[Picture], bytes], says: str, pattern: Picture, calibration: Path, tmp_path: Path
) -> None:
    (tmp_path / "my.png").write_bytes(make(pattern))
    for command in (("calibrate",), ("locate", "--calibration", calibration)):
        line = refused_soon(*command, "my.png", cwd=tmp_path)
        assert line.startswith("affcli: my.png: ")
        assert says in line
    assert names_in(tmp_path) == ["my.png"]


@pytest.mark.parametrize(("make", "says"), NO_PATTERN.values(), ids=NO_PATTERN.keys())
def test_a_picture_without_the_whole_pattern_says_what_is_wrong(
    make: Callable[[Picture], bytes], says: str, pattern: Picture, tmp_path: Path
) -> None:
    (tmp_path / "my.png").write_bytes(make(pattern))
    line = refused_soon("calibrate", "my.png", "--out", "my.json", cwd=tmp_path)
    assert line.startswith("affcli: my.png: ")
    assert says in line
    assert names_in(tmp_path) == ["my.png"]


def test_a_marker_too_few_is_counted_and_a_thing_too_many_left_out(
    pattern: Picture, reference: dict[str, Any], tmp_path: Path
) -> None:
    """A hidden one leaves 35; a red disc between two rows, or at the edge, is no marker."""
    here, there = (reference["markers"][k] for k in (14, 21))
    x, y = (round(here[key]) for key in ("x_px", "y_px"))
    cv2.imwrite(str(tmp_path / "35.png"), cv2.circle(pattern.copy(), (x, y), 16, CARDBOARD, -1))
    line = refused_soon("calibrate", "35.png", cwd=tmp_path)
    assert "35 markers found instead of 36; uncover all of them and nothing else" in line
    x, y = (round((here[key] + there[key]) / 2) for key in ("x_px", "y_px"))
    for name, place in (("37.png", (x, y)), ("edge.png", (637, 329))):
        cv2.imwrite(str(tmp_path / name), cv2.circle(pattern.copy(), place, 6, RED, -1))
        found = calibrated(tmp_path / name)
        assert found["focal_length_mm"] == pytest.approx(reference["focal_length_mm"], abs=0.005)


@pytest.mark.parametrize("make", AS_GOOD.values(), ids=AS_GOOD.keys())
def test_the_same_pixels_give_the_same_calibration(
    make: Callable[[Picture], bytes], pattern: Picture, reference: dict[str, Any], tmp_path: Path
) -> None:
    (tmp_path / "my.png").write_bytes(make(pattern))
    found = calibrated(tmp_path / "my.png")
    assert {**found, "capture": {}} == reference  # which adds how the picture was taken


@pytest.mark.parametrize("make", NEARLY_AS_GOOD.values(), ids=NEARLY_AS_GOOD.keys())
def test_a_little_loss_does_little_harm(
    make: Callable[[Picture], bytes], pattern: Picture, reference: dict[str, Any], tmp_path: Path
) -> None:
    """The name's ending does not matter: a JPEG may be called *.png."""
    (tmp_path / "my.png").write_bytes(make(pattern))
    found = calibrated(tmp_path / "my.png")
    assert found["rms_px"] < 0.2
    assert found["focal_length_mm"] == pytest.approx(reference["focal_length_mm"], abs=0.05)
    assert found["translation_in"] == pytest.approx(reference["translation_in"], abs=0.5)


def test_a_smaller_picture_of_the_same_camera_gives_the_same_camera(
    pattern: Picture, reference: dict[str, Any], tmp_path: Path
) -> None:
    half = cv2.resize(pattern, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(tmp_path / "half.png"), half)
    found = calibrated(tmp_path / "half.png")
    assert (found["width_px"], found["height_px"]) == (320, 240)
    assert found["focal_length_mm"] == pytest.approx(reference["focal_length_mm"], abs=0.1)


def test_a_picture_of_another_size_than_the_calibrations_is_refused(
    pattern: Picture, calibration: Path, tmp_path: Path
) -> None:
    cv2.imwrite(str(tmp_path / "half.png"), cv2.resize(pattern, None, fx=0.5, fy=0.5))
    line = refused_soon("locate", "half.png", "--calibration", calibration, cwd=tmp_path)
    assert "half.png: 320x240 pixels, but the camera was calibrated at 640x480; take both" in line


def test_a_picture_that_shows_no_color_has_nothing_to_locate(
    calibration: Path, tmp_path: Path
) -> None:
    (tmp_path / "white.png").write_bytes(plain(255))
    line = refused_soon("locate", "white.png", "--calibration", calibration, cwd=tmp_path)
    assert "none of the colours is seen (puck, wrist, goal, " in line
    assert line.endswith("as it looks in the picture (--colors)")


PATHS: dict[str, tuple[Arg, str]] = {
    "missing": ("none.png", "none.png: No such file or directory; give a PNG or JPEG picture"),
    "a folder": (".", ".: Is a directory; give a PNG or JPEG picture"),
    "below a file": ("file/p.png", "file/p.png: Not a directory; give"),
    "no name": ("", ".: Is a directory"),
    "an empty device": ("/dev/null", "/dev/null: not a PNG or JPEG picture"),
    "without end": ("/dev/zero", "/dev/zero: more than 200000000 bytes"),
    "escape sequence": ("\x1b[31mred.png", "\\x1b[31mred.png: No such file"),
    "markup": ("[/].png", "[/].png: No such file"),
    "no character at all": (b"\xff.png", "\\udcff.png: No such file"),
    "10 kB": ("x" * 10_000, "File name too long"),
}


@pytest.mark.parametrize(("path", "says"), PATHS.values(), ids=PATHS.keys())
def test_a_path_without_a_picture_is_one_line(
    path: Arg, says: str, calibration: Path, tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    assert says in refused_soon("calibrate", path, cwd=tmp_path)
    assert says in refused_soon("locate", path, "--calibration", calibration, cwd=tmp_path)
    assert names_in(tmp_path) == ["file"]


def test_no_path_holds_a_nul(calibration: Path, tmp_path: Path) -> None:
    """No shell can give one, but a program can."""
    for args in (("calibrate", "p\0.png"), ("locate", "p\0.png", "--calibration", calibration)):
        assert "null byte" in refused(2, "camera", *args, cwd=tmp_path)


def test_a_strange_name_is_only_a_name(rendered: Path, tmp_path: Path) -> None:
    for name in (b"\xff.png", b"50% of #1?.jpg", b"[x] \xe6\x9c\xba", b"no ending"):
        path = Path(os.fsdecode(bytes(tmp_path) + b"/" + name))
        path.write_bytes(rendered.read_bytes())
        assert calibrated(path)["rms_px"] < 0.2
