"""A tool that a person drew is read as it is, or refused in one line that names the place."""

import json
import re
from pathlib import Path

import pytest

from affcli import registry
from affcli.core.tool import Color, tool_from_canonical
from affcli.core.workspace import ToolGeometry
from affcli.errors import BadInputError
from affcli.own_files.tools import tool_from_file

HEAD = 'name = "rake"\ncolor = [110, 230, 200]'
SQUARE = "[[-1, 0], [1, 0], [1, 2], [-1, 2]]"
HOOK = "[[-0.4, 0], [0.4, 0], [0.4, 12], [4, 12], [4, 9], [5, 9], [5, 13], [-0.4, 13]]"
TWO = f"""
[tool]
{HEAD}
[[part]]
name = "handle"
outline = {SQUARE}
[[part]]
name = "tine"
outline = {HOOK}
"""


def written(path: Path, text: str) -> Path:
    file = path / "rake.toml"
    file.write_text(text)
    return file


def test_a_tool_is_read_with_its_parts(tmp_path: Path) -> None:
    tool = tool_from_file(written(tmp_path, TWO))
    assert (tool.name, tool.color) == ("rake", Color((110.0, 230.0, 200.0)))
    names = [part.name for part in tool.parts]
    assert names[0] == "handle"
    assert names[1:] == [f"tine {n}" for n in range(1, len(names))]
    assert sum(part.outline.area for part in tool.parts) == pytest.approx(4.0 + 0.8 * 13 + 4.6 + 3)


def test_one_outline_is_the_whole_tool(tmp_path: Path) -> None:
    tool = tool_from_file(written(tmp_path, f"[tool]\n{HEAD}\noutline = {HOOK}"))
    assert {part.name.split()[0] for part in tool.parts} == {"outline"}


def test_a_tool_of_a_file_is_a_tool_by_its_value(tmp_path: Path) -> None:
    """Where the file lies, and what its text looks like, is nothing of it."""
    here = registry.tool(str(written(tmp_path, TWO)), ToolGeometry())
    (tmp_path / "there").mkdir()
    changed = TWO.replace("-1, 0", "-1.0,   0.0").replace('"handle"', "'handle'")
    there = registry.tool(str(written(tmp_path / "there", changed)), ToolGeometry())
    assert (here, here.key) == (there, there.key)


WRONG = {
    "": "needs a table [tool]",
    "[tool]\n[tols]": "'tols'; did you mean tool",
    f"[tool]\n{HEAD}": "give either an outline under [tool], or parts",
    f"[tool]\n{HEAD}\noutline = {SQUARE}\n[[part]]\nname = 'a'\noutline = {SQUARE}": "give either",
    f"[tool]\n{HEAD}\nwings = 2": "'wings'; did you mean",
    f"[tool]\n{HEAD}\n[part]\nname = 'a'": "write each part under [[part]]",
    f"[tool]\n{HEAD}\n[[part]]\nnane = 'a'": "key of part 1 'nane'; did you mean name",
    f"[tool]\n{HEAD}\n[[part]]\nname = 'a'": "part 1: outline: must be a list of corners",
    f"[tool]\n{HEAD}\n[[part]]\noutline = {SQUARE}": "part 1: name: must be a word",
    f"[tool]\ncolor = [1, 2, 3]\noutline = {SQUARE}": "tool: name: must be a word",
    f"[tool]\nname = 'a'\noutline = {SQUARE}": "tool: color: must be [red, green, blue]",
    TWO.replace("tine", "handle"): "two parts have one name",
    TWO.replace("[1, 0]", "[1, 0, 2]"): "part 1: outline, corner 2: must be [x, y]",
    TWO.replace("[1, 0]", "[1, 'a']"): "part 1: outline, corner 2",
    TWO.replace("[1, 0]", "[1, true]"): "part 1: outline, corner 2",
    TWO.replace("[1, 0]", "[2, 2], [1, 0]"): "part 1: outline: its edges",
    TWO.replace("[1, 0]", "[1, 41]"): "each must be a number in -40 to 40 in",
    TWO.replace("110", "256"): "each 0 to 255",
    TWO.replace("110", "-1"): "each 0 to 255",
}


@pytest.mark.parametrize(("text", "words"), WRONG.items())
def test_what_is_wrong_is_named_with_its_place(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError) as caught:
        tool_from_file(written(tmp_path, text))
    said = str(caught.value)
    assert words in said
    assert said.startswith("tool ")
    assert said.isprintable()


BROKEN = f'{TWO}[broken]\nloses = ["tine"]\n'


def test_a_file_says_which_parts_break_off(tmp_path: Path) -> None:
    """Also of a part that was cut."""
    tool = tool_from_file(written(tmp_path, BROKEN))
    assert tool.loses == ("tine",)
    left = tool.without(tool.loses)
    assert ([part.name for part in left.parts], left.loses) == (["handle"], ())
    whole = tool_from_file(written(tmp_path, TWO))
    assert whole.key != tool.key
    assert tool_from_canonical(json.loads(json.dumps(tool.canonical()))) == tool


@pytest.mark.parametrize(
    ("loses", "words"),
    [
        ('["handle", "tine"]', "broken: loses: nothing would be left of the rake"),
        ('["tines"]', "broken: loses: no part of the rake 'tines'; did you mean tine"),
        ("[]", "broken: loses: must be names of parts in a list"),
        ('"tine"', "broken: loses: must be names of parts in a list"),
        ('["tine"]\nlooses = 1', "no key of broken 'looses'; did you mean loses"),
    ],
)
def test_what_cannot_break_off_is_refused(loses: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match=re.escape(words)):
        tool_from_file(written(tmp_path, BROKEN.replace('["tine"]', loses)))


@pytest.mark.fault(23)
@pytest.mark.fault(27)
@pytest.mark.parametrize("number", ["nan", "inf", "-inf", "1e999", "9" * 4000, "1e300"])
def test_what_is_no_length_never_reaches_the_engine(number: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match="part 1: outline, corner 2"):
        tool_from_file(written(tmp_path, TWO.replace("[1, 0]", f"[{number}, 0]")))


@pytest.mark.fault(24)
@pytest.mark.fault(27)
@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            f"[tool]\n{HEAD}\noutline = [" + "[0, 0]," * 100_000 + "]",
            "99999 corners: give 3 to 500",
        ),
        (TWO + "\n" + "# \n" * 400_000, "more than 1000000 bytes"),
        (TWO.replace(SQUARE, "[" * 9_000), "nested too deeply"),
    ],
)
def test_a_file_that_is_too_much_is_refused(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match=words):
        tool_from_file(written(tmp_path, text))


@pytest.mark.fault(20)
@pytest.mark.parametrize(
    "name", ["../../x", "/etc/x", "a:b", "a,b", "-rm", " a", "a\\u001b[31m", "", "x" * 41]
)
def test_a_name_that_means_something_else_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match="tool: name"):
        tool_from_file(written(tmp_path, TWO.replace("rake", name)))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("rake", "t-hook"), "t-hook is one of affcli's own tools; give another name"),
        (("110, 230, 200", "200, 60, 50"), "its color is taken for that of the stick"),
        (("-1, 0], [1, 0], [1, 2], [-1, 2", "3, -2], [4, -2], [4, 2], [3, 2"), "nothing to grasp"),
    ],
)
def test_a_tool_that_robots_cannot_tell_or_hold_is_refused(
    change: tuple[str, str], words: str, tmp_path: Path
) -> None:
    file = written(tmp_path, TWO.replace(*change))
    with pytest.raises(BadInputError, match=words):
        registry.tool(str(file), ToolGeometry())
