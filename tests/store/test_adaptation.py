"""What the database sums over the steps of trials with a broken tool."""

from dataclasses import replace

import pytest

from affcli.core.affordance import Affordance
from affcli.core.records import LearningRunInfo
from affcli.core.results import StepSums, TrialGroup
from affcli.core.specs import Protocol, TrialRecord
from affcli.core.trial import Outcome, TrialEnd, TrialStep
from affcli.store import Store
from tests.store.records import (
    NOW,
    VERSIONS,
    begun,
    counted,
    learned,
    robot_record,
    trial_spec,
    trial_step,
    unfinished_trial,
)

BROKEN = Protocol.TOOL_ADAPTATION
RIGHT, LEFT = 4.0, -4.0
"""Rows of these records were made with the attractor to the right of the wrist."""


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A learning run with three rows."""
    return learned(store, 9)


def save(
    store: Store,
    run: LearningRunInfo,
    start: int,
    *steps: TrialStep,
    outcome: Outcome = Outcome.SOLVED,
    shape: str = "l-hook",
) -> int:
    """Put a trial into the store; return its session."""
    sessions = store.sessions.all("break-tool")
    session = sessions[-1].id if sessions else begun(store, "break-tool")
    protocol = BROKEN if shape != "t-hook" else Protocol.EXTENSION_OF_REACH
    spec = trial_spec(1, start, shape=shape, protocol=protocol)
    record = TrialRecord(spec, steps, TrialEnd(outcome, len(steps), 1.0))
    _, ids = store.learning.table(run.id)
    store.trials.save_all(session, run.id, [record], ids)
    return session


def rows_of(store: Store, run: LearningRunInfo) -> list[Affordance]:
    return list(store.learning.table(run.id, as_learned=True)[0])


def test_each_trial_by_itself(store: Store, run: LearningRunInfo) -> None:
    first, second, _ = rows_of(store, run)
    vain = trial_step(first, 1, seen=(0.0, 0.0), lost=True)
    again = trial_step(counted(first, vain.record), 2, seen=(0.0, 0.0), lost=True)
    well = trial_step(second, 3, lost=False)
    session = save(store, run, 1, vain, again, well)
    save(store, run, 2, replace_number(well, 1), outcome=Outcome.STEP_LIMIT)
    one, other = store.results.trial_groups(session, "t-hook", "l-hook", RIGHT, by_robot=False)
    assert (one.key, one.trials, one.with_rows) == (1, 1, 1)
    assert one.steps == (
        StepSums(1, 1, 1, (1 / 2 - 1) / 3),
        StepSums(2, 1, 1, (1 / 3 - 1 / 2) / 3),
        StepSums(3, 1, 0, 0.0),
    )
    assert other == TrialGroup(2, 1, 1, (StepSums(1, 1, 0, 0.0),))


def replace_number(step: TrialStep, number: int) -> TrialStep:
    return step._replace(record=replace(step.record, number=number))


def test_trials_that_have_not_ended_or_are_invalid_are_left_out(
    store: Store, run: LearningRunInfo
) -> None:
    vain = trial_step(rows_of(store, run)[0], 1, seen=(0.0, 0.0), lost=True)
    session = save(store, run, 1, vain)
    save(store, run, 2, vain, outcome=Outcome.INVALID)
    unfinished_trial(store, session, run.id, trial_spec(1, 3, shape="l-hook", protocol=BROKEN))
    (group,) = store.results.trial_groups(session, "t-hook", "l-hook", RIGHT, by_robot=True)
    assert (group.trials, len(group.steps)) == (1, 1)
    assert store.results.losses(session, BROKEN) == (1, 1)


def test_a_trial_without_steps_counts_as_one(store: Store, run: LearningRunInfo) -> None:
    session = save(store, run, 1, outcome=Outcome.NO_ROW)
    (group,) = store.results.trial_groups(session, "t-hook", "l-hook", RIGHT, by_robot=False)
    assert group == TrialGroup(1, 1, 1, ())


def test_a_row_that_fails_and_stays_probable_is_not_excluded(
    store: Store, run: LearningRunInfo
) -> None:
    """§6.2: one of at most 1/2 is; it counts once, in however many trials."""
    first, second, _ = rows_of(store, run)
    vain = trial_step(first, 1, seen=(0.0, 0.0), lost=True)
    proven = replace(second, times_used=4, times_successful=4)
    session = save(store, run, 1, vain, trial_step(proven, 2, seen=(0.0, 0.0), lost=True))
    save(store, run, 2, vain, outcome=Outcome.NO_ROW)
    assert store.results.losses(session, BROKEN) == (3, 1)


@pytest.mark.parametrize("side", [LEFT, 0.0])
def test_rows_on_the_other_side_do_not_count(
    side: float, store: Store, run: LearningRunInfo
) -> None:
    vain = trial_step(rows_of(store, run)[0], 1, seen=(0.0, 0.0), lost=True)
    session = save(store, run, 1, vain)
    (group,) = store.results.trial_groups(session, "t-hook", "l-hook", side, by_robot=False)
    assert group == TrialGroup(1, 1, 0, (StepSums(1, 1, 1, 0.0),))


def test_the_whole_tool_s_trials_are_told_apart(store: Store, run: LearningRunInfo) -> None:
    well = trial_step(rows_of(store, run)[0], 1)
    session = save(store, run, 1, well, shape="t-hook")
    assert store.trials.first_broken(session) is None
    save(store, run, 1, well)
    first = store.trials.first_broken(session)
    assert first is not None
    assert (first.spec.tool, first.spec.shape, first.learned.tool) == ("t-hook", "l-hook", "t-hook")
    for shape in ("t-hook", "l-hook"):
        (group,) = store.results.trial_groups(session, "t-hook", shape, RIGHT, by_robot=True)
        assert (group.trials, [step.lost for step in group.steps]) == (1, [0])


def test_robots_are_summed_each_with_its_own_table(store: Store) -> None:
    """Robot i babbled 6 + 3 i behaviors: it has 2 + i rows, all on the right."""
    session = begun(store, "reproduce", robots=3)
    for robot in range(3):
        life = robot_record(robot, behaviors=6 + 3 * robot)
        assert store.sessions.save_robot({session: VERSIONS}, life, NOW)
    groups = store.results.trial_groups(session, "t-hook", "l-hook", RIGHT, by_robot=True)
    assert groups == tuple(
        TrialGroup(
            robot,
            1,
            1,
            (StepSums(1, 1, 1, -0.5 / (2 + robot)), StepSums(2, 1, 0, 0.0)),
        )
        for robot in range(3)
    )
    whole = store.results.trial_groups(session, "t-hook", "t-hook", RIGHT, by_robot=True)
    assert [(group.key, group.trials) for group in whole] == [(0, 2), (1, 2), (2, 2)]
    assert store.results.trial_groups(session + 1, "t-hook", "l-hook", RIGHT, by_robot=True) == ()
