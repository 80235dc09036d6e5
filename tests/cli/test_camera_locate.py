"""``affcli camera locate``: a calibration, or colours, of one's own; and what is none."""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from tests.cli.camera_table import linked, located, photographed, place
from tests.cli.program import done, refused

PUCK, WRIST = (-3.0, 22.4), (0.0, 14.9)
"""Where they are as a trial begins (in)."""


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a picture of the table and the calibration; not to be changed."""
    return photographed(tmp_path_factory.mktemp("camera"))


@pytest.fixture
def folder(shared: Path, tmp_path: Path) -> Path:
    """A folder of this test alone with table.png and cal.json."""
    return linked(shared, tmp_path)


BAD_CALIBRATIONS: dict[str, tuple[bytes | dict[str, Any], str]] = {
    "not JSON": (b"focal length 5.3 mm", "not a calibration (Expecting value"),
    "empty": (b"", "not a calibration (Expecting value"),
    "not text": (b"\xff\xfe\x00\xd8", "not a calibration ("),
    "a list": (b"[1, 2]", "not a calibration (no JSON object)"),
    "of another kind": (b'{"run": 1, "tool": "stick"}', "not a calibration (no 'width_px' in it)"),
    "deeply nested": (b'{"a":' * 100_000, "not a calibration (nested too deeply: more than 20"),
    "deeply nested list": (b"[" * 100_000, "not a calibration (nested too deeply: more than 20"),
    "2 MB": (b" " * 2_000_000, "my.json: more than 1000000 bytes"),
    "without end": (b"", "/dev/zero: more than 1000000 bytes"),
    "past any float": ({"focal_length_mm": 10**400}, "not a calibration (int too large"),
    "past any float in rows": ({"rotation": [[10**400, 0, 0]] * 3}, "not a calibration ("),
    "a mirror": ({"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}, "the axes of a camera"),
    "a truth for a size": ({"width_px": True}, "width_px must be a whole number"),
    "NaN": ({"focal_length_mm": math.nan}, "all numbers must lie within"),
    "infinite": ({"distortion_per_mm2": math.inf}, "all numbers must lie within"),
    "an infinite place": ({"translation_in": [0, math.inf, 0]}, "all numbers must lie within"),
    "no focal length": (
        {"focal_length_mm": 0.0},
        "sensor width and focal length must be at least 0.001 mm",
    ),
    "text": ({"focal_length_mm": "long"}, "could not convert string to float: 'long'"),
    "nothing": ({"sensor_width_mm": None}, "not a calibration (float() argument must"),
    "half a pixel": ({"width_px": 640.5}, "width_px must be a whole number from 1 to 100000"),
    "no pixels": ({"height_px": 0}, "height_px must be a whole number from 1 to 100000"),
    "absurdly wide": ({"width_px": 10**1000}, "width_px must be a whole number from 1 to 100000"),
    "two axes": ({"rotation": [[1, 0, 0], [0, 1, 0]]}, "rotation must be 3 by 3"),
    "uneven axes": ({"rotation": [[1, 0, 0], [0, 1], [0]]}, "not a calibration (setting an array"),
    "stretched": ({"rotation": [[2, 0, 0], [0, 1, 0], [0, 0, 1]]}, "must be the axes of a camera"),
    "skew": ({"rotation": [[1, 0, 0], [0.1, 1, 0], [0, 0, 1]]}, "must be the axes of a camera"),
}


@pytest.mark.parametrize(
    ("content", "says"), BAD_CALIBRATIONS.values(), ids=BAD_CALIBRATIONS.keys()
)
def test_what_is_no_calibration_is_named(
    content: bytes | dict[str, Any], says: str, folder: Path
) -> None:
    path = Path("/dev/zero") if "/dev/zero" in says else folder / "my.json"
    if isinstance(content, dict):
        known = json.loads((folder / "cal.json").read_text())
        content = json.dumps({**known, **content}).encode()
    (folder / "my.json").write_bytes(content)
    line = refused(4, "camera", "locate", "table.png", "--calibration", path, cwd=folder)
    assert says in line


def test_a_calibration_that_cannot_be_read_is_named(folder: Path) -> None:
    for path, says in {"none.json": "No such file", ".": "Is a dir", "x" * 999: "too long"}.items():
        line = refused(4, "camera", "locate", "table.png", "--calibration", path, cwd=folder)
        assert says in line
        assert line.endswith(
            "; give a file that `affcli camera calibrate PICTURE --out FILE` wrote"
        )


def test_a_line_of_sight_that_misses_the_table_has_no_place(folder: Path) -> None:
    """A camera that looks at the horizon sees half of what it sees above it."""
    known = json.loads((folder / "cal.json").read_text())
    known["rotation"] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    (folder / "my.json").write_text(json.dumps(known))
    places = [one["places"] for one in located("--calibration", "my.json", cwd=folder).values()]
    assert any(seen[0]["x_in"] is None for seen in places if seen)


def test_own_colors_are_found_by_name(folder: Path) -> None:
    """Their height takes them to their place: the puck's middle is 0.5 in over the table."""
    (folder / "my.toml").write_text(
        '[ball]\nrgb = [240, 120, 20]\nheight = 0.5\n\n["my [/] hand"]\nrgb = [225.0, 50.0, 150]\n'
        "\n[moon]\nrgb = [240, 240, 20]\n"
    )
    args = ("--calibration", "cal.json", "--colors", "my.toml")
    seen = located(*args, cwd=folder)
    assert list(seen) == ["ball", "my [/] hand", "moon"]
    assert [one["condition"] for one in seen.values()] == ["once", "once", "no"]
    assert math.dist(place(seen["ball"]), PUCK) < 0.05
    assert math.dist(place(seen["my [/] hand"]), WRIST) > 0.2
    shown = done("camera", "locate", "table.png", *args, cwd=folder).out
    assert "my [/] hand  once " in shown


