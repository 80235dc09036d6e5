"""What a file of an experiment says, and what it may not."""

import json
from pathlib import Path
from typing import Any

import pytest

from affcli.core.identity import Component
from affcli.errors import BadInputError
from affcli.lab.conducting import begin
from affcli.lab.definition import MOST_CONDITIONS, experiment_file, experiment_of
from affcli.lab.experiment import Experiment
from affcli.lab.run_parts import RunParts, settings_of
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import Store
from tests.lab.quick import IMPATIENT, now

HEAD = '[experiment]\nname = "try"\nrobots = 3\n'
TWO = '[[condition]]\nname = "a"\n[[condition]]\nname = "b"\n'


@pytest.fixture
def read(tmp_path: Path) -> Any:
    """What reads a file of this text."""

    def reader(text: str) -> Experiment:
        path = tmp_path / "try.toml"
        path.write_text(text)
        return experiment_file(path)

    return reader


def test_what_is_not_said_is_the_papers(read: Any) -> None:
    what = read(HEAD)
    assert (what.name, what.robots, what.seed, what.question) == ("try", 3, 0, "")
    (only,) = what.conditions
    assert (only.name, only.hours, only.tools) == ("base", 1.0, tuple(TOOL_PARTS))
    assert only.tasks == ("extension-of-reach", "adaptation")
    assert only.planner == Component("nested-query")
    (told,) = read(f"{HEAD}[base.trial]\nmax_steps = 6\n").conditions
    assert told.parts == RunParts.chosen(IMPATIENT)


def test_a_condition_is_the_base_but_for_what_it_says(read: Any) -> None:
    what = read(
        f'{HEAD}seed = 7\ntasks = "adaptation"\n'
        '[base]\nminutes = 30\ntools = ["t-hook"]\nfriction.tool_puck = 0.4\n'
        '[[condition]]\nname = "a"\n'
        '[[condition]]\nname = "b"\nhours = 2\nplanner = "nested-query:share=0.05"\n'
        'sensor = "exact"\nsettings.trial.max_steps = 9\nsettings.friction.tool_puck = 0.3\n'
        'tasks = ["extension-of-reach"]\nrepertoire = "paper"\nbinding = "grasp:grasp_point=4"\n'
    )
    a, b = what.conditions
    assert (a.hours, a.tasks, a.tools, str(a.planner)) == (
        *(0.5, ("adaptation",), ("t-hook",)),
        "nested-query",
    )
    assert (b.hours, b.tasks, b.tools, str(b.planner)) == (
        *(2.0, ("extension-of-reach",), ("t-hook",)),
        "nested-query:share=0.05",
    )
    assert (a.parts.sensor, b.parts.sensor) == ("noisy", "exact")
    assert settings_of(a.parts).workspace.friction.tool_puck == 0.4
    assert settings_of(b.parts).workspace.friction.tool_puck == 0.3
    assert settings_of(b.parts).trial.max_steps == 9
    assert b.parts.binding["grasp_point"] == 4.0
    assert what.seed == 7


@pytest.mark.parametrize(
    "said",
    [
        '"sensor.position_noise" = 0.25',
        "sensor.position_noise = 0.25",
        "settings.sensor.position_noise = 0.25",
        'settings."sensor.position_noise" = 0.25',
        "settings = {sensor = {position_noise = 0.25}}",
    ],
)
def test_a_setting_may_be_written_as_toml_allows(read: Any, said: str) -> None:
    (only,) = read(f"{HEAD}[base]\n{said}\n").conditions
    assert settings_of(only.parts).sensor.position_noise == 0.25


def test_a_condition_has_one_grasp_or_several(read: Any) -> None:
    """Of which one in a list is the one; and each condition of a sweep may have its own."""
    grasps = "'grasp', 'grasp:grasp_point=7'"
    one, listed, both = read(
        f"{HEAD}[sweep]\nbinding = ['grasp', ['grasp:angle=90'], [{grasps}]]\n"
    ).conditions
    assert [list(map(str, c.parts.bindings)) for c in (one, listed, both)] == [
        *(["grasp 1"], ["grasp 1 90"]),
        ["grasp 1", "grasp 7"],
    ]
    assert both.name == "binding=grasp+grasp:grasp_point=7"
    what = read(f"{HEAD}[base]\nbinding = [{grasps}]\n")
    assert experiment_of(what.definition, "as stored") == what


def test_sizes_need_fit_only_together(read: Any) -> None:
    sizes = "settings.tools.part_width = 6\nsettings.tools.hook_length = 8\n"
    more = "settings.tools.bar_reach = 9\n"
    (only,) = read(f"{HEAD}[base]\n{sizes}{more}").conditions
    assert settings_of(only.parts).workspace.tools.part_width == 6.0


