"""Counts and sums over stored records, held against what the records say one by one."""

import sqlite3
from contextlib import closing
from dataclasses import replace

import pytest

from affcli.behaviors.moving import CONTRACT_ARM, EXTEND_ARM
from affcli.core.behavior import BehaviorCall
from affcli.core.choice import Reason
from affcli.core.effects import Way
from affcli.core.results import InvalidTrials, LearningInterval, StepSums
from affcli.core.specs import Counters, Protocol, TrialRecord
from affcli.core.trial import Outcome, TrialEnd
from affcli.core.verification import ReplicationRecord
from affcli.store import Store
from affcli.store.reading import UnreadableError
from tests.factories import learning_spec
from tests.store.records import (
    NOW,
    VERSIONS,
    begun,
    learned,
    learning_step,
    save_trial,
    trial_spec,
    trial_step,
    verification_spec,
)

EXTEND_1 = BehaviorCall.of(EXTEND_ARM, {"offset_distance": 1.0})
EXTEND_2 = BehaviorCall.of(EXTEND_ARM, {"offset_distance": 2.0})
CONTRACT_5 = BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 5.0})

FAR, BACK, BESIDE, STILL = (0.0, 4.0), (0.0, -3.0), (2.0, 0.0), (0.0, 0.0)
BROKEN = Protocol.TOOL_ADAPTATION


def babbled(store: Store) -> int:
    """Put a run into the store that did three calls; return its number."""
    run = store.learning.begin(learning_spec(behaviors=7), VERSIONS, NOW)
    done = [
        *((EXTEND_2, FAR), (CONTRACT_5, BACK), (EXTEND_2, BESIDE), (EXTEND_2, STILL)),
        *((CONTRACT_5, STILL), (EXTEND_2, FAR), (EXTEND_1, STILL)),
    ]
    steps = [learning_step(n, call=call, moved=moved) for n, (call, moved) in enumerate(done, 1)]
    assert store.learning.append(run.id, 0, steps, None, 36.75, done=True, now=NOW)
    return run.id


def test_behaviors_are_counted_call_by_call(store: Store) -> None:
    contract, once, extend = store.results.behavior_groups(babbled(store))
    assert (contract.call, contract.tried, contract.rows) == (CONTRACT_5, 2, 1)
    assert (contract.mean_movement, contract.mean_dx, contract.mean_dy) == (3.0, 0.0, -3.0)
    assert (once.call, once.tried, once.rows, once.mean_dx) == (EXTEND_1, 1, 0, None)
    assert (extend.call, extend.tried, extend.rows) == (EXTEND_2, 4, 3)
    means = (extend.mean_movement, extend.mean_dx, extend.mean_dy)
    assert means == pytest.approx((10.0 / 3.0, 2.0 / 3.0, 8.0 / 3.0))


def test_effects_are_those_that_went_so_far_that_way(store: Store) -> None:
    """In the order of the behaviors, of each that of its parameters; a row is alive above 1/2."""
    run = babbled(store)
    table, ids = store.learning.table(run)
    failed = trial_step(table.row(0), seen=STILL)
    record = TrialRecord(trial_spec(), (failed,), TrialEnd(Outcome.STEP_LIMIT, 1, 6.5))
    assert store.results.effects(run, Way.NEARER, 2.5) == (
        (CONTRACT_5, 2, 1, 1, 1),
        (EXTEND_1, 1, 0, 0, 0),
        (EXTEND_2, 4, 0, 3, 3),
    )
    assert [one.moved for one in store.results.effects(run, Way.NEARER, 3.0)] == [0, 0, 0]
    assert [one.moved for one in store.results.effects(run, Way.FARTHER, 3.5)] == [0, 0, 2]
    assert [one.moved for one in store.results.effects(run, Way.RIGHT, 1.5)] == [0, 0, 1]
    assert [one.moved for one in store.results.effects(run, Way.LEFT, -2.5)] == [2, 1, 4]
    assert [one.moved for one in store.results.effects(run, Way.LEFT, -1.5)] == [2, 1, 3]
    spec = trial_spec(counters=Counters.STORED)
    store.trials.save_all(begun(store), run, [replace(record, spec=spec)], ids)
    assert [one.alive for one in store.results.effects(run, Way.FARTHER, 3.5)] == [1, 0, 2]


def test_intervals_count_what_ended_in_them(store: Store) -> None:
    """Each behavior takes 5.25 s: the first three end within 20 s; of them the third has no row."""
    run = babbled(store)
    learned(store)
    told = store.results.learning_intervals(20.0)
    assert list(told) == [run, run + 1]
    assert told[run] == [LearningInterval(run, 0, 3, 3), LearningInterval(run, 1, 4, 1)]


def test_behaviors_without_a_time_are_of_a_log_or_damage(store: Store) -> None:
    run, other = learned(store), learned(store, spec=learning_spec(seed=5))
    with closing(sqlite3.connect(store.path)) as driver, driver:
        driver.execute("UPDATE behavior SET clock = NULL WHERE learning_run_id = ?", [run.id])
    with pytest.raises(UnreadableError, match=f"^learning run {run.id} holds a value"):
        store.results.learning_intervals(20.0)
    with closing(sqlite3.connect(store.path)) as driver, driver:
        logged = "UPDATE learning_run SET world = 'log:map=1', robot_seconds = NULL WHERE id = ?"
        driver.execute(logged, [run.id])
    assert list(store.results.learning_intervals(20.0)) == [other.id]


