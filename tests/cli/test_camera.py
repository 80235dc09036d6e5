"""``affcli camera``: calibrate from a picture, then locate; what is asked wrongly or missing."""

import json
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import pytest
from rich.cells import cell_len

from tests.cli.camera_table import AS_IT_LIES, linked, located, photographed, place
from tests.cli.program import (
    Arg,
    Ended,
    affcli,
    done,
    names_in,
    one_printable_line,
    refused,
    rows,
)
from tests.cli.pseudo_terminal import COLOR, ESCAPE, on_terminal
from tests.cli.test_read_only import as_nobody
from tests.cli.without import without

ON_TABLE = {"puck": (-3.0, 22.4), "goal": (12.4, 22.4), "wrist": (0.0, 14.9)}
"""What lies where as a trial with the T-hook begins (in)."""
MARKER = {"x_px", "y_px", "x_in", "y_in", "residual_x_px", "residual_y_px"}
INSTALL = "affcli: the camera needs OpenCV and Pillow; install them: pip install 'affcli[camera]'"


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with pictures of pattern and table, and the calibration; not to be changed."""
    return photographed(tmp_path_factory.mktemp("camera"))


@pytest.fixture
def folder(shared: Path, tmp_path: Path) -> Path:
    """A folder of this test alone with pattern.png, table.png and cal.json."""
    return linked(shared, tmp_path)


def calibrated(*args: Arg, cwd: Path) -> dict[str, Any]:
    """Return what ``calibrate`` gives."""
    value: dict[str, Any] = done("camera", "calibrate", *args, "--json", cwd=cwd).result
    return value


def test_what_a_picture_of_the_pattern_gives_finds_what_is_on_the_table(tmp_path: Path) -> None:
    ended = done("camera", "view", "--pattern", "--frame", "--out", "p.png", cwd=tmp_path)
    assert ended.out == ""
    assert ended.err == "The calibration pattern, first marker at (-12.5, 9.2) in: p.png\n"
    calibrate = ("camera", "calibrate", "p.png", *AS_IT_LIES, "--out", "cal.json", "--json")
    ended = done(*calibrate, cwd=tmp_path)
    assert ended.err == "the calibration is in cal.json\n"
    assert json.loads((tmp_path / "cal.json").read_text()) == ended.result
    done("camera", "view", "--frame", "--out", "table.png", cwd=tmp_path)
    seen = located("--calibration", "cal.json", cwd=tmp_path)
    for name, truth in ON_TABLE.items():
        assert math.dist(place(seen[name]), truth) < 0.05
    conditions = {name: one["condition"] for name, one in seen.items()}
    once = {**dict.fromkeys(ON_TABLE, "once"), "t-hook": "once"}
    assert conditions == {**dict.fromkeys(("stick", "l-stick", "l-hook", "t-stick"), "no"), **once}
    assert [name for name, one in seen.items() if not one["places"]] == [
        name for name, condition in conditions.items() if condition == "no"
    ]
    assert names_in(tmp_path) == ["cal.json", "p.png", "table.png"]


def test_the_seed_decides_the_noise_in_a_picture(folder: Path) -> None:
    for name, args in {"pattern.png": ("--pattern",), "table.png": ()}.items():
        for seed in ("0", "1"):
            view = ("camera", "view", *args, "--frame", "--seed", seed)
            done(*view, "--out", f"{seed}.png", "--force", cwd=folder)
        assert (folder / "0.png").read_bytes() == (folder / name).read_bytes()
        assert (folder / "1.png").read_bytes() != (folder / name).read_bytes()


def test_beside_the_frame_is_what_the_robot_makes_of_it(folder: Path) -> None:
    done("camera", "view", "--out", "both.png", cwd=folder)
    both, frame = (cv2.imread(str(folder / name)) for name in ("both.png", "table.png"))
    assert both is not None
    assert frame is not None
    assert frame.shape == (480, 640, 3)
    assert both.shape[1] > 1280
    assert (both[:480, :640] == frame).all()
    assert (both[:480, -640:] != frame).any()


def test_the_color_of_the_markers_may_be_named(folder: Path) -> None:
    found = calibrated("pattern.png", *AS_IT_LIES, cwd=folder)
    for color in ("200,40,40", "#c82828", "#C82828"):
        args = ("pattern.png", *AS_IT_LIES, "--marker-color", color)
        assert calibrated(*args, cwd=folder) == found
    line = refused(4, "camera", "calibrate", "pattern.png", "--marker-color", "0,0,255", cwd=folder)
    assert "pattern.png: no markers found" in line


@pytest.mark.parametrize("turn", [0, 90, 180, 270])
def test_turn_says_how_the_pattern_lies(turn: int, folder: Path) -> None:
    """With 0 x runs to the right in the picture and y up; each 90 turns both to the left."""
    found = calibrated("pattern.png", "--turn", str(turn), "--origin", "3,-4", cwd=folder)
    first, along_x, along_y = (found["markers"][k] for k in (0, 5, 30))
    assert [(m["x_in"], m["y_in"]) for m in (first, along_x, along_y)] == [
        (3.0, -4.0),
        (28.0, -4.0),
        (3.0, 21.0),
    ]
    for marker, angle in ((along_x, turn), (along_y, turn + 90)):
        right, down = marker["x_px"] - first["x_px"], marker["y_px"] - first["y_px"]
        direction = math.cos(math.radians(angle)), -math.sin(math.radians(angle))
        assert right * direction[0] + down * direction[1] > 0.9 * math.hypot(right, down)


def test_spacing_and_sensor_width_are_the_units(folder: Path) -> None:
    """Half the spacing puts the camera at half the distance, twice the width doubles f."""
    found = calibrated("pattern.png", cwd=folder)
    nearer = calibrated("pattern.png", "--spacing", "2.5", cwd=folder)
    assert nearer["translation_in"] == pytest.approx([0.5 * t for t in found["translation_in"]])
    assert nearer["focal_length_mm"] == pytest.approx(found["focal_length_mm"])
    wider = calibrated("pattern.png", "--sensor-width", "9.6", cwd=folder)
    assert wider["focal_length_mm"] == pytest.approx(2.0 * found["focal_length_mm"], rel=1e-4)


def test_without_an_image_the_simulated_camera_is_calibrated(tmp_path: Path) -> None:
    found = calibrated(cwd=tmp_path)
    assert found["focal_length_mm"] == pytest.approx(5.29, abs=0.03)
    assert 0.0 < found["rms_px"] < 0.2
    assert len(found["markers"]) == 36
    residuals = []
    for marker in found["markers"]:
        assert marker.keys() == MARKER
        residuals += [marker["residual_x_px"], marker["residual_y_px"]]
    assert found["rms_px"] == pytest.approx(math.sqrt(sum(r * r for r in residuals) / 72))
    assert calibrated("--seed", "0", cwd=tmp_path) == found
    assert calibrated("--seed", "1", cwd=tmp_path)["markers"] != found["markers"]
    assert names_in(tmp_path) == []


def test_settings_move_the_simulated_camera(tmp_path: Path) -> None:
    config = tmp_path / "my.toml"
    config.write_text("[camera]\nfocal_length_mm = 5.0\n")
    found = calibrated("--config", "my.toml", cwd=tmp_path)
    assert found["focal_length_mm"] == pytest.approx(5.0, abs=0.03)
    config.write_text("[camera]\ntilt_degrees = 75.0\n")
    for command in (("calibrate",), ("view", "--out", "v.png")):
        line = refused(4, "camera", *command, "--config", "my.toml", cwd=tmp_path)
        assert line.endswith("; see the section camera of the settings")
    assert names_in(tmp_path) == ["my.toml"]


SHOWING = {
    "the simulated camera": ("calibrate",),
    "a picture": ("calibrate", "pattern.png", *AS_IT_LIES),
    "places": ("locate", "table.png", "--calibration", "cal.json"),
}


@pytest.mark.parametrize("columns", [80, 40])
@pytest.mark.parametrize("args", SHOWING.values(), ids=SHOWING.keys())
def test_nothing_is_wider_than_the_screen_or_cut_off(
    args: tuple[str, ...], columns: int, folder: Path
) -> None:
    ended = done("camera", *args, cwd=folder, COLUMNS=str(columns), TERM="xterm-256color")
    assert ended.err == ""
    assert max(map(cell_len, ended.out.splitlines())) <= columns
    assert "…" not in ended.out
    assert all(line.isprintable() for line in ended.out.splitlines())
    if args[0] == "calibrate":
        assert "focal length" in ended.out
        # 36 markers, and the error of all of them.
        assert ended.out.count("0.0") + ended.out.count("0.1") >= 37
    else:
        words = ended.out.split()
        assert words.count("once") == 4
        assert words.count("no") == 4
        assert {"puck", "22.40", "wrist", "14.91", "goal", "t-hook"} <= set(words)


def test_colors_on_the_terminal_are_for_those_who_want_them(folder: Path) -> None:
    args = ("camera", "locate", folder / "table.png", "--calibration", folder / "cal.json")
    code, shown = on_terminal(*args, NO_COLOR="1")
    assert code == 0
    assert not COLOR.search(shown)
    code, shown = on_terminal(*args, TERM="dumb")
    assert code == 0
    assert not ESCAPE.search(shown)
    assert shown == done(*args).out


BAD_OPTIONS: dict[str, tuple[tuple[str, ...], str]] = {
    "one number of markers": (("--markers", "6"), "--markers 6: must be columns x rows"),
    "no columns": (("--markers", "0x6"), "--markers 0x6: must be columns x rows, each 3 to 40"),
    "too few markers": (("--markers", "2x2"), "--markers 2x2: must be columns x rows, each 3"),
    "too many markers": (("--markers", "99x99"), "--markers 99x99: must be columns x rows"),
    "markers of 10 kB": (("--markers", "9" * 10_000), "--markers 999"),
    "other markers": (("--markers", "6x5"), "and no grid of 6x5 among them"),
    "no spacing": (("--spacing", "0"), "--spacing 0.0: must lie in 0.001 to 10000"),
    "spacing no number": (("--spacing", "nan"), "--spacing nan: must "),
    "negative spacing": (("--spacing", "-1"), "--spacing -1.0: must lie in 0.001 to 10000"),
    "infinite spacing": (("--spacing", "inf"), "--spacing inf: must "),
    "turned between": (("--turn", "45"), "--turn 45: must be one of 0, 90, 180, 270"),
    "one coordinate": (
        ("--origin", "1"),
        "--origin 1: must be 2 numbers within 10000, with commas between",
    ),
    "three coordinates": (("--origin", "1,2,3"), "--origin 1,2,3: must be 2 numbers"),
    "coordinate no number": (("--origin", "nan,0"), "--origin nan,0: must be 2 "),
    "coordinates in words": (("--origin", "here,\x1b[31m"), "--origin here,\\x1b[31m: must be 2"),
    "no colour": (("--marker-color", "nonsense"), "--marker-color nonsense: must be 3 numbers"),
    "short colour": (("--marker-color", "#c22"), "--marker-color #c22: must be 3 numbers"),
    "colour too bright": (("--marker-color", "300,0,0"), "300,0,0: each must lie in 0 to 255"),
    "grey colour": (("--marker-color", "128,128,128"), "too grey or too dark"),
    "dark colour": (("--marker-color", "#100000"), "too grey or too dark"),
    "no sensor": (("--sensor-width", "0"), "--sensor-width 0.0: must lie in 0.001 to 10000"),
    "seed": (("--seed", "-1"), "--seed -1: must lie in 0 to 2^63 - 1"),
    "missing settings": (("--config", "none.toml"), "none.toml"),
    "into no folder": (("--out", "none/cal.json"), "none/cal.json: its folder does not exist"),
    "over a folder": (("--out", ".", "--force"), ".: not a file; name another"),
    "below a file": (("--out", "cal.json/x"), "cal.json/x: its folder does not exist"),
    "over a file": (("--out", "cal.json"), "cal.json: exists already; name another file, or give"),
}
ONLY_SIMULATED = {"missing settings"}
"""What does not matter where there is a picture."""


@pytest.mark.parametrize("name", BAD_OPTIONS)
def test_a_bad_option_of_calibrate_is_named(name: str, folder: Path) -> None:
    args, says = BAD_OPTIONS[name]
    image = () if name in ONLY_SIMULATED else ("pattern.png",)
    before = (folder / "cal.json").read_bytes()
    assert says in refused(4, "camera", "calibrate", *image, *args, cwd=folder)
    assert (folder / "cal.json").read_bytes() == before
    assert names_in(folder) == ["cal.json", "pattern.png", "table.png"]


IGNORED: dict[str, tuple[tuple[str, ...], str]] = {
    "markers of no picture": (("--markers", "4x4"), "goes with an IMAGE of it; give one"),
    "spacing of no picture": (("--spacing", "2"), "goes with an IMAGE of it; give one"),
    "colour of no picture": (("--marker-color", "#c82828"), "goes with an IMAGE of it; give one"),
    "turn of no picture": (("--turn", "180"), "goes with an IMAGE of it; give one"),
    "seed of a picture": (("pattern.png", "--seed", "1"), "leave out IMAGE or them"),
    "settings of a picture": (("pattern.png", "--config", "my.toml"), "leave out IMAGE or them"),
}


@pytest.mark.parametrize(("args", "says"), IGNORED.values(), ids=IGNORED.keys())
def test_an_option_that_would_be_ignored_is_a_usage_error(
    args: tuple[str, ...], says: str, folder: Path
) -> None:
    assert says in refused(2, "camera", "calibrate", *args, cwd=folder)


def test_what_is_no_number_is_a_usage_error(folder: Path) -> None:
    for option in ("--spacing", "--turn", "--sensor-width", "--seed"):
        line = refused(2, "camera", "calibrate", "pattern.png", option, "much", cwd=folder)
        assert option in line
    assert "'IMAGE'" in refused(2, "camera", "locate", cwd=folder)
    assert "'--calibration'" in refused(2, "camera", "locate", "table.png", cwd=folder)


def test_without_a_command_it_says_which_there_are(tmp_path: Path) -> None:
    ended = affcli("camera", cwd=tmp_path)
    assert (ended.code, ended.err) == (0, "")
    for command in ("calibrate", "locate", "view"):
        assert f"\n  {command} " in ended.out


def test_a_file_is_written_over_only_by_force(folder: Path) -> None:
    mine = folder / "mine.json"
    mine.write_text("precious")
    line = refused(4, "camera", "calibrate", "--out", "mine.json", cwd=folder)
    assert line.endswith("mine.json: exists already; name another file, or give --force")
    assert mine.read_text() == "precious"
    done("camera", "calibrate", "--out", "mine.json", "--force", cwd=folder)
    assert len(json.loads(mine.read_text())["markers"]) == 36


@pytest.fixture
def public(shared: Path) -> Iterator[Path]:
    """A folder that everybody may enter but nobody write to, nor read its files."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path in shared.iterdir():
            (folder / path.name).write_bytes(path.read_bytes())
            (folder / path.name).chmod(0o000)
        folder.chmod(0o555)
        yield folder
        folder.chmod(0o755)