def test_a_sweep_is_a_grid_under_each_condition(read: Any) -> None:
    what = read(
        f"{HEAD}{TWO}explorer = 'random'\nsettings.trial.max_steps = 9\n"
        '[sweep]\n"sensor.position_noise" = [0.008, 0.25]\ntools = ["stick", ["stick", "t-hook"]]\n'
        'tasks = ["extension-of-reach"]\n'
    )
    names = [condition.name for condition in what.conditions]
    assert len(names) == 8
    assert names[1] == ("a, position_noise=0.008, tools=stick+t-hook, tasks=extension-of-reach")
    assert [c.tools for c in what.conditions[:2]] == [("stick",), ("stick", "t-hook")]
    noises = [settings_of(c.parts).sensor.position_noise for c in what.conditions]
    assert noises == [0.008, 0.008, 0.25, 0.25] * 2
    both = read(f"{HEAD}[sweep]\nminutes = [6, 12]\nsensor = ['noisy', 'exact']\n")
    assert [c.name for c in both.conditions][1] == "minutes=6, sensor=exact"
    assert [c.hours for c in both.conditions] == [0.1, 0.1, 0.2, 0.2]


def test_the_stored_form_is_read_as_the_same(read: Any) -> None:
    what = read(
        f"{HEAD}{TWO}planner = 'nested-query:share=0.05'\n[base]\nminutes = 7\n"
        "[sweep]\n'sensor.position_noise' = [0.008, 0.25]\nsensor = ['noisy', 'exact']\n"
    )
    again = experiment_of(json.loads(json.dumps(what.definition)), "a database")
    assert (again, again.key) == (what, what.key)


def test_the_key_is_of_what_robots_are_functions_of(read: Any) -> None:
    key = read(HEAD).key
    assert read(HEAD.replace("3", "9").replace("try", "other")).key == key
    assert (
        read(f"{HEAD}question = 'why?'\n[base]\nminutes = 60\nfriction.gravity = 386.09\n").key
        == key
    )
    for more in ("seed = 1", "tasks = 'extension-of-reach'", "[base]\nhours = 2"):
        assert read(f"{HEAD}{more}\n").key != key


def test_as_many_hours_in_minutes_are_the_same(read: Any) -> None:
    keys = {read(f"{HEAD}[base]\n{said}\n").key for said in ("minutes = 207", "hours = 3.45")}
    assert len(keys) == 1


