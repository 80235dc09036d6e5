"""Every table, on a screen of 80 and of 40 columns, as it was when somebody last looked at it.

After a change that was meant: ``pytest tests/report --snapshot-update``, and look at the diff.
"""

import io
from dataclasses import replace

import pytest
from rich.console import Console, RenderableType
from syrupy.assertion import SnapshotAssertion

from affcli.core.trial import Outcome
from affcli.report.breaking import broken_tables
from affcli.report.learning import groups_table, learned_table
from affcli.report.overview import overview_tables
from affcli.report.reproduction import failures_table, reproduction_tables
from affcli.report.rows import row_tables, rows_table
from affcli.report.trials import counts_tables, explain_trial, solve_table
from tests.factories import learning_spec
from tests.report import hand_made
from tests.report.hand_made import (
    BROKEN,
    FOUR_ROBOTS,
    GROUPS,
    MANY_ROBOTS,
    OVERVIEW,
    RUNS,
    WHOLE,
    row,
    spec,
    stored_row,
    tried,
)

SOLVED, LIMIT = Outcome.SOLVED, Outcome.STEP_LIMIT
OUT, NO_ROW = Outcome.ATTRACTOR_OUT_OF_REACH, Outcome.NO_ROW
ENDS = {
    "stick": ((LIMIT, 32), (LIMIT, 32), (OUT, 7), (NO_ROW, 0)),
    "t-hook": ((SOLVED, 3), (SOLVED, 12), (SOLVED, 1), (OUT, 10)),
}
SOLVE = [
    (trial.spec, trial.end)
    for tool, ends in ENDS.items()
    for start, (outcome, steps) in enumerate(ends, start=1)
    for trial in [hand_made.trial(spec(start, tool=tool), outcome, steps_taken=steps)]
]

USED = {"stick": replace(RUNS[1], id=2), "t-hook": replace(RUNS[0], id=7)}
EXPLAINED = hand_made.trial(
    spec(2),
    NO_ROW,
    hand_made.step(1, row(7)),
    hand_made.step(2, row(9), seen=(0.1, 0.0)),
    hand_made.step(3, row(11), blocked=True),
    hand_made.step(4, row(7, used=3, successful=3), seen=(0.0, 2.0)),
)

ROWS = [
    (stored_row(9, 1, "t-hook", row(7)), "left bar"),
    (stored_row(12345, 1, "t-hook", row(33, offset_x=5.04, used=12, successful=6)), "right hook"),
    (stored_row(12346, 22, "\x1b[31m=cmd", row(34, offset_x=-0.04)), "handle"),
]
HISTORY = [
    tried(3, hand_made.step(1, row(7)), spec(2)),
    tried(3, hand_made.step(12, row(7, used=2, successful=2), seen=(0.1, 0.0)), spec(2)),
    tried(19, hand_made.step(1, row(7), seen=(0.0, 0.0), lost=True), spec(2, shape="l-hook")),
    tried(1234, hand_made.step(3, row(7), blocked=True), spec(2)),
]

TABLES: dict[str, tuple[RenderableType, ...]] = {
    "groups": (groups_table(RUNS[0], GROUPS),),
    "learned": (learned_table(RUNS),),
    "solve": (solve_table(SOLVE, USED),),
    "solve, one start": (solve_table(SOLVE[5:6], USED),),
    "explain": (
        explain_trial(
            EXPLAINED.spec,
            EXPLAINED.end,
            [(step.record.row.step, step.record) for step in EXPLAINED.steps],
        ),
    ),
    "rows": (rows_table(ROWS[:2], "Rows of run 1 (t-hook)", with_runs=False),),
    "rows of all runs": (rows_table(ROWS, "Rows of all runs", with_runs=True),),
    "no rows": (rows_table([], "Rows of run 1 (t-hook)", with_runs=False),),
    "one row": row_tables(*ROWS[0], RUNS[0], HISTORY),
    "a row of a robot, never tried": row_tables(
        *ROWS[1], replace(RUNS[0], session_id=4, spec=learning_spec(seed=1000, robot=17)), []
    ),
    "counts": tuple(counts_tables(OVERVIEW.solved, {run.id: run for run in RUNS})),
    "broken": broken_tables(RUNS[0], [*BROKEN, *WHOLE]),
    "failures": (failures_table({"step limit": 31, "no row left": 2}, 80, 4),),
    "only invalid trials": (failures_table({}, 0, 1),),
    "no failures": (failures_table({}, 16),),
    "reproduction": tuple(reproduction_tables(FOUR_ROBOTS)),
    "reproduction, many robots": tuple(reproduction_tables(MANY_ROBOTS)),
    "overview": tuple(overview_tables(OVERVIEW)),
}


@pytest.mark.parametrize("columns", [80, 40])
@pytest.mark.parametrize("name", TABLES)
def test_table(name: str, columns: int, snapshot: SnapshotAssertion) -> None:
    file = io.StringIO()
    console = Console(file=file, width=columns, markup=False, highlight=False, emoji=False)
    for table in TABLES[name]:
        console.print(table, "")
    lines = [line.rstrip() for line in file.getvalue().splitlines()]
    assert max(map(len, lines)) <= columns
    assert "\n".join(lines) == snapshot
