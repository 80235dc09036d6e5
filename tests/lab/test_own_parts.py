"""Tools of files in an experiment: kept by value, and the same rows whoever lets robots live."""

import json
import shutil
from pathlib import Path

import pytest

from affcli.core.tool import Tool
from affcli.errors import BadInputError, UsageError
from affcli.lab.conducting import begin, run
from affcli.lab.definition import experiment_file, experiment_of
from affcli.lab.experiment import Experiment
from affcli.store import merge, open_store
from tests.cli.program import contents
from tests.lab.quick import NOW, now

RAKE = """
[tool]
name = "rake"
color = [110, 230, 200]
[[part]]
name = "handle"
outline = [[-0.4, 0], [0.4, 0], [0.4, 13.2], [-0.4, 13.2]]
[[part]]
name = "head"
outline = [[-5, 9], [-4.2, 9], [-4.2, 13.2], [4.2, 13.2], [4.2, 9], [5, 9], [5, 14], [-5, 14]]
"""
CORNER = """
[task]
name = "corner"
[[goal]]
name = "left"
at = [-8, 26]
half_width = 2
[[start]]
name = "middle"
at = [0, 20]
"""
SHOVE = """
[behavior]
name = "shove"
[[segment]]
slide = [1, 4]
"""
TEXT = """
[experiment]
name = "own"
robots = 2
tasks = ["./tools/corner.toml"]
[base]
minutes = 1
tools = ["stick", "./tools/rake.toml"]
repertoire = ["paper", "tools/shove.toml"]
trial.max_steps = 2
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "tools").mkdir()
    for name, text in (("rake", RAKE), ("corner", CORNER), ("shove", SHOVE)):
        (tmp_path / "tools" / f"{name}.toml").write_text(text)
    path = tmp_path / "own.toml"
    path.write_text(TEXT)
    return path


def live(path: Path, what: Experiment, workers: int = 1, robots: range = range(2)) -> Path:
    with open_store(path, create=True, write=True) as store:
        list(run(store, what, begin(store, what, now), workers, now, robots=robots))
    return path


def test_the_tool_of_a_file_lives_the_same_with_workers_in_shards_and_from_what_is_stored(
    file: Path, tmp_path: Path
) -> None:
    what = experiment_file(file)
    (rake,) = (one for one in what.conditions[0].tools if isinstance(one, Tool))
    assert rake.name == "rake"
    alone = live(tmp_path / "alone.db", what)
    with open_store(alone, create=False, write=False) as store:
        runs = store.learning.runs(session_id=store.experiments.named("own").conditions[0][1])
        assert {one.spec.held for one in runs if one.spec.tool == "rake"} == {rake}
        stored = store.experiments.named("own").definition
    shutil.rmtree(tmp_path / "tools")
    assert {str(r.spec.repertoire[-1].call) for r in runs} == {"shove"}
    again = experiment_of(stored, "a database")
    assert (again, again.key) == (what, what.key)
    assert contents(live(tmp_path / "two.db", again, workers=2)) == contents(alone)
    shards = [live(tmp_path / f"{k}.db", what, robots=range(k, 2, 2)) for k in range(2)]
    merge(shards, tmp_path / "merged.db", NOW)
    assert contents(tmp_path / "merged.db") == contents(alone)


@pytest.mark.parametrize(("name", "change"), [("corner", ("26", "25")), ("shove", ("4", "5"))])
def test_what_a_file_says_is_part_of_the_key(
    name: str, change: tuple[str, str], file: Path
) -> None:
    before = experiment_file(file)
    other = file.parent / "tools" / f"{name}.toml"
    other.write_text(other.read_text() + "# the same\n")
    assert experiment_file(file).key == before.key
    other.write_text(other.read_text().replace(*change))
    assert experiment_file(file).key != before.key


def test_a_file_that_changed_is_another_experiment(file: Path, tmp_path: Path) -> None:
    path = live(tmp_path / "own.db", experiment_file(file), robots=range(1))
    other = tmp_path / "tools" / "rake.toml"
    other.write_text(RAKE.replace("[-5, 9]", "[-5, 8]"))
    changed = "is in .* already, but a file that it names says otherwise now; give this"
    with (
        open_store(path, create=False, write=True) as store,
        pytest.raises(UsageError, match=changed),
    ):
        begin(store, experiment_file(file), now)
    other.write_text(RAKE.replace("13.2]", "13.20]"))
    with open_store(path, create=False, write=True) as store:
        begin(store, experiment_file(file), now)


def test_tools_of_files_can_be_swept_by_their_names(file: Path) -> None:
    longer = RAKE.replace("rake", "long rake").replace("9]", "8]")
    (file.parent / "long.toml").write_text(longer)
    swept = "[sweep]\ntools = ['tools/rake.toml', ['long.toml', 'stick']]\n"
    what = experiment_of_text(file, TEXT.replace('tools = ["stick"', '# ["stick"') + swept)
    assert [one.name for one in what.conditions] == ["tools=rake", "tools=long rake+stick"]
    stored = json.loads(json.dumps(what.definition))
    assert [one["tool"]["name"] for one in stored["tool"]] == ["rake", "long rake"]
    assert experiment_of(stored, "a database") == what


def experiment_of_text(file: Path, text: str) -> Experiment:
    file.write_text(text)
    return experiment_file(file)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("/tools/rake", "/tools/hoe"), "base.tools: tool ./tools/hoe.toml: No such file"),
        (('"stick",', '"./tools/rake.toml",'), "base.tools: rake comes twice"),
        (("tools = [", "planner = './tools/rake.toml'\n#"), "base.planner: no planner './tools"),
        (("[base]", "[[tool]]\nname = 'a'\n[base]"), "tool[0]: no table 'name'; did you mean tool"),
        (
            ("tools/corner", "tools/rake"),
            "experiment.tasks: task ./tools/rake.toml: no table",
        ),
        (("[experiment]", "tool = 3\n[experiment]"), "tool must be tables of files; name files"),
    ],
)
def test_what_is_wrong_with_a_file_is_said_with_its_place(
    file: Path, change: tuple[str, str], message: str
) -> None:
    with pytest.raises(BadInputError) as told:
        experiment_of_text(file, TEXT.replace(*change))
    assert str(told.value).startswith(f"experiment {file}: {message}")
    assert str(told.value).isprintable()


def test_two_tools_of_one_name_are_refused(file: Path) -> None:
    (file.parent / "rake.toml").write_text(RAKE.replace("9]", "8]"))
    two = TEXT.replace('"stick"', '"rake.toml"')
    with pytest.raises(BadInputError, match=r"base.tools: tool ./tools/rake.toml: another tool of"):
        experiment_of_text(file, two)
    (file.parent / "rake.toml").write_text(RAKE.replace('"rake"', '"t-hook"'))
    with pytest.raises(BadInputError, match=r"tool t-hook: t-hook is one of affcli's own"):
        experiment_of_text(file, two)
