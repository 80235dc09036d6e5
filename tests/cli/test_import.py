"""The log of another robot: imported whole or not at all, and then asked like any run."""

import math
from pathlib import Path
from typing import Any

import pytest

from affcli.store import check
from tests.cli.program import done, refused, rows
from tests.logs.made_up import OBJECTS, REPEATS, TOOLS, written

PATTERN = "log/**/*.txt"


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the made-up log, its map, and a database into which it was imported."""
    folder = written(tmp_path_factory.mktemp("log"))
    done("import", PATTERN, "--map", "map.toml", "--db", "log.db", cwd=folder)
    return folder


def asked(folder: Path, *words: Any) -> Any:
    """Return what a command answers of the imported log."""
    return done(*words, "--db", "log.db", "--json", cwd=folder).results


def test_each_tool_becomes_a_run(imported: Path) -> None:
    runs = asked(imported, "runs", "list")
    assert [run["tool"] for run in runs] == sorted(TOOLS)
    for run in runs:
        assert run["behaviors"] == len(OBJECTS) * 4 * REPEATS
        assert run["robot_seconds"] is None
        assert run["seed"] is None
    assert not [one for one in check(imported / "log.db") if one.wrong]
    assert "from log" in done("runs", "list", "--db", "log.db", cwd=imported).out


def test_which_tool_pulls(imported: Path) -> None:
    found = asked(imported, "which", "nearer", "--by", "5cm", "--behavior", "draw")
    assert [(one["tool"], one["moved"], one["tried"]) for one in found] == [
        ("hook", 12, 12),
        ("rake", 12, 12),
        ("stick", 0, 12),
    ]
    assert found[0]["inches"] == pytest.approx(5 / 2.54)
    best = asked(imported, "which", "left", "--tool", "rake")[0]
    assert (best["behavior"], best["moved"]) == ("tap from right", 12)
    said = done("which", "farther", "--db", "log.db", cwd=imported)
    assert "most often farther: the" in said.err
    assert "did you mean nearer" in refused(2, "which", "near", "--db", "log.db", cwd=imported)
    for length in ("5ell", "-1", "nan", "0", ""):
        assert "--by" in refused(4, "which", "left", "--by", length, "--db", "log.db", cwd=imported)


def test_where_a_row_comes_from_is_kept(imported: Path) -> None:
    (shown,) = asked(imported, "table", "show", "3")
    assert shown["logged"]["name"] == "log/hook/ball/1.txt"
    assert (shown["logged"]["line"], shown["logged"]["object"]) == (3, "ball")
    assert len(shown["logged"]["sha256"]) == 64
    assert shown["from_wrist"] == [None, None]
    (run,) = asked(imported, "runs", "show", "1")
    assert (run["log"]["licence"], run["log"]["citation"]) == ("CC0", "Nobody, A log (2026)")
    assert len(run["log"]["files"]) == len(OBJECTS) * 4
    text = done("runs", "show", "1", "--db", "log.db", cwd=imported).out
    assert "made up for a test" in text
    assert "nan" not in text + done("table", "show", "3", "--db", "log.db", cwd=imported).out


def test_what_the_log_lacks_is_null(imported: Path) -> None:
    nothing = "sum(start_wrist_to_object_x IS NOT NULL OR object_is OR wrist_angle IS NOT NULL)"
    query = f"SELECT {nothing}, count(*), min(start_object_x) FROM (SELECT *, start_object_z "
    query += "IS NOT NULL OR end_tool_red IS NOT NULL AS object_is FROM affordance_wide)"
    ((known, count, x),) = rows(imported / "log.db", query)
    assert known == 0
    assert count > 100
    assert math.isfinite(x)
    ((text,),) = rows(imported / "log.db", "SELECT start_observation FROM affordance_table LIMIT 1")
    assert text.endswith(", -) from wrist (-, -, -) object rgb (-, -, -) tool rgb (-, -, -)")


@pytest.mark.parametrize(
    "words",
    [
        ("report",),
        ("report", "--html", "out.html"),
        ("table", "list", "--tool", "rake"),
        ("table", "export", "--out", "out.csv"),
        ("figure", "affordances", "--run", "1", "--out", "out.svg"),
        ("figure", "row", "2", "--out", "out.svg"),
        ("figure", "prediction", "--run", "2", "--out", "out.svg"),
        ("predict", "--tool", "rake"),
        ("sql", "select * from affordance_table"),
    ],
    ids=" ".join,
)
def test_it_is_asked_like_any_run(imported: Path, words: tuple[str, ...]) -> None:
    force = ("--force",) if {"--out", "--html"} & set(words) else ()
    assert "nan" not in done(*words, *force, "--db", "log.db", cwd=imported).out.split()


def test_each_trial_is_predicted_by_the_others(imported: Path) -> None:
    (answer,) = asked(imported, "predict", "--tool", "rake")
    whole = answer["scores"][-1]
    assert whole["moved"] == len(OBJECTS) * 4 * REPEATS
    assert whole["by_row"]["degrees"] < 30.0
    assert whole["as_wrist"]["inches"] is None


@pytest.mark.parametrize(
    "words",
    [
        ("solve", "--run", "1", "--goal", "1"),
        ("verify", "--run", "1"),
        ("break-tool", "--run", "1", "--becomes", "stick"),
        ("replay", "--run", "1"),
        ("predict", "--run", "1", "--sensor", "exact"),
        ("predict", "--run", "1", "--shape", "t-hook"),
    ],
    ids=" ".join,
)
def test_what_needs_a_robot_says_so_in_a_line(imported: Path, words: tuple[str, ...]) -> None:
    line = refused(4, *words, "--db", "log.db", cwd=imported)
    assert "the hook of this run comes from a log: there is no robot" in line


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("solve", "--goal", "1"), "but from a log, which no robot can use"),
        (("verify", "--tool", "rake"), "nothing learned with the rake in log.db but from a log"),
        (("figure", "learning", "--out", "a.svg"), "comes from a log without times"),
        (
            ("figure", "affordances", "--run", "1", "--compare", "2", "--out", "a.svg"),
            "does not say where the tool was",
        ),
    ],
)
def test_what_the_log_lacks_switches_off_what_needs_it(
    imported: Path, words: tuple[str, ...], says: str
) -> None:
    assert says in refused(2, *words, "--db", "log.db", cwd=imported)


def test_a_tool_of_a_log_does_not_take_the_place_of_one_that_was_learned(tmp_path: Path) -> None:
    """Both are called stick: solving takes the robot's, looking the latest."""
    written(tmp_path)
    db = ("--db", "both.db")
    done("learn", "--tool", "stick", "--minutes", "1", *db, cwd=tmp_path)
    done("import", PATTERN, "--map", "map.toml", *db, cwd=tmp_path)
    done("solve", "--goal", "2", "--tool", "stick", *db, cwd=tmp_path)
    assert rows(tmp_path / "both.db", "SELECT DISTINCT learning_run_id FROM trial") == [(1,)]
    drawn = done("figure", "learning", "--out", "a.svg", *db, cwd=tmp_path).err
    assert "run 1: Stick" in " ".join(drawn.split())
    found = done("which", "nearer", "--tool", "stick", *db, "--json", cwd=tmp_path).results
    assert {one["run"] for one in found} == {4}


