"""A part of another package that fails is named; the rest works, and what it ended is recorded."""

from pathlib import Path

import pytest

from affcli import registry
from affcli.errors import PartFailedError
from affcli.plugins import hosted
from tests.cli.program import affcli, contents, done, refused, rows
from tests.plugins.conftest import Install

PLANNER = """
import os, time
import numpy as np
from affcli.core.part import Part
from affcli.planning.nested_query import NestedQuery

class Bad(NestedQuery):
    def choose(self, situation):
        {does}

MINE = Part("planners", "mine", "mine", "a test", Bad)
"""
FAILING = {
    "raises": ("raise KeyError('no row')", "KeyError: 'no row' (bad_one.py, line 9)"),
    "ends": ("os._exit(7)", "its process ended (exit code 7)"),
    "leaves": ("raise SystemExit(3)", "SystemExit: 3 (bad_one.py, line 9)"),
    "crashes": ("os.abort()", "its process ended (signal 6)"),
    "loops": ("\n        while True: pass", "no answer within 2 s"),
    "asks": ("\n        while True: situation.reaches(*np.ones((2, 3)))", "no answer within 2 s"),
    "asks badly": ("situation.reaches('there')", "TypeError: "),
    "answers": ("return 3", "it chose 3"),
    "beyond": (
        "from affcli.core.choice import Choice; return Choice(10**9, ())",
        "it chose Choice",
    ),
    "nan": (
        "import affcli.core.choice as c; return c.Choice(0, (c.Reason('x', 1, float('nan')),))",
        "it chose Choice",
    ),
    "unsent": ("return lambda: 3", "its answer cannot be sent: "),
}


