"""The Gymnasium environments keep Gymnasium's rules, and are the table that robots learn at."""

import copy
import importlib
import json
import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from affcli import registry
from affcli.core.affordance_table import AffordanceTable
from affcli.errors import AffcliError, SimulationDivergedError, UsageError
from affcli.gym import Babble, Reach, RowActions, learned_table
from affcli.simulation.robot import SimulatedRobot
from tests.cli.program import done
from tests.readmes import blocks

REACH, BABBLE = "affcli.gym:affcli/Reach-v0", "affcli.gym:affcli/Babble-v0"
MADE: tuple[tuple[str, dict[str, Any]], ...] = (
    (REACH, {}),
    (REACH, {"tool": "stick", "task": "anywhere", "sensor": "exact", "action": "box"}),
    (REACH, {"shape": "l-hook", "reward": "dense", "settings": {"friction.tool_puck": 0.4}}),
    (REACH, {"repertoire": ["paper", "turn-wrist:angle=30"], "binding": "grasp:angle=20"}),
    (BABBLE, {"render_mode": "ansi"}),
    (BABBLE, {"action": "box", "render_mode": "rgb_array"}),
)


def played(env: Any, steps: int, seed: int | None = 3) -> list[Any]:
    """Return what random actions give; the same for the same seed."""
    env.action_space.seed(7)
    seen, _ = env.reset(seed=seed)
    told: list[Any] = [seen.tolist()]
    for _ in range(steps):
        seen, reward, ended, cut, info = env.step(env.action_space.sample())
        told.append((seen.tolist(), reward, ended, cut, str(info)))
        if ended or cut:
            env.reset()
    return told


@pytest.mark.filterwarnings("ignore:.*we recommend using a symmetric and normalized space")
@pytest.mark.parametrize(("name", "given"), MADE)
def test_it_keeps_the_rules_of_gymnasium(name: str, given: dict[str, Any]) -> None:
    env = gymnasium.make(name, **given)
    check_env(env.unwrapped)
    assert played(env, 12) == played(gymnasium.make(name, **given), 12)
    assert played(env, 3, seed=4) != played(env, 3, seed=5)


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_several_run_beside_each_other(mode: str) -> None:
    both: Any = gymnasium.make_vec(REACH, num_envs=2, vectorization_mode=mode)
    both.action_space.seed(1)
    seen, told = both.reset(seed=[3, 4])
    alone, _ = gymnasium.make(REACH).reset(seed=4)
    assert np.array_equal(seen[1], alone)
    _, rewards, *_, told = both.step(both.action_space.sample())
    assert rewards.shape == (2,)
    assert told["is_success"].shape == (2,)
    both.close()


def test_a_step_is_a_wrist_position_and_a_behavior() -> None:
    env: Any = gymnasium.make(REACH, sensor="exact", tool="t-hook", goal="2", start="2")
    seen, told = env.reset(seed=0, options={"attractor": [1.0, 22.0]})
    assert (told["goal"], told["start"], told["is_success"]) == ("2", "given", False)
    assert seen[:2].tolist() == [1.0, 22.0]
    goal = seen[15:]
    call = env.unwrapped.calls.index(registry.repertoire(["contract-arm"])[0].call)
    action = {"behavior": call, "offset": np.array([2.4, 12.0], np.float32)}
    after, reward, ended, _, told = env.step(action)
    assert (told["behavior"], told["status"]) == ("contract arm 5", "done")
    assert after[12:14].tolist() == pytest.approx([-1.4, 5.0], abs=0.01)
    assert after[1] <= 22.0
    assert (reward, ended) == (float(told["is_success"]), told["is_success"])
    assert goal[2] == env.unwrapped.setting.sensor.observe_goal().half_width


def test_over_the_goal_it_is_solved_and_ends() -> None:
    env: Any = gymnasium.make(REACH, sensor="exact", reward="dense", action="box")
    near = [0.0, 20.0]
    seen, _ = env.reset(seed=0, options={"attractor": near, "goal_at": [0.0, 20.5]})
    _, reward, ended, cut, told = env.step(np.full(env.action_space.shape, -1.0, np.float32))
    assert (ended, cut, told["is_success"]) == (True, False, True)
    assert reward == pytest.approx(1.0, abs=0.5)
    far = math.dist(seen[:2], seen[15:17])
    assert far == pytest.approx(0.5)


