"""What the database holds can be done again, and equals its record to the bit."""

from dataclasses import replace

import pytest

from affcli.config import Settings, settings_with
from affcli.core.affordance import Affordance
from affcli.core.behavior import ExecutionStatus
from affcli.core.identity import Component
from affcli.core.records import LearningRunInfo
from affcli.core.replay import Replay
from affcli.core.specs import Counters, LearningSpec
from affcli.errors import BadInputError, UsageError
from affcli.lab.breaking import break_tool
from affcli.lab.film_strips import film_of
from affcli.lab.filming import FRAME_RATE
from affcli.lab.replaying import CLOSE, film_length, gif_of, replay_run, replay_trial
from affcli.lab.reproduction import Reproduced, reproduce
from affcli.lab.run_parts import RunParts
from affcli.lab.solving import session_spec
from affcli.lab.verifying import verification_spec, verify
from affcli.lab.viewing import scenes_of_step
from affcli.store import Store, open_store, run_sql
from affcli.store.connection import insert_many
from affcli.store.rows import affordance_row
from affcli.store.tables import affordance
from tests.factories import tool_named, trial_spec
from tests.lab.parts import CURIOUS, SILENT, register
from tests.lab.quick import (
    IMPATIENT,
    LEISURELY,
    NOW,
    PLANNER,
    altered,
    counted,
    learned,
    now,
    solving,
    spec_of,
    stored,
    table_from,
)
from tests.store.records import unfinished_trial


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A run of the T-hook whose trials end soon."""
    return stored(store, spec_of(behaviors=400, settings=IMPATIENT))


def broken(store: Store, run: LearningRunInfo) -> None:
    """Do the trials with the broken tool and the whole one."""
    counted(break_tool(store, run, tool_named("l-hook"), 0, now, PLANNER))


def assert_equal_to_the_record(store: Store) -> None:
    """Do every trial and every learning run again."""
    for trial in store.trials.trials():
        replay = replay_trial(store, trial.id)
        assert replay.differences == (), trial
        assert len(replay.steps) == trial.steps
    for run in store.learning.runs():
        # Those before the last are not filmed, and told only where they differ.
        (last,) = replay_run(store, run, run.behaviors)
        assert last.differences == ()


def test_all_96_trials_of_a_robot_are_what_their_record_says(store: Store) -> None:
    """80 trials of extension of reach (§7.1) and 16 with a broken tool (§7.2)."""
    what = Reproduced(RunParts.chosen(Settings()), PLANNER, 77)
    counted(reproduce(store, what, robots=1, workers=1, now=now))
    trials = store.trials.trials()
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
        counted(solving(store, run, "2", seed=seed))
    broken(store, run)
    spec = verification_spec(run, tool_named("l-hook"), 3, None, 40, until_verdict=False)
    counted(verify(store, run, spec, now, update=True))
    counted(solving(store, run, "1", "2", seed=9))
    assert_equal_to_the_record(store)
    table, ids = store.trials.table_before(max(trial.id for trial in store.trials.trials()))
    assert any(row.times_used > 1 for row in table)
    assert ids == {row.row.step: row.id for row in store.learning.rows(run.id)}


def test_a_trial_seen_through_the_camera(store: Store, run: LearningRunInfo) -> None:
    """A trial through another sensor than the run's is done again through that sensor."""
    counted(solving(store, run, "4", "3", sensor="camera"))
    replay = replay_trial(store, 1)
    assert replay.spec.sensor == "camera"
    assert replay.differences == ()


def test_an_interrupted_trial_is_done_as_far_as_it_came(store: Store, run: LearningRunInfo) -> None:
    """Trials are saved whole now; databases of before may hold one that was cut off."""
    counted(solving(store, run, "1", "1"))
    altered(store.path, "delete from step where number > 2")
    altered(store.path, "update trial set outcome = null, steps = null, robot_seconds = null")
    replay = replay_trial(store, 1)
    assert (len(replay.steps), replay.end, replay.differences) == (2, None, ())


