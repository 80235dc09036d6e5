"""Solving with what the store holds: counters and steps together (§3.2, §6.2, §7.1)."""

import pytest

from affcli.core.affordance import Affordance
from affcli.core.trial import Counters, Outcome
from affcli.lab.learning import learn
from affcli.lab.solving import SolvedStep, SolvedTrial, solve
from affcli.store import LearningRunInfo, Store, StoredStep
from tests.lab.quick import IMPATIENT, counted, learned, now, spec_of, table_from, taken

ALL = (1, 2, 3, 4)


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A T-hook's learning run, in the store."""
    return learn(store, spec_of("t-hook", 400, settings=IMPATIENT), now).info


def rows_of(store: Store, run: LearningRunInfo) -> list[Affordance]:
    return list(store.affordance_table(run.id)[0])


def steps_of(store: Store) -> list[StoredStep]:
    """Return all steps in the store, oldest first."""
    with_end = [trial.id for trial in store.outcomes()]
    return [step for trial in with_end for step in store.trial_steps(trial)]


def assert_counters_are_those_of_the_steps(
    store: Store, run: LearningRunInfo, steps: list[SolvedStep]
) -> None:
    for row in rows_of(store, run):
        uses = [s.record for s in steps if s.record.row.step == row.step]
        assert row.times_used == 1 + len(uses)
        assert row.times_successful == 1 + sum(record.replicated for record in uses)


@pytest.mark.parametrize("goal", ALL)
def test_stored_counters_and_stored_steps_agree(
    store: Store, run: LearningRunInfo, goal: int
) -> None:
    """§3.2: the counters "are updated during testing trials": those in the store."""
    events = list(solve(store, [run], goal, ALL, 0, now))
    steps = [event for event in events if isinstance(event, SolvedStep)]
    assert_counters_are_those_of_the_steps(store, run, steps)
    stored = steps_of(store)
    assert [(s.number, s.row.step, s.replicated) for s in stored] == [
        (s.record.number, s.record.row.step, s.record.replicated) for s in steps
    ]
    latest = {s.affordance_id: s for s in stored}
    table, ids = store.affordance_table(run.id)
    for row in table:
        if ids[row.step] in latest:
            last = latest[ids[row.step]]
            assert row.times_used == last.times_used_after
            assert row.times_successful == last.times_successful_after


def test_each_trial_starts_from_the_counters_that_the_one_before_it_left(
    store: Store, run: LearningRunInfo
) -> None:
    used = {row.step: 1 for row in rows_of(store, run)}
    for event in solve(store, [run], 2, ALL, 0, now):
        if isinstance(event, SolvedStep):
            assert event.record.row.times_used == used[event.record.row.step]
            used[event.record.row.step] += 1
    assert sum(used.values()) > len(used)


def test_a_step_is_in_the_store_before_it_is_told(store: Store, run: LearningRunInfo) -> None:
    """Nothing told is lost: a command that is stopped after a step has saved that step."""
    told: list[SolvedStep] = []
    for event in solve(store, [run], 1, ALL, 0, now):
        if isinstance(event, SolvedStep):
            told.append(event)
            assert_counters_are_those_of_the_steps(store, run, told)
        if len(told) == 5:
            break
    assert len(told) == 5
    assert_counters_are_those_of_the_steps(store, run, told)


def test_a_trial_of_each_tool_and_start_ends_and_is_kept(
    store: Store, run: LearningRunInfo
) -> None:
    stick = learn(store, spec_of("stick", 200, settings=IMPATIENT), now).info
    events = list(solve(store, [run, stick], 3, (2, 4), 7, now))
    ends = [event for event in events if isinstance(event, SolvedTrial)]
    which = [(e.trial.tool, e.trial.shape, e.trial.goal, e.trial.start) for e in ends]
    assert which == [
        *(("t-hook", "t-hook", 3, start) for start in (2, 4)),
        *(("stick", "stick", 3, start) for start in (2, 4)),
    ]
    assert {(e.trial.seed, e.trial.counters) for e in ends} == {(7, Counters.STORED)}
    assert all(e.solved is (e.end.outcome is Outcome.SOLVED) for e in ends)
    kept = store.outcomes(kind="solve")
    assert [(t.tool, t.start, t.outcome, t.steps) for t in kept] == [
        (e.trial.tool, e.trial.start, e.end.outcome, e.end.steps) for e in ends
    ]
    (session,) = store.sessions("solve")
    assert session.status == "done"
    for end in ends:
        mine = [e for e in events if isinstance(e, SolvedStep) and e.trial == end.trial]
        assert len(mine) == end.end.steps


def test_solving_again_goes_on_with_the_counters_as_they_are(
    store: Store, run: LearningRunInfo
) -> None:
    for _ in range(2):
        before = {row.step: row for row in rows_of(store, run)}
        events = solve(store, [run], 4, (1,), 3, now)
        first = next(e for e in events if isinstance(e, SolvedStep))
        assert first.record.row == before[first.record.row.step]
    assert len(store.sessions("solve")) == 2


def test_solving_uses_the_table_that_was_learned(store: Store, run: LearningRunInfo) -> None:
    assert rows_of(store, run) == list(
        table_from(learned(spec_of("t-hook", 400, settings=IMPATIENT)))
    )
    taken(solve(store, [run], 1, ALL, 0, now), 1)
    assert run.spec.settings == IMPATIENT.to_json()
    assert counted(rows_of(store, run)) == run.rows
