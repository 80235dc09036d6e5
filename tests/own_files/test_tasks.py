"""Tasks of a file: each goal from each start, or refused in one line."""

from pathlib import Path

import pytest

from affcli import registry
from affcli.core.geometry import Point
from affcli.core.task import GoalRegion, Task
from affcli.errors import BadInputError
from affcli.own_files.tasks import tasks_from_file

CORNER = """
[task]
name = "corner"
[[goal]]
name = "far left"
at = [-8, 26]
half_width = 1.5
[[goal]]
name = "2"
at = [8, 26]
half_width = 2
[[start]]
name = "middle"
at = [0, 20]
[[start]]
name = "near"
at = [0, 16]
"""


def written(path: Path, text: str) -> Path:
    file = path / "corner.toml"
    file.write_text(text)
    return file


def test_each_goal_is_a_task_from_each_start(tmp_path: Path) -> None:
    tasks = tasks_from_file(written(tmp_path, CORNER))
    assert tasks == registry.own_tasks(tmp_path / "corner.toml")
    named = [(task.goal.name, task.start_name) for task in tasks]
    assert named == [(goal, start) for goal in ("far left", "2") for start in ("middle", "near")]
    goal = GoalRegion("far left", Point(-8.0, 26.0), 1.5)
    assert tasks[0] == Task("corner", goal, "middle", Point(0.0, 20.0))


WRONG = {
    "": "needs a table [task] with name",
    "[task]\nname = 'a'": "0 goals: write 1 to 100, each under [[goal]]",
    CORNER.split("[[start]]", maxsplit=1)[0]: "0 starts: write 1 to 100, each under [[start]]",
    CORNER.replace("half_width", "width"): "no key of goal 1 'width'; did you mean half_width",
    CORNER.replace("half_width = 1.5", ""): "goal 1: half_width: must be a number in 0.1 to 10 in",
    CORNER.replace("= 1.5", "= 11"): "goal 1: half_width = 11: must be a number",
    CORNER.replace("[8, 26]", "[8, 260]"): "goal 2: at: [8, 260]: each must be a number",
    CORNER.replace("[8, 26]", "8"): "goal 2: at: must be [x, y] in inches",
    CORNER.replace("[0, 16]", "[nan, 16]"): "start 2: at: [nan, 16]: each must be a number",
    CORNER.replace('"2"', '"far left"'): "two goals have one name",
    CORNER.replace('"near"', '"middle"'): "start 2: name: middle means another",
    CORNER.replace('"near"', '"all"'): "start 2: name: all means another",
    CORNER.replace('"near"', '"a/b"'): "start 2: name = a/b: must be a word",
    CORNER.replace("[0, 16]", "[7, 25]"): "start near lies over goal 2: nothing would be left",
    CORNER.replace("[task]", "[tasks]"): "no table 'tasks'; did you mean task",
}


@pytest.mark.parametrize(("text", "words"), WRONG.items())
def test_what_is_wrong_is_named_with_its_place(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(BadInputError) as told:
        tasks_from_file(written(tmp_path, text))
    assert words in str(told.value)
    assert str(told.value).startswith("task ")
    assert str(told.value).isprintable()


def test_a_name_of_ours_is_refused(tmp_path: Path) -> None:
    file = written(tmp_path, CORNER.replace('"corner"', '"anywhere"'))
    with pytest.raises(BadInputError, match="anywhere is one of affcli's own tasks; give another"):
        registry.own_tasks(file)
