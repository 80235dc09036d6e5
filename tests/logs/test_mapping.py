"""The map of a log: what it says, and what is wrong in it, in one line that names the place."""

from pathlib import Path

import pytest

from affcli.errors import BadInputError
from tests.logs.made_up import MAP, mapped


def test_a_map_says_where_what_stands(tmp_path: Path) -> None:
    how = mapped(tmp_path, MAP)
    assert (how.source, how.licence) == ("made up for a test", "CC0")
    assert how.columns["end_x"] == 8
    assert how.length == pytest.approx(1.0 / 0.0254)
    assert (how.right, how.away) == ((1, 1.0), (0, -1.0))
    assert how.names["behavior"]["3"] == "draw"
    assert "source" not in how.tables["log"]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('source = "made up for a test"', "", "[log] needs source"),
        ("tool = 1\n", "", "where does tool stand?"),
        ("tool = 1\n", 'tool = "tool"\n', "columns.tool = tool: must be a column from 1"),
        ("tool = 1\n", "tool = 0\n", "columns.tool = 0"),
        ("tool = 1\n", "tool = true\n", "columns.tool = True"),
        ("tool = 1\n", "tol = 1\n", "did you mean tool"),
        ("end_x = 8", "end_x = 8\nwrist_x = 3", "both wrist_x and wrist_y"),
        ('length = "m"', 'length = "ell"', "units.length = ell: must be one of m, dm"),
        ('right = "y"', 'right = "x"', "one of x and one of y"),
        ('right = "y"', 'right = "z"', "axes.right = z"),
        ('3 = "draw"', "3 = 3", "names.behavior.3 = 3"),
        ('3 = "draw"', '3 = "a/b"', "names.behavior.3 = a/b"),
        ("[units]", "[unit]", "did you mean units"),
        ("[units]", "[constants]\ntool = 'a'\n[units]", "tool stands under [columns] and"),
        ("[units]", "[parameters]\n'a b' = 3\n[units]", "parameters: a b"),
        ('licence = "CC0"', "decimal = ';'", "log.decimal = ;"),
        ('licence = "CC0"', 'separator = "pipe"', "log.separator = pipe"),
        ('licence = "CC0"', "header = 1", "log.header = 1"),
        ('licence = "CC0"', f"licence = '{'x' * 3000}'", "1 to 2000 letters"),
    ],
)
def test_what_is_wrong_in_a_map_is_named(tmp_path: Path, old: str, new: str, says: str) -> None:
    assert MAP.count(old) == 1
    with pytest.raises(BadInputError) as told:
        mapped(tmp_path, MAP.replace(old, new))
    assert says in str(told.value)
    assert str(told.value).isprintable()
    assert str(tmp_path / "map.toml") in str(told.value)
