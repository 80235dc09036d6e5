"""What every figure of ``affcli figure`` has: caption, title, width, pixels; and their limits."""

from pathlib import Path
from typing import Any

import cv2
import pytest

from affcli.cli.app import program
from affcli.report import figures
from tests.cli.program import Arg, done, names_in, refused

SHARED = {"--out", "--width", "--dpi", "--title", "--no-caption", "--force"}
DRAWS: dict[str, tuple[str, ...]] = {
    "affordances": (),
    "row": ("1",),
    "workspace": (),
    "tools": (),
    "learning": (),
    "trial": ("9",),
    "results": (),
    "adaptation": (),
    "prediction": ("--pushes", "20"),
}
OF_NOTHING = {"workspace", "tools"}
NOT_DEFAULT = "not default: sensor.position_noise = 0.02"


def commands() -> dict[str, Any]:
    """Return the commands that draw, by name."""
    return {name: one.loaded for name, one in program.commands["figure"].commands.items()}


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """What each figure that is written gets over and under it, and of how many pixels.

    Only those of a title that was given are drawn: other tests draw all figures.
    """
    written: list[dict[str, Any]] = []
    encoded = figures.canvas.encoded

    def noted(*args: Any, **words: Any) -> bytes:
        written.append(words)
        return encoded(*args, **words) if words["title"].startswith("Mine") else b"drawn"

    monkeypatch.setattr(figures.canvas, "encoded", noted)
    return written


def size(path: Path) -> tuple[int, int]:
    """Return width and height of a picture (pixels)."""
    picture = cv2.imread(str(path))
    assert picture is not None
    return picture.shape[1], picture.shape[0]


def test_every_figure_has_the_same_page_options() -> None:
    """A figure that is registered later has them too."""
    found = commands()
    assert set(DRAWS) <= set(found)
    for name, command in found.items():
        options = {option for one in command.params for option in one.opts}
        assert options >= SHARED, name


@pytest.mark.parametrize("name", DRAWS)
def test_a_figure_is_as_wide_as_asked_in_inches_and_pixels(name: str, used: Path) -> None:
    """Its title and its caption make it higher, and change nothing else."""
    database = () if name in OF_NOTHING else ("--db", used)
    sizes = []
    for number, more in enumerate((("--title", "", "--no-caption"), ())):
        out = used.with_name(f"{number}.png")
        draw = ("figure", name, *DRAWS[name], *database, "--width", "3.3", "--dpi", "110")
        done(*draw, "--out", out, *more)
        sizes.append(size(out))
    (bare_width, bare_height), (width, height) = sizes
    assert width == bare_width == round(3.3 * 110)
    strips = height - bare_height
    assert 2 * 0.2 * 110 < strips < 1.0 * 110


@pytest.mark.parametrize(("width", "dpi"), [(3, 50), (3.5, 200), (3.55, 300), (7, 300), (7.1, 96)])
def test_pixels_are_inches_times_dpi(width: float, dpi: int, tmp_path: Path) -> None:
    out = tmp_path / "f.png"
    done("figure", "tools", "--width", str(width), "--dpi", str(dpi), "--out", out)
    assert size(out)[0] == round(width * dpi)


@pytest.mark.parametrize("name", ["affordances", "row", "learning", "prediction"])
def test_a_caption_says_run_seed_and_what_is_not_default(
    name: str, empty: Path, told: list[dict[str, Any]]
) -> None:
    learn = ("learn", "--tool", "l-stick", "--behaviors", "90", "--seed", "7", "--db", empty)
    done(*learn, "--set", "sensor.position_noise=0.02")
    of_tool = ("--tool", "l-stick") if name != "row" else ()
    draw = ("figure", name, *DRAWS[name], *of_tool, "--db", empty, "--force")
    draw = (*draw, "--out", empty.with_name("f.svg"))
    said = done(*draw).err
    done(*draw, "--no-caption")
    done(*draw, "--title", "")
    done(*draw, "--title", "Mine: $\\alpha$ 机 ✓")
    captions, titles = [one["caption"] for one in told], [one["title"] for one in told]
    assert "run 1: L-stick, seed 7, " in captions[0]
    assert NOT_DEFAULT in captions[0]
    assert said == f"{titles[0]}; {captions[0]}: {draw[-1]}\n"
    assert captions[1:] == ["", captions[0], captions[0]]
    assert titles == [titles[0], titles[0], "", "Mine: $\\alpha$ 机 ✓"]
    assert titles[0]


@pytest.mark.parametrize("name", ["trial", "results", "adaptation"])
def test_a_caption_of_trials_names_session_or_runs(
    name: str, used: Path, told: list[dict[str, Any]]
) -> None:
    done("figure", name, *DRAWS[name], "--db", used, "--out", used.with_name("f.svg"))
    (page,) = told
    assert "run 1: T-hook, seed " in page["caption"]
    assert {"adaptation": "session 2 (break-tool), 1 robot, seed 0"}.get(name, "") in page[
        "caption"
    ]
    assert page["dpi"] == 300


BAD: dict[str, tuple[tuple[str, ...], str]] = {
    "narrow": (("--width", "2.9"), "--width 2.9: must lie in 3 to 15"),
    "wide": (("--width", "15.1"), "--width 15.1: must lie in 3 to 15"),
    "no number": (("--width", "nan"), "--width nan: must lie in 3 to 15"),
    "endless": (("--width", "inf"), "--width inf: must lie in 3 to 15"),
    "coarse": (("--dpi", "49"), "--dpi 49: must lie in 50 to 600"),
    "fine": (("--dpi", "601"), "--dpi 601: must lie in 50 to 600"),
    "huge": (("--dpi", "9" * 60), "must lie in 50 to 600"),
    "long": (("--title", "x" * 201), "--title of 201 letters: at most 200 fit"),
}


@pytest.mark.parametrize("what", BAD)
def test_what_no_page_can_be_is_one_line_and_no_file(what: str, tmp_path: Path) -> None:
    options, says = BAD[what]
    args: tuple[Arg, ...] = ("figure", "tools", "--out", tmp_path / "f.png", *options)
    assert says in refused(4, *args)
    assert names_in(tmp_path) == []