@pytest.mark.parametrize(
    ("column", "value"), [("true_end_x", 1.25), ("times_used_after", 7), ("affordance_id", 1)]
)
def test_a_record_that_was_changed_is_found_out(
    store: Store, run: LearningRunInfo, column: str, value: float
) -> None:
    counted(solving(store, run, "1", "1"))
    altered(store.path, f"update step set {column} = {value} where number = 2")
    with open_store(store.path, create=False, write=False) as again:
        (difference,) = replay_trial(again, 1).differences
    assert (difference.number, difference.column, difference.stored) == (2, column, value)
    assert difference.again != value


def test_steps_that_are_missing_or_an_end_that_was_another_are_found_out(
    store: Store, run: LearningRunInfo
) -> None:
    counted(solving(store, run, "1", "1"))
    altered(store.path, "delete from step where number = 2")
    altered(store.path, "update trial set outcome = 'no row left'")
    found = [d[:2] for d in replay_trial(store, 1).differences]
    assert found == [(2, "number"), (0, "outcome")]


@pytest.fixture
def replay(store: Store, run: LearningRunInfo) -> Replay:
    """A trial with the broken tool, done again."""
    broken(store, run)
    trials = store.trials.trials()
    trials = tuple(t for t in trials if t.spec.shape == "l-hook" and t.spec.goal == "1")
    return replay_trial(store, trials[-1].id)


def test_the_scenes_of_a_replay_follow_what_happened(replay: Replay) -> None:
    """15 a robot second; each step begins and ends where its record says; nothing leaps."""
    start = replay.opening.attractor.point
    for one in replay.steps:
        record, truth = one.step.record, one.step.truth
        assert truth is not None
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
        assert len(one.considered) == min(CLOSE, record.reasons[-1].rows or 0)
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
    run = stored(store, spec_of(behaviors=300, settings=settings))
    counted(solving(store, run, "1", "1"))
    replay = replay_trial(store, 1)
    assert replay.differences == ()
    assert replay.steps
    ends = [one.step.truth.end for one in replay.steps if one.step.truth is not None]
    assert any(one.scenes[-1].attractor == end for one, end in zip(replay.steps, ends, strict=True))
    assert all(one.scenes for one in replay.steps)
    assert all(behavior.scenes for behavior in replay_run(store, run, 2, 9))


@pytest.mark.parametrize("speed", [1.0, 1.4, 1.6, 100.0])
def test_a_film_has_as_many_pictures_as_was_said(replay: Replay, speed: float) -> None:
    for numbers in ([1], range(1, len(replay.steps) + 1)):
        drawn: list[int] = []
        gif_of(replay, numbers, speed, drawn.append)
        assert drawn == list(range(1, film_length(replay, numbers, speed) + 1))
    assert film_length(replay, [], speed) == 0


def test_a_learning_run_is_done_again(store: Store) -> None:
    info = stored(store, spec_of("l-stick", behaviors=60, settings=LEISURELY))
    behaviors = list(replay_run(store, info))
    assert [b.record.step for b in behaviors] == list(range(1, 61))
    assert not any(b.differences for b in behaviors)
    assert all(b.truth and b.scenes[-1].attractor.point == b.truth.end.point for b in behaviors)
    some = list(replay_run(store, info, 11, 13))
    assert [b.record.step for b in some] == [11, 12, 13]
    assert [b.scenes for b in some] == [b.scenes for b in behaviors[10:13]]


def test_a_changed_behavior_or_row_is_found_out(store: Store) -> None:
    info = stored(store, spec_of(behaviors=60))
    row = store.learning.rows(info.id)[0]
    altered(store.path, "update behavior set true_end_angle = 4.5 where step = 7")
    altered(store.path, f"update affordance set movement = 99 where id = {row.id}")
    with open_store(store.path, create=False, write=False) as again:
        found = [d[:3] for b in replay_run(again, info, 50, 50) for d in b.differences]
    assert found == sorted([(7, "true_end_angle", 4.5), (row.row.step, "movement", 99.0)])


