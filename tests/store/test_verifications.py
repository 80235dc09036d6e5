"""Verifications in the store: what is kept of one, and of a world that tells no truth."""

from dataclasses import replace

from affcli.core.affordance import Affordance
from affcli.core.specs import Counters, TrialRecord
from affcli.core.trial import Outcome, TrialEnd
from affcli.store import Store, run_sql
from tests.factories import learning_spec
from tests.store.records import (
    NOW,
    VERSIONS,
    begun,
    learned,
    learning_steps,
    replication,
    save_trial,
    trial_spec,
    trial_step,
    verification_spec,
)

LATER = "2026-01-02T00:00:00+00:00"


def test_a_verification_is_kept_with_what_its_camera_was_calibrated_to(store: Store) -> None:
    run = learned(store)
    for calibration in ('{"focal_length_mm":5.1}', None):
        number = store.verifications.save(
            run.id, verification_spec(), [], VERSIONS, NOW, LATER, calibration=calibration
        )
        kept = f"select calibration, tries, robot_seconds from verification where id = {number}"
        assert run_sql(store.path, kept).rows == ((calibration, 0, 0.0),)


def test_a_world_that_does_not_tell_the_truth_leaves_it_out(store: Store) -> None:
    """Of behaviors, of steps and of tries alike."""
    run = store.learning.begin(learning_spec(behaviors=3), VERSIONS, NOW)
    blind = [(record, None) for record, _ in learning_steps(3)]
    store.learning.append(run.id, 0, blind, None, 1.0, done=True, now=NOW)
    table, ids = store.learning.table(run.id)
    step = trial_step(table.row(0))._replace(truth=None)
    record = TrialRecord(trial_spec(), (step,), TrialEnd(Outcome.SOLVED, 1, 1.0))
    store.trials.save_all(begun(store), run.id, [record], ids)
    tried = [(replication(table.row(0))[0], None, ids[table.row(0).step])]
    store.verifications.save(run.id, verification_spec(), tried, VERSIONS, NOW, LATER)
    for name, ends in (("behavior", "xy"), ("step", "xy"), ("replication", ("x", "y", "angle"))):
        columns = ", ".join(f"true_{end}_{axis}" for end in ("start", "end") for axis in ends)
        found = set(run_sql(store.path, f"select {columns} from {name}").rows)
        assert found == {(None,) * 2 * len(ends)}
    assert store.learning.row_starts(run.id) == {}


def test_a_verification_is_kept_with_when_its_verdict_could_be_told(store: Store) -> None:
    """Three rows that fail at their first try say that the tool has changed."""
    run = learned(store, 9)
    table, ids = store.learning.table(run.id)
    tries = []
    for number, row in enumerate(table, 1):
        record, truth = replication(row, number)
        tries.append((replace(record, replicated=False), truth, ids[row.step]))
    store.verifications.save(run.id, verification_spec(), tries, VERSIONS, NOW, LATER)
    kept = "select verdict, decided_after, tries from verification"
    assert run_sql(store.path, kept).rows == (("tool has changed", 3, 3),)


def test_the_table_before_a_trial_counts_what_was_done_with_it_before(store: Store) -> None:
    """Both trials that update the stored counters and verifications; none of them or after it."""
    run = learned(store, 9)
    trials = []

    def row_now(position: int) -> Affordance:
        return store.learning.table(run.id)[0].row(position)

    _, ids = store.learning.table(run.id)
    for position in (0, 1):
        row = row_now(position)
        record, truth = replication(row)
        tried = [(record, truth, ids[row.step])]
        store.verifications.save(run.id, verification_spec(), tried, VERSIONS, NOW, LATER)
        step = trial_step(row_now(position), seen=(0.0, 0.0))
        spec = trial_spec(counters=Counters.STORED)
        trials.append(save_trial(store, begun(store), run.id, spec, [step]))
    counters = [
        [(row.times_used, row.times_successful) for row in store.trials.table_before(trial)[0]]
        for trial in trials
    ]
    assert counters == [[(2, 2), (1, 1), (1, 1)], [(3, 2), (2, 2), (1, 1)]]
    assert store.trials.table_before(trials[0])[1] == ids
