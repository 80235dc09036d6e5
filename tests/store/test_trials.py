"""Sessions, trials and steps; counters and steps hold together."""

import sqlite3
from contextlib import closing
from dataclasses import replace
from itertools import product

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from affcli.core.choice import Reason
from affcli.core.geometry import Point, Pose
from affcli.core.identity import Component
from affcli.core.row_filter import Cell
from affcli.core.specs import Counters, Protocol, TrialRecord
from affcli.core.task import GoalRegion, Task
from affcli.core.trial import Outcome, TrialEnd
from affcli.errors import DatabaseError, UsageError
from affcli.store import Store, open_store, pack_robot, run_sql
from tests.factories import learning_spec
from tests.store.records import (
    NOW,
    VERSIONS,
    begun,
    counted,
    learned,
    replication,
    robot_record,
    save_trial,
    session_spec,
    trial_record,
    trial_spec,
    trial_step,
    unfinished_trial,
    verification_spec,
)

LATER = "2026-01-02T04:04:05+00:00"
STORED = Counters.STORED


def value(store: Store, query: str) -> Cell:
    """Return the one value of a query."""
    ((only,),) = run_sql(store.path, query).rows
    return only


def counters_of(store: Store) -> list[tuple[Cell, ...]]:
    """Return the counters of all rows by age."""
    return list(
        run_sql(store.path, "select times_used, times_successful from affordance order by id").rows
    )


def say_last(store: Store, reasons: str) -> None:
    """Let all trials end with these reasons, as another affcli may write them."""
    with closing(sqlite3.connect(store.path)) as driver, driver:
        driver.execute("UPDATE trial SET last_reasons = ?", [reasons])


def begin_solving(store: Store) -> int:
    return begun(store)


def test_sessions_are_begun_found_and_finished(store: Store) -> None:
    first, second = begin_solving(store), begin_solving(store)
    assert first != second
    other = begun(store, "break-tool")
    assert [s.id for s in store.sessions.all()] == [first, second, other]
    assert [s.id for s in store.sessions.all("solve")] == [first, second]
    found = store.sessions.all("solve")[-1]
    assert (found.id, found.status) == (second, "running")
    assert (found.versions, found.spec) == (VERSIONS, session_spec())
    store.sessions.finish(second, LATER)
    store.sessions.finish(second, "2027")
    found = store.sessions.all("solve")[-1]
    kept = f"select status, started_at, finished_at from session where id = {second}"
    assert run_sql(store.path, kept).rows == ((found.status, NOW, LATER),)


def test_a_reproduction_begun_again_is_the_same_session(store: Store) -> None:
    first = begun(store, "reproduce", seed=7, robots=200)
    assert store.sessions.begin(session_spec("reproduce", seed=7, robots=200), {}, LATER) == first
    assert begun(store, "reproduce", seed=7, robots=201) != first
    assert begun(store, "reproduce", seed=8, robots=200) != first


def test_a_trial_and_the_counters_it_changes_are_saved_together(store: Store) -> None:
    run = learned(store, 9)
    table, _ = store.learning.table(run.id)
    row = table.row(1)
    step = trial_step(row)
    failed = trial_step(counted(row, step.record), 2, seen=(0.0, 0.0))
    spec = trial_spec(counters=STORED)
    trial = save_trial(store, begin_solving(store), run.id, spec, [step, failed])
    assert counters_of(store) == [(1, 1), (3, 2), (1, 1)]
    assert list(store.learning.table(run.id)[0])[1].times_used == 3
    assert [(s.times_used_after, s.times_successful_after) for s in store.trials.steps(trial)] == [
        (2, 2),
        (3, 2),
    ]


def test_a_trial_that_cannot_be_saved_leaves_the_counters(store: Store) -> None:
    run = learned(store, 9)
    table, _ = store.learning.table(run.id)
    row = table.row(0)
    step = trial_step(row)
    again = trial_step(counted(row, step.record), 1)  # of the same number
    with pytest.raises(DatabaseError, match="UNIQUE constraint failed: step"):
        save_trial(store, begun(store), run.id, trial_spec(counters=STORED), [step, again])
    assert counters_of(store) == [(1, 1)] * 3
    assert store.trials.trials() == ()


