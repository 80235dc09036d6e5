"""Parts of another package do all that ours do, and are recorded with their package."""

import json
import subprocess
import sys
from itertools import islice
from pathlib import Path

import pytest

from affcli import registry
from affcli.config import Settings
from affcli.core.identity import Component
from affcli.core.part import Kind
from affcli.core.ports import can_slide
from affcli.core.world import shows_tools
from affcli.errors import BadInputError, UsageError
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts
from affcli.lab.transferring import mask_of
from affcli.plugins import parts
from tests.cli.program import contents, done, environment, refused, rows
from tests.plugins.conftest import SHOP, Install

NAMES: dict[Kind, str] = {
    "tools": "hoe",
    "bindings": "low",
    "behaviors": "shove",
    "explorers": "rambling",
    "planners": "nearest",
    "sensors": "blurry",
    "tasks": "corner",
    "worlds": "yard",
}
PACKAGE = "shop-of-parts-1.2"
LEARN = (
    *("learn", "--tool", "hoe", "--behaviors", "60", "--explorer", "rambling", "--world", "yard"),
    *("--repertoire", "paper", "--repertoire", "shove:far=2", "--binding", "low"),
    *("--sensor", "blurry:noise=0.02"),
)


@pytest.mark.usefixtures("shop")
def test_each_kind_lists_what_the_package_brings() -> None:
    listed = done("list", "--json").results
    brought = {one["kind"]: one["name"] for one in listed if one["package"] == PACKAGE}
    assert brought == NAMES
    assert {one["package"] for one in listed} == {PACKAGE, "affcli-0.1.0.dev0"}
    shown = done("list", "planners", COLUMNS="200").out
    assert f" {PACKAGE}" in next(line for line in shown.splitlines() if line.startswith("nearest "))


@pytest.mark.usefixtures("shop")
def test_parts_of_a_package_are_learned_with_used_and_done_again(tmp_path: Path) -> None:
    db = ("--db", tmp_path / "own.db")
    done(*LEARN, *db)
    solve = ("solve", "--task", "corner", "--planner", "nearest", "--tool", "hoe")
    trial = done(*solve, "--json", *db).result
    assert trial["planner"] == f"nearest@{PACKAGE}"
    assert trial["outcome"] != "invalid"
    stored = rows(tmp_path / "own.db", "SELECT world, explorer, binding_params FROM learning_run")
    assert stored == [(f"yard@{PACKAGE}", f"rambling@{PACKAGE}", '{"grasp_point": 0.5}')]
    assert rows(tmp_path / "own.db", "SELECT world, planner, task_set FROM trial") == [
        tuple(f"{name}@{PACKAGE}" for name in ("yard", "nearest", "corner"))
    ]
    (again,) = done("replay", "--all", "--json", *db).results
    assert again["equal"]
    assert "all 60 behaviors" in done("replay", "--run", "1", *db).err
    assert "already learned" in done(*LEARN, *db).err
    seen = rows(
        tmp_path / "own.db", "SELECT sensor FROM learning_run UNION SELECT sensor FROM trial"
    )
    assert seen == [(f"blurry@{PACKAGE}:noise=0.02",)]


@pytest.mark.usefixtures("shop")
def test_what_a_world_of_a_package_can_do_beyond_the_least_is_found() -> None:
    """Its robot slides, its camera shows tools; its setting does neither."""
    ours, theirs = (
        RunParts.chosen(Settings(), world=world).spec("stick", 0, 0, 1.0)
        for world in ("table", "yard")
    )
    setting = LearningRun(theirs).setting
    assert can_slide(setting.robot)
    assert mask_of(theirs) == mask_of(ours)
    assert not shows_tools(setting)
    assert not can_slide(setting)


@pytest.mark.usefixtures("shop")
def test_an_explorer_in_its_own_process_is_the_same_and_can_be_gone_on_with(tmp_path: Path) -> None:
    """The random stream is that of the robot; where a run stops is nothing of it."""
    few = ("learn", "--tool", "stick", "--behaviors", "40", "--set", "trial.max_steps=3", "--json")
    for name in ("random", "rambling"):
        done(*few, "--explorer", name, "--db", tmp_path / f"{name}.db")
    ours, theirs = (contents(tmp_path / f"{name}.db") for name in ("random", "rambling"))
    assert ours["behavior"] == theirs["behavior"]
    assert ours["affordance"] == theirs["affordance"]


