"""What the page gathers: which robot, which of its trials, and what is left out (§6, §7)."""

import sqlite3
from itertools import islice
from pathlib import Path

import pytest

from affcli.core.trial import Counters, Outcome, Protocol
from affcli.errors import BadInputError, DatabaseError, UsageError
from affcli.lab.breaking import break_tool
from affcli.lab.learning import learn
from affcli.lab.page import content_of
from affcli.lab.reproduction import reproduce
from affcli.lab.solving import solve
from affcli.report.page.content import Content
from affcli.report.page.rendering import render
from affcli.store import LearningRunInfo, Store, open_store
from tests.lab.quick import IMPATIENT, LEISURELY, counted, now, spec_of, taken


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A run of the T-hook whose trials end soon."""
    return learn(store, spec_of(behaviors=400, settings=IMPATIENT), now).info


def altered(path: Path, *statements: str) -> None:
    """Change the database as no affcli would."""
    with sqlite3.connect(path) as driver:
        for statement in statements:
            driver.execute(statement)
    driver.close()


def gathered(path: Path) -> Content:
    """Return the page's content of a database that was changed meanwhile."""
    with open_store(path, create=False, write=False) as again:
        return content_of(again)


def shown(content: Content) -> list[tuple[str, int, int]]:
    """Return shape, goal and start of the trials in their order."""
    return [(r.spec.shape, r.spec.goal, r.spec.start) for r in content.replays]


def test_a_robot_that_only_learned(store: Store, run: LearningRunInfo) -> None:
    content = content_of(store)
    assert content.robot == "the robot of seed 0"
    assert content.database == "lab.db"
    assert (content.replays, content.broken, content.left_out) == ([], [], 0)
    assert content.reproduction is None
    (tool,) = content.tools
    assert (tool.run, tool.tool.name, tool.behaviors) == (run.id, "t-hook", 400)
    assert tool.rows == {row.id: row.row for row in store.affordances(run.id)}
    assert len(tool.rows) == run.rows
    assert tool.settings == "trial.max_steps = 6"
    assert "<h1>" in render(content, "")


def test_the_latest_trial_of_each_kind_in_the_order_of_the_paper_s_table(
    store: Store, run: LearningRunInfo
) -> None:
    stick = learn(store, spec_of("stick", behaviors=300, settings=IMPATIENT), now).info
    counted(solve(store, [run], 2, [2, 1], 0, now))
    counted(solve(store, [run, stick], 1, [3], 0, now))
    counted(solve(store, [run], 2, [1], 5, now))
    content = content_of(store)
    assert shown(content) == [("stick", 1, 3), ("t-hook", 1, 3), ("t-hook", 2, 1), ("t-hook", 2, 2)]
    assert [replay.spec.seed for replay in content.replays] == [0, 0, 5, 0]
    assert content.left_out == 1
    assert [tool.tool.name for tool in content.tools] == ["stick", "t-hook"]
    assert content.robot == "the robot of seed 0"


def test_trials_of_solve_come_before_those_of_break_tool(
    store: Store, run: LearningRunInfo
) -> None:
    """The latter do the whole tool's trials too, beside those with the broken one."""
    counted(solve(store, [run], 2, [1, 2], 0, now))
    counted(break_tool(store, run, "l-hook", 0, now))
    content = content_of(store)
    whole, adapted = content.replays[:16], content.replays[16:]
    assert [r.spec.shape for r in whole] == ["t-hook"] * 16
    assert [r.spec.shape for r in adapted] == ["l-hook"] * 16
    stored = [r for r in whole if r.spec.counters is Counters.STORED]
    assert [(r.spec.goal, r.spec.start) for r in stored] == [(2, 1), (2, 2)]
    assert content.left_out == 2
    (broken,) = content.broken
    assert (broken.tool.name, broken.shape.name) == ("t-hook", "l-hook")
    assert broken.missing_side > 0
    assert list(broken.trials) == adapted
    assert broken.rows == {row.id: row.row for row in store.affordances(run.id)}


