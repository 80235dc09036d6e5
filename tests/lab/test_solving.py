"""Solving with what the store holds: counters and steps together (§3.2, §6.2, §7.1)."""

from dataclasses import replace

import pytest

from affcli.core.affordance import Affordance
from affcli.core.identity import Component
from affcli.core.records import LearningRunInfo, StoredStep
from affcli.core.specs import Counters
from affcli.core.task import ALL_STARTS
from affcli.core.trial import Outcome, StepRecord
from affcli.errors import AffcliError, BadInputError, UsageError
from affcli.lab.replaying import replay_trial
from affcli.store import Store, open_store, run_sql
from tests.lab.quick import IMPATIENT, counted, solving, spec_of, stored, taken

GOALS = ("1", "2", "3", "4")
NARROW = Component.of("nested-query", {"share": 0.05})


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A T-hook's learning run, in the store."""
    return stored(store, spec_of("t-hook", 400, settings=IMPATIENT))


def rows_of(store: Store, run: LearningRunInfo) -> list[Affordance]:
    return list(store.learning.table(run.id)[0])


def steps_of(store: Store) -> list[StoredStep]:
    """Return all steps in the store, oldest first."""
    return [step for trial in store.trials.trials() for step in store.trials.steps(trial.id)]


def assert_counters_are_those_of_the_steps(
    store: Store, run: LearningRunInfo, steps: list[tuple[int, StepRecord]]
) -> None:
    for row in rows_of(store, run):
        uses = [record for _, record in steps if record.row.step == row.step]
        assert row.times_used == 1 + len(uses)
        assert row.times_successful == 1 + sum(record.replicated for record in uses)


@pytest.mark.parametrize("goal", GOALS)
def test_stored_counters_and_stored_steps_agree(
    store: Store, run: LearningRunInfo, goal: str
) -> None:
    """§3.2: the counters "are updated during testing trials": those in the store."""
    steps = [step for trial in solving(store, run, goal) for step in trial.steps]
    assert_counters_are_those_of_the_steps(store, run, steps)
    kept = steps_of(store)
    assert [(s.number, s.affordance_id, s.row, s.replicated, s.reasons) for s in kept] == [
        (r.number, row, r.row, r.replicated, r.reasons) for row, r in steps
    ]
    latest = {s.affordance_id: s for s in kept}
    table, ids = store.learning.table(run.id)
    for row in table:
        if ids[row.step] in latest:
            last = latest[ids[row.step]]
            assert row.times_used == last.times_used_after
            assert row.times_successful == last.times_successful_after


def test_each_trial_starts_from_the_counters_that_the_one_before_it_left(
    store: Store, run: LearningRunInfo
) -> None:
    used = {row.step: 1 for row in rows_of(store, run)}
    for trial in solving(store, run, "2"):
        for _, record in trial.steps:
            assert record.row.times_used == used[record.row.step]
            used[record.row.step] += 1
    assert sum(used.values()) > len(used)


def test_a_trial_is_in_the_store_before_its_steps_are_told(
    store: Store, run: LearningRunInfo
) -> None:
    """Nothing told is lost: a command that is stopped after a trial has saved that trial, whole."""
    told = next(solving(store, run))
    (kept,) = store.trials.trials()
    assert (kept.id, kept.outcome) == (told.id, told.end.outcome)
    assert len(store.trials.steps(kept.id)) == kept.steps == len(told.steps) > 0
    assert_counters_are_those_of_the_steps(store, run, list(told.steps))


