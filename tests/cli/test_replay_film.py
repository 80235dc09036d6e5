"""``affcli replay --gif``: what the film shows, how long it is, and where it cannot be written."""

import math
import shlex
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from affcli.core.tool import ToolName
from affcli.simulation.tools.paper import TOOL_COLORS
from tests.cli.program import (
    PROGRAM,
    ROOT,
    Ended,
    done,
    environment,
    names_in,
    one_printable_line,
    refused,
    rows,
)
from tests.cli.test_read_only import as_nobody
from tests.cli.test_replay import SOLVED, same
from tests.cli.without import without

SIZE = (480, 460)
PX = 13.55
"""Pixels an inch; the middle of the table's picture is the point below."""
MIDDLE, MIDDLE_PX = (0.0, 17.55), (240.0, 253.0)
ORANGE = (230, 159, 0)
"""The attractor, and the path that it has taken."""
INSTALL = (
    "affcli: figures need Matplotlib and Pillow; install them: pip install 'affcli[figures]'\n"
)

Picture = NDArray[np.uint8]


def filmed(database: Path, *args: str, name: str = "film.gif") -> tuple[list[Picture], list[int]]:
    """Film a trial; return the pictures and how long each is shown (ms)."""
    path = database.parent / name
    ended = done("replay", *args, "--gif", path, "--force", "--db", database)
    assert ended.out == ""
    first, *_, last = ended.err.splitlines()
    assert first.startswith(f"trial {args[0]}, step")
    assert first.endswith(f": {path}")
    assert f"{last}\n" == same(args[0], database)
    pictures, shown = [], []
    with Image.open(path) as film:
        assert film.format == "GIF"
        assert film.size == SIZE
        assert film.info["loop"] == 0
        for frame in range(getattr(film, "n_frames", 1)):
            film.seek(frame)
            shown.append(int(film.info["duration"]))
            pictures.append(np.asarray(film.convert("RGB")))
    return pictures, shown


def place(picture: Picture, color: tuple[float, ...]) -> tuple[float, float]:
    """Return the middle of all that has a colour (in, table frame)."""
    off = np.abs(picture.astype(float) - np.array(color)).max(axis=2)
    down, across = np.nonzero(off < 16)
    x = MIDDLE[0] + (across.mean() - MIDDLE_PX[0]) / PX
    return x, MIDDLE[1] - (down.mean() - MIDDLE_PX[1]) / PX


@pytest.mark.parametrize("speed", ["0.5", "1", "3.7", "10", "100"])
def test_a_film_lasts_as_long_as_the_robot_took_by_the_speed(speed: str, used: Path) -> None:
    """Steps 2 to 4 begin when step 1 has ended; each picture stands for a stretch of that time."""
    clock = f"SELECT clock FROM step WHERE trial_id = {SOLVED} AND number IN (1, 4) ORDER BY number"
    (began,), (ended,) = rows(used, clock)
    pictures, shown = filmed(used, SOLVED, "--steps", "2-4", "--speed", speed)
    picture = max(1, round(float(speed))) / 15.0 / float(speed)
    took = (ended - began) / float(speed)
    assert sum(shown) / 1e3 == pytest.approx(took, abs=2 * picture + 0.01)
    assert min(shown) >= 40
    assert 2 <= len(pictures) <= math.ceil(took / picture) + 2
    assert all((a != b).any() for a, b in pairwise(pictures))


def test_a_film_of_all_steps_holds_those_of_each(used: Path) -> None:
    _, whole = filmed(used, SOLVED)
    parts = [sum(filmed(used, SOLVED, "--steps", step)[1]) for step in "1234"]
    assert sum(whole) == pytest.approx(sum(parts), abs=40)


@pytest.mark.parametrize("speed", ["1", "100"])
@pytest.mark.parametrize("trial", ["1", SOLVED])
def test_a_film_ends_as_the_trial_ended(trial: str, speed: str, used: Path) -> None:
    """However fast it is; and the tool has its colour, by which alone the robot knows it (§7.2)."""
    ((tool, x, y),) = rows(
        used,
        "SELECT tool, true_end_x, true_end_y FROM step JOIN trial ON trial.id = trial_id"
        f" WHERE trial_id = {trial} ORDER BY number DESC LIMIT 1",
    )
    pictures, _ = filmed(used, trial, "--speed", speed)
    paler = tuple(0.75 * part + 0.25 * 255.0 for part in TOOL_COLORS[ToolName(tool)])
    assert place(pictures[-1], paler) is not None
    after = place(pictures[-1], ORANGE)
    assert math.dist(after, (x, y)) < 3.0  # the path is orange too
    before = place(pictures[0], ORANGE)
    start = rows(used, f"SELECT true_start_x, true_start_y FROM step WHERE trial_id = {trial}")[0]
    assert math.dist(before, start) < 0.3


def test_the_same_trial_gives_the_same_bytes(used: Path) -> None:
    for name in ("first.gif", "again.gif"):
        filmed(used, SOLVED, name=name)
    filmed(used, "6", name="other.gif")
    first, again, other = (
        (used.parent / f"{name}.gif").read_bytes() for name in ("first", "again", "other")
    )
    assert first == again
    assert first != other


