"""A tool that breaks: 16 trials, and the same 16 with the whole tool beside them (§7.2)."""

from collections.abc import Iterator

import pytest

from affcli.core.records import LearningRunInfo
from affcli.core.specs import Counters, Protocol, TrialRecord
from affcli.lab.breaking import break_tool
from affcli.lab.run_parts import RunParts
from affcli.store import Store
from tests.factories import tool_named
from tests.lab.parts import SILENT, register
from tests.lab.quick import (
    IMPATIENT,
    PLANNER,
    counted,
    now,
    solving,
    spec_of,
    stored,
    taken,
)

WHOLE, BROKEN = Protocol.EXTENSION_OF_REACH, Protocol.TOOL_ADAPTATION


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A T-hook's learning run, in the store."""
    return stored(store, spec_of("t-hook", 250, settings=IMPATIENT))


def breaking(store: Store, run: LearningRunInfo) -> Iterator[tuple[int, TrialRecord, float]]:
    return break_tool(store, run, tool_named("l-hook"), 0, now, PLANNER)


def broken(store: Store, run: LearningRunInfo) -> list[TrialRecord]:
    return [trial for _, trial, _ in breaking(store, run)]


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
    before = list(store.learning.table(run.id)[0])
    trials = broken(store, run)
    assert list(store.learning.table(run.id)[0]) == before
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
    counted(solving(store, run))
    solved = list(store.learning.table(run.id)[0])
    assert broken(store, run) == first
    assert list(store.learning.table(run.id)[0]) == solved


def test_the_store_keeps_every_trial_with_its_steps(store: Store, run: LearningRunInfo) -> None:
    trials = broken(store, run)
    kept = store.trials.trials()
    assert [(k.spec, k.outcome, k.steps, k.robot_seconds) for k in kept] == [
        (t.spec, t.end.outcome, t.end.steps, t.end.clock) for t in trials
    ]
    assert kept == store.trials.trials(kind="break-tool")
    assert {k.run_id for k in kept} == {run.id}
    for one, trial in zip(kept, trials, strict=True):
        steps = store.trials.steps(one.id)
        assert [(s.row, s.died, s.lost) for s in steps] == [
            (s.record.row, s.record.died, s.lost) for s in trial.steps
        ]
    (session,) = store.sessions.all("break-tool")
    assert session.status == "done"


def test_each_trial_tells_how_much_is_done(store: Store, run: LearningRunInfo) -> None:
    told = [(number, share) for number, _, share in breaking(store, run)]
    assert told == [(trial.id, trial.id / 32) for trial in store.trials.trials()]


def test_a_trial_is_in_the_store_before_it_is_told(store: Store, run: LearningRunInfo) -> None:
    taken(breaking(store, run), 3)
    assert len(store.trials.trials()) == 3


def test_a_world_that_cannot_tell_says_of_no_row_that_it_was_lost(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    register(monkeypatch, SILENT)
    parts = RunParts.chosen(IMPATIENT, world="silent")
    run = stored(store, parts.spec("t-hook", 0, 0, None, 250))
    trials = broken(store, run)
    assert any(trial.steps for trial in trials)
    assert {step.lost for trial in trials for step in trial.steps} == {None}