@pytest.mark.fault(28)
@pytest.mark.parametrize("how", FAILING)
def test_a_trial_that_a_planner_ended_is_recorded_so(
    how: str, install: Install, learned: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    does, words = FAILING[how]
    if "while" in does:
        monkeypatch.setattr(hosted, "ANSWERING", 2.0)
    install("bad_one", PLANNER.format(does=does), {"planners": {"mine": "bad_one:MINE"}})
    db = ("--db", learned)
    ended = affcli("solve", "--goal", "2", "--start", "1", "--planner", "mine", "--json", *db)
    assert ended.code == 4
    assert (ended.result["outcome"], ended.result["steps"]) == ("invalid", 0)
    said = f"trial 1 counts for nothing: planner mine of bad-one-0.1: {words}"
    assert said in " ".join(ended.err.split())
    ((outcome, reasons),) = rows(learned, "SELECT outcome, last_reasons FROM trial")
    assert outcome == "invalid"
    assert "planner mine of bad-one-0.1: " in str(reasons)


@pytest.mark.fault(28)
def test_a_trial_that_failed_is_explained_left_out_done_again_and_shown(
    install: Install, learned: Path, tmp_path: Path
) -> None:
    text = PLANNER.format(does="return 1 / 0")
    install("bad_one", text, {"planners": {"mine": "bad_one:MINE"}})
    db = ("--db", learned)
    solve = ("solve", "--goal", "2", "--planner", "mine")
    words = "planner mine of bad-one-0.1: ZeroDivisionError: division by zero (bad_one.py, line 9)"
    ended = affcli(*solve, "--explain", *db)
    assert words in " ".join(ended.out.split())
    assert "counters" not in ended.out
    assert (ended.code, ended.err.splitlines()) == (
        4,
        [f"4 trials, from trial 1 on, count for nothing: {words}", "trials 1 to 4 saved"],
    )
    (all_again,) = [done("replay", "--all", "--json", *db).results]
    assert len(all_again) == 4
    assert all(one["equal"] for one in all_again)
    said = " ".join(done("report", *db).out.split())
    assert "4 invalid trials left out: the simulation or a plug-in failed" in said
    broken = affcli("break-tool", "--planner", "mine", *db)
    assert (broken.code, broken.err.splitlines()) == (
        4,
        [f"32 trials, from trial 5 on, count for nothing: {words}", "trials 5 to 36 saved"],
    )
    done("solve", "--goal", "2", *db)  # the rest works
    done("report", "--html", tmp_path / "page.html", *db)
    assert "ZeroDivisionError" in (tmp_path / "page.html").read_text()


def test_a_planner_that_gives_no_row_and_no_reason_has_found_no_plan(
    install: Install, learned: Path
) -> None:
    """It keeps its contract: its trials count, as failures of a kind of their own."""
    text = PLANNER.format(does="from affcli.core.choice import Choice; return Choice(None, ())")
    install("bad_one", text, {"planners": {"mine": "bad_one:MINE"}})
    db = ("--db", learned)
    ended = done("solve", "--goal", "2", "--planner", "mine", "--explain", *db)
    assert ended.out.count("start 1, planner mine@bad-one-0.1: no plan found (0 steps)\n") == 1
    assert "rows left" not in ended.out
    assert set(rows(learned, "SELECT outcome, last_reasons FROM trial")) == {
        ("no plan found", "[]")
    }
    assert done("report", "--json", *db).result["failures"] == {"no plan found": 4}
    assert done("replay", "1", *db).err == (
        "trial 1 ended: no plan found; the replay equals the record, no steps\n"
    )


EXPERIMENT = """
[experiment]
name = "two"
question = "Does the planner matter?"
robots = 1
[base]
minutes = 2
tools = ["t-hook"]
trial.max_steps = 2
[[condition]]
name = "paper"
[[condition]]
name = "own"
planner = "mine"
"""


@pytest.mark.fault(28)
def test_a_condition_without_a_trial_that_counts_is_named_with_the_reason(
    install: Install, tmp_path: Path
) -> None:
    text = PLANNER.format(does="return 1 / 0")
    install("bad_one", text, {"planners": {"mine": "bad_one:MINE"}})
    file, db = tmp_path / "two.toml", ("--db", tmp_path / "two.db")
    file.write_text(EXPERIMENT)
    why = "planner mine of bad-one-0.1: ZeroDivisionError: division by zero (bad_one.py, line 9)"
    words = f"own: all 32 trials count for nothing: {why}"
    ended = affcli("experiment", file, "--workers", "1", *db)
    _, said = ended.err.splitlines()
    assert said == f"{words}; they stay as stored: another name or --db tries again"
    assert ended.code == 4
    for shown in (ended.out, done("report", *db).out):
        assert words in " ".join(shown.split())
        heading, _, paper, own, *_ = shown.partition("two: solved, mean of")[2].splitlines()[1:]
        assert heading.split()[-1] == "invalid"
        assert (paper.split()[0], paper.split()[-1]) == ("paper", "0")
        assert (own.split()[0], own.split()[-2:]) == ("own", ["-", "32"])
    again = affcli("experiment", file, "--json", *db)
    assert (again.code, again.err.splitlines()[-1]) == (4, said)
    invalid = [(one["invalid"], one["why_invalid"]) for one in again.result["conditions"]]
    assert invalid == [(0, ""), (32, why)]
    refusal = f"own has no trial that counts: all 32 are invalid ({why}): what is stored stays; "
    refusal += "repair that, and give the experiment another name or --db"
    for command in (("compare", "two"), ("power", "two"), ("power", "--session", "2")):
        assert refused(2, *command, *db) == f"affcli: {refusal}"


LOADING = {
    "import": ("import nothing_that_is_here", "ModuleNotFoundError: No module named 'nothing_"),
    "syntax": ("def (", "SyntaxError: "),
    "nothing": ("", "AttributeError: module 'bad_one' has no attribute 'MINE'"),
    "no part": ("MINE = 3", "TypeError: bad_one:MINE is no affcli.core.part.Part"),
    "other": (
        "from affcli.core.part import Part; MINE = Part('planners', 'x', 'x', 'x', int)",
        "ValueError: bad_one:MINE is the planners x",
    ),
    "told": (
        "from affcli.core.part import Part; MINE = Part('planners', 'mine', 'x', 'x', int, told=1)",
        "ValueError: a plug-in is told nothing that no robot sees",
    ),
    "loops": ("while True: pass", "no answer within 1 s"),
    "crashes": ("import os; os.abort()", "its process ended (signal 6)"),
}


@pytest.mark.fault(28)
@pytest.mark.parametrize("how", LOADING)
def test_what_does_not_load_is_named(
    how: str, install: Install, monkeypatch: pytest.MonkeyPatch
) -> None:
    text, words = LOADING[how]
    if how == "loops":
        monkeypatch.setattr(hosted, "LOADING", 1.0)
    install("bad_one", text, {"planners": {"mine": "bad_one:MINE"}})
    with pytest.raises(PartFailedError) as told:
        registry.component("planners", "mine")
    assert str(told.value).startswith(f"planner mine of bad-one-0.1: {words}")
    assert str(told.value).isprintable()


@pytest.mark.fault(28)
def test_what_does_not_load_is_named_before_anything_is_recorded_and_the_rest_is_listed(
    install: Install, learned: Path
) -> None:
    offered = {"planners": {"mine": "bad_one:MINE", "other": "bad_one:nothing"}}
    install("bad_one", "1 / 0", offered)
    words = "planner mine of bad-one-0.1: ZeroDivisionError: division by zero (bad_one.py, line 1)"
    before = learned.read_bytes()
    solve = ("solve", "--goal", "2", "--planner", "mine", "--db", learned)
    assert words in refused(4, *solve)
    assert learned.read_bytes() == before
    listed = done("list", "planners", "--json")
    assert [one["name"] for one in listed.results] == list(registry.parts("planners"))
    assert f"left out: {words}" in listed.err
    assert listed.err.count("left out: ") == 2


VALUES = """
import math
from dataclasses import replace
from affcli.core.part import Part
from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.behavior import BehaviorCall, ExploratoryBehavior
from affcli.core.motion import Slide
from affcli.core.task import GoalRegion, Task
from affcli.core.tool import *

def tool(geometry):
    part = ToolPart("a", ConvexPolygon.box(0, 0, 1, math.nan))
    return Tool(ToolName("mine"), Color((1, 2, 3)), (part,))

def behaviors():
    return (ExploratoryBehavior(BehaviorCall.of("far", {}), (Slide(math.inf, 0.0),)),)

def binding(geometry):
    return BehaviorCall.of("grasp", {"grasp_point": math.nan})

def tasks(workspace):
    return [Task("x", GoalRegion("a", Point(0.0, math.nan), 1.0), "b", Point(0.0, 0.0))]

MADE = [
    Part(kind, "mine", "mine", "a test", build)
    for kind, build in
    zip(("tools", "behaviors", "bindings", "tasks"), (tool, behaviors, binding, tasks))
]
TOOL, BEHAVIORS, BINDING, TASKS = MADE
"""


@pytest.mark.fault(23)
@pytest.mark.fault(28)
def test_what_a_package_makes_never_reaches_the_engine_unchecked(
    install: Install, learned: Path
) -> None:
    kinds = ("tools", "behaviors", "bindings", "tasks")
    where = ("TOOL", "BEHAVIORS", "BINDING", "TASKS")
    offered = {kind: {"mine": f"values:{name}"} for kind, name in zip(kinds, where, strict=True)}
    install("values", VALUES, offered)
    learn = ("learn", "--behaviors", "5", "--db", learned)
    for words in (
        ("--tool", "mine"),
        ("--tool", "stick", "--repertoire", "mine"),
        ("--tool", "stick", "--binding", "mine"),
    ):
        assert " of values-0.1: it makes no " in refused(4, *learn, *words)
    solve = ("solve", "--task", "mine", "--db", learned)
    assert "task mine of values-0.1: it makes no tasks: " in refused(4, *solve)


COMPOSED = """
        from affcli.core import behavior as b, motion as m
        return b.composed((m.Turn(9e9),)).call
"""
EXPLORER = """
from affcli.core.part import Part
from affcli.exploration.random_babbling import RandomBabbling

class Bad(RandomBabbling):
    def {method}(self, *args):
        {does}

MINE = Part("explorers", "mine", "mine", "a test", Bad)
"""


@pytest.mark.fault(28)
@pytest.mark.parametrize(
    ("method", "does", "words"),
    [
        ("tell", "args[0].step < 30 or 1 / 0", "ZeroDivisionError: division by zero"),
        ("places", "return [[1.0, 2.0, 3.0]]", "its places are "),
        ("places", "return [[float('nan'), 2.0]]", "its places are "),
        ("behavior", "return 'push'", "it tries push, which nobody gave it"),
        (
            "behavior",
            COMPOSED,
            "it tries turn 9e+09, which nobody gave it: it: segment 1: turn",
        ),
        ("state", "return {1: object()}", "its state is "),
    ],
)
def test_a_run_that_an_explorer_ended_keeps_what_was_saved(
    method: str, does: str, words: str, install: Install, learned: Path
) -> None:
    text = EXPLORER.format(method=method, does=does)
    install("bad_one", text, {"explorers": {"mine": "bad_one:MINE"}})
    learn = ("learn", "--tool", "stick", "--behaviors", "600", "--explorer", "mine")
    before = contents(learned)["affordance"]
    refusal = refused_after(*learn, "--db", str(learned))
    assert f"explorer mine of bad-one-0.1: {words}" in refusal
    assert contents(learned)["affordance"] == before
    done("solve", "--goal", "2", "--start", "1", "--tool", "t-hook", "--db", learned)
    assert "running" in str(rows(learned, "SELECT status FROM learning_run"))


def refused_after(*words: str) -> str:
    """Run a command that fails on its way; return what it says at the end."""
    ended = affcli(*words)
    assert ended.code == 4, ended
    return ended.err.splitlines()[-1]


def test_a_part_can_be_used_again_after_it_failed(install: Install) -> None:
    from affcli.testing import examples

    text = PLANNER.format(
        does="return 1 / 0 if len(situation.table) < 3 else super().choose(situation)"
    )
    install("bad_one", text, {"planners": {"mine": "bad_one:MINE"}})
    chosen = registry.component("planners", "mine")
    short, *_, long = examples.situations()
    with pytest.raises(PartFailedError, match="ZeroDivisionError"):
        registry.planner(chosen).choose(short)
    assert registry.planner(chosen).choose(long).position is not None


SENSOR = """
from affcli.core.part import Part
from affcli.perception.noisy_sensor import NoisySensor, SensorSettings

class Bad(NoisySensor):
    asked = 0

    def {method}(self):
        Bad.asked += 1
        {does}

MINE = Part("sensors", "mine", "x", "x", lambda look, rng, *_: Bad(look, SensorSettings(), rng))
"""


@pytest.mark.fault(28)
@pytest.mark.fault(29)
@pytest.mark.parametrize(
    ("method", "does", "words", "steps"),
    [
        ("observe", "return super().observe() if Bad.asked < 3 else 1 / 0", "ZeroDivision", 0),
        ("observe", "return super().observe()._replace(object_x=float('nan'))", "it sees ", 0),
        ("observe", "return (1.0, 2.0)", "it sees (1.0, 2.0), not twelve numbers", 0),
        ("observe_goal", "return 'there'", "it sees the goal there", 0),
    ],
)
def test_a_trial_that_a_sensor_ended_is_recorded_so(
    method: str, does: str, words: str, steps: int, install: Install, learned: Path
) -> None:
    install(
        "bad_one", SENSOR.format(method=method, does=does), {"sensors": {"mine": "bad_one:MINE"}}
    )
    ended = affcli("solve", "--goal", "2", "--start", "1", "--sensor", "mine", "--db", learned)
    assert f"counts for nothing: sensor mine of bad-one-0.1: {words}" in ended.err
    assert rows(learned, "SELECT outcome, steps FROM trial") == [("invalid", steps)]


WORLD = """
from affcli.core.part import Part
from affcli.simulation.table_world import TableWorld

class Bad(TableWorld):
    name, version = "mine", 1

    def trial(self, spec, learned):
        setting = super().trial(spec, learned)
        robot, execute = setting.robot, setting.robot.execute
        class Robot(type(robot)):
            uses = 0
            def execute(self, call, seen):
                Robot.uses += 1
                return super().execute(call, seen) if Robot.uses < 4 else 1 / 0
        robot.__class__ = Robot
        return setting

MINE = Part("worlds", "mine", "mine", "a test", Bad)
OTHER = Part("worlds", "other", "mine", "a test", Bad)
"""


@pytest.mark.fault(28)
def test_a_trial_that_a_world_ended_is_recorded_so(install: Install, tmp_path: Path) -> None:
    install("bad_one", WORLD, {"worlds": {"mine": "bad_one:MINE", "other": "bad_one:OTHER"}})
    db = ("--db", tmp_path / "own.db")
    done("learn", "--tool", "t-hook", "--behaviors", "60", "--world", "mine", *db)
    ended = affcli("solve", "--goal", "2", "--start", "1", "--json", *db)
    assert ended.code == 4
    assert ended.result["outcome"] == "invalid"
    assert "world mine of bad-one-0.1: ZeroDivisionError: division by zero" in ended.err
    learn = ("learn", "--tool", "stick", "--world", "other", *db)
    assert "it is ('mine', 1), its part ('other', 1); let them agree" in refused(4, *learn)