def test_a_dry_run_writes_nothing(tmp_path: Path) -> None:
    written(tmp_path)
    ended = done("import", PATTERN, "--map", "map.toml", "--dry-run", "--json", cwd=tmp_path)
    assert [one["run"] for one in ended.results] == [None] * len(TOOLS)
    assert "nothing was written" in ended.err
    assert not list(tmp_path.glob("*.db"))


def test_the_same_log_again_is_there_already(imported: Path) -> None:
    before = rows(imported / "log.db", "SELECT * FROM learning_run")
    again = done("import", PATTERN, "--map", "map.toml", "--db", "log.db", "--json", cwd=imported)
    assert [one["new"] for one in again.results] == [False] * len(TOOLS)
    assert "imported before" in again.err
    assert rows(imported / "log.db", "SELECT * FROM learning_run") == before


def test_bad_lines_are_counted_and_named_or_refuse_the_log(tmp_path: Path) -> None:
    written(tmp_path, bad=7)
    line = refused(4, "import", PATTERN, "--map", "map.toml", "--strict", cwd=tmp_path)
    assert "a line of the log cannot be read: 7 lines; the first: " in line
    assert "1.txt:1: 4 columns, the map names 9" in line
    assert not list(tmp_path.glob("*.db"))
    ended = done("import", PATTERN, "--map", "map.toml", "--json", cwd=tmp_path)
    assert ended.err.count("left out: ") == 6
    assert "left out: 2 lines more" in ended.err
    assert {one["left_out"] for one in ended.results} == {7}
    assert rows(tmp_path / "affcli.db", "SELECT DISTINCT left_out FROM log") == [(7,)]


