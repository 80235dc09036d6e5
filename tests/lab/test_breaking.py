"""A tool that breaks: 16 trials, and the same 16 with the whole tool beside them (§7.2)."""

import pytest

from affcli.core.trial import Counters, Protocol, TrialRecord
from affcli.lab.breaking import break_tool
from affcli.lab.learning import learn
from affcli.lab.solving import solve
from affcli.store import LearningRunInfo, Store
from tests.lab.quick import IMPATIENT, counted, now, spec_of, taken

WHOLE, BROKEN = Protocol.EXTENSION_OF_REACH, Protocol.TOOL_ADAPTATION


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A T-hook's learning run, in the store."""
    return learn(store, spec_of("t-hook", 250, settings=IMPATIENT), now).info


def broken(store: Store, run: LearningRunInfo) -> list[TrialRecord]:
    return [trial for _, trial in break_tool(store, run, "l-hook", 0, now)]


def test_sixteen_trials_with_the_broken_tool_and_then_the_same_with_the_whole_one(
    store: Store, run: LearningRunInfo
) -> None:
    """§7.2: "A total of 16 trials ... (i.e., 4 goal regions x 4 initial attractor positions)"."""
    trials = broken(store, run)
    assert [t.spec.protocol for t in trials] == [BROKEN] * 16 + [WHOLE] * 16
    assert [t.spec.shape for t in trials] == ["l-hook"] * 16 + ["t-hook"] * 16
    assert {t.spec.tool for t in trials} == {"t-hook"}
    for half in (trials[:16], trials[16:]):
        assert len({(t.spec.goal, t.spec.start) for t in half}) == 16
    assert all(step.lost is not None for t in trials[:16] for step in t.steps)
    assert all(step.lost is None for t in trials[16:] for step in t.steps)


def test_the_stored_table_stays_as_it_is_and_the_trials_keep_their_own_counters(
    store: Store, run: LearningRunInfo
) -> None:
    """§7.2: each started "with the original representation for the T-hook tool and modified it
    based on actual experience"."""
    before = list(store.affordance_table(run.id)[0])
    trials = broken(store, run)
    assert list(store.affordance_table(run.id)[0]) == before
    assert {t.spec.counters for t in trials} == {Counters.AS_LEARNED}
    for trial in trials:
        used: dict[int, int] = {}
        for step in trial.steps:
            row = step.record.row
            assert row.times_used == used.get(row.step, 1)
            used[row.step] = step.record.times_used_after


def test_what_solving_made_of_the_counters_does_not_count(
    store: Store, run: LearningRunInfo
) -> None:
    first = broken(store, run)
    counted(solve(store, [run], 1, (1, 2, 3, 4), 0, now))
    solved = list(store.affordance_table(run.id)[0])
    assert broken(store, run) == first
    assert list(store.affordance_table(run.id)[0]) == solved


def test_the_store_keeps_every_trial_with_its_steps(store: Store, run: LearningRunInfo) -> None:
    trials = broken(store, run)
    kept = store.outcomes(kind="break-tool")
    assert [(k.protocol, k.goal, k.start, k.outcome, k.steps) for k in kept] == [
        (t.spec.protocol, t.spec.goal, t.spec.start, t.end.outcome, t.end.steps) for t in trials
    ]
    for stored, trial in zip(kept, trials, strict=True):
        steps = store.trial_steps(stored.id)
        assert len(steps) == trial.end.steps
        assert [(s.row, s.died, s.lost) for s in steps] == [
            (s.record.row, s.record.died, s.lost) for s in trial.steps
        ]
    (session,) = store.sessions("break-tool")
    assert session.status == "done"


def test_a_trial_is_in_the_store_before_it_is_told(store: Store, run: LearningRunInfo) -> None:
    taken(break_tool(store, run, "l-hook", 0, now), 3)
    assert len(store.outcomes(kind="break-tool")) == 3
