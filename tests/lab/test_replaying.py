"""What the database holds can be done again, and equals its record to the bit."""

import sqlite3
from itertools import islice
from pathlib import Path

import pytest

from affcli.config import Settings, settings_with
from affcli.core.behavior import ExecutionStatus
from affcli.core.replay import Replay
from affcli.errors import UsageError
from affcli.lab.breaking import break_tool
from affcli.lab.filming import FRAME_RATE
from affcli.lab.learning import learn
from affcli.lab.replaying import CLOSE, film_length, gif_of, replay_run, replay_trial
from affcli.lab.reproduction import reproduce
from affcli.lab.solving import solve
from affcli.lab.verifying import verification_spec, verify
from affcli.store import LearningRunInfo, Store, open_store
from tests.lab.quick import IMPATIENT, LEISURELY, counted, now, spec_of


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A run of the T-hook whose trials end soon."""
    return learn(store, spec_of(behaviors=400, settings=IMPATIENT), now).info


def altered(path: Path, statement: str) -> None:
    """Change the database as no affcli would."""
    with sqlite3.connect(path) as driver:
        driver.execute(statement)
    driver.close()


def test_all_96_trials_of_a_robot_are_what_their_record_says(store: Store) -> None:
    """80 trials of extension of reach (§7.1) and 16 with a broken tool (§7.2)."""
    counted(reproduce(store, Settings(), robots=1, seed=77, workers=1, now=now))
    trials = store.trials()
    assert len(trials) == 96
    for trial in trials:
        replay = replay_trial(store, trial.id)
        assert replay.differences == (), trial
        assert len(replay.steps) == trial.steps
        assert replay.end is not None
        assert replay.end.outcome is trial.outcome


def test_trials_that_update_the_stored_counters_begin_with_those_of_their_time(
    store: Store, run: LearningRunInfo
) -> None:
    """`solve` and `verify --update` again and again: each starts from what the others left."""
    for seed in range(3):
        counted(solve(store, [run], 2, [1, 2, 3, 4], seed, now))
    counted(break_tool(store, run, "l-hook", 0, now))
    spec = verification_spec(run, "l-hook", 3, None, 40, until_verdict=False)
    counted(verify(store, run, spec, now, update=True))
    counted(solve(store, [run], 1, [1, 2], 9, now))
    for trial in store.trials():
        assert replay_trial(store, trial.id).differences == (), trial
    table, ids = store.table_before(max(trial.id for trial in store.trials()))
    assert any(row.times_used > 1 for row in table)
    assert ids == {row.row.step: row.id for row in store.affordances(run.id)}


def test_a_trial_seen_through_the_camera(store: Store, run: LearningRunInfo) -> None:
    """A trial through another sensor than the run's is done again through that sensor."""
    counted(solve(store, [run], 4, [3], 0, now, "camera"))
    replay = replay_trial(store, 1)
    assert replay.spec.sensor == "camera"
    assert replay.differences == ()


def test_an_interrupted_trial_is_done_as_far_as_it_came(store: Store, run: LearningRunInfo) -> None:
    taken = list(islice(solve(store, [run], 1, [1], 0, now), 2))
    assert len(taken) == 2
    replay = replay_trial(store, 1)
    assert (len(replay.steps), replay.end, replay.differences) == (2, None, ())


@pytest.mark.parametrize(
    ("column", "value"), [("true_end_x", 1.25), ("times_used_after", 7), ("affordance_id", 1)]
)
def test_a_record_that_was_changed_is_found_out(
    store: Store, run: LearningRunInfo, column: str, value: float
) -> None:
    counted(solve(store, [run], 1, [1], 0, now))
    altered(store.path, f"update step set {column} = {value} where number = 2")
    with open_store(store.path, create=False, write=False) as again:
        (difference,) = replay_trial(again, 1).differences
    assert (difference.number, difference.column, difference.stored) == (2, column, value)
    assert difference.again != value


def test_steps_that_are_missing_or_an_end_that_was_another_are_found_out(
    store: Store, run: LearningRunInfo
) -> None:
    counted(solve(store, [run], 1, [1], 0, now))
    altered(store.path, "delete from step where number = 2")
    altered(store.path, "update trial set outcome = 'no row left'")
    found = [d[:2] for d in replay_trial(store, 1).differences]
    assert found == [(2, "number"), (0, "outcome")]


@pytest.fixture
def replay(store: Store, run: LearningRunInfo) -> Replay:
    """A trial with the broken tool, done again."""
    counted(break_tool(store, run, "l-hook", 0, now))
    trials = [t for t in store.trials() if t.spec.shape == "l-hook" and t.spec.goal == 1]
    return replay_trial(store, trials[-1].id)


