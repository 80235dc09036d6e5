"""What a step of a trial says of its row (§3.2, §6.2)."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.affordance import PROBABILITY_THRESHOLD, Affordance
from affcli.core.behavior import Execution, ExecutionStatus
from affcli.core.geometry import Pose
from affcli.core.trial import StepRecord
from affcli.planning.nested_query import likely_to_succeed
from tests.factories import EXTEND_5, affordance, moved_by, observation, table_of


def step_with(row: Affordance, *, replicated: bool) -> StepRecord:
    """Return the record of a step that tried `row`."""
    placing = Execution(EXTEND_5, ExecutionStatus.DONE, Pose(0.0, 0.0), Pose(0.0, 0.0), 1.0)
    return StepRecord(
        number=1,
        clock=1.0,
        reasons=(),
        row=row,
        placing=placing,
        execution=placing,
        start=observation(),
        end=observation(),
        expected=moved_by(0.0, 5.0),
        seen=moved_by(0.0, 0.0),
        replicated=replicated,
        regrasped=False,
        threshold=PROBABILITY_THRESHOLD,
    )


@settings(deadline=None)
@given(st.integers(1, 50), st.integers(0, 50), st.booleans())
def test_a_row_has_died_when_search_2_no_longer_finds_it(
    used: int, successful: int, replicated: bool
) -> None:
    """§6.2, search 2: "greater than 1/2", so at 1/2 a row is out of further consideration."""
    row = affordance(used=used, successful=min(used, successful))
    step = step_with(row, replicated=replicated)
    assert step.times_used_after == row.times_used + 1
    assert step.times_successful_after == row.times_successful + replicated
    table = table_of(row)
    table.count_use(0, success=replicated)
    assert step.died is (not len(likely_to_succeed(table, np.arange(1))))


def test_a_fresh_row_dies_after_one_failure() -> None:
    """§6.2: "it takes only one unsuccessful behavioral execution in order to eliminate an
    affordance from further consideration": 1/2 is not greater than 1/2."""
    assert step_with(affordance(), replicated=False).died
    assert not step_with(affordance(), replicated=True).died


def test_a_row_that_has_succeeded_before_survives_one_failure() -> None:
    """§6.2: 2/3 is greater than 1/2; a second failure makes it 2/4."""
    assert not step_with(affordance(used=2, successful=2), replicated=False).died
    assert step_with(affordance(used=3, successful=2), replicated=False).died