def test_tries_and_the_counters_they_change_are_saved_together(store: Store) -> None:
    run = learned(store, 9)
    table, ids = store.learning.table(run.id)
    row = table.row(0)
    record, truth = replication(row)
    again, _ = replication(counted(row, record))
    one, same = (record, truth, ids[row.step]), (again, truth, ids[row.step])
    with pytest.raises(DatabaseError, match="UNIQUE constraint failed: replication"):
        store.verifications.save(run.id, verification_spec(), [one, same], VERSIONS, NOW, NOW)
    assert counters_of(store) == [(1, 1)] * 3
    store.verifications.save(run.id, verification_spec(), [one], VERSIONS, NOW, LATER)
    assert counters_of(store) == [(2, 2), (1, 1), (1, 1)]
    (tried,) = store.verifications.of_row(ids[row.step])
    assert (tried.shape, tried.before, tried.after) == ("l-hook", (1, 1), (2, 2))
    kept = "select world, tries, uses_before, started_at, finished_at, verdict from verification"
    assert run_sql(store.path, kept).rows == (("table@2", 1, 3, NOW, LATER, "undecided"),)


def test_two_planners_and_any_goal_fit_into_a_session(store: Store) -> None:
    """A trial comes back as it was given, whatever its parts are called."""
    run = learned(store)
    session = begun(store)
    shelf = Task("kitchen", GoalRegion("shelf", Point(1.5, 20.1), 3.0), "sink", Point(0.1, 0.2))
    specs = (
        trial_spec(),
        trial_spec(planner="nested-query:share=0.05"),
        replace(trial_spec(planner="oracle@2:depth=3"), task=shelf, world=Component("moon")),
    )
    for spec in specs:
        save_trial(store, session, run.id, spec)
    trials = store.trials.trials(session_id=session)
    assert tuple(trial.spec for trial in trials) == specs
    assert {trial.learned for trial in trials} == {run.spec}


def test_a_step_s_scene_is_as_it_truly_was(store: Store) -> None:
    run = learned(store)
    table, ids = store.learning.table(run.id)
    spec = trial_spec(shape="l-hook", protocol=Protocol.TOOL_ADAPTATION)
    steps = (trial_step(table.row(0), 1), trial_step(table.row(1), 2, blocked=True))
    blind = trial_step(table.row(1), 3)._replace(truth=None)
    record = TrialRecord(spec, (*steps, blind), TrialEnd(Outcome.NO_ROW, 3, 1.0))
    (trial,) = store.trials.save_all(begun(store), run.id, [record], ids)
    scene = store.trials.scene(trial, 2)
    assert (scene.title, scene.key) == (f"Trial {trial}, step 2 of 3", (trial, 2))
    assert (scene.tool, scene.held, scene.goal) == ("t-hook", spec.held, spec.task.goal)
    assert (scene.blocked, scene.wrist_before) == (True, Pose(2.5, 16.0, 0.25))
    assert scene.wrist_start == steps[1].record.placing.wrist_start
    assert (scene.attractor_start, scene.learned) == (Point(3.0, 25.1), run.spec)
    assert store.trials.scene(trial, 1).wrist_before is None
    with pytest.raises(UsageError, match="its world does not tell where the attractor was"):
        store.trials.scene(trial, 3)
    with pytest.raises(UsageError, match=f"no step 4 in trial {trial}; it has steps 1 to 3"):
        store.trials.scene(trial, 4)
    with pytest.raises(UsageError, match="no trial 9; they are numbered 1 to 1"):
        store.trials.scene(9, 1)


def test_a_trial_from_the_table_as_learned_leaves_the_stored_counters(store: Store) -> None:
    run = learned(store, 9)
    table, ids = store.learning.table(run.id)
    session = begin_solving(store)
    save_trial(store, session, run.id, trial_spec(), [trial_step(table.row(0))])
    store.trials.save_all(session, run.id, [trial_record(trial_spec(3), list(table))], ids)
    assert counters_of(store) == [(1, 1)] * 3


