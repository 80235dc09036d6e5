"""A tool of one's own: begun, checked, learned, used and broken by commands."""

from pathlib import Path

import pytest

from tests.cli.program import done, names_in, refused, rows


@pytest.fixture
def rake(tmp_path: Path) -> Path:
    done("new", "tool", "rake", cwd=tmp_path)
    return tmp_path / "rake.toml"


def test_a_tool_to_begin_with_is_as_it_must_be(rake: Path) -> None:
    value = done("check", rake, "--out", rake.with_suffix(".svg"), "--json").result
    assert (value["kind"], value["name"]) == ("tool", "rake")
    assert value["facts"]["parts"] == "handle, bar, left tine, right tine"
    assert value["facts"]["babbling"] == "brings the attractor to all sides of it"
    assert value["facts"]["broken"] == "loses left tine"
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
    assert "did you mean left tine" in refused(
        2, "break-tool", "--tool", "rake", "--loses", "tine", *db
    )
    for what in ("affordances", "learning"):
        picture = rake.with_name(f"{what}.svg")
        done("figure", what, "--tool", "rake", "--out", picture, *db)
        assert "rake" in picture.read_text().lower()
    broken = done("break-tool", "--tool", "rake", "--json", *db).result  # as its file says
    assert (broken["becomes"], broken["parts_gained"]) == ("rake without left tine", [])
    assert broken["paper"] is None
    other = ("--loses", "right tine", "--loses", "bar", "--task", "anywhere:n=1")
    broken = done("break-tool", "--tool", "rake", *other, "--json", *db).result
    assert broken["becomes"] == "rake without right tine, bar"
    again = done("replay", "--all", "--json", *db).results
    assert len(again) == 1 + 32 + 2
    assert all(one["equal"] for one in again)
    assert "learned rake (run 2" in done(*learn).err  # another tool, by its value
    held = rows(rake.with_name("own.db"), "SELECT count(DISTINCT tool_key) FROM learning_run")
    assert held == [(2,)]


def test_a_tool_that_does_not_say_how_it_breaks_is_asked(rake: Path) -> None:
    rake.write_text(rake.read_text().split("[broken]")[0])
    db = ("--db", rake.with_name("own.db"))
    done("learn", "--tool", rake, "--behaviors", "20", *db)
    assert "give --loses with one of handle, bar" in refused(2, "break-tool", "--tool", "rake", *db)
    facts = done("check", rake, "--json").result["facts"]
    assert facts["broken"] == "not said: [broken] loses = [...]"


def test_it_is_said_where_babbling_does_not_bring_the_attractor(rake: Path) -> None:
    rake.write_text(rake.read_text().replace("-5, ", "-8, "))
    words = "--set babbling.offset_x_max=9.5"
    assert words in done("check", rake, "--json").result["facts"]["babbling"]
    learn = ("learn", "--tool", rake, "--behaviors", "1", "--db", rake.with_name("own.db"))
    assert words in " ".join(done(*learn).err.split())


def test_a_behavior_of_ones_own_is_learned_with_and_used(tmp_path: Path) -> None:
    done("new", "behavior", "shove", cwd=tmp_path)
    drawn = ("--out", "shove.svg", "--json")
    value = done("check", "shove.toml", *drawn, cwd=tmp_path).result
    assert (value["kind"], value["name"]) == ("behavior", "shove")
    assert value["facts"]["segments"] == "slide 0, 4; turn 30; slide 0, -4"
    assert "s of the robot's time" in value["facts"]["begun at the table's centre"]
    assert (tmp_path / "shove.svg").stat().st_size > 5_000
    learn = ("learn", "--tool", "t-hook", "--behaviors", "60", "--repertoire", "./shove.toml")
    run = done(*learn, "--set", "trial.max_steps=3", "--json", "--db", "own.db", cwd=tmp_path)
    assert run.result["repertoire"] == ["shove"]
    (tmp_path / "shove.toml").unlink()  # the run has it
    done("solve", "--goal", "1", "--db", "own.db", cwd=tmp_path)
    assert all(
        one["equal"]
        for one in done("replay", "--all", "--json", "--db", "own.db", cwd=tmp_path).results
    )
    assert "all 60 behaviors" in done("replay", "--run", "1", "--db", "own.db", cwd=tmp_path).err