def test_every_shape_that_a_tool_became_is_told_of(store: Store, run: LearningRunInfo) -> None:
    for shape in ("l-hook", "stick", "l-hook"):
        counted(break_tool(store, run, shape, 0, now))
    content = content_of(store)
    assert sorted(str(broken.shape.name) for broken in content.broken) == ["l-hook", "stick"]
    assert [len(broken.trials) for broken in content.broken] == [16, 16]
    assert len(content.replays) == 48
    assert content.left_out == 16 + 2 * 16
    sides = {str(broken.shape.name): broken.missing_side for broken in content.broken}
    assert sides["stick"] == pytest.approx(0.0, abs=1e-9)
    page = render(content, "")
    assert page.count("that became the") == 2


def test_only_the_latest_run_of_a_tool_counts(store: Store, run: LearningRunInfo) -> None:
    counted(solve(store, [run], 2, [1], 0, now))
    again = learn(store, spec_of(behaviors=400, seed=3, settings=IMPATIENT), now).info
    content = content_of(store)
    assert [tool.run for tool in content.tools] == [again.id]
    assert content.replays == []
    assert content.robot == "the robot of seed 3"


def test_a_run_that_is_still_learning_is_not_shown(store: Store) -> None:
    """With nothing else there is nothing to show, and the message says why."""
    begun = spec_of("stick", behaviors=300, settings=IMPATIENT)
    store.begin_learning(begun, {"affcli": "0"}, now())
    with pytest.raises(UsageError, match="run 1 is not finished; go on with the command that"):
        content_of(store)
    done = learn(store, spec_of(behaviors=60, settings=IMPATIENT), now).info
    assert [tool.run for tool in content_of(store).tools] == [done.id]


def test_an_interrupted_trial_is_shown_as_far_as_it_came(
    store: Store, run: LearningRunInfo
) -> None:
    taken(solve(store, [run], 1, [1], 0, now), 2)
    content = content_of(store)
    (replay,) = content.replays
    assert (replay.end, len(replay.steps), replay.differences) == (None, 2, ())
    page = render(content, "")
    assert "<td>interrupted</td><td>2</td>" in page
    assert "this one has tried nothing yet" in page


def test_an_interrupted_trial_with_a_broken_tool_tells_nothing_of_it(
    store: Store, run: LearningRunInfo
) -> None:
    counted(islice(break_tool(store, run, "l-hook", 0, now), 3))
    altered(store.path, "UPDATE trial SET outcome = NULL WHERE id = 3")
    content = gathered(store.path)
    assert len(content.replays) == 3
    adapted = [r for r in content.replays if r.spec.protocol is Protocol.TOOL_ADAPTATION]
    ended = [r for r in adapted if r.end is not None]
    assert len(ended) == len(adapted) - 1
    assert [list(broken.trials) for broken in content.broken] == [ended]
    assert "interrupted" in render(content, "")


def test_while_trials_are_replayed_it_is_said_how_many_are(
    store: Store, run: LearningRunInfo
) -> None:
    counted(solve(store, [run], 2, [1, 2, 3], 0, now))
    said: list[tuple[int, int]] = []
    content_of(store, done=lambda done, trials: said.append((done, trials)))
    assert said == [(1, 3), (2, 3), (3, 3)]


@pytest.fixture
def reproduced(store: Store) -> Store:
    """A reproduction of two leisurely robots, and the first robot of another one."""
    counted(reproduce(store, LEISURELY, robots=2, seed=7, workers=1, now=now))
    counted(reproduce(store, LEISURELY, robots=1, seed=8, workers=1, now=now))
    return store


def test_of_reproductions_the_first_robot_of_the_latest_is_shown(reproduced: Store) -> None:
    content = content_of(reproduced)
    assert content.robot == "robot 0 of 1, seed 8"
    assert content.reproduction is not None
    assert (content.reproduction.session, content.reproduction.robots) == (2, 1)
    assert len(content.replays) == 96
    assert content.left_out == 0
    assert [tool.tool.name for tool in content.tools] == [
        *("stick", "l-stick", "l-hook", "t-stick", "t-hook"),
    ]
    assert [len(broken.trials) for broken in content.broken] == [16]