def test_counters_that_trials_changed_are_no_difference(store: Store, run: LearningRunInfo) -> None:
    counted(solving(store, run, "1", "1"))
    (last,) = replay_run(store, run, run.behaviors)
    assert last.differences == ()


def test_what_is_not_there_is_said(store: Store, run: LearningRunInfo) -> None:
    with pytest.raises(UsageError, match="no trial 1; there are none yet"):
        replay_trial(store, 1)
    with pytest.raises(UsageError, match="no learning run 2; they are numbered 1 to 1"):
        store.learning.run(2)


def test_trials_by_two_planners_are_each_done_again_by_their_own(
    store: Store, run: LearningRunInfo
) -> None:
    for planner in ("nested-query", "nested-query:share=0.05"):
        counted(solving(store, run, "2", planner=Component.parse(planner)))
    assert {str(trial.spec.planner) for trial in store.trials.trials()} == {
        "nested-query",
        "nested-query:share=0.05",
    }
    assert_equal_to_the_record(store)


def other_run(store: Store, **chosen: object) -> LearningRunInfo:
    """Return a stored run of the T-hook with other parts than the paper's."""
    parts = RunParts.chosen(IMPATIENT, **chosen)  # type: ignore[arg-type]
    return stored(store, parts.spec("t-hook", 0, 0, None, 300))


def test_runs_by_two_grasps_and_another_repertoire_are_solved_and_done_again(
    store: Store, run: LearningRunInfo
) -> None:
    high = other_run(store, binding="grasp:grasp_point=4")
    more = other_run(store, repertoire=["paper", "extend-arm:offset_distance=3"])
    for one in (run, high, more):
        counted(solving(store, one, "2"))
    broken(store, high)
    used = "select distinct exploratory_params from affordance where learning_run_id = 3"
    assert ('{"offset_distance": 3.0}',) in run_sql(store.path, used).rows
    assert_equal_to_the_record(store)


def test_a_wrist_that_turns_and_a_lopsided_puck_are_solved_with_and_done_again(
    store: Store,
) -> None:
    """To the bit, from the wrist turned by a behavior and the puck turned as it was drawn."""
    puck = {"puck": {"mass_offset": 0.3, "mass_turned": "drawn"}, "trial": {"max_steps": 6}}
    turning = ["paper", "turn-and-pull:angle=60", "turn-wrist"]
    parts = RunParts.chosen(settings_with(puck, "a test"), repertoire=turning)
    one = stored(store, parts.spec("stick", 0, 0, None, 120))
    assert {row.row.exploratory.name for row in store.learning.rows(one.id)} >= {
        "turn and pull",
        "turn wrist",
    }
    counted(solving(store, one, "1"))
    ends = run_sql(store.path, "select count(*) from step where wrist_end_angle > 0.5").rows
    assert ends[0][0] != 0
    assert_equal_to_the_record(store)


def with_rows(store: Store, spec: LearningSpec, rows: list[Affordance]) -> LearningRunInfo:
    """Return a stored run whose table has rows that no behavior of it made."""
    run = stored(store, spec)
    last, more = store.learning.rows(run.id)[-1].row.step, []
    for step, row in enumerate(rows, last + 1):
        more.append(replace(row, step=step))
    with store.database.writing() as connection:
        for row in more:
            values = affordance_row(run.id, spec.tool, row)
            insert_many(connection, affordance, [values])
        count = f"UPDATE learning_run SET rows = rows + {len(more)} WHERE id = {run.id}"
        connection.exec_driver_sql(count)
    return store.learning.run(run.id)