def test_where_one_may_not_write_or_read_is_named(public: Path) -> None:
    before = names_in(public)
    new, picture, calibration = (
        str(public / name) for name in ("new.png", "pattern.png", "cal.json")
    )
    writing = (("calibrate", "--out", new), ("view", "--out", new))
    reading = (("calibrate", picture), ("locate", picture, "--calibration", calibration))
    results = as_nobody(*(("camera", *args) for args in (*writing, *reading)))
    for ended, path in zip(results, (new, new, picture, calibration), strict=True):
        assert (ended.code, ended.out) == (4, "")
        line = one_printable_line(ended.err)
        assert line.startswith(f"affcli: {path}: ")
        assert ": Permission denied; " in line
    assert names_in(public) == before


@pytest.mark.parametrize("package", ["cv2", "PIL"])
def test_without_its_packages_the_camera_says_what_to_install(package: str) -> None:
    assert without(package, "camera", "calibrate") == Ended(2, "", f"{INSTALL}\n")


def test_without_opencv_nothing_else_is_missed(shared: Path, tmp_path: Path) -> None:
    pattern, table, calibration = (shared / n for n in ("pattern.png", "table.png", "cal.json"))
    database = tmp_path / "my.db"
    learn = ("learn", "--tool", "stick", "--behaviors", "5", "--db", database)
    for command in (
        ("camera", "calibrate", pattern),
        ("camera", "locate", table, "--calibration", calibration),
        ("camera", "view", "--out", tmp_path / "v.png"),
        (*learn, "--sensor", "camera"),
    ):
        assert without("cv2", *command) == Ended(2, "", f"{INSTALL}\n")
    assert names_in(tmp_path) == []
    ended = without("cv2", *learn)
    assert ended.code == 0
    assert "what the stick affords" in ended.out
    assert rows(database, "SELECT status, calibration FROM learning_run") == [("done", None)]


@pytest.mark.parametrize("package", ["cv2", "PIL"])
@pytest.mark.parametrize("command", [("solve", "--goal", "2"), ("break-tool",)])
def test_without_its_packages_no_trial_through_the_camera_is_begun(
    package: str, command: tuple[str, ...], learned: Path
) -> None:
    before = rows(learned, "SELECT count(*) FROM session")
    ended = without(package, *command, "--sensor", "camera", "--db", learned)
    assert ended == Ended(2, "", f"{INSTALL}\n")
    assert rows(learned, "SELECT count(*) FROM session") == before


def test_a_table_of_miles_is_drawn_without_a_warning(tmp_path: Path) -> None:
    """Its corners lie where the model of the lens has no place for them."""
    config = tmp_path / "miles.toml"
    config.write_text("table.far = 316000\ntools.handle_length = 1460\ncamera.height = 39\n")
    assert "no markers found" in refused(4, "camera", "calibrate", "--config", config)