def test_after_sixty_steps_it_is_cut() -> None:
    env: Any = gymnasium.make(REACH)
    env.reset(seed=0)
    nothing = {"behavior": 0, "offset": env.unwrapped.action_space["offset"].high}
    for step in range(1, 61):
        *_, ended, cut, _ = env.step(nothing)
        assert not ended
        assert cut is (step == 60)


def test_babbling_gives_rows_from_which_a_table_can_be_made() -> None:
    env: Any = gymnasium.make(BABBLE, sensor="exact")
    total = sum(one[1] for one in played(env, 120)[1:])
    rows = env.unwrapped.rows
    assert total == len(rows) >= 3
    table = AffordanceTable(rows)
    assert len({row.step for row in table}) == len(rows)
    assert all(row.expected_movement.distance > 0.5 for row in table)


def test_a_simulation_that_diverges_ends_the_episode(monkeypatch: pytest.MonkeyPatch) -> None:
    def diverging(*_: object) -> None:
        raise SimulationDivergedError("too much")

    for name in (REACH, BABBLE):
        env: Any = gymnasium.make(name)
        env.reset(seed=0)
        with monkeypatch.context() as patched:
            patched.setattr(SimulatedRobot, "execute", diverging)
            _, reward, ended, _, told = env.step(env.action_space.sample())
        assert (reward, ended, told["status"]) == (0.0, True, "diverged")


def test_it_is_drawn_in_letters_and_in_colours() -> None:
    env: Any = gymnasium.make(REACH, render_mode="ansi")
    env.reset(seed=0)
    assert {"#", "o", "+"} <= set(env.render())
    env = gymnasium.make(BABBLE, render_mode="rgb_array")
    env.reset(seed=0)
    before = env.render()
    assert (before.dtype, before.shape[2]) == (np.uint8, 3)
    played(env, 20)
    assert not np.array_equal(env.render(), before)
    assert gymnasium.make(BABBLE).unwrapped.render() is None