def test_counters_that_another_process_changed_stop_the_trial(store: Store) -> None:
    run = learned(store, 9)
    table, _ = store.learning.table(run.id)
    spec = trial_spec(counters=STORED)
    step = trial_step(table.row(0))
    with open_store(store.path, create=False, write=True) as other:
        save_trial(other, begin_solving(other), run.id, spec, [step])
    with pytest.raises(DatabaseError, match="another process changed the counters of affordance 1"):
        save_trial(store, begin_solving(store), run.id, spec, [step])
    assert len(store.trials.trials()) == 1
    assert counters_of(store) == [(2, 2), (1, 1), (1, 1)]


@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=25
)
@given(st.lists(st.tuples(st.integers(0, 2), st.booleans(), st.sampled_from(Counters)), max_size=8))
def test_counters_and_steps_hold_together(
    store: Store, uses: list[tuple[int, bool, Counters]]
) -> None:
    """A stored counter is 1 plus what the steps of trials with stored counters add to it."""
    runs = store.learning.runs()
    run = runs[0] if runs else learned(store, 9)
    for position, success, counters in uses:
        table, _ = store.learning.table(run.id, as_learned=counters is Counters.AS_LEARNED)
        spec = trial_spec(counters=counters)
        step = trial_step(table.row(position), seen=(0.0, 4.0) if success else (0.0, 0.0))
        save_trial(store, begin_solving(store), run.id, spec, [step])
    assert (
        value(
            store,
            """
        select count(*) from affordance a where (times_used, times_successful) <> (
            select 1 + count(*), 1 + coalesce(sum(replicated), 0)
            from step join trial t on t.id = trial_id
            where affordance_id = a.id and t.counters = 'stored')
        """,
        )
        == 0
    )


def test_a_trial_keeps_how_it_ended(store: Store) -> None:
    run = learned(store)
    session, reasons = begin_solving(store), (Reason("probable", 0, 0.5),)
    record = TrialRecord(trial_spec(), (), TrialEnd(Outcome.NO_ROW, 3, 41.5, reasons))
    (trial,) = store.trials.save_all(session, run.id, [record], {})
    (result,) = store.trials.trials()
    assert (result.outcome, result.steps, result.robot_seconds) == (Outcome.NO_ROW, 3, 41.5)
    assert store.trials.trial(trial).last_reasons == (Reason("probable", 0, 0.5),)
    assert value(store, "select last_reasons from trial") == (
        '[{"name":"probable","rows":0,"value":0.5}]'
    )


def test_a_reason_of_a_newer_affcli_is_read_as_far_as_it_is_known(store: Store) -> None:
    run = learned(store)
    session, reasons = begin_solving(store), (Reason("probable", 0, 0.5),)
    record = TrialRecord(trial_spec(), (), TrialEnd(Outcome.NO_ROW, 3, 41.5, reasons))
    (trial,) = store.trials.save_all(session, run.id, [record], {})
    for text in (
        '[{"name":"probable","rows":0,"value":0.5,"unit":"in"}]',
        '[{"unit":"in","value":0.5,"rows":0,"name":"probable"}]',
    ):
        say_last(store, text)
        assert store.trials.trial(trial).last_reasons == reasons
    for text in ('[{"unit":"in"}]', '["name"]', "[7]", "7"):
        say_last(store, text)
        with pytest.raises(DatabaseError, match=f"trial {trial} holds a value"):
            store.trials.trial(trial)


def test_every_step_is_kept_with_the_row_it_tried(store: Store) -> None:
    run = learned(store, 9)
    table, ids = store.learning.table(run.id)
    row = replace(table.row(2), times_used=4, times_successful=3)
    steps = (
        trial_step(row, 1, seen=(1.0, 3.0)),
        trial_step(row, 2, blocked=True, lost=True),
        trial_step(row, 3, seen=(0.0, -4.0), lost=False),
    )
    end = TrialEnd(Outcome.STEP_LIMIT, 3, 20.0)
    session = begin_solving(store)
    store.trials.save_all(session, run.id, [TrialRecord(trial_spec(), steps, end)], ids)
    (result,) = store.trials.trials(session_id=session)
    stored = store.trials.steps(result.id)
    assert [s.row for s in stored] == [row] * 3
    for kept, (record, _, lost) in zip(stored, steps, strict=True):
        assert (kept.number, kept.clock, kept.reasons, kept.regrasped) == (
            *(record.number, record.clock, record.reasons, record.regrasped),
        )
        moved = record.execution or record.placing
        assert (kept.wrist_start, kept.wrist_end) == (moved.wrist_start, moved.wrist_end)
        assert (kept.affordance_id, kept.replicated, kept.died) == (
            *(ids[row.step], record.replicated),
            record.died,
        )
        assert (kept.expected, kept.seen, kept.seen_distance) == (
            *(record.expected, record.seen),
            record.seen.distance,
        )
        assert (kept.seen_start, kept.seen_end) == (
            record.start.object_position,
            record.end.object_position,
        )
        assert (kept.times_used_after, kept.times_successful_after) == (
            record.times_used_after,
            record.times_successful_after,
        )
        assert kept.lost is lost
    assert [(s.placing_status, s.status) for s in stored] == [
        ("done", "done"),
        ("blocked", None),
        ("done", "done"),
    ]
    truths = run_sql(
        store.path, "select true_start_x, true_start_y, true_end_x, true_end_y from step"
    )
    assert truths.rows == ((3.0, 25.1, 3.1, 29.2),) * 3


