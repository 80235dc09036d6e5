"""Learning by intervals of robot time, and what earlier trials excluded."""

import pytest

from affcli.core.results import LearningInterval
from affcli.core.specs import Counters
from affcli.store import Store
from tests.factories import learning_spec
from tests.store.records import (
    NOW,
    VERSIONS,
    begun,
    counted,
    learned,
    learning_steps,
    robot_record,
    save_trial,
    trial_spec,
    trial_step,
)


@pytest.mark.parametrize("count", [1, 2, 3, 40])
@pytest.mark.parametrize("seconds", [1.0, 5.25, 7.0, 20.0, 1000.0])
def test_every_behavior_is_counted_in_the_interval_in_which_it_ended(
    store: Store, count: int, seconds: float
) -> None:
    run = learned(store, count, spec=learning_spec(behaviors=count))
    expected: dict[int, tuple[int, int]] = {}
    for record, _ in learning_steps(count):
        number = int(record.clock / seconds)
        done, made = expected.get(number, (0, 0))
        expected[number] = (done + 1, made + (record.affordance is not None))
    intervals = [LearningInterval(run.id, n, *expected[n]) for n in sorted(expected)]
    assert store.results.learning_intervals(seconds) == {run.id: intervals}


def test_of_a_reproduction_every_robot_is_counted_and_of_a_run_only_that(store: Store) -> None:
    alone = learned(store)
    session = begun(store, "reproduce", robots=2)
    for robot in (0, 1):
        assert store.sessions.save_robot({session: VERSIONS}, robot_record(robot), NOW)
    runs = store.learning.runs(session_id=session)
    whole = store.results.learning_intervals(1e6, session)
    assert whole == {run.id: [LearningInterval(run.id, 0, 6, 2)] for run in runs}
    assert list(store.results.learning_intervals(1e6)) == [alone.id]
    assert store.results.learning_intervals(1e6, session + 1) == {}


def stored_trial(store: Store, run: int, session: int, start: int, *failed: int) -> int:
    """Do a trial that updates the stored counters and in which some rows fail once."""
    rows, _ = store.learning.table(run)
    steps = []
    for number, position in enumerate(failed, 1):
        row = rows.row(position)
        steps.append(trial_step(row, number, seen=(0.0, 0.0)))
        assert counted(row, steps[-1].record).replication_probability <= 0.5
    spec = trial_spec(start=start, counters=Counters.STORED)
    return save_trial(store, session, run, spec, steps)


def test_a_trial_finds_excluded_what_died_in_the_trials_before_it(store: Store) -> None:
    run = learned(store)
    _, ids = store.learning.table(run.id)
    by_age = [ids[step] for step in sorted(ids)]
    session = begun(store)
    first = stored_trial(store, run.id, session, 1, 0)
    second = stored_trial(store, run.id, session, 2, 1)
    third = stored_trial(store, run.id, session, 3)
    assert store.trials.excluded_before(first) == set()
    assert store.trials.excluded_before(second) == {by_age[0]}
    assert store.trials.excluded_before(third) == {by_age[0], by_age[1]}


@pytest.mark.parametrize("counters", Counters)
def test_a_trial_that_starts_from_the_table_as_learned_finds_all_rows(
    counters: Counters, store: Store
) -> None:
    """Nor does what dies in such a trial count for later ones, or for another run."""
    run = learned(store)
    other = learned(store, spec=learning_spec(seed=5, behaviors=9))
    session = begun(store)
    stored_trial(store, run.id, session, 1, 0)
    later = save_trial(store, session, run.id, trial_spec(start=2, counters=counters))
    assert len(store.trials.excluded_before(later)) == (counters is Counters.STORED)
    foreign = begun(store)
    spec = trial_spec(counters=Counters.STORED)
    assert store.trials.excluded_before(save_trial(store, foreign, other.id, spec)) == set()
