"""``affcli camera view``: pictures and videos of what is stored, and what cannot be shown."""

import math
import shlex
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import pytest

from affcli.perception.rendering import Picture
from tests.cli.program import (
    PROGRAM,
    ROOT,
    Arg,
    done,
    environment,
    names_in,
    one_printable_line,
    refused,
    rows,
)

MOVED = ", ".join(
    f"{what}_{axis}"
    for what in ("wrist_start", "wrist_end", "true_start", "true_end")
    for axis in "xy"
)
FAR = "abs(true_end_x - true_start_x) + abs(true_end_y - true_start_y)"
NEAR = 0.15
"""How near (in) what is located in a picture lies to what is stored; a tool may hide some of it."""


@pytest.fixture(scope="module")
def calibration(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the robot of seed 0 knows about its camera."""
    path = tmp_path_factory.mktemp("view") / "calibration.json"
    done("camera", "calibrate", "--out", path)
    return path


def view(*args: Arg) -> str:
    """Make a picture or video; return what is said of it."""
    ended = done("camera", "view", *args)
    assert ended.out == ""
    return ended.err


def seen_in(picture: Path, calibration: Path) -> dict[str, list[dict[str, Any]]]:
    """Return what is where in a picture, by name."""
    found = done("camera", "locate", picture, "--calibration", calibration, "--json").results
    return {seen["name"]: seen["places"] for seen in found}


def distance(places: Sequence[dict[str, Any]], truth: Sequence[float]) -> float:
    """Return how far from the truth (in) the only place lies where something is seen."""
    (place,) = places
    return math.dist((place["x_in"], place["y_in"]), truth)


def frames_of(path: Path) -> list[Picture]:
    """Return the pictures of a video, which runs at 15 a second."""
    video = cv2.VideoCapture(str(path))
    assert video.isOpened()
    assert video.get(cv2.CAP_PROP_FPS) == 15.0
    frames: list[Picture] = []
    while True:
        read, frame = video.read()
        if not read:
            video.release()
            return frames
        frames.append(frame.astype("uint8"))


def farthest(database: Path) -> tuple[int, int, tuple[float, ...]]:
    """Return trial, number and places of the step with a whole tool that moved the puck most."""
    ((trial, number, *places),) = rows(
        database,
        f"""SELECT trial_id, number, {MOVED} FROM step JOIN trial ON trial.id = trial_id
        WHERE status = 'done' AND tool = shape ORDER BY {FAR} DESC LIMIT 1""",
    )
    return trial, number, tuple(places)


def test_before_and_after_a_step_things_are_seen_where_they_were(
    used: Path, calibration: Path, tmp_path: Path
) -> None:
    trial, number, places = farthest(used)
    stored = used.read_bytes()
    step = ("--trial", str(trial), "--step", str(number), "--frame", "--db", used)
    for moment, after in (("before", ()), ("after", ("--after",))):
        picture = tmp_path / f"{moment}.png"
        said = view(*step, *after, "--out", picture)
        assert said.startswith(f"Trial {trial}, step {number} of ")
        assert f", {moment} " in said
        assert said.endswith(f": {picture}\n")
        wrist, puck = (places[2:4], places[6:8]) if after else (places[0:2], places[4:6])
        seen = seen_in(picture, calibration)
        assert distance(seen["wrist"], wrist) < NEAR
        assert distance(seen["puck"], puck) < NEAR
    assert math.dist(places[4:6], places[6:8]) > 10 * NEAR
    assert used.read_bytes() == stored
    assert names_in(tmp_path) == ["after.png", "before.png", used.name]


def test_a_behavior_of_a_learning_run_is_shown_too(
    learned: Path, calibration: Path, tmp_path: Path
) -> None:
    """The robot babbles without a goal."""
    ((number, *places),) = rows(
        learned,
        f"""SELECT step, {MOVED} FROM behavior WHERE learning_run_id = 2 AND status = 'done'
        ORDER BY {FAR} DESC LIMIT 1""",
    )
    step = ("--run", "2", "--step", str(number), "--frame", "--db", learned)
    picture = tmp_path / "after.png"
    said = view(*step, "--after", "--out", picture)
    assert said.startswith(f"Run 2, behavior {number} of 800, after ")
    seen = seen_in(picture, calibration)
    assert distance(seen["wrist"], places[2:4]) < NEAR
    assert distance(seen["puck"], places[6:8]) < NEAR
    assert seen["goal"] == []
    assert seen["stick"] != []


def test_the_same_step_gives_the_same_picture(used: Path, tmp_path: Path) -> None:
    """And others give others, though nothing but the noise may differ."""
    steps = {"first": ("3", "1"), "again": ("3", "1"), "next": ("3", "2"), "other": ("4", "1")}
    for name, (trial, number) in steps.items():
        view("--trial", trial, "--step", number, "--db", used, "--out", tmp_path / f"{name}.png")
    first, again, later, other = ((tmp_path / f"{name}.png").read_bytes() for name in steps)
    assert first == again
    assert len({first, later, other}) == 3


def test_a_broken_tool_is_smaller_and_has_the_color_of_the_whole_one(
    used: Path, calibration: Path, tmp_path: Path
) -> None:
    pixels = []
    for protocol in ("tool adaptation", "extension of reach"):
        ((trial,),) = rows(
            used,
            f"""SELECT min(trial_id) FROM step JOIN trial ON trial.id = trial_id
            WHERE tool = 't-hook' AND protocol = '{protocol}'""",
        )
        picture = tmp_path / f"{protocol}.png"
        view("--trial", str(trial), "--frame", "--db", used, "--out", picture)
        seen = seen_in(picture, calibration)
        assert seen["l-hook"] == []
        pixels.append(sum(place["area_px"] for place in seen["t-hook"]))
    broken, whole = pixels
    assert 0.3 * whole < broken < 0.9 * whole


@pytest.mark.parametrize("ending", [".avi", ".MP4"])
def test_a_video_ends_as_the_step_ended(
    ending: str, used: Path, calibration: Path, tmp_path: Path
) -> None:
    trial, number, places = farthest(used)
    step = ("--trial", str(trial), "--step", str(number), "--frame", "--db", used)
    path = tmp_path / f"film{ending}"
    said = view(*step, "--video", path)
    assert said.startswith(f"Trial {trial}, step {number} of ")
    assert said.endswith(f": {path}\n")
    frames = frames_of(path)
    assert len(frames) >= 10
    assert {frame.shape for frame in frames} == {(480, 640, 3)}
    cv2.imwrite(str(tmp_path / "last.png"), frames[-1])
    seen = seen_in(tmp_path / "last.png", calibration)
    assert distance(seen["wrist"], places[2:4]) < NEAR
    assert distance(seen["puck"], places[6:8]) < NEAR
    assert names_in(tmp_path) == [path.name, "last.png", used.name]


def test_a_picture_and_a_video_are_made_at_once(used: Path, tmp_path: Path) -> None:
    """With the segmentation beside the frame both are of one size."""
    picture, video = tmp_path / "v.png", tmp_path / "v.avi"
    said = view("--trial", "1", "--db", used, "--out", picture, "--video", video)
    assert len(said.splitlines()) == 2
    shown = cv2.imread(str(picture))
    assert shown is not None
    assert shown.shape[1] > 1280
    assert {frame.shape for frame in frames_of(video)} == {shown.shape}


def test_a_step_that_was_blocked_moved_the_wrist_alone(
    used: Path, calibration: Path, tmp_path: Path
) -> None:
    """The tool was carried there and could not be lowered; the film ends with that."""
    blocked = rows(
        used, f"SELECT trial_id, number, {MOVED} FROM step WHERE status IS NULL ORDER BY 1, 2"
    )
    if not blocked:
        pytest.skip("no step was blocked")
    trial, number, *places = blocked[0]
    step = ("--trial", str(trial), "--step", str(number), "--frame", "--db", used)
    view(*step, "--out", tmp_path / "before.png", "--video", tmp_path / "film.avi")
    view(*step, "--after", "--out", tmp_path / "after.png")
    cv2.imwrite(str(tmp_path / "last.png"), frames_of(tmp_path / "film.avi")[-1])
    for name, wrist in (("before", places[0:2]), ("after", places[2:4]), ("last", places[2:4])):
        seen = seen_in(tmp_path / f"{name}.png", calibration)
        assert distance(seen["wrist"], wrist) < NEAR
        assert distance(seen["puck"], places[4:6]) < NEAR


USAGE: dict[str, tuple[tuple[str, ...], str]] = {
    "nowhere": (("--trial", "1"), "where to? give --out FILE.png, or --video FILE.mp4"),
    "a video of nothing": (("--video", "v.avi"), "a video of what? give --trial ID or --run ID"),
    "a video of the pattern": (("--pattern", "--video", "v.avi"), "a video of what?"),
    "a step of nothing": (("--step", "2", "--out", "v.png"), "--step and --after go with --trial"),
    "after nothing": (("--after", "--out", "v.png"), "--step and --after go with --trial"),
    "pattern and trial": (
        ("--pattern", "--trial", "1", "--out", "v.png"),
        "give one of --trial, --run and --pattern",
    ),
    "run and trial": (("--run", "1", "--trial", "1", "--out", "v.png"), "give one of --trial, "),
    "trial in words": (("--trial", "first", "--out", "v.png"), "--trial "),
    "unknown trial": (("--trial", "99", "--out", "v.png"), "no trial 99; they are numbered 1 to "),
    "unknown step": (
        ("--trial", "1", "--step", "99", "--out", "v.png"),
        "no step 99 in trial 1; it has steps 1 to ",
    ),
    "unknown run": (
        ("--run", "3", "--out", "v.png"),
        "no learning run 3; they are numbered 1 to 2",
    ),
    "unknown behavior": (
        ("--run", "1", "--step", "801", "--out", "v.png"),
        "no behavior 801 in run 1; it has 1 to 800",
    ),
}

PLACES: dict[str, tuple[tuple[str, ...], str]] = {
    "a JPEG": (("--out", "v.jpg"), "v.jpg: name it *.png"),
    "no ending": (("--out", "v"), "v: name it *.png"),
    "a GIF of a step": (("--trial", "1", "--video", "v.gif"), "v.gif: name it *.mp4 or *.avi"),
    "over a picture": (
        ("--out", "mine.png"),
        "mine.png: exists already; name another file",
    ),
    "over a video": (("--trial", "1", "--video", "mine.avi"), "mine.avi: exists already; name ano"),
    "over the first of two": (
        ("--trial", "1", "--out", "mine.png", "--video", "v.avi"),
        "mine.png: exists already",
    ),
    "over the second of two": (
        ("--trial", "1", "--out", "v.png", "--video", "mine.avi"),
        "mine.avi: exists already",
    ),
    "into no folder": (("--out", "none/v.png"), "none/v.png: its folder does not exist; make it"),
    "a video into no folder": (
        ("--trial", "1", "--video", "none/v.mp4"),
        "none/v.mp4: its folder does not exist",
    ),
    "over a folder": (("--out", "folder.png", "--force"), "folder.png: not a file; name another"),
    "10 kB": (("--out", "x" * 10_000 + ".png"), "File name too long"),
    "escape sequence": (("--out", "\x1b[31mred"), "\\x1b[31mred: name it *.png"),
    "seed": (("--out", "v.png", "--seed", "-1"), "--seed -1: must lie in 0 to 2^63 - 1"),
    "missing settings": (("--out", "v.png", "--config", "none.toml"), "config none.toml: No such"),
}


@pytest.fixture
def folder(used: Path) -> Path:
    """A folder with a database, used.db, and a few files that are not to be touched."""
    for name in ("mine.png", "mine.avi"):
        (used.parent / name).write_text("precious")
    (used.parent / "folder.png").mkdir()
    return used.parent


@pytest.mark.parametrize(
    ("code", "args", "says"),
    [(code, *one) for code, all_ in ((2, USAGE), (4, PLACES)) for one in all_.values()],
    ids=[*USAGE, *PLACES],
)
def test_what_cannot_be_shown_is_one_line_and_no_file(
    code: int, args: tuple[str, ...], says: str, folder: Path
) -> None:
    before = names_in(folder)
    line = refused(code, "camera", "view", *args, "--db", "used.db", cwd=folder)
    assert says in line
    assert names_in(folder) == before
    assert (folder / "mine.png").read_text() == (folder / "mine.avi").read_text() == "precious"


def test_files_are_written_over_by_force(folder: Path) -> None:
    args = ("--trial", "1", "--db", "used.db", "--out", "mine.png", "--video", "mine.avi")
    before = names_in(folder)
    done("camera", "view", *args, "--force", cwd=folder)
    assert cv2.imread(str(folder / "mine.png")) is not None
    assert len(frames_of(folder / "mine.avi")) >= 10
    assert names_in(folder) == before


def test_a_strange_name_is_only_a_name(used: Path) -> None:
    names = ["[x] %03d;.avi", "č机.mp4"]
    show = ("camera", "view", "--trial", "1", "--frame", "--db", used)
    for name in names:
        done(*show, "--video", name, cwd=used.parent)
        assert len(frames_of(used.parent / name)) >= 10
    done("camera", "view", "--out", b"\xff.png", cwd=used.parent)
    assert names_in(used.parent) == sorted([*names, "\udcff.png", used.name])


@pytest.mark.parametrize("args", [("--trial", "1"), ("--run", "1")])
def test_without_a_database_there_is_nothing_stored(args: tuple[str, str], tmp_path: Path) -> None:
    (tmp_path / "diary.db").write_text("Dear diary,\n" * 500)
    show = ("camera", "view", *args, "--out", "v.png")
    assert "none.db: no database there" in refused(3, *show, "--db", "none.db", cwd=tmp_path)
    assert "not a SQLite database" in refused(3, *show, "--db", "diary.db", cwd=tmp_path)
    assert names_in(tmp_path) == ["diary.db"]


def test_before_any_trial_it_says_that_there_is_none(learned: Path) -> None:
    show = ("camera", "view", "--trial", "1", "--out", "v.png", "--db", learned)
    assert "no trial 1; there are none yet" in refused(2, *show, cwd=learned.parent)


@pytest.mark.parametrize("ending", [".mp4", ".avi"])
def test_on_a_full_disk_no_video_is_left_and_none_is_promised(
    ending: str, used: Path, tmp_path: Path
) -> None:
    """OpenCV itself says nothing of it."""
    before = names_in(tmp_path)
    program = shlex.join([*PROGRAM, "camera", "view", "--db", str(used), "--trial", "1", "--video"])
    ended = subprocess.run(
        ["/bin/sh", "-c", f"ulimit -f 40; {program} full{ending}"],
        cwd=tmp_path,
        env=environment(PYTHONPATH=str(ROOT)),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert ended.returncode == 4
    assert one_printable_line(ended.stderr).startswith("affcli: ")
    assert "make room" in ended.stderr
    assert names_in(tmp_path) == before


@pytest.mark.parametrize("option", ["--trial", "--run", "--step"])
def test_numbers_that_no_record_has_are_bad_input(option: str, tmp_path: Path) -> None:
    trial = () if option != "--step" else ("--trial", "1")
    view = ("camera", "view", "--out", "x.png", *trial)
    for number in ("0", "-9223372036854775808", "9223372036854775808"):
        line = refused(4, *view, option, number, cwd=tmp_path)
        assert f"{option} {number}: must lie in 1 to 9223372036854775807" in line


def test_a_stored_step_has_its_own_seed_and_settings(used: Path, tmp_path: Path) -> None:
    for own in (("--seed", "3"), ("--config", tmp_path / "x.toml")):
        line = refused(2, "camera", "view", "--db", used, "--trial", "1", "--out", "x.png", *own)
        assert "leave out --seed, --config and --set" in line