def test_the_same_trial_is_not_stored_twice_in_a_session(store: Store) -> None:
    run = learned(store)
    session = begin_solving(store)
    save_trial(store, session, run.id, trial_spec())
    with pytest.raises(Exception, match="UNIQUE constraint failed: trial"):
        save_trial(store, session, run.id, trial_spec())
    save_trial(store, begin_solving(store), run.id, trial_spec())


def begin_reproducing(store: Store, robots: int = 2) -> int:
    return begun(store, "reproduce", robots=robots)


def test_a_robot_is_saved_once_and_whole(store: Store) -> None:
    session = begin_reproducing(store)
    assert store.sessions.saved_robots(session) == frozenset()
    assert store.sessions.save_robot({session: VERSIONS}, robot_record(1), NOW)
    assert not store.sessions.save_robot({session: VERSIONS}, robot_record(1), LATER)
    assert store.sessions.save_robot({session: VERSIONS}, robot_record(0), NOW)
    assert store.sessions.saved_robots(session) == {0, 1}
    runs = store.learning.runs(session_id=session)
    assert [(r.spec.tool, r.spec.robot, r.behaviors, r.rows) for r in runs] == [
        ("stick", 1, 6, 2),
        ("t-hook", 1, 6, 2),
        ("stick", 0, 6, 2),
        ("t-hook", 0, 6, 2),
    ]
    assert {(r.status, r.robot_seconds, r.resets, r.checkpoint) for r in runs} == {
        ("done", 31.5, 3, None)
    }
    assert value(store, "select count(*) from trial") == 10
    assert value(store, "select count(*) from step") == 16
    assert store.learning.runs() == ()


def test_a_robot_of_another_session_is_another_robot(store: Store) -> None:
    first, second = begin_reproducing(store, 2), begin_reproducing(store, 3)
    assert store.sessions.save_robot({first: VERSIONS}, robot_record(0), NOW)
    assert store.sessions.save_robot({second: VERSIONS}, robot_record(0), NOW)
    alone = learned(store, spec=learning_spec("stick", behaviors=6))
    assert alone.session_id is None


def everything(store: Store) -> list[tuple[tuple[Cell, ...], ...]]:
    """Return all rows of all tables."""
    tables = ("session", "learning_run", "behavior", "affordance", "trial", "step")
    return [run_sql(store.path, f"select * from {table}").rows for table in tables]


def test_a_packed_robot_is_saved_as_the_robot_itself(store: Store, empty_database: object) -> None:
    session = begin_reproducing(store)
    store.sessions.save_robot({session: VERSIONS}, robot_record(0), NOW)
    plain = everything(store)
    with store.database.writing() as connection:
        for table in ("step", "trial", "affordance", "behavior", "learning_run"):
            connection.exec_driver_sql(f"DELETE FROM {table}")
        connection.exec_driver_sql("DELETE FROM sqlite_sequence WHERE name <> 'session'")
    store.sessions.save_robot({session: VERSIONS}, pack_robot(robot_record(0)), NOW)
    assert everything(store) == plain