BAD_COLORS = {
    "not TOML": (b"my ball is orange", "colors my.toml: not TOML"),
    "not text": (b"\xff\xfe\x00", "colors my.toml: not TOML"),
    "deeply nested": (b"a = " + b"[" * 100_000, "colors my.toml: not TOML"),
    "2 MB": (b"# a long remark\n" * 125_000, "colors my.toml: more than 1000000 bytes"),
    "empty": (b"", "colors my.toml: no colour in it; name one"),
    "unknown key": (b"[a]\nrgb = [240, 120, 20]\nhue = 30", "[a] must hold rgb = [red, green, b"),
    "no colour": (b"[a]\nheight = 1.0", "[a] must hold rgb = [red, green, blue], and height"),
    "no section": (b"rgb = [240, 120, 20]", "[rgb] must hold rgb = [red, green, blue]"),
    "too bright": (b"[a]\nrgb = [256, 0, 0]", "a.rgb = [256, 0, 0] must lie in [0, 255]"),
    "negative": (b"[a]\nrgb = [-1, 0, 0]", "a.rgb = [-1, 0, 0] must lie in [0, 255]"),
    "NaN": (b"[a]\nrgb = [nan, 0, 255]", "a.rgb = [nan, 0, 255] must lie in [0, 255]"),
    "two numbers": (b"[a]\nrgb = [1, 2]", "a.rgb = [1, 2] must be three numbers"),
    "a word": (b'[a]\nrgb = "red"', "a.rgb = red must be three numbers"),
    "a truth": (b"[a]\nrgb = [true, 0, 0]", "a.rgb = [True, 0, 0] must be three numbers"),
    "6,000 digits": (b"[a]\nrgb = [0x" + b"f" * 6000 + b", 0, 0]", "a.rgb = (list too large"),
    "below": (b"[a]\nrgb = [255, 0, 0]\nheight = -1", "a.height = -1 must lie in [0, "),
    "height NaN": (b"[a]\nrgb = [255, 0, 0]\nheight = nan", "a.height = nan must lie in [0, "),
    "height in words": (b'[a]\nrgb = [255, 0, 0]\nheight = "1"', "a.height = 1 must be a number"),
    "alike": (
        b"[a]\nrgb = [240, 120, 20]\n[b]\nrgb = [120, 58, 10]",
        "b (120, 58, 10) and a differ by less than 12 degrees of hue; paint one of them",
    ),
    "grey": (b"[a]\nrgb = [128, 130, 128]", "a (128, 130, 128) is too grey or too dark"),
    "dark": (b"[a]\nrgb = [40, 0, 0]", "a (40, 0, 0) is too grey or too dark"),
    "not seen": (b"[moon]\nrgb = [240, 240, 20]", "none of the colours is seen (moon); uncover it"),
    "escape sequence": (b'["\\u001b[31mred"]\nrgb = [0, 0, 0]', "\\x1b[31mred (0, 0, 0) is too"),
    "10 kB name": (b"[" + b"x" * 10_000 + b"]\nrgb = [0, 0, 0]", "more than 100 letters"),
}


@pytest.mark.parametrize(("text", "says"), BAD_COLORS.values(), ids=BAD_COLORS.keys())
def test_bad_colors_are_named(text: bytes, says: str, folder: Path) -> None:
    (folder / "my.toml").write_bytes(text)
    args = ("--calibration", "cal.json", "--colors", "my.toml")
    assert says in refused(4, "camera", "locate", "table.png", *args, cwd=folder)


def test_colors_that_cannot_be_read_are_named(folder: Path) -> None:
    for path in ("none.toml", "."):
        args = ("--calibration", "cal.json", "--colors", path)
        line = refused(4, "camera", "locate", "table.png", *args, cwd=folder)
        assert line.startswith(f"affcli: colors {path}: ")
        assert line.endswith("; give a TOML file that can be read")


def test_a_height_above_the_camera_is_named(folder: Path) -> None:
    (folder / "my.toml").write_text("[cup]\nrgb = [240, 120, 20]\nheight = 60.0\n")
    args = ("--calibration", "cal.json", "--colors", "my.toml")
    line = refused(4, "camera", "locate", "table.png", *args, cwd=folder)
    assert "cup.height lies above the camera, which is 52.0 in over the table" in line
