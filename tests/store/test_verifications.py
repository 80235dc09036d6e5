"""Verifications in the store: what is kept of one, and of a world that tells no truth."""

from affcli.core.specs import TrialRecord
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