@pytest.fixture(scope="module")
def database(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("gym") / "learned.db"
    done("learn", "--tool", "t-hook", "--behaviors", "500", "--db", path)
    return path


def test_the_nested_query_solves_it_by_the_rows_of_a_learned_table(database: Path) -> None:
    """What a learner that chooses among the rows is beside."""
    reach = gymnasium.make(REACH, tool="t-hook")
    env = RowActions(reach, learned_table(database))
    planner = registry.planner(registry.component("planners", "nested-query"))
    inner = reach.unwrapped
    assert isinstance(inner, Reach)
    solved = 0
    for seed in range(12):
        _, told = env.reset(seed=seed)
        ended = cut = False
        while not (ended or cut):
            choice = planner.choose(inner.situation(env.table)).position
            if choice is None:
                break
            assert told["action_mask"][choice] == 1
            before = env.table.row(choice).times_used
            *_, ended, cut, told = env.step(choice)
            assert env.table.row(choice).times_used == before + 1
        solved += bool(told["is_success"])
    assert solved >= 8
    env.reset(seed=0)
    assert {row.times_used for row in env.table} == {1}


def test_rows_that_the_robot_does_not_have_are_refused(database: Path) -> None:
    table = learned_table(database, 1)
    few = gymnasium.make(REACH, repertoire=["extend-arm"])
    with pytest.raises(UsageError, match="which is not in the environment's repertoire"):
        RowActions(few, table)
    with pytest.raises(UsageError, match="RowActions is for affcli/Reach-v0"):
        RowActions(gymnasium.make(BABBLE), table)
    with pytest.raises(UsageError, match="blank table"):
        RowActions(gymnasium.make(REACH), AffordanceTable())
    with pytest.raises(UsageError, match="no row of the table has the colour of the stick"):
        RowActions(gymnasium.make(REACH, tool="stick"), table)
    with pytest.raises(UsageError, match="rows held by grasp 1, which the environment does not"):
        RowActions(gymnasium.make(REACH, binding="grasp:grasp_point=7"), table)
    RowActions(gymnasium.make(REACH, binding=["grasp:grasp_point=7", "grasp"]), table)
    rows = RowActions(gymnasium.make(REACH), table)
    rows.reset(seed=0)
    with pytest.raises(ValueError, match=f"row {len(table)}: must lie in 0 to {len(table) - 1}"):
        rows.step(len(table))
    with pytest.raises(UsageError, match="no finished learning run 7"):
        learned_table(database, 7)


@pytest.mark.parametrize(
    ("given", "options", "says"),
    [
        ({"action": "text"}, {}, "give dict or box"),
        ({"reward": "much"}, {}, "give sparse or dense"),
        ({"tool": "hoe"}, {}, "no tool 'hoe'"),
        ({"goal": "9"}, {}, "no task with goal 9 and start None; goals: 1, 2, 3, 4"),
        ({"settings": {"friction.tool_puck": -1}}, {}, "must lie in"),
        ({}, {"goal": "9"}, "no task with goal 9"),
        ({}, {"attractor": [1]}, "attractor must be [x, y] in inches"),
        ({}, {"attractor": [math.nan, 0]}, "attractor must be [x, y] in inches"),
        ({}, {"attractor": [100, 100]}, "of the t-hook; the table has x of -16 to 16 and y of "),
        ({}, {"seed": 1}, "reset: no option seed; there are goal, start"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(
    given: dict[str, Any], options: dict[str, Any], says: str
) -> None:
    with pytest.raises(AffcliError) as told:
        Reach(**given).reset(options=options)
    assert says in str(told.value)
    assert str(told.value).isprintable()
    with pytest.raises(UsageError, match="reset the environment first"):
        _ = Babble().seen


@pytest.mark.parametrize(
    ("behavior", "offset", "says"),
    [
        (99, [0.0, 10.0], "behavior 99: must lie in 0 to 7"),
        (-1, [0.0, 10.0], "behavior -1: must lie in 0 to 7"),
        (0, [math.nan, 10.0], "offset must lie within 100 in"),
    ],
)
def test_an_action_beyond_the_limits_is_refused(
    behavior: int, offset: list[float], says: str
) -> None:
    env = Reach()
    env.reset(seed=0)
    with pytest.raises(ValueError, match=says):
        env.step({"behavior": behavior, "offset": offset})


def test_without_gymnasium_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gymnasium.envs.registration", None)
    monkeypatch.delitem(sys.modules, "affcli.gym")
    with pytest.raises(ImportError, match=r"pip install 'affcli\[gym\]'"):
        importlib.import_module("affcli.gym")


def test_its_spec_says_what_it_is() -> None:
    env = gymnasium.make(REACH, tool="stick", task="anywhere:half_width=1")
    assert env.spec is not None
    assert json.loads(env.spec.to_json())["kwargs"]["task"] == "anywhere:half_width=1"
    again = gymnasium.make(copy.deepcopy(env.spec))
    assert played(again, 3) == played(env, 3)


def test_the_readme_runs(
    database: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    (tmp_path / "affcli.db").write_bytes(database.read_bytes())
    monkeypatch.chdir(tmp_path)
    known: dict[str, Any] = {}
    for code in blocks("affcli/gym/README.md", "python"):
        exec(code, known)  # noqa: S102  # our own
    assert capsys.readouterr().out.split()[0] in ("True", "False")
    assert len(known["seen"]) == 18


def test_a_row_is_of_the_grasp_that_holds_the_tool(database: Path) -> None:
    """As a row that was used before asked for it."""
    env = gymnasium.make(BABBLE, binding=["grasp", "grasp:grasp_point=4"]).unwrapped
    assert isinstance(env, Babble)
    env.reset(seed=3)
    higher = env.learned.bindings[1]
    for row in learned_table(database):
        env.step(replace(row, binding=higher))
        if env.rows:
            break
    assert {row.binding for row in env.rows} == {higher}