def test_tasks_of_ones_own_are_done_and_done_again(tmp_path: Path) -> None:
    done("new", "task", "corner", cwd=tmp_path)
    value = done("check", "corner.toml", "--out", "corner.svg", "--json", cwd=tmp_path).result
    assert (value["kind"], value["name"]) == ("tasks", "corner")
    assert value["facts"]["tasks"] == "2: 2 goals, each from 1 start"
    assert "within reach" in value["facts"]["reach"]
    assert "right" in (tmp_path / "corner.svg").read_text()
    db = ("--db", "own.db")
    few = ("learn", "--tool", "t-hook", "--behaviors", "60", "--set", "trial.max_steps=3")
    done(*few, *db, cwd=tmp_path)
    solve = ("solve", "--task", "./corner.toml")
    trials = done(*solve, "--json", *db, cwd=tmp_path).results
    assert [(one["tasks"], one["goal"]) for one in trials] == [
        ("corner", "left"),
        ("corner", "right"),
    ]
    assert trials[0]["goal_at"] == [-8.0, 26.0]
    one = done(*solve, "--goal", "right", "--json", *db, cwd=tmp_path).result
    assert one["goal"] == "right"
    assert "--n is of random tasks" in refused(2, *solve, "--n", "3", *db, cwd=tmp_path)
    done("break-tool", "--task", "corner.toml", *db, cwd=tmp_path)
    (tmp_path / "corner.toml").unlink()  # the trials have it
    again = done("replay", "--all", "--json", *db, cwd=tmp_path).results
    assert [one["equal"] for one in again] == [True] * 7
    assert "corner.toml: No such file" in refused(4, *solve, *db, cwd=tmp_path)


def test_places_that_no_tool_reaches_are_named(tmp_path: Path) -> None:
    done("new", "task", "corner", cwd=tmp_path)
    file = tmp_path / "corner.toml"
    text = file.read_text().replace("[-8, 26]", "[-18, 26]").replace("[8, 26]", "[0, 39]")
    file.write_text(text)
    facts = done("check", file, "--set", "table.far=40", "--json").result["facts"]
    assert facts["reach"] == (
        "off the table: goal left; out of reach of the paper's tools: goal right"
    )


def test_who_tries_what_no_tool_reaches_is_told_so_in_a_line(tmp_path: Path) -> None:
    """Of those tasks that were asked for; the trials are done, and fail."""
    done("new", "task", "corner", cwd=tmp_path)
    file = tmp_path / "corner.toml"
    file.write_text(file.read_text().replace("[-8, 26]", "[-18, 26]"))
    few = ("--behaviors", "60", "--set", "trial.max_steps=3", "--db", "own.db")
    done("learn", "--tool", "t-hook", *few, cwd=tmp_path)
    solve = ("solve", "--task", "./corner.toml", "--db", "own.db")
    told = done(*solve, cwd=tmp_path).err
    assert told.splitlines()[0] == "tasks corner: off the table: goal left"
    assert "off the table" not in done(*solve, "--goal", "right", cwd=tmp_path).err
    (tmp_path / "it.toml").write_text(
        "[experiment]\nname = 'it'\nquestion = '?'\nrobots = 1\n[base]\nminutes = 2\n"
        "tools = ['t-hook']\ntasks = ['./corner.toml']\n[[condition]]\nname = 'paper'\n"
    )
    ended = done("experiment", "it.toml", "--workers", "1", "--db", "it.db", cwd=tmp_path)
    assert ended.err.splitlines()[0] == "tasks corner: off the table: goal left"


@pytest.mark.parametrize("kind", ["tool", "behavior", "task"])
def test_a_name_with_quotes_is_written_as_toml_has_it(kind: str, tmp_path: Path) -> None:
    done("new", kind, 'so "called"', "--out", "it.toml", cwd=tmp_path)
    assert done("check", "it.toml", "--json", cwd=tmp_path).result["name"] == 'so "called"'


@pytest.mark.parametrize(
    ("kind", "name", "says"),
    [
        ("tool", "l-hook", "NAME: l-hook is one of affcli's own tools; give another name"),
        ("behavior", "extend arm", "NAME: extend arm is one of affcli's own behaviors"),
        ("behavior", "paper", "NAME: paper is one of affcli's own behaviors"),
        ("behavior", "grasp", "grasp is another one"),
        ("task", "extension-of-reach", "NAME: extension-of-reach is one of affcli's own tasks"),
    ],
)
def test_a_name_that_is_there_is_refused_before_a_file_is_written(
    kind: str, name: str, says: str, tmp_path: Path
) -> None:
    assert says in refused(4, "new", kind, name, cwd=tmp_path)
    assert names_in(tmp_path) == []


def test_settings_and_experiments_are_checked_too(tmp_path: Path) -> None:
    file = tmp_path / "file.toml"
    file.write_text("[friction]\ntool_puck = 0.3\n")
    settings = done("check", file, "--json").result
    assert (settings["kind"], settings["facts"]) == ("settings", {"friction.tool_puck": "0.3"})
    file.write_text('[experiment]\nname = "one"\nrobots = 2\n[base]\nminutes = 1\n')
    experiment = done("check", file, "--json").result
    assert (experiment["kind"], experiment["facts"]["conditions"]) == ("experiment", "base")
    assert "--out draws tools, behaviors and tasks" in refused(
        2, "check", file, "--out", tmp_path / "a.svg"
    )
    file.write_text("[frictoin]\ntool_puck = 0.3\n")
    assert "frictoin" in refused(4, "check", file)
    assert "No such file" in refused(4, "check", tmp_path / "none.toml")