def test_a_film_and_the_json_are_made_at_once(used: Path) -> None:
    args = ("replay", SOLVED, "--steps", "2", "--speed", "20", "--db", used)
    ended = done(*args, "--json", "--gif", used.parent / "film.gif")
    assert [step["step"] for step in ended.result["steps"]] == [2]
    assert ended.err.endswith(same(SOLVED, used))


def test_a_broken_tool_is_filmed_in_the_colour_of_the_whole_one(used: Path) -> None:
    ((trial,),) = rows(used, "SELECT min(id) FROM trial WHERE shape = 'l-hook'")
    pictures, _ = filmed(used, str(trial), "--steps", "1")
    green = tuple(0.75 * part + 0.25 * 255.0 for part in TOOL_COLORS[ToolName("t-hook")])
    off = np.abs(pictures[-1].astype(float) - np.array(green)).max(axis=2)
    assert (off < 16).sum() > 1000


def test_what_would_be_too_long_can_be_shorter_or_faster(reproduced: Path) -> None:
    """These robots stand still for 50 s in each step."""
    ((trial,),) = rows(reproduced, "SELECT min(id) FROM trial WHERE steps = 6")
    film = ("replay", str(trial), "--gif", reproduced.parent / "film.gif", "--db", reproduced)
    line = refused(4, *film)
    assert " pictures: at most 4500; give --steps A-B or more --speed" in line
    assert names_in(reproduced.parent) == [reproduced.name]
    assert done(*film, "--speed", "50").code == 0


PLACES = {
    "another ending": (("--gif", "film.mp4"), "film.mp4: name it *.gif"),
    "no ending": (("--gif", "film"), "film: name it *.gif"),
    "over a film": (("--gif", "mine.gif"), "mine.gif: exists already; name another file, or give"),
    "over a folder": (("--gif", "folder.gif", "--force"), "folder.gif: not a file; name another"),
    "into no folder": (("--gif", "none/film.gif"), "none/film.gif: its folder does not exist"),
    "10 kB": (("--gif", "x" * 10_000 + ".gif"), "File name too long"),
    "escape sequence": (("--gif", "\x1b[31mred"), "\\x1b[31mred: name it *.gif"),
}


@pytest.mark.parametrize(("args", "says"), PLACES.values(), ids=PLACES.keys())
def test_where_no_film_can_be_is_one_line(args: tuple[str, ...], says: str, used: Path) -> None:
    """Before any work: though no such trial is there."""
    mine, folder = used.parent / "mine.gif", used.parent / "folder.gif"
    mine.write_text("precious")
    folder.mkdir()
    before = names_in(used.parent)
    for trial in (SOLVED, "999"):
        line = refused(4, "replay", trial, *args, "--db", used, cwd=used.parent)
        assert says in line
    assert names_in(used.parent) == before
    assert mine.read_text() == "precious"


def test_a_film_is_written_over_by_force(used: Path) -> None:
    mine = used.parent / "mine.gif"
    mine.write_text("precious")
    film = ("replay", SOLVED, "--speed", "20", "--gif", mine, "--db", used)
    done(*film, "--force")
    assert mine.read_bytes().startswith(b"GIF89a")


@pytest.fixture
def public(used: Path) -> Iterator[Path]:
    """`used` in a folder that everybody may enter and nobody write to."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(shutil.copy(used, f"{name}/kept.db"))
        path.chmod(0o444)
        path.parent.chmod(0o555)
        yield path
        path.parent.chmod(0o755)


def test_a_folder_that_may_not_be_written_to_is_named(public: Path) -> None:
    film = str(public.parent / "film.gif")
    (ended,) = as_nobody(("replay", SOLVED, "--gif", film, "--db", str(public)))
    assert (ended.code, ended.out) == (4, "")
    line = one_printable_line(ended.err)
    assert line == f"affcli: {film}: cannot be written: Permission denied; name another file"
    assert names_in(public.parent) == [public.name]


def test_on_a_full_disk_no_film_is_left_and_none_is_promised(used: Path, tmp_path: Path) -> None:
    before = names_in(tmp_path)
    program = shlex.join([*PROGRAM, "replay", SOLVED, "--db", str(used), "--gif", "full.gif"])
    ended = subprocess.run(
        ["/bin/sh", "-c", f"ulimit -f 20; {program}"],
        cwd=tmp_path,
        env=environment(PYTHONPATH=str(ROOT)),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert ended.returncode == 4
    line = one_printable_line(ended.stderr)
    assert line == "affcli: full.gif: cannot be written: File too large; name another file"
    assert names_in(tmp_path) == before


@pytest.mark.parametrize("package", ["matplotlib", "PIL"])
def test_without_its_packages_a_film_says_what_to_install(package: str, used: Path) -> None:
    """Before any work: though no such trial is there. All else is shown without them."""
    before = names_in(used.parent)
    for trial in (SOLVED, "999"):
        film = ("replay", trial, "--gif", used.parent / "film.gif", "--db", used)
        assert without(package, *film) == Ended(2, "", INSTALL)
    assert names_in(used.parent) == before
    for shown in ((SOLVED,), (SOLVED, "--json"), ("--run", "1", "--steps", "1-3")):
        assert without(package, "replay", *shown, "--db", used).code == 0