def test_why_the_first_of_the_trials_counts_for_nothing(store: Store) -> None:
    run, session, other = learned(store).id, begun(store), begun(store)
    assert store.results.invalid(session) == InvalidTrials()
    table, ids = store.learning.table(run)
    for number, (where, why) in enumerate([(session, "late"), (other, "no"), (session, "later")]):
        spec = trial_spec(start=number + 1)
        end = TrialEnd(Outcome.INVALID, 0, 0.0, (Reason(why),))
        store.trials.save_all(where, run, [TrialRecord(spec, (), end)], ids)
    save_trial(store, session, run, trial_spec(start=4), [trial_step(table.row(0))])
    assert store.results.invalid(session) == InvalidTrials(2, "late")
    ends = {Outcome.INVALID: 2, Outcome.SOLVED: 1}
    assert store.results.outcome_counts([session]) == ends
    assert store.results.outcome_counts([session, other]) == {**ends, Outcome.INVALID: 3}
    (counted,) = store.results.success_counts(session)
    assert (counted.trials, counted.solved) == (1, 1)


def test_verifications_count_live_tries_and_those_that_failed(store: Store) -> None:
    """A row that was excluded is tried, too, and counts for neither."""
    run = learned(store, 12)
    table, ids = store.learning.table(run.id)
    failed = trial_step(table.row(3), seen=STILL)
    save_trial(store, begun(store), run.id, trial_spec(counters=Counters.STORED), [failed])
    table, ids = store.learning.table(run.id)
    tries = []
    seen = (FAR, STILL, STILL, STILL)
    for number, (row, moved) in enumerate(zip(table, seen, strict=True), 1):
        step = trial_step(row, number, seen=moved)
        record = ReplicationRecord(**step.record.by_name(), number=number, clock=7.5 * number)
        tries.append((record, step.truth, ids[row.step]))
    number = store.verifications.save(run.id, verification_spec(), tries, VERSIONS, NOW, NOW)
    empty = store.verifications.save(run.id, verification_spec(), [], VERSIONS, NOW, NOW)
    first, second = store.results.verifications([run.id])
    assert (first.id, first.live, first.failed) == (number, 3, 2)
    assert (second.id, second.live, second.failed) == (empty, 0, 0)
    assert (first.tool, first.shape) == ("t-hook", "l-hook")
    assert (first.borrowed, first.borrowed_failed) == (0, 0)
    assert store.results.verifications([]) == ()
    with closing(sqlite3.connect(store.path, isolation_level=None)) as driver:
        lent = sorted(row_id for _, _, row_id in tries)
        driver.execute("UPDATE affordance SET step = 0 WHERE id = ?", [lent[0]])
        driver.execute("UPDATE affordance SET step = -1 WHERE id = ?", [lent[1]])
        driver.execute("UPDATE affordance SET step = -2 WHERE id = ?", [lent[3]])
    first, _ = store.results.verifications([run.id])
    assert (first.live, first.failed, first.borrowed, first.borrowed_failed) == (3, 2, 2, 1)


def test_the_trials_of_a_broken_tool_are_summed_step_by_step(store: Store) -> None:
    """Each robot tries a row that is lost, then one that is not; the rows lie to the right."""
    run, session = learned(store).id, begun(store, "break-tool")
    table, _ = store.learning.table(run)
    for start in (1, 2):
        spec = trial_spec(start=start, shape="l-hook", protocol=BROKEN)
        steps = [trial_step(table.row(0), seen=STILL, lost=True)]
        if start == 1:
            steps.append(trial_step(table.row(1), 2, lost=False))
        save_trial(store, session, run, spec, steps)
    assert store.results.losses(session, BROKEN) == (2, 1)
    assert store.results.losses(session, Protocol.EXTENSION_OF_REACH) == (0, 0)
    (group,) = store.results.trial_groups(session, "t-hook", "l-hook", 1.0, by_robot=True)
    lost = -0.5 / len(table)
    assert (group.key, group.trials) == (0, 2)
    assert group.steps == (StepSums(1, 2, 2, 2 * lost), StepSums(2, 1, 0, 0.0))
    each = store.results.trial_groups(session, "t-hook", "l-hook", -1.0, by_robot=False)
    assert [(one.trials, len(one.steps)) for one in each] == [(1, 2), (1, 1)]
    assert all(step.change == 0.0 for one in each for step in one.steps)
    assert store.results.trial_groups(session, "t-hook", "t-hook", 1.0, by_robot=True) == ()
    other = learned(store, 12, spec=learning_spec("stick", behaviors=12)).id
    spec = trial_spec(tool="stick", shape="l-hook", protocol=BROKEN)
    save_trial(store, session, other, spec, [trial_step(store.learning.table(other)[0].row(0))])
    assert store.results.trial_groups(session, "t-hook", "l-hook", 1.0, by_robot=True) == (group,)