def test_a_deleted_run_goes_with_its_log(imported: Path, tmp_path: Path) -> None:
    path = tmp_path / "log.db"
    path.write_bytes((imported / "log.db").read_bytes())
    done("runs", "delete", "2", "--yes", "--db", path)
    for table in ("log", "log_file", "log_line"):
        assert rows(path, f"SELECT DISTINCT learning_run_id FROM {table}") == [(1,), (3,)]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("import", "none*.txt", "--map", "map.toml"), "no file fits this pattern"),
        (("import", "none.txt", "--map", "map.toml"), "No such file"),
        (("import", "x" * 300 + "*", "--map", "map.toml"), "no file fits this pattern"),
        (("import", "log", "--map", "map.toml"), "Is a directory"),
        (("import", PATTERN, "--map", "none.toml"), "No such file"),
    ],
)
def test_what_is_not_there_is_named(tmp_path: Path, words: tuple[str, ...], says: str) -> None:
    written(tmp_path)
    assert says in refused(4, *words, cwd=tmp_path)
    assert not list(tmp_path.glob("*.db"))


def test_its_source_is_cited_once(imported: Path) -> None:
    text = done("cite", "--db", "log.db", cwd=imported).out
    assert text.count("note = {Nobody, A log (2026)}") == text.count("@misc{log1,") == 1
    assert "howpublished = {CC0}" in text
    assert "world log}" in text


OFFSETS = """
[log]
source = "made up"
separator = "comma"
[columns]
tool = 1
start_x = 2
start_y = 3
end_x = 4
end_y = 5
clock = 6
[constants]
behavior = "draw"
offset_x = 1.0
offset_y = 12.0
"""


def test_offsets_and_times_bring_back_what_needs_them(tmp_path: Path) -> None:
    """Arrows begin where the tool was, tables are compared row by row, learning has a curve."""
    (tmp_path / "map.toml").write_text(OFFSETS)
    lines = [f"{tool},0,20,{n % 2},16,{10 * n + 10}" for tool in ("rake", "hoe") for n in range(9)]
    (tmp_path / "log.csv").write_text("\n".join(lines))
    done("import", "log.csv", "--map", "map.toml", cwd=tmp_path)
    (row,) = done("table", "show", "1", "--json", cwd=tmp_path).results
    assert row["from_wrist"] == [1.0, 12.0]
    assert rows(tmp_path / "affcli.db", "SELECT robot_seconds FROM learning_run") == [(90.0,)] * 2
    compared = ("figure", "affordances", "--run", "1", "--compare", "2", "--out", "a.svg")
    assert "9 of 9 rows kept" in done(*compared, cwd=tmp_path).err
    done("figure", "learning", "--run", "1", "--out", "b.svg", cwd=tmp_path)
    done("figure", "row", "1", "--out", "c.svg", cwd=tmp_path)
    done("report", "--html", "d.html", cwd=tmp_path)


def test_a_map_is_checked(imported: Path) -> None:
    (found,) = done("check", "map.toml", "--json", cwd=imported).results
    assert (found["kind"], found["facts"]["licence"]) == ("map of a log", "CC0")