@pytest.mark.usefixtures("shop")
def test_a_run_with_an_explorer_of_a_package_goes_on_as_if_it_had_not_stopped() -> None:
    chosen = RunParts.chosen(Settings(), explorer="rambling", repertoire=["paper", "shove"])
    spec = chosen.spec("stick", 3, 0, None, 24)
    whole = list(LearningRun(spec).steps())
    begun = LearningRun(spec)
    first = list(islice(begun.steps(), 10))
    checkpoint = json.loads(json.dumps(begun.checkpoint()))
    assert [*first, *LearningRun(spec, checkpoint).steps()] == whole


@pytest.mark.usefixtures("shop")
def test_a_sensor_in_its_own_process_sees_as_it_would_here(tmp_path: Path) -> None:
    """The random stream of its noise is that of the run."""
    few = ("learn", "--tool", "stick", "--behaviors", "30")
    done(*few, "--sensor", "blurry", "--db", tmp_path / "theirs.db")
    done(*few, "--set", "sensor.position_noise=0.05", "--db", tmp_path / "ours.db")
    ours, theirs = (contents(tmp_path / f"{name}.db") for name in ("ours", "theirs"))
    assert ours["behavior"] == theirs["behavior"]
    done("solve", "--goal", "1", "--sensor", "blurry", "--db", tmp_path / "ours.db")
    (*_, last) = done("replay", "--all", "--json", "--db", tmp_path / "ours.db").results
    assert last["equal"]


@pytest.mark.usefixtures("shop")
def test_a_planner_in_its_own_process_chooses_as_it_would_here(learned: Path) -> None:
    from shop_of_parts import Nearest  # type: ignore[import-not-found]

    from affcli.core.affordance_table import AffordanceTable
    from affcli.testing import examples

    there, here = registry.planner(registry.component("planners", "nearest")), Nearest()
    for situation in examples.situations():
        assert there.choose(situation) == here.choose(situation)
        assert there.candidates(situation) == here.candidates(situation)
    nothing = examples.situation(AffordanceTable())
    assert there.choose(nothing).position is None
    done("solve", "--goal", "2", "--planner", "nearest", "--db", learned)


EXPERIMENT = """
[experiment]
name = "brought"
robots = 2
tasks = ["corner"]
[base]
minutes = 1
tools = ["stick", "hoe"]
explorer = "rambling"
repertoire = ["paper", "shove"]
trial.max_steps = 2
[[condition]]
name = "ours"
[[condition]]
name = "theirs"
planner = "nearest"
world = "yard"
sensor = "blurry"
"""


@pytest.mark.usefixtures("shop")
def test_robots_of_an_experiment_live_the_same_in_several_processes(tmp_path: Path) -> None:
    file = tmp_path / "brought.toml"
    file.write_text(EXPERIMENT)
    for workers in ("1", "2"):
        done("experiment", file, "--workers", workers, "--db", tmp_path / f"{workers}.db")
    assert contents(tmp_path / "2.db") == contents(tmp_path / "1.db")
    names = rows(tmp_path / "1.db", "SELECT DISTINCT planner FROM trial ORDER BY 1")
    assert names == [(f"nearest@{PACKAGE}",), ("nested-query",)]


@pytest.mark.usefixtures("shop")
def test_the_version_of_the_package_is_part_of_what_it_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    db = ("--db", tmp_path / "own.db")
    few = ("learn", "--tool", "stick", "--behaviors", "20", "--explorer", "rambling", *db)
    done(*few)
    newer = tmp_path / "newer"
    (newer / "shop_of_parts-1.3.dist-info").mkdir(parents=True)
    (newer / "shop_of_parts.py").write_bytes((SHOP / "shop_of_parts.py").read_bytes())
    for name in ("METADATA", "entry_points.txt"):
        text = (SHOP / "shop_of_parts-1.2.dist-info" / name).read_text().replace("1.2", "1.3")
        (newer / "shop_of_parts-1.3.dist-info" / name).write_text(text)
    monkeypatch.syspath_prepend(newer)
    parts.forget()  # as in another process
    replay = refused(4, "replay", "--run", "1", *db)
    assert (
        f"explorer rambling@{PACKAGE}: this affcli has version 1, from shop-of-parts-1.3" in replay
    )
    said = done(*few).err
    assert "learned stick (run 2" in said
    assert done("runs", "list", *db).out.count("stick") == 2


