"""A behavior of a file is segments of the wrist's motion, or refused in one line."""

import math
from pathlib import Path

import pytest

from affcli import registry
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import Pose
from affcli.core.motion import Carry, Slide, Turn, Wait, poses
from affcli.errors import BadInputError, UsageError
from affcli.own_files.behaviors import behavior_from_file

SHOVE = """
[behavior]
name = "shove"
[[segment]]
slide = [1, 4]
[[segment]]
turn = 30
[[segment]]
wait = 0.5
[[segment]]
carry = [5, 12, 90]
[[segment]]
carry = [0, 12]
"""


def written(path: Path, text: str) -> Path:
    file = path / "shove.toml"
    file.write_text(text)
    return file


def test_a_behavior_is_read_with_its_segments(tmp_path: Path) -> None:
    own = behavior_from_file(written(tmp_path, SHOVE))
    assert own.call == BehaviorCall.of(BehaviorName("shove"), {})
    away = Carry(Pose(5.0, 12.0, math.pi / 2))
    assert own.motion == (Slide(1.0, 4.0), Turn(30.0), Wait(0.5), away, Carry(Pose(0.0, 12.0)))
    way = poses(own.motion, Pose(1.0, 1.0))
    assert way[1:3] == (Pose(2.0, 5.0), Pose(2.0, 5.0, math.radians(30)))
    assert way[3:] == (way[2], away.to, Pose(0.0, 12.0))


def test_it_stands_in_a_repertoire_beside_ours(tmp_path: Path) -> None:
    file = str(written(tmp_path, SHOVE))
    names = [one.call.name for one in registry.repertoire(["extend-arm", file])]
    assert names == ["extend arm", "shove"]
    with pytest.raises(UsageError, match="shove comes twice"):
        registry.repertoire([file, file])


WRONG = {
    "": "needs a table [behavior] with name",
    "[behavior]\nname = 'a'": "0 segments: write 1 to 20, each under [[segment]]",
    "[behavior]\nname = 'a'\n[[segment]]\nwait = 1": "it only waits: let a segment slide",
    "[behavior]\nname = 'a'\n[segment]\nwait = 1": "write each segment under [[segment]]",
    SHOVE.replace("turn", "trun"): "no key of segment 2 'trun'; did you mean turn",
    SHOVE.replace("turn = 30", "turn = 30\nwait = 1"): "segment 2: give it one of slide, turn",
    SHOVE.replace("turn = 30", ""): "segment 2: give it one of slide, turn",
    SHOVE.replace("turn = 30", "turn = 361"): "segment 2: turn = 361: must be a number in -360",
    SHOVE.replace("turn = 30", "turn = true"): "segment 2: turn = True: must be a number",
    SHOVE.replace("wait = 0.5", "wait = -1"): "segment 3: wait = -1: must be a number in 0 to 600",
    SHOVE.replace("[1, 4]", "[1]"): "segment 1: slide: must be [x, y]",
    SHOVE.replace("[1, 4]", "4"): "segment 1: slide: must be [x, y]",
    SHOVE.replace("[1, 4]", "[1, 41]"): "segment 1: slide: [1, 41]: each must be a number in -40",
    SHOVE.replace("[5, 12, 90]", "[5, 12, 'a']"): "segment 4: carry, the angle = a: must be",
    SHOVE.replace("[5, 12, 90]", "[5, 12, 9, 9]"): "segment 4: carry: must be [x, y]",
    SHOVE.replace("[5, 12, 90]", "5"): "segment 4: carry: must be [x, y]",
    SHOVE + "[[segment]]\nwait = 1\n" * 16: "21 segments: write 1 to 20",
    SHOVE.replace("shove", "grasp"): "name: grasp is another one; give it another name",
    SHOVE.replace("shove", "../x"): "behavior: name = ../x: must be a word",
    SHOVE + "[tool]": "no table 'tool'; did you mean",
}


@pytest.mark.parametrize(("text", "words"), WRONG.items())
def test_what_is_wrong_is_named_with_its_place(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError) as told:
        behavior_from_file(written(tmp_path, text))
    assert words in str(told.value)
    assert str(told.value).startswith("behavior ")
    assert str(told.value).isprintable()


@pytest.mark.fault(23)
@pytest.mark.fault(27)
@pytest.mark.parametrize("number", ["nan", "inf", "1e999", "9" * 4000])
@pytest.mark.parametrize(
    "segment", ["slide = [0, {}]", "turn = {}", "wait = {}", "carry = [0, {}]"]
)
def test_what_is_no_number_never_reaches_the_engine(
    segment: str, number: str, tmp_path: Path
) -> None:
    text = f"[behavior]\nname = 'a'\n[[segment]]\n{segment.format(number)}"
    with pytest.raises(BadInputError, match="segment 1: "):
        behavior_from_file(written(tmp_path, text))


def test_a_name_of_ours_is_refused(tmp_path: Path) -> None:
    file = written(tmp_path, SHOVE.replace("shove", "extend arm"))
    with pytest.raises(
        BadInputError, match="extend arm is one of affcli's own behaviors; give another"
    ):
        registry.repertoire([str(file)])