def test_a_table_with_rows_of_two_grasps_and_of_a_turned_wrist_is_used_and_done_again(
    store: Store,
) -> None:
    """Steps say where the tool was grasped anew, films how it was held."""
    high = RunParts.chosen(IMPATIENT, binding="grasp:grasp_point=4").spec("t-hook", 0, 0, None, 300)
    rows = list(table_from(learned(high)))
    turned = [replace(row, wrist_angle=0.5) for row in rows]
    run = with_rows(store, spec_of(behaviors=300, settings=IMPATIENT), turned)
    for goal in "1234":
        counted(solving(store, run, goal))
    steps = [step for t in store.trials.trials() for step in store.trials.steps(t.id)]
    assert {step.regrasped for step in steps} == {True, False}
    assert {step.row.binding["grasp_point"] for step in steps} == {1.0, 4.0}
    assert {step.wrist_end.angle for step in steps} == {0.0, 0.5}
    for trial in store.trials.trials():
        assert replay_trial(store, trial.id).differences == ()
        film_of(store, trial.id)
        for number in range(1, (trial.steps or 0) + 1):
            scene = store.trials.scene(trial.id, number)
            film = scenes_of_step(scene)
            assert film[-1].attractor.point == pytest.approx(scene.attractor_end, abs=0.02)


def test_a_run_of_an_outsiders_explorer_is_done_again(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as here:
        register(here, CURIOUS)
        run = other_run(store, explorer="curious")
        (last,) = replay_run(store, run, run.behaviors)
        assert last.differences == ()
    with pytest.raises(BadInputError, match="explorer curious: this affcli has no such part"):
        list(replay_run(store, run))
    # Its table serves all the same.
    counted(solving(store, run, "2", "1"))
    assert replay_trial(store, 1).differences == ()


@pytest.mark.parametrize(
    ("column", "value", "says"),
    [
        ("planner", "clairvoyant", "planner clairvoyant: this affcli has no such part"),
        ("planner", "nested-query@7", "this affcli has version 1 of it"),
        ("world", "table@7", "made in version 7 of the world table, this affcli has 2"),
        ("world", "moon", "world moon: this affcli has no such part"),
    ],
)
def test_a_trial_with_a_part_that_is_not_here_is_refused_and_the_others_are_not(
    column: str, value: str, says: str, store: Store, run: LearningRunInfo
) -> None:
    counted(solving(store, run, "1", "1"))
    altered(store.path, f"update trial set {column} = '{value}'")
    counted(solving(store, run, "1", "2"))
    with pytest.raises(BadInputError, match=says) as caught:
        replay_trial(store, 1)
    assert "\n" not in str(caught.value)
    assert store.trials.trial(1).outcome is not None
    assert film_of(store, 1).steps
    assert replay_trial(store, 2).differences == ()


def test_a_world_without_replays_says_so_in_a_line(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    register(monkeypatch, SILENT)
    run = other_run(store, world="silent")
    counted(solving(store, run, "2"))
    kept = "select count(*) > 0, count(true_start_x), count(true_end_y) from step"
    assert run_sql(store.path, kept).rows == ((1, 0, 0),)
    for refused in (lambda: replay_trial(store, 1), lambda: list(replay_run(store, run))):
        with pytest.raises(UsageError, match="the world silent has no replays"):
            refused()
    assert film_of(store, 1).steps
    with pytest.raises(UsageError, match="its world does not tell where the attractor was"):
        store.trials.scene(1, 1)
    with pytest.raises(UsageError, match="its world does not tell where the attractor was"):
        store.learning.scene(run.id, 1)


def test_a_trial_that_was_killed_before_its_first_step_is_there_without_steps(
    store: Store, run: LearningRunInfo
) -> None:
    spec = replace(trial_spec(run.spec), counters=Counters.STORED)
    session = store.sessions.begin(session_spec("solve", run, spec), {}, NOW)
    number = unfinished_trial(store, session, run.id, spec)
    replay = replay_trial(store, number)
    assert (replay.steps, replay.end, replay.differences) == ((), None, ())
    assert replay.opening.attractor.point == spec.task.start
    assert film_length(replay, [], 1.0) == 0
    assert film_of(store, number).steps == ()
    assert [trial.outcome for trial in store.trials.trials()] == [None]
    with pytest.raises(UsageError, match=f"no step 1 in trial {number}; it has none"):
        store.trials.scene(number, 1)
