"""Parts by name: ``affcli list``, the options that take a part, and what is recorded of it."""

import json
from pathlib import Path

import pytest

from affcli import registry
from tests.cli.program import done, names_in, refused, rows

FEW = ("learn", "--tool", "stick", "--behaviors", "20")


@pytest.mark.parametrize("kind", registry.KINDS)
def test_a_kind_is_listed_with_each_of_its_parts(kind: str, tmp_path: Path) -> None:
    listed = done("list", kind, "--json", cwd=tmp_path).results
    assert {one["kind"] for one in listed} == {kind}
    known = next(registry.parts(one) for one in registry.KINDS if one == kind)
    assert [one["name"] for one in listed] == list(known)
    assert all(one["summary"] and one["source"] for one in listed)
    table = done("list", kind, cwd=tmp_path, COLUMNS="40").out
    assert max(map(len, table.splitlines())) <= 40
    assert names_in(tmp_path) == []


def test_parameters_are_listed_with_default_unit_and_limits() -> None:
    everything = done("list", "--json").results
    assert list(dict.fromkeys(one["kind"] for one in everything)) == list(registry.KINDS)
    planner = next(one for one in everything if one["name"] == "nested-query")
    angle = next(one for one in planner["parameters"] if one["name"] == "angle_degrees")
    assert (angle["default"], angle["unit"]) == (40, "degrees")
    assert (angle["low"], angle["high"]) == (1, 180)


def test_a_kind_that_there_is_not_is_a_usage_error() -> None:
    assert "did you mean planners" in refused(2, "list", "planer")


SOLVE = ("solve", "--goal", "2")
UNKNOWN = {
    "planner": ((*SOLVE, "--planner", "nested-quer"), "did you mean nested-query"),
    "planner to break": (("break-tool", "--planner", "x"), "(affcli list planners)"),
    "planner of all": (("reproduce", "--planner", "x"), "(affcli list planners)"),
    "task": ((*SOLVE, "--task", "extension"), "did you mean extension-of-reach"),
    "explorer": ((*FEW, "--explorer", "rando"), "did you mean random"),
    "behavior": ((*FEW, "--repertoire", "extend"), "did you mean extend-arm"),
    "binding": ((*FEW, "--binding", "gras"), "did you mean grasp"),
    "world": ((*FEW, "--world", "tabel"), "did you mean table"),
    "behavior twice": (
        (*FEW, "--repertoire", "paper", "--repertoire", "extend-arm"),
        "comes twice",
    ),
}
WRONG = {
    "unknown parameter": ((*SOLVE, "--planner", "nested-query:shar=1"), "it has share, thr"),
    "beyond its limits": (
        (*SOLVE, "--planner", "nested-query:share=2"),
        "share = 2 must lie in [0.001, 1]",
    ),
    "in a unit": (
        (*FEW, "--binding", "grasp:angle=300"),
        "angle = 300 must lie in [-180, 180] (degrees)",
    ),
    "in words": ((*SOLVE, "--planner", "nested-query:share=x"), "share"),
    "without a value": ((*SOLVE, "--planner", "nested-query:share"), "name:key=value,key=value"),
    "behavior": ((*FEW, "--repertoire", "extend-arm:offset_distance=99"), "[0.1, 20] (in)"),
    "of what has none": ((*FEW, "--explorer", "random:x=1"), "it has none"),
    "world": ((*FEW, "--world", "table:x=1"), "no parameter x"),
}


@pytest.mark.parametrize(
    ("code", "args", "says"),
    [*((2, *one) for one in UNKNOWN.values()), *((4, *one) for one in WRONG.values())],
    ids=[*(f"unknown {name}" for name in UNKNOWN), *(f"wrong {name}" for name in WRONG)],
)
def test_a_part_that_cannot_be_is_refused_and_nothing_recorded(
    code: int, args: tuple[str, ...], says: str, learned: Path
) -> None:
    before = learned.read_bytes()
    assert says in refused(code, *args, "--db", learned)
    assert learned.read_bytes() == before


def test_a_run_carries_its_parts_and_is_shown_with_them(tmp_path: Path) -> None:
    database = tmp_path / "my.db"
    parts = (
        *("--binding", "grasp:angle=20", "--explorer", "random", "--world", "table"),
        *("--repertoire", "extend-arm:offset_distance=3", "--repertoire", "slide-arm-left"),
    )
    (said,) = done(*FEW, *parts, "--json", "--db", database).results
    assert said["explorer"] == "random"
    assert "20" in said["binding"]
    assert said["repertoire"] == ["extend arm 3", "slide arm left 5"]
    ((world, repertoire, binding),) = rows(
        database, "SELECT world, repertoire, binding_params FROM learning_run"
    )
    assert world.startswith("table")
    assert len(json.loads(repertoire)) == 2
    assert json.loads(binding)["angle"] == 20
    tried = rows(database, "SELECT DISTINCT exploratory_behavior FROM behavior ORDER BY 1")
    assert tried == [("extend arm",), ("slide arm left",)]
    again = done(*FEW, *parts, "--db", database)
    assert "already learned" in again.err
    assert done("replay", "--run", "1", "--db", database).err.endswith("all 20 behaviors\n")
    assert "learned stick (run 2" in done(*FEW, "--db", database).err


def test_runs_of_one_tool_are_told_apart_by_their_number(learned: Path) -> None:
    """A command takes the latest of a tool, unless a run is named."""
    learn = ("learn", "--tool", "t-hook", "--behaviors", "60", "--binding", "grasp:angle=10")
    done(*learn, "--db", learned)
    one = ("solve", "--goal", "2", "--tool", "t-hook")
    assert {trial["run"] for trial in done(*one, "--json", "--db", learned).results} == {3}
    named = ("solve", "--goal", "2", "--run", "1", "--json")
    assert {trial["run"] for trial in done(*named, "--db", learned).results} == {1}
    assert done("break-tool", "--run", "1", "--json", "--db", learned).result["run"] == 1
    assert done("verify", "--run", "1", "--rows", "2", "--json", "--db", learned).result["run"] == 1
    predict = ("predict", "--run", "1", "--pushes", "2", "--json")
    assert done(*predict, "--db", learned).result["run"] == 1


def test_trials_by_two_planners_are_kept_beside_each_other_and_done_again(learned: Path) -> None:
    few = ("nested-query:share=0.05", "nested-query")
    for planner in few:
        solve = ("solve", "--goal", "2", "--tool", "t-hook", "--planner", planner)
        done(*solve, "--explain", "--db", learned)
    kept = rows(learned, "SELECT planner, count(*) FROM trial GROUP BY planner ORDER BY 1")
    assert kept == [("nested-query", 4), ("nested-query:share=0.05", 4)]
    assert done("replay", "--all", "--db", learned).err.startswith("8 of 8 trials equal ")
    replayed = done("replay", "1", "--json", "--db", learned).result
    assert replayed["planner"] == "nested-query:share=0.05"
    assert replayed["steps"][0]["reasons"]
    assert "nested-query:share=0.05" in done("replay", "1", "--db", learned).out