def test_another_robot_of_another_reproduction_can_be_asked_for(reproduced: Store) -> None:
    content = content_of(reproduced, robot=1, session=1)
    assert content.robot == "robot 1 of 2, seed 7"
    assert {replay.spec.robot for replay in content.replays} == {1}
    assert all(replay.differences == () for replay in content.replays)
    assert content.reproduction is not None
    assert content.reproduction.session == 1
    solved = sum(r.end is not None and r.end.outcome is Outcome.SOLVED for r in content.replays)
    assert solved == content.reproduction.totals[1] + content.reproduction.broken[1]


def test_a_robot_of_one_s_own_comes_before_those_of_a_reproduction(reproduced: Store) -> None:
    """Its page shows what the reproduction gave, too."""
    run = learn(reproduced, spec_of(behaviors=60, settings=IMPATIENT), now).info
    content = content_of(reproduced)
    assert content.robot == "the robot of seed 0"
    assert [tool.run for tool in content.tools] == [run.id]
    assert content.reproduction is not None
    assert content_of(reproduced, robot=0).robot == "robot 0 of 1, seed 8"
    assert content_of(reproduced, session=1).robot == "robot 0 of 2, seed 7"


def test_a_half_finished_reproduction_is_shown_with_the_robots_that_are_saved(
    store: Store,
) -> None:
    taken(reproduce(store, LEISURELY, robots=5, seed=7, workers=1, now=now), 3)
    content = content_of(store)
    assert content.robot == "robot 0 of 2, seed 7"
    assert content.reproduction is not None
    assert content.reproduction.robots == 2
    assert {len(counts) for counts in content.reproduction.cells.values()} == {2}
    assert "2 robots are too few to say." in render(content, "")


def test_a_reproduction_without_a_robot_is_none(store: Store) -> None:
    taken(reproduce(store, LEISURELY, robots=2, seed=7, workers=1, now=now), 1)
    with pytest.raises(UsageError, match=r"nothing learned in .*; first run: affcli learn"):
        content_of(store)


def test_what_is_not_there_is_said(reproduced: Store) -> None:
    with pytest.raises(UsageError, match="no robot 2 in session 1; they are numbered 0 to 1"):
        content_of(reproduced, robot=2, session=1)
    with pytest.raises(UsageError, match=r"session 9 is no reproduction .*; there are: 1, 2"):
        content_of(reproduced, session=9)


def test_what_no_robot_can_have_made_is_refused(store: Store, run: LearningRunInfo) -> None:
    counted(solve(store, [run], 2, [1], 0, now))
    place = f"row {store.affordances(run.id)[0].row.step} of learning run {run.id}"
    for statement, error, says in (
        ("UPDATE trial SET goal = 0", DatabaseError, "trial 1 holds"),
        ("UPDATE trial SET tool = 'spoon'", DatabaseError, "trial 1 holds"),
        ("UPDATE affordance SET exploratory_behavior = 'throw'", DatabaseError, place),
        ("UPDATE affordance SET exploratory_params = '{}'", DatabaseError, place),
        ("UPDATE affordance SET end_object_y = 9e999", DatabaseError, place),
        ("UPDATE learning_run SET settings = '[]'", BadInputError, "the stored settings"),
        ("UPDATE learning_run SET versions = '7'", DatabaseError, "learning run 1 holds"),
    ):
        before = store.path.read_bytes()
        altered(store.path, statement)
        with pytest.raises(error, match=says):
            gathered(store.path)
        store.path.write_bytes(before)


def test_a_reproduction_that_lacks_its_first_robot_is_refused(reproduced: Store) -> None:
    altered(
        reproduced.path,
        "DELETE FROM step WHERE trial_id IN (SELECT id FROM trial WHERE robot = 0)",
        "DELETE FROM trial WHERE robot = 0",
        "PRAGMA foreign_keys = OFF",
        "DELETE FROM learning_run WHERE robot = 0 AND session_id = 1",
        "DELETE FROM learning_run WHERE session_id = 2",
    )
    with pytest.raises(DatabaseError, match="session 1 holds a value that affcli did not write"):
        gathered(reproduced.path)