def test_without_the_package_its_records_are_shown_and_say_what_they_lack(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    db = ("--db", tmp_path / "own.db")
    with monkeypatch.context() as installed:
        installed.syspath_prepend(SHOP)
        done("learn", "--tool", "stick", "--behaviors", "20", "--explorer", "rambling", *db)
    parts.forget()  # as in another process
    assert "rambling" in done("runs", "show", "1", *db).out
    lacking = f"explorer rambling@{PACKAGE}: this affcli has no such part; install what made"
    assert lacking in refused(4, "replay", "--run", "1", *db)
    assert "no explorer 'rambling'" in refused(
        2, "learn", "--tool", "stick", "--explorer", "rambling", *db
    )


@pytest.mark.usefixtures("shop")
def test_names_and_versions_of_packages_are_told() -> None:
    with pytest.raises(UsageError, match="did you mean nearest"):
        registry.component("planners", "neares")
    with pytest.raises(BadInputError, match=f"has version 1, from {PACKAGE}, of nearest; leave"):
        registry.component("planners", "nearest@shop-of-parts-1.1")
    here = Component("shove", (("far", 2.0),), 2, PACKAGE)
    for text in ("shove:far=2", f"shove@2@{PACKAGE}:far=2", str(here)):
        assert registry.component("behaviors", text) == here


def test_nobody_looks_for_packages_where_the_parts_are_ours(learned: Path) -> None:
    """Not even the module that would is loaded: it is a part of the time of every command."""
    code = (
        "import sys; from affcli.cli.main import main; code = main(); "
        "print([one for one in ('importlib.metadata', 'affcli.plugins') if one in sys.modules], "
        "file=sys.stderr); sys.exit(code)"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code, "report", "--db", learned],
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "affcli.plugins" not in ended.stderr.splitlines()[-1]
    assert ended.stdout


def test_a_name_of_ours_is_ours_and_of_two_packages_none_is_taken(install: Install) -> None:
    part = "from affcli.planning.nested_query import NestedQuery as N\n"
    part += "from affcli.core.part import Part\n"
    part += "A, B = (Part('planners', n, 'x', 'y', N) for n in ('nested-query', 'twin'))\n"
    for name in ("one", "two"):
        install(name, part, {"planners": {"nested-query": f"{name}:A", "twin": f"{name}:B"}})
    assert registry.part("planners", "nested-query").package == ""
    both = "planner twin of one-0.1: two-0.1 offers one too; uninstall all but one"
    assert both in refused(4, "solve", "--goal", "2", "--planner", "twin")
    ended = done("list", "planners", "--json")
    assert {one["package"] for one in ended.results} == {"affcli-0.1.0.dev0"}
    assert ended.err.count("affcli has one of that name, which is used") == 2
    assert ended.err.count("uninstall all but one") == 2
    assert json.loads(ended.out)


COMPOSING = """
from affcli.core.behavior import composed
from affcli.core.motion import Slide, Turn
from affcli.core.part import Part
from affcli.exploration.random_babbling import RandomBabbling

class Composing(RandomBabbling):
    def behavior(self, place, start):
        return composed((Turn(20.0), Slide(0.0, -3.0))).call

MINE = Part("explorers", "composing", "turns and pulls", "a test", Composing)
"""


def test_an_explorer_of_a_package_may_compose_behaviors(install: Install, tmp_path: Path) -> None:
    install("composing", COMPOSING, {"explorers": {"composing": "composing:MINE"}})
    learn = ("learn", "--tool", "t-hook", "--behaviors", "10", "--explorer", "composing")
    done(*learn, "--db", tmp_path / "own.db")
    tried = rows(tmp_path / "own.db", "SELECT DISTINCT exploratory_behavior FROM behavior")
    assert tried == [("turn, slide",)]
