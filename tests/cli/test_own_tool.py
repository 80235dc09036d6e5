"""A tool of one's own: begun, checked, learned, used and broken by commands."""

from pathlib import Path

import pytest

from tests.cli.program import done, refused, rows


@pytest.fixture
def rake(tmp_path: Path) -> Path:
    done("new", "tool", "rake", cwd=tmp_path)
    return tmp_path / "rake.toml"


def test_a_tool_to_begin_with_is_as_it_must_be(rake: Path) -> None:
    value = done("check", rake, "--out", rake.with_suffix(".svg"), "--json").result
    assert (value["kind"], value["name"]) == ("tool", "rake")
    assert value["facts"]["parts"] == "handle, bar, left tine, right tine"
    assert value["facts"]["babbling"] == "brings the attractor to all sides of it"
    assert value["facts"]["a camera"] == "tells it from the rest by its color"
    assert "left tine" in rake.with_suffix(".svg").read_text()
    before = rake.read_bytes()
    assert "exists already" in refused(4, "new", "tool", "rake", cwd=rake.parent)
    assert rake.read_bytes() == before


def test_a_tool_of_ones_own_is_learned_used_broken_and_replayed(rake: Path) -> None:
    db = ("--db", rake.with_name("own.db"))
    learn = ("learn", "--tool", rake, "--behaviors", "60", "--set", "trial.max_steps=3", *db)
    assert "learned rake (run 1" in done(*learn).err
    rake.write_text(rake.read_text().replace("-5, 9]", "-5, 8]"))  # the run keeps what it had
    done("solve", "--goal", "3", "--start", "1", "--tool", "rake", *db)
    assert "give --loses with one of handle, bar" in refused(2, "break-tool", "--tool", "rake", *db)
    assert "did you mean left tine" in refused(
        2, "break-tool", "--tool", "rake", "--loses", "tine", *db
    )
    broken = done("break-tool", "--tool", "rake", "--loses", "left tine", "--json", *db).result
    assert (broken["becomes"], broken["parts_gained"]) == ("rake without left tine", [])
    assert broken["paper"] is None
    again = done("replay", "--all", "--json", *db).results
    assert len(again) == 1 + 32
    assert all(one["equal"] for one in again)
    assert "learned rake (run 2" in done(*learn).err  # another tool, by its value
    held = rows(rake.with_name("own.db"), "SELECT count(DISTINCT tool_key) FROM learning_run")
    assert held == [(2,)]


def test_it_is_said_where_babbling_does_not_bring_the_attractor(rake: Path) -> None:
    rake.write_text(rake.read_text().replace("-5, ", "-8, "))
    words = "--set babbling.offset_x_max=9.5"
    assert words in done("check", rake, "--json").result["facts"]["babbling"]
    learn = ("learn", "--tool", rake, "--behaviors", "1", "--db", rake.with_name("own.db"))
    assert words in " ".join(done(*learn).err.split())


def test_settings_and_experiments_are_checked_too(tmp_path: Path) -> None:
    file = tmp_path / "file.toml"
    file.write_text("[friction]\ntool_puck = 0.3\n")
    settings = done("check", file, "--json").result
    assert (settings["kind"], settings["facts"]) == ("settings", {"friction.tool_puck": "0.3"})
    file.write_text('[experiment]\nname = "one"\nrobots = 2\n[base]\nminutes = 1\n')
    experiment = done("check", file, "--json").result
    assert (experiment["kind"], experiment["facts"]["conditions"]) == ("experiment", "base")
    assert "--out draws tools" in refused(2, "check", file, "--out", tmp_path / "a.svg")
    file.write_text("[frictoin]\ntool_puck = 0.3\n")
    assert "frictoin" in refused(4, "check", file)
    assert "No such file" in refused(4, "check", tmp_path / "none.toml")
