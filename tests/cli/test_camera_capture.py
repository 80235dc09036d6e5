"""A calibration and a picture belong together: both were turned, zoomed and taken alike."""

import json
import math
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from PIL.TiffImagePlugin import IFDRational

from tests.cli.camera_table import AS_IT_LIES, place
from tests.cli.program import Ended, done, refused

PUCK, WRIST = (-3.0, 22.4), (0.0, 14.9)
"""Where they are as a trial begins (in)."""
ORIENTATION, MAKE, MODEL = 0x0112, 0x010F, 0x0110
FOCAL_LENGTH, LENS, ZOOM, FOR_35MM, WIDTH, HEIGHT = 0x920A, 0xA434, 0xA404, 0xA405, 0xA002, 0xA003
STORED_AS = {
    1: lambda seen: seen,
    2: np.fliplr,
    3: lambda seen: seen[::-1, ::-1],
    4: np.flipud,
    5: lambda seen: seen.swapaxes(0, 1),
    6: lambda seen: np.rot90(seen, 1),
    7: lambda seen: np.rot90(seen.swapaxes(0, 1), 2),
    8: lambda seen: np.rot90(seen, -1),
}
"""How a camera that was held so stores what a person sees (TIFF 6.0, Orientation)."""


@pytest.fixture(scope="module")
def seen(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the simulated camera's pictures of pattern and table."""
    folder = tmp_path_factory.mktemp("seen")
    done("camera", "view", "--pattern", "--frame", "--out", "pattern.png", cwd=folder)
    done("camera", "view", "--frame", "--out", "table.png", cwd=folder)
    return folder


def saved(picture: Path, to: Path, notes: dict[int, Any], stored: int = 1) -> Path:
    """Save a picture as a JPEG file with notes (EXIF), its pixels turned as one camera stores them.

    Args:
        picture: what a person sees.
        to: the file.
        notes: by tag.
        stored: the orientation that would be right.
    """
    exif = Image.Exif()
    for tag, value in notes.items():
        where = exif if tag < 0x8000 else exif.get_ifd(0x8769)
        where[tag] = value
    pixels = np.ascontiguousarray(STORED_AS[stored](np.asarray(Image.open(picture))))
    Image.fromarray(pixels).save(to, "JPEG", quality=95, exif=exif)
    return to


def calibrated(seen: Path, folder: Path, notes: dict[int, Any], stored: int = 1) -> dict[str, Any]:
    """Calibrate from a picture of the pattern into cal.json; return what is in it.

    It is done once for each kind of picture.
    """
    known = seen / f"{stored} {sorted(notes.items())}".replace("/", ":")
    if not known.exists():
        saved(seen / "pattern.png", seen / "pattern.jpg", notes, stored)
        calibrate = ("camera", "calibrate", "pattern.jpg", *AS_IT_LIES)
        done(*calibrate, "--out", known.name, cwd=seen)
    shutil.copyfile(known, folder / "cal.json")
    value: dict[str, Any] = json.loads(known.read_text())
    return value


LOCATE = ("camera", "locate", "table.jpg", "--calibration", "cal.json")


def found(folder: Path) -> dict[str, tuple[float, float]]:
    """Return where puck and wrist are found."""
    return positions(done(*LOCATE, "--json", cwd=folder))


def positions(ended: Ended) -> dict[str, tuple[float, float]]:
    named = {one["name"]: one for one in ended.results}
    return {name: place(named[name]) for name in ("puck", "wrist")}


def near(places: dict[str, tuple[float, float]]) -> bool:
    return math.dist(places["puck"], PUCK) < 0.1 and math.dist(places["wrist"], WRIST) < 0.1


@pytest.mark.parametrize("flag", [1, 3, 6, 8])
def test_a_phone_that_flips_the_flag_changes_nothing(flag: int, seen: Path, tmp_path: Path) -> None:
    """It looks down on the table from one place; which way is up it can only guess."""
    calibrated(seen, tmp_path, {ORIENTATION: 1})
    saved(seen / "table.png", tmp_path / "table.jpg", {ORIENTATION: flag})
    assert near(found(tmp_path))


@pytest.mark.parametrize("held", STORED_AS)
def test_a_camera_may_be_held_in_any_way(held: int, seen: Path, tmp_path: Path) -> None:
    """The pattern is calibrated as a person sees it; later flags may be right, or another."""
    kept = calibrated(seen, tmp_path, {ORIENTATION: held}, held)["capture"]
    assert kept == {"orientation": held}
    for flag in (held, 1):
        saved(seen / "table.png", tmp_path / "table.jpg", {ORIENTATION: flag}, held)
        assert near(found(tmp_path))


def test_one_picture_without_its_flag_is_refused(seen: Path, tmp_path: Path) -> None:
    """Whoever took the flag away may have turned the pixels, or not."""
    calibrated(seen, tmp_path, {ORIENTATION: 3}, 3)
    saved(seen / "table.png", tmp_path / "table.jpg", {})
    line = refused(4, *LOCATE, cwd=tmp_path)
    assert "the calibration's picture was stored turned (EXIF orientation 3), and this does" in line
    calibrated(seen, tmp_path, {})
    saved(seen / "table.png", tmp_path / "table.jpg", {ORIENTATION: 3}, 3)
    line = refused(4, *LOCATE, cwd=tmp_path)
    assert "this picture was stored turned (EXIF orientation 3), and the calibration's doe" in line


def test_a_calibration_of_before_takes_pictures_that_nobody_turned(
    seen: Path, tmp_path: Path
) -> None:
    """Its file does not say how its picture was taken."""
    known = calibrated(seen, tmp_path, {ORIENTATION: 1})
    del known["capture"]
    (tmp_path / "cal.json").write_text(json.dumps(known))
    for notes in ({}, {ORIENTATION: 1}):
        saved(seen / "table.png", tmp_path / "table.jpg", notes)
        assert near(found(tmp_path))
    saved(seen / "table.png", tmp_path / "table.jpg", {ORIENTATION: 3}, 3)
    assert "and calibrate again" in refused(4, *LOCATE, cwd=tmp_path)


TAKEN = {
    MAKE: "Acme\0",
    MODEL: "Phone 5 ",
    LENS: "wide 1.8",
    FOCAL_LENGTH: IFDRational(424, 100),
    FOR_35MM: 26,
    ZOOM: IFDRational(0, 1),
    WIDTH: 4032,
    HEIGHT: 3024,
}
OTHERWISE: dict[str, tuple[dict[int, Any], str]] = {
    "camera": ({MODEL: "Phone 6"}, "camera Acme Phone 6, but that of the calibration's picture"),
    "lens": ({LENS: "tele"}, "lens tele, but that of the calibration's picture was wide 1.8"),
    "focal length": ({FOCAL_LENGTH: IFDRational(6)}, "focal length (mm) 6.0, but"),
    "crop": ({FOR_35MM: 52}, "focal length for 35 mm film 52.0, but that of the calibration's"),
    "zoom": ({ZOOM: IFDRational(2)}, "digital zoom 2.0, but that of the calibration's picture"),
    "size": ({WIDTH: 3024, HEIGHT: 3024}, "size when it was taken 3024x3024, but that of"),
}


def test_a_picture_that_was_taken_alike_or_says_nothing_is_read(seen: Path, tmp_path: Path) -> None:
    kept = calibrated(seen, tmp_path, TAKEN)["capture"]
    assert kept == {
        "camera": "Acme Phone 5",
        "lens": "wide 1.8",
        "focal_length_mm": 4.24,
        "focal_length_35mm": 26.0,
        "digital_zoom": 1.0,
        "captured_px": "4032x3024",
    }
    for notes in (TAKEN, {}, {ZOOM: IFDRational(1), FOCAL_LENGTH: IFDRational(42400, 10001)}):
        saved(seen / "table.png", tmp_path / "table.jpg", notes)
        assert near(found(tmp_path))


@pytest.mark.parametrize(("change", "says"), OTHERWISE.values(), ids=OTHERWISE.keys())
def test_a_picture_that_was_taken_otherwise_is_refused(
    change: dict[int, Any], says: str, seen: Path, tmp_path: Path
) -> None:
    """At another zoom, or through another lens, each pixel looks elsewhere."""
    calibrated(seen, tmp_path, TAKEN)
    saved(seen / "table.png", tmp_path / "table.jpg", {**TAKEN, **change})
    line = refused(4, *LOCATE, cwd=tmp_path)
    assert line.startswith(f"affcli: table.jpg: {says}")
    assert line.endswith("; take both pictures alike")


@pytest.mark.parametrize(
    "notes",
    [{FOCAL_LENGTH: IFDRational(0, 0), ZOOM: IFDRational(1, 0), FOR_35MM: 0}, {ORIENTATION: 9}],
)
def test_notes_that_make_no_sense_are_not_kept(
    notes: dict[int, Any], seen: Path, tmp_path: Path
) -> None:
    kept = calibrated(seen, tmp_path, notes)["capture"]
    assert set(kept) <= {"digital_zoom"}


BAD_CAPTURES = {
    "a list": ([1], "capture must be an object of texts and numbers"),
    "nested": ({"lens": {"a": 1}}, "capture must be an object of texts and numbers"),
    "orientation 9": ({"orientation": 9}, "capture.orientation must be 1 to 8"),
    "orientation in words": ({"orientation": "up"}, "capture.orientation must be 1 to 8"),
}


@pytest.mark.parametrize(("capture", "says"), BAD_CAPTURES.values(), ids=BAD_CAPTURES.keys())
def test_a_capture_that_affcli_did_not_write_is_named(
    capture: Any, says: str, seen: Path, tmp_path: Path
) -> None:
    known = calibrated(seen, tmp_path, {})
    (tmp_path / "cal.json").write_text(json.dumps({**known, "capture": capture}))
    saved(seen / "table.png", tmp_path / "table.jpg", {})
    assert f"cal.json: not a calibration ({says})" in refused(4, *LOCATE, cwd=tmp_path)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-32"])
def test_a_calibration_may_be_saved_in_any_encoding_of_unicode(
    encoding: str, seen: Path, tmp_path: Path
) -> None:
    """Editors put a mark before it, and some shells write UTF-16."""
    calibrated(seen, tmp_path, {})
    path = tmp_path / "cal.json"
    path.write_bytes(path.read_text().encode(encoding))
    saved(seen / "table.png", tmp_path / "table.jpg", {})
    assert near(found(tmp_path))


def test_another_encoding_is_named(seen: Path, tmp_path: Path) -> None:
    known = calibrated(seen, tmp_path, {})
    text = json.dumps({**known, "capture": {"lens": "Weitwinkel ä"}}, ensure_ascii=False)
    (tmp_path / "cal.json").write_bytes(text.encode("latin-1"))
    saved(seen / "table.png", tmp_path / "table.jpg", {})
    line = refused(4, *LOCATE, cwd=tmp_path)
    assert "cal.json: not a calibration (it is not UTF-8); save it as UTF-8" in line


def test_colours_may_begin_with_a_byte_order_mark(seen: Path, tmp_path: Path) -> None:
    calibrated(seen, tmp_path, {})
    saved(seen / "table.png", tmp_path / "table.jpg", {})
    text = "[puck]\nrgb = [240, 120, 20]\nheight = 0.5\n[wrist]\nrgb = [225, 50, 150]\n"
    (tmp_path / "my.toml").write_bytes(text.encode("utf-8-sig"))
    done(*LOCATE, "--colors", "my.toml", cwd=tmp_path)
    (tmp_path / "my.toml").write_bytes(text.encode("utf-16"))
    line = refused(4, *LOCATE, "--colors", "my.toml", cwd=tmp_path)
    assert "save it as UTF-8" in line


def test_a_file_too_large_for_a_picture_is_not_read(seen: Path, tmp_path: Path) -> None:
    """Whatever is in it: here a picture, and nothing for two gigabytes."""
    path = tmp_path / "pattern.png"
    path.write_bytes((seen / "pattern.png").read_bytes())
    with path.open("r+b") as file:
        file.truncate(2_000_000_000)
    line = refused(4, "camera", "calibrate", "pattern.png", cwd=tmp_path)
    assert "pattern.png: more than 200000000 bytes; give a PNG or JPEG picture" in line
