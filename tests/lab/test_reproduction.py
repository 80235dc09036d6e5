"""The whole paper on one robot and on many (§6, §7)."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from affcli.core.identity import Component
from affcli.core.specs import Protocol, RobotRecord
from affcli.lab.reproduction import Reproduced, one_robot, reproduce, reproduced_again
from affcli.lab.run_parts import RunParts
from affcli.lab.trials import whole_trial
from affcli.simulation.table_world import TableWorld
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import Store, open_store
from tests.lab.quick import LEISURELY, PLANNER, learned, now, table_from, taken

WHAT = Reproduced(RunParts.chosen(LEISURELY), PLANNER, 11)


@pytest.fixture(scope="module")
def life() -> RobotRecord:
    """The life of robot 2."""
    return one_robot(WHAT, 2)


def test_a_life_is_a_pure_function_of_what_is_reproduced_and_its_number(life: RobotRecord) -> None:
    assert one_robot(WHAT, 2) == life


def test_other_robots_and_other_seeds_live_other_lives(life: RobotRecord) -> None:
    for what, robot in ((WHAT, 3), (replace(WHAT, seed=12), 2)):
        other = one_robot(what, robot)
        for (_, mine, _), (_, theirs, _) in zip(life.learned, other.learned, strict=True):
            calls = [[r.placing.call for r, _ in steps[:3]] for steps in (mine, theirs)]
            assert calls[0] != calls[1]


def test_a_robot_learns_the_five_tools_for_an_hour_each(life: RobotRecord) -> None:
    """§6: "The learning trials were limited to one hour of run time for every tool"."""
    specs = [spec for spec, _, _ in life.learned]
    assert specs == [WHAT.parts.spec(tool, 11, 2, 1.0) for tool in TOOL_PARTS]
    for spec, steps, seconds in life.learned:
        assert steps == learned(spec)
        assert seconds == steps[-1][0].clock >= 3600.0 > steps[-2][0].clock


def test_a_robot_does_80_trials_with_whole_tools_and_16_with_a_broken_one(
    life: RobotRecord,
) -> None:
    """§7.1: "A total of 80 trials were performed"; §7.2: "A total of 16 trials": "the learning was
    performed with a T-hook which was then replaced with an L-hook"."""
    whole = [t for t in life.trials if t.spec.protocol is Protocol.EXTENSION_OF_REACH]
    broken = [t for t in life.trials if t.spec.protocol is Protocol.TOOL_ADAPTATION]
    assert (len(whole), len(broken)) == (80, 16)
    assert len({(t.spec.tool, t.spec.goal, t.spec.start) for t in whole}) == 80
    assert all(t.spec.shape == t.spec.tool for t in whole)
    assert {(t.spec.tool, t.spec.shape) for t in broken} == {("t-hook", "l-hook")}
    assert all(step.lost is None for t in whole for step in t.steps)
    assert all(step.lost is not None for t in broken for step in t.steps)
    assert {(t.spec.seed, t.spec.robot) for t in life.trials} == {(11, 2)}


def test_each_trial_of_a_life_is_what_it_is_by_itself(life: RobotRecord) -> None:
    """Each starts from the table as learned, whatever trials went before."""
    runs = {spec.tool: spec for spec, _, _ in life.learned}
    tables = {spec.tool: table_from(steps) for spec, steps, _ in life.learned}
    assert any(trial.steps for trial in life.trials)
    for trial in life.trials[::7]:
        tool, world = trial.spec.tool, TableWorld(LEISURELY)
        alone = whole_trial(trial.spec, runs[tool], tables[tool], world)
        assert alone.end == trial.end
        assert [s[:2] for s in alone.steps] == [s[:2] for s in trial.steps]


def test_what_is_reproduced_is_chosen_and_brought_back_from_its_session() -> None:
    parts = RunParts.chosen(LEISURELY, binding="grasp:grasp_point=2", repertoire=["slide-arm-left"])
    what = Reproduced(parts, Component.of("nested-query", {"share": 0.05}), 3)
    session = what.session(7)
    assert session.robots == 7
    assert reproduced_again(session) == what
    assert session.key != WHAT.session(7).key
    assert {str(trial.spec.planner) for trial in one_robot(what, 0).trials} == {
        "nested-query:share=0.05"
    }


@pytest.fixture
def another_store(migrated: Path, tmp_path: Path) -> Iterator[Store]:
    path = tmp_path / "another.db"
    path.write_bytes(migrated.read_bytes())
    with open_store(path, create=False, write=True) as opened:
        yield opened


def contents(store: Store) -> list[str]:
    """Return all that a database holds, as SQL."""
    with closing(sqlite3.connect(f"{store.path.as_uri()}?mode=ro", uri=True)) as reader:
        return list(reader.iterdump())


def test_the_store_is_the_same_for_any_number_of_workers(
    store: Store, another_store: Store
) -> None:
    alone = list(reproduce(store, WHAT, 3, 1, now))
    assert alone == [alone[0], 0, 1, 2, 3]
    assert list(reproduce(another_store, WHAT, 3, 2, now)) == alone
    assert contents(store) == contents(another_store)
    assert store.sessions.saved_robots(alone[0]) == {0, 1, 2}
    (session,) = store.sessions.all("reproduce")
    assert (session.status, session.spec) == ("done", WHAT.session(3))


def test_an_interrupted_reproduction_goes_on_with_the_robots_that_are_missing(
    store: Store, another_store: Store
) -> None:
    whole = list(reproduce(another_store, WHAT, 2, 1, now))
    taken(reproduce(store, WHAT, 2, 1, now), 3)
    assert store.sessions.saved_robots(whole[0]) == {0}
    (half,) = store.sessions.all("reproduce")
    assert list(reproduce(store, reproduced_again(half.spec), 2, 1, now)) == [whole[0], 1, 2]
    assert contents(store) == contents(another_store)
    assert list(reproduce(store, WHAT, 2, 1, now)) == [whole[0], 2]
    assert contents(store) == contents(another_store)