def test_a_trial_that_is_stopped_leaves_nothing(
    store: Store, run: LearningRunInfo, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is read, done and counted in a trial is one whole."""

    def stop(*args: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("affcli.store.trials.count_use", stop)
    with pytest.raises(KeyboardInterrupt):
        list(solving(store, run))
    assert store.trials.trials() == ()
    assert_counters_are_those_of_the_steps(store, run, [])


def test_two_who_solve_with_one_table_take_turns(store: Store, run: LearningRunInfo) -> None:
    """Between the trials of one, another does its own; each begins with what the others left."""
    with open_store(store.path, create=False, write=True) as other:
        one, two = solving(store, run, "1"), solving(other, run, "2")
        for _ in range(4):
            for events in (one, two):
                next(events)
    trials = store.trials.trials()
    assert [t.spec.goal for t in trials] == ["1", "2"] * 4
    assert not any(replay_trial(store, trial.id).differences for trial in trials)


def test_a_trial_of_each_tool_and_start_ends_and_is_kept(
    store: Store, run: LearningRunInfo
) -> None:
    stick = stored(store, spec_of("stick", 200, settings=IMPATIENT))
    ends = list(solving(store, [run, stick], "3", seed=7))
    which = [(e.trial.tool, e.trial.shape, e.trial.goal, e.trial.start) for e in ends]
    assert which == [(tool, tool, "3", start) for tool in ("t-hook", "stick") for start in GOALS]
    assert {(e.trial.seed, e.trial.counters) for e in ends} == {(7, Counters.STORED)}
    assert all(e.solved is (e.end.outcome is Outcome.SOLVED) for e in ends)
    kept = store.trials.trials()
    assert [(t.id, t.spec, t.outcome, t.steps) for t in kept] == [
        (e.id, e.trial, e.end.outcome, e.end.steps) for e in ends
    ]
    (session,) = store.sessions.all("solve")
    assert session.status == "done"
    for end in ends:
        assert len(end.steps) == end.end.steps


def test_one_start_alone(store: Store, run: LearningRunInfo) -> None:
    counted(solving(store, run, "4", "2"))
    (trial,) = store.trials.trials()
    assert (trial.spec.goal, trial.spec.start) == ("4", "2")


@pytest.mark.parametrize(
    ("goal", "start", "planner", "error", "says"),
    [
        ("5", ALL_STARTS, NARROW, UsageError, "no goal '5'; did you mean 1 or 2 or 3 or 4"),
        ("1", "north", NARROW, UsageError, "no start 'north'"),
        (
            "1",
            ALL_STARTS,
            Component("clairvoyant"),
            BadInputError,
            "planner clairvoyant: this affcli has no such",
        ),
        ("1", ALL_STARTS, replace(NARROW, version=3), BadInputError, "version 1 of it"),
    ],
)
def test_what_is_not_there_is_refused_before_anything_is_recorded(
    goal: str,
    start: str,
    planner: Component,
    error: type[AffcliError],
    says: str,
    store: Store,
    run: LearningRunInfo,
) -> None:
    with pytest.raises(error, match=says):
        counted(solving(store, run, goal, start, planner=planner))
    assert store.sessions.all() == ()


def test_solving_again_goes_on_with_the_counters_as_they_are(
    store: Store, run: LearningRunInfo
) -> None:
    for _ in range(2):
        before = {row.step: row for row in rows_of(store, run)}
        (trial,) = solving(store, run, "4", "1", seed=3)
        _, first = trial.steps[0]
        assert first.row == before[first.row.step]
    assert len(store.sessions.all("solve")) == 2


def test_two_planners_are_both_stored_and_choose_by_their_own_rule(
    store: Store, run: LearningRunInfo
) -> None:
    for planner in (Component("nested-query"), NARROW):
        counted(solving(store, run, "2", planner=planner))
    sessions = store.sessions.all("solve")
    assert [str(one.spec.planner) for one in sessions] == [
        "nested-query",
        "nested-query:share=0.05",
    ]
    planners = "select distinct planner from trial order by id"
    assert run_sql(store.path, planners).rows == (
        ("nested-query",),
        ("nested-query:share=0.05",),
    )
    for session, share in zip(sessions, (0.2, 0.05), strict=True):
        for trial in store.trials.trials(session_id=session.id):
            for step in store.trials.steps(trial.id):
                assert step.reasons[-1].value == share


def test_solving_uses_the_table_that_was_learned(store: Store, run: LearningRunInfo) -> None:
    taken(solving(store, run), 1)
    assert run.spec.settings == '{"trial.max_steps":6}'
    assert counted(rows_of(store, run)) == run.rows
    (session,) = store.sessions.all("solve")
    assert (session.spec.settings, session.status) == (run.spec.settings, "running")
