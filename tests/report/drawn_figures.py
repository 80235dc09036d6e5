"""Figures of hand-made tables, and a process that writes them.

``python -m tests.report.drawn_figures`` prints the SHA-256 of every file it would make.
"""

import hashlib
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from affcli.analysis.comparison import Beside, Results
from affcli.analysis.curves import Curve, ToolCurves
from affcli.analysis.prediction import Prediction, Push
from affcli.analysis.row_status import RowStatus, compared
from affcli.behaviors.moving import paper_repertoire
from affcli.core.affordance import Affordance
from affcli.core.geometry import Point
from affcli.core.mask import Mask
from affcli.core.tool import ToolName, unknown_tool
from affcli.core.workspace import Workspace
from affcli.report.figures.affordances import affordances_figure
from affcli.report.figures.canvas import FORMATS, encoded
from affcli.report.figures.learning import bands_figure, curves_figure
from affcli.report.figures.prediction import prediction_figure
from affcli.report.figures.results import results_figure
from affcli.report.figures.row import row_figure
from affcli.report.figures.tools import tools_figure
from affcli.report.figures.transfer import transfer_figure
from affcli.report.figures.trial import trial_figure
from affcli.report.figures.workspace import workspace_figure
from affcli.report.film import FilmedTrial, Shown, shown_of
from affcli.report.table_views import RowView, TableView
from affcli.report.transferring import Kind, LentTable
from affcli.simulation.arm import reach_at
from affcli.simulation.tasks.extension_of_reach import extension_of_reach
from affcli.simulation.tools.paper import paper_tools
from tests.factories import affordance, learning_spec, moved_by
from tests.report.filmed import filmed_step, filmed_trial
from tests.report.hand_made import learned_run, session_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WORKSPACE = Workspace()
TOOLS = paper_tools(WORKSPACE.tools)
T_HOOK, L_HOOK = TOOLS[ToolName("t-hook")], TOOLS[ToolName("l-hook")]
TASKS = extension_of_reach(WORKSPACE.layout)
REACH = reach_at(WORKSPACE.arm, WORKSPACE.arm.flange_height)
CALLS = [one.call for one in paper_repertoire()]
KEY = {status: f"what is {status.value}" for status in RowStatus}


def table(*, first: int = 0, count: int = 24) -> list[Affordance]:
    """Return rows of all eight behaviors, some of them so short that a head is half of them."""
    return [
        affordance(
            step,
            moved=(0.2 + 0.17 * step, 0.6 - 0.11 * step),
            offset=Point(step / 4 - 3.0, 8.0 + step / 3),
            call=CALLS[step % len(CALLS)],
        )
        for step in range(first, first + count)
    ]


def view(
    rows: Sequence[tuple[Affordance, RowStatus]], heading: str = "", *, broken: bool = False
) -> TableView:
    """Return a table over the T-hook, or over what is left of it."""
    tool = L_HOOK if broken else T_HOOK
    missing = T_HOOK.parts_missing_in(tool)
    return TableView(heading, tool.parts, missing, WORKSPACE.puck.radius, list(rows))


def compared_views() -> list[TableView]:
    """Return two tables that have some rows in common."""
    tables = table(), table(first=8)
    statuses = compared(*tables)
    return [
        view(list(zip(rows, its, strict=True)), heading, broken=heading == "Run 2")
        for rows, its, heading in zip(tables, statuses, ("Run 1", "Run 2"), strict=True)
    ]


def curve(name: str, slope: float) -> Curve:
    """Return a curve of 41 points that rises evenly."""
    minutes = [1.5 * i for i in range(41)]
    run = learned_run(1, replace(learning_spec(), held=unknown_tool(name)))
    return Curve(run, minutes, [slope * m for m in minutes], [slope / 10.0 for _ in minutes])


def bands() -> list[ToolCurves]:
    """Return three robots with each of the five tools."""
    return [
        ToolCurves.of(name, [curve("", k + n / 4) for k in (1.0, 1.2, 1.7)])
        for n, name in enumerate(TOOLS)
    ]


WIDTHS = (3.5, 7.0)
"""Of a column and of two (in)."""
LONG = "a very long name of a tool that nobody has"
CELLS = {
    (tool, goal): Beside(3, [2, 3] * 10, 4)
    for tool in (*TOOLS, f"{LONG}, lookahead:depth=2")
    for goal in ("1", "2", "3", "4", "far corner")
}
SUMS = Beside(69, [61, 70] * 10, 80), Beside(16, [14, 16] * 10, 16)


def pushes() -> list[Push]:
    """Return pushes of which some were predicted, better and better."""
    seen, wrist = moved_by(2.0, 0.5), moved_by(5.0, 0.0)
    return [
        Push(
            number % 2 == 0,
            seen if number % 2 == 0 else moved_by(0.0, 0.0),
            wrist,
            {
                rows: Prediction(moved_by(2.0 + number / rows / 9, 0.6), moved_by(1.0, 1.0))
                for rows in (5, 10, 20, 40, 80, 97)
            },
        )
        for number in range(24)
    ]


def strip() -> tuple[FilmedTrial, Shown]:
    """Return a trial of twelve steps with a broken tool."""
    steps = [filmed_step(n, row=1_000 + n, lost=n < 6, excluded=n < 6) for n in range(1, 13)]
    trial = filmed_trial(*steps, shape="l-hook")
    return trial, shown_of(trial.steps, None)


def lent() -> list[LentTable]:
    """Return what two tools lent to a third."""
    mask = Mask.of(np.ones((8, 140), dtype=bool), -4, 0, (200.0, 40.0, 40.0))
    rows = [(row, list(Kind)[number % 4]) for number, row in enumerate(table())]
    return [LentTable(f"{name}, run 1: 3 of 9 rows lent", mask, rows) for name in ("a", LONG, "c")]


FIGURES: dict[str, "Callable[[float | None], Figure]"] = {
    "affordances": partial(
        affordances_figure, CALLS, [view([(row, RowStatus.LIVE) for row in table()])], KEY
    ),
    "compared": partial(affordances_figure, CALLS, compared_views(), KEY),
    "row": partial(row_figure, RowView(table()[3], T_HOOK, WORKSPACE.puck.radius)),
    "workspace": partial(workspace_figure, WORKSPACE, T_HOOK, REACH, TASKS),
    "tools": partial(tools_figure, list(TOOLS.values()), (T_HOOK, L_HOOK), WORKSPACE.puck.radius),
    "curves": partial(curves_figure, [curve(f"run {n}", n) for n in range(1, 13)]),
    "bands": partial(bands_figure, bands()),
    "results": partial(results_figure, Results(session_of(5), 20, {}, CELLS, *SUMS)),
    "prediction": partial(prediction_figure, pushes()),
    "transfer": partial(transfer_figure, lent()),
    "trial": partial(trial_figure, *strip()),
}
"""Each as wide as asked (in), or as suits it."""


def hashes() -> list[str]:
    """Return one line a file: every figure as SVG, a small one in every format."""
    files = [(name, ".svg") for name in FIGURES]
    files += [("workspace", ending) for ending in FORMATS if ending != ".svg"]
    return [
        f"{name}{ending} {hashlib.sha256(encoded(FIGURES[name](None), ending)).hexdigest()}"
        for name, ending in files
    ]


if __name__ == "__main__":
    sys.stdout.write("\n".join(hashes()))
