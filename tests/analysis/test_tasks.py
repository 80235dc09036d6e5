"""What trials came to over many tasks, and how far off its expectation a step ended."""

from dataclasses import replace

import pytest

from affcli.analysis.tasks import TaskSums, error_of, final_distance
from affcli.core.behavior import Execution, ExecutionStatus
from affcli.core.choice import Move, Reason
from affcli.core.geometry import Point, Pose
from affcli.core.trial import Outcome, StepRecord, TrialEnd
from tests.factories import EXTEND_5, affordance, learning_spec, moved_by, observation, trial_spec

SPEC = trial_spec(learning_spec(), goal="2", start="1")
CENTER = SPEC.task.goal.center


def step(expected: Point, seen: Point, *reasons: Reason) -> StepRecord:
    """Return a step from (0, 24) that was expected to move by one vector, and moved by another."""
    start, wrist = Point(0.0, 24.0), Pose(0.0, 16.0)
    done = Execution(EXTEND_5, ExecutionStatus.DONE, wrist, wrist, 1.0)
    return StepRecord(
        row=affordance(moved=expected),
        placing=done,
        execution=done,
        start=observation(start),
        end=observation(Point(start.x + seen.x, start.y + seen.y)),
        expected=moved_by(*expected),
        seen=moved_by(*seen),
        replicated=True,
        regrasped=False,
        threshold=0.5,
        number=1,
        clock=9.0,
        reasons=reasons,
    )


def test_a_step_is_held_against_the_plan_where_there_is_one_else_against_its_row() -> None:
    went = step(Point(0.0, 5.0), Point(3.0, 5.0))
    assert error_of(went) == pytest.approx(3.0)
    plan = Reason("plan", None, 1.0, (Move(1, "extend arm 5", 3.0, 28.0), Move(2, "x", 9.0, 9.0)))
    close = Reason("other plan", None, 1.0, (Move(3, "x", -9.0, -9.0),))
    assert error_of(replace(went, reasons=(plan, close))) == pytest.approx(1.0)


def test_sums_count_what_ended_and_leave_out_what_is_invalid() -> None:
    there = Point(CENTER.x, CENTER.y - 24.0)
    near, far = step(there, there), step(Point(0.0, 1.0), Point(0.0, 1.0))
    trials = [
        (SPEC, TrialEnd(Outcome.SOLVED, 1, 10.0), [near]),
        (SPEC, TrialEnd(Outcome.SOLVED, 3, 20.0), [far, far, near]),
        (SPEC, TrialEnd(Outcome.STEP_LIMIT, 60, 60.0), [far]),
        (SPEC, TrialEnd(Outcome.NO_ROW, 0, 6.0), []),
        (SPEC, TrialEnd(Outcome.INVALID, 1, 99.0), [far]),
    ]
    sums = TaskSums.of(trials)
    assert (sums.tried, sums.solved, sums.steps, sums.seconds) == (4, 2, 2.0, 24.0)
    assert sums.failures == {Outcome.NO_ROW: 1, Outcome.STEP_LIMIT: 1}
    assert sums.error == 0.0
    off = abs(25.0 - CENTER.y)
    assert sums.distance == pytest.approx(off / 2)
    assert final_distance(SPEC, []) > off


def test_of_nothing_there_is_nothing_to_say() -> None:
    sums = TaskSums.of([])
    assert (sums.tried, sums.steps, sums.seconds, sums.distance, sums.error) == (0, *[None] * 4)