def test_the_scenes_of_a_replay_follow_what_happened(replay: Replay) -> None:
    """15 a robot second; each step begins and ends where its record says; nothing leaps."""
    start = replay.opening.attractor.point
    for one in replay.steps:
        record, truth = one.step.record, one.step.truth
        first, last = one.scenes[0], one.scenes[-1]
        assert first.attractor.point == pytest.approx(start, abs=0.02)
        assert last.attractor == pytest.approx(truth.end, abs=0.05)
        took = record.placing.duration + (record.execution.duration if record.execution else 0.0)
        assert len(one.scenes) == pytest.approx(took * FRAME_RATE, abs=2)
        assert 0 < one.placed <= len(one.scenes)
        assert any(scene.lift > 1.0 for scene in one.scenes[: one.placed])
        pushing = one.scenes[one.placed + 1 :]
        assert all(scene.lift == 0.0 for scene in pushing)
        assert {scene.tool.name for scene in one.scenes} == {"l-hook"}
        start = last.attractor.point


def test_the_row_chosen_comes_first_among_those_considered(replay: Replay) -> None:
    """§6.2, search 4: of the nearest rows the one that needs the least re-positioning."""
    for one in replay.steps:
        record = one.step.record
        assert one.considered[0].row == record.row
        assert len(one.considered) == min(CLOSE, record.survivors.nearest)
        travels = [each.repositioning for each in one.considered]
        assert travels == sorted(travels)
        if record.placing.status is ExecutionStatus.DONE:
            start, end = record.placing.wrist_start, record.placing.wrist_end
            went = ((end.x - start.x) ** 2 + (end.y - start.y) ** 2) ** 0.5
            assert travels[0] == pytest.approx(went, abs=0.01)


def test_of_arms_too_quick_for_a_frame_there_is_a_scene_too(store: Store) -> None:
    """Though none of the 15 a second falls into a step."""
    speeds = ("push_speed", "transfer_speed", "lift_speed", "push_acceleration")
    quick = dict.fromkeys((*speeds, "transfer_acceleration"), 1e6) | {"hold": 0.0}
    settings = settings_with({"motion": quick, "trial": {"max_steps": 4}}, "a test")
    run = learn(store, spec_of(behaviors=300, settings=settings), now).info
    counted(solve(store, [run], 1, [1], 0, now))
    replay = replay_trial(store, 1)
    assert replay.differences == ()
    assert replay.steps
    assert any(one.scenes[-1].attractor == one.step.truth.end for one in replay.steps)
    assert all(one.scenes for one in replay.steps)
    assert all(behavior.scenes for behavior in replay_run(store, run, 2, 9))


@pytest.mark.parametrize("speed", [0.2, 1.0, 1.4, 1.6, 7.0, 100.0])
def test_a_film_has_as_many_pictures_as_was_said(replay: Replay, speed: float) -> None:
    for numbers in ([1], range(1, len(replay.steps) + 1)):
        drawn: list[int] = []
        gif_of(replay, numbers, speed, drawn.append)
        assert drawn == list(range(1, film_length(replay, numbers, speed) + 1))
    assert film_length(replay, [], speed) == 0


def test_a_learning_run_is_done_again(store: Store) -> None:
    info = learn(store, spec_of("l-stick", behaviors=60, settings=LEISURELY), now).info
    behaviors = list(replay_run(store, info))
    assert [b.record.step for b in behaviors] == list(range(1, 61))
    assert not any(b.differences for b in behaviors)
    assert all(b.scenes[-1].attractor.point == b.truth.end.point for b in behaviors)
    some = list(replay_run(store, info, 11, 13))
    assert [b.record.step for b in some] == [11, 12, 13]
    assert [b.scenes for b in some] == [b.scenes for b in behaviors[10:13]]


def test_a_changed_behavior_or_row_is_found_out(store: Store) -> None:
    info = learn(store, spec_of(behaviors=60), now).info
    row = store.affordances(info.id)[0]
    altered(store.path, "update behavior set true_end_angle = 4.5 where step = 7")
    altered(store.path, f"update affordance set movement = 99 where id = {row.id}")
    with open_store(store.path, create=False, write=False) as again:
        found = [d[:3] for b in replay_run(again, info, 50, 50) for d in b.differences]
    assert found == sorted([(7, "true_end_angle", 4.5), (row.row.step, "movement", 99.0)])


def test_counters_that_trials_changed_are_no_difference(store: Store, run: LearningRunInfo) -> None:
    counted(solve(store, [run], 1, [1], 0, now))
    assert not any(b.differences for b in replay_run(store, run))


def test_what_is_not_there_is_said(store: Store, run: LearningRunInfo) -> None:
    with pytest.raises(UsageError, match="no trial 1; there are none yet"):
        replay_trial(store, 1)
    with pytest.raises(UsageError, match="no learning run 2; they are numbered 1 to 1"):
        store.learning_run(2)