def test_as_many_conditions_as_there_may_be_can_be_stored(read: Any, store: Store) -> None:
    sweep = f"[sweep]\nminutes = [{', '.join(str(n + 1) for n in range(MOST_CONDITIONS))}]\n"
    info = begin(store, read(f"{HEAD}question = '{'ä' * 1000}'\n{sweep}"), now)
    assert len(store.experiments.named("try").conditions) == MOST_CONDITIONS
    again = experiment_of(info.definition, "a database")
    assert (len(again.conditions), begin(store, again, now)) == (MOST_CONDITIONS, info)
    more = 'planner = "nested-query:share=0.05"\nsensor.color_noise = 0.011\n'
    more += "puck.mass = 0.21\nmotion.push_speed = 3.5\nmotion.hold = 1.5\ntrial.max_steps = 9\n"
    with pytest.raises(BadInputError, match=r"its 250 conditions, written out, are more than"):
        read(f"{HEAD}[base]\n{more}{sweep}")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "experiment: name must be a line of 1 to 80 letters"),
        ("[experiment]\nname = 'x'\n", "experiment: robots must be a whole number in 1 to 100000"),
        (HEAD.replace("3", "0"), "experiment: robots = 0 must be a whole number in 1 to 100000"),
        (HEAD.replace("3", "true"), "experiment: robots = True must be a whole number"),
        (f"{HEAD}seed = -1\n", "experiment: seed = -1 must be a whole number in 0 to 9223"),
        (f"{HEAD}sed = 1\n", "experiment: no key 'sed'; did you mean seed?"),
        (f"{HEAD}[bases]\n", "no table 'bases'; did you mean base"),
        ("base = 3\n" + HEAD, "base must be a table, [base]"),
        ("condition = 3\n" + HEAD, "condition must be tables, [[condition]]"),
        (f"{HEAD}[base]\nplaner = 'x'\n", "base: no key 'planer'; did you mean planner"),
        (
            f"{HEAD}[base]\nplanner = 'x'\n",
            "base.planner: no planner 'x'; did you mean lookahead or nested-query",
        ),
        (f"{HEAD}[base]\nplanner = 3\n", "base.planner: 3 must be a name"),
        (f"{HEAD}[base]\nbinding = []\n", "base.binding: [] must be a name, or several in a list"),
        (
            f"{HEAD}[base]\nbinding = ['grasp', 3]\n",
            "base.binding: ['grasp', 3] must be a name, or",
        ),
        (f"{HEAD}[base]\nbinding = ['grasp', 'grasp']\n", "base.binding: grasp comes twice"),
        (
            f"{HEAD}{TWO}binding = ['grasp', 'grasp:grasp_point=16']\n",
            "condition[1]: grasp: grasp_point = 16 lies beyond the end of the handle, at 15.6",
        ),
        (
            f"{HEAD}{TWO}explorer = 'inventing'\nbinding = ['grasp', 'grasp:angle=90']\n",
            "condition[1]: binding: robots that explore by inventing take one grasp; give one; in",
        ),
        (f"{HEAD}[base]\ntools = []\n", "base.tools: [] must be names in a list"),
        (f"{HEAD}[base]\ntools = ['stick', 3]\n", "base.tools: ['stick', 3] must be names in a"),
        (f"{HEAD}[base]\ntools = ['hoe']\n", "base.tools: no tool 'hoe'; did you mean"),
        (f"{HEAD}[base]\ntools = ['stick', 'stick']\n", "base.tools: stick comes twice"),
        (f"{HEAD}[base]\nexplorer = 'random:x=1'\n", "base.explorer: random: no parameter x"),
        (f"{HEAD}[base]\nhours = 0\n", "hours: 0 must be more than 0 where robots borrow nothing"),
        (f"{HEAD}[base]\nminutes = 1{'0' * 400}\n", "base.minutes: 1000"),
        (f"{HEAD}[base]\nhours = 'long'\n", "base.hours: long must be a number of more than 0"),
        (f"{HEAD}[base]\nminutes = nan\n", "base.minutes: nan must be a number of more than 0"),
        (f"{HEAD}[base]\nminutes = 6\nhours = 1\n", "base.hours: hours is said twice"),
        (f"{HEAD}[base]\nsensor = 'eye'\n", "base.sensor: no sensor 'eye'; did you mean noisy or"),
        (f"{HEAD}[base]\n'sensor.nose' = 1\n", "base: no key sensor.nose; known: "),
        (f"{HEAD}[base]\nsettings.nose = 1\n", "base: no section nose; the sections are"),
        (f"{HEAD}[base]\nnose.length = 1\n", "base: no section nose; the sections are"),
        (f"{HEAD}[base]\nsettings = 1\n", "base.settings: 1 must be a name"),
        (
            f"{HEAD}[base]\nsensor.position_noise = 99\n",
            "base: sensor.position_noise = 99 must lie in [",
        ),
        (f"{HEAD}[[condition]]\nplanner = 'x'\n", "condition[0]: name must be a line of 1 to"),
        (f"{HEAD}{TWO}planner = 'x'\n", "condition[1].planner: no planner 'x'"),
        (
            f"{HEAD}{TWO}sensor.position_noise = 99\n",
            "condition[1]: sensor.position_noise = 99 must",
        ),
        (f"{HEAD}{TWO.replace('b', 'a')}", "condition[1]: a condition named a is there already"),
        (f"{HEAD}{TWO}", "condition[1]: b is the same as a; leave one of them out"),
        (
            f"{HEAD}[[condition]]\nname = 'a'\ntools = ['stick']\n",
            "condition[0]: tasks adaptation is of the t-hook, which is not in tools",
        ),
        (
            f"{HEAD}[base]\ntasks = ['adaptation']\n",
            "tools: no tasks for the stick; leave it out, or add tasks",
        ),
        (f"{HEAD}[base]\ntasks = ['chess']\n", "base.tasks: no tasks 'chess'; did you mean"),
        (f"{HEAD}[sweep]\nplanner = 'nested-query'\n", "sweep.planner: must be a list of values"),
        (f"{HEAD}[sweep]\nplanner = ['x']\n", "sweep[0].planner: no planner 'x'"),
        (
            f"{HEAD}[sweep]\nminutes = [{','.join('1' * 251)}]\n",
            "sweep: more than 250 conditions",
        ),
        (
            f"{HEAD}[sweep]\nminutes = [1, 2]\nhours = [3, 4]\n",
            "sweep.hours: hours is said twice",
        ),
        (
            f"{HEAD}[sweep]\nsensor = ['noisy']\nsettings.sensor.kind = ['exact']\n",
            "sweep.sensor.kind: sensor.kind is said twice",
        ),
        (
            f"{HEAD}[[condition]]\nname = '{'a' * 75}'\n[sweep]\nminutes = [1]\n",
            f"condition[0]: the name {'a' * 75}, minutes=1 has more than 80 letters; give",
        ),
        (
            f"{HEAD}{TWO}hours = 2\n[sweep]\nminutes = [1, 2]\n",
            "condition[1]: hours is said here and in the sweep; say it once",
        ),
        (
            f"{HEAD}[base]\ntools.part_width = 5\ntools.hook_length = 4\n",
            "settings: tools.part_width = 5 must be less than tools.hook_length = 4",
        ),
        ("[experiment\n", "not TOML: "),
        ("a.b.c.d.e.f = 1\n", "not TOML: more than 4 dots"),
    ],
)
def test_all_that_is_wrong_is_found_and_its_place_named(
    read: Any, tmp_path: Path, text: str, message: str
) -> None:
    with pytest.raises(BadInputError) as refused:
        read(text)
    place, _, rest = str(refused.value).partition(": ")
    assert place == f"experiment {tmp_path / 'try.toml'}"
    assert rest.startswith(message), rest
    assert "\n" not in rest