def test_a_robot_is_saved_whole_or_not_at_all(store: Store) -> None:
    session = begin_reproducing(store)
    record = robot_record(0)
    torn = replace(record, tested=(*record.tested, record.tested[-1]))
    with pytest.raises(Exception, match="UNIQUE constraint failed"):
        store.sessions.save_robot({session: VERSIONS}, torn, NOW)
    assert store.sessions.saved_robots(session) == frozenset()
    assert [len(rows) for rows in everything(store)] == [1, 0, 0, 0, 0, 0]


def test_sums_for_reports(store: Store) -> None:
    session = begin_reproducing(store)
    for robot in range(2):
        store.sessions.save_robot({session: VERSIONS}, robot_record(robot), NOW)
    whole, broken = Protocol.EXTENSION_OF_REACH, Protocol.TOOL_ADAPTATION
    assert [
        (c.robot, c.protocol, c.tool, c.shape, c.goal, c.trials, c.solved)
        for c in store.results.success_counts(session)
    ] == [
        (robot, *cell)
        for robot in range(2)
        for cell in (
            (whole, "stick", "stick", "1", 2, 1),
            (whole, "t-hook", "t-hook", "1", 2, 1),
            (broken, "t-hook", "l-hook", "1", 1, 1),
        )
    ]
    assert store.results.outcome_counts([session]) == {Outcome.NO_ROW: 4, Outcome.SOLVED: 6}
    assert store.results.outcome_counts([]) == {}
    assert store.results.losses(session, broken) == (2, 2)
    assert store.results.losses(session, whole) == (0, 0)
    assert store.results.losses(session + 1, broken) == (0, 0)


def test_invalid_trials_count_for_nothing(store: Store) -> None:
    run = learned(store)
    _, ids = store.learning.table(run.id)
    session = begin_solving(store)
    ended = [
        trial_record(trial_spec(1, start), (), outcome)
        for start, outcome in enumerate((Outcome.SOLVED, Outcome.INVALID, Outcome.NO_ROW), 1)
    ]
    store.trials.save_all(session, run.id, ended, ids)
    unfinished_trial(store, session, run.id, trial_spec(1, 4))
    (count,) = store.results.success_counts(session)
    assert (count.trials, count.solved) == (2, 1)
    assert [t.outcome for t in store.trials.trials()] == [*(t.end.outcome for t in ended), None]


def test_a_trial_of_every_outcome_is_kept_and_of_no_other(store: Store) -> None:
    """What the schema knows are the names that affcli has."""
    run = learned(store)
    _, ids = store.learning.table(run.id)
    ended = [
        trial_record(trial_spec(goal, start), (), outcome)
        for (goal, start), outcome in zip(product((1, 2), (1, 2, 3, 4)), Outcome, strict=False)
    ]
    store.trials.save_all(begin_solving(store), run.id, ended, ids)
    assert [trial.outcome for trial in store.trials.trials()] == list(Outcome)
    with (
        closing(sqlite3.connect(store.path)) as driver,
        pytest.raises(sqlite3.IntegrityError, match="CHECK constraint failed: outcome"),
    ):
        driver.execute("UPDATE trial SET outcome = 'gave up'")


def test_outcomes_can_be_narrowed(store: Store) -> None:
    runs = {
        tool: learned(store, spec=learning_spec(tool, behaviors=9)) for tool in ("stick", "t-hook")
    }
    solving = begin_solving(store)
    breaking = begun(store, "break-tool")
    for session in (solving, breaking):
        for tool, run in runs.items():
            store.trials.save_all(session, run.id, [trial_record(trial_spec(tool=tool), ())], {})
    assert len(store.trials.trials()) == 4
    assert {r.session_id for r in store.trials.trials(kind="solve")} == {solving}
    (one,) = store.trials.trials(session_id=breaking, run_id=runs["t-hook"].id)
    assert (one.spec.tool, one.spec.protocol) == ("t-hook", Protocol.EXTENSION_OF_REACH)


def test_behavior_groups_count_tries_and_rows(store: Store) -> None:
    run = learned(store, 9)
    (group,) = store.results.behavior_groups(run.id)
    assert (str(group.call), group.tried, group.rows) == ("extend arm 5", 9, 3)
    assert (group.mean_movement, group.mean_dx, group.mean_dy) == (4.0, 0.0, 4.0)
    empty = store.learning.begin(learning_spec(seed=9), VERSIONS, NOW)
    assert store.results.behavior_groups(empty.id) == ()
