"""Affordance tables and their rows, gathered for figures (Figs. 5 and 6)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from affcli.behaviors.registry import paper_behaviors
from affcli.config import Settings, settings_from_json
from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.tool import TOOL_PARTS, Tool, ToolName, paper_tools
from affcli.errors import DatabaseError, UsageError, one_line
from affcli.lab.plausible import check_numbers
from affcli.report.fates import Fate, RowView, TableView, around_trial, compared, now
from affcli.report.figures.words import tool_words
from affcli.report.learning import clock
from affcli.store import LearningRunInfo, Store, StoredRow, TrialInfo

EXCLUDED = "excluded: replication probability 1/2 or below"


@dataclass(frozen=True, slots=True)
class ShownTables:
    """One affordance table, or two side by side.

    Args:
        title: what is shown, in words.
        calls: the exploratory behaviors, each with its distance.
        views: the tables.
        key: what each fate of a row means here.
    """

    title: str
    calls: Sequence[BehaviorCall]
    views: Sequence[TableView]
    key: Mapping[Fate, str]


def table_of_run(store: Store, run: LearningRunInfo) -> ShownTables:
    """Return the table of a learning run as it is now: excluded rows are told apart."""
    settings = settings_from_json(run.spec.settings)
    rows = _rows(store, run)
    view = _view("", settings, _tool(settings, run.spec.tool, run), None, rows, now(rows))
    left_out = view.count(Fate.EXCLUDED)
    counted = _counted(len(rows)) + (f", {left_out} of them excluded" if left_out else "")
    title = f"run {run.id}, {run.spec.tool}{_unfinished(run)}, {counted}"
    key = {Fate.ROW: "live row of the affordance table", Fate.EXCLUDED: EXCLUDED}
    return ShownTables(title, _calls(settings), [view], key)


def tables_compared(store: Store, one: LearningRunInfo, other: LearningRunInfo) -> ShownTables:
    """Return the tables of two learning runs: what both have, and what only one of them has.

    Raises:
        UsageError: they are the same run.
    """
    if one.id == other.id:
        raise UsageError(f"--compare {other.id}: that is the run itself; name another")
    rows = _rows(store, one), _rows(store, other)
    fates = compared(*rows)
    settings = settings_from_json(one.spec.settings)
    tool = _tool(settings, one.spec.tool, one)
    before = _view(_heading(one), settings, tool, None, rows[0], fates[0])
    own = settings_from_json(other.spec.settings)
    after = _view(_heading(other), own, _tool(own, other.spec.tool, other), tool, rows[1], fates[1])
    title = (
        f"runs {one.id} ({one.spec.tool}) and {other.id} ({other.spec.tool}): "
        f"{before.count(Fate.KEPT)} of {_counted(len(rows[0]))} kept, "
        f"{before.count(Fate.LOST)} lost, {after.count(Fate.WON)} of "
        f"{_counted(len(rows[1]))} won"
    )
    key = {
        Fate.KEPT: "in both runs",
        Fate.LOST: f"lost: only in run {one.id}",
        Fate.WON: f"won: only in run {other.id}",
        Fate.EXCLUDED: "excluded",
    }
    return ShownTables(title, _calls(settings), (before, after), key)


def tables_around_trial(store: Store, trial_id: int) -> ShownTables:
    """Return the table that a trial started from, and what it left of it.

    Raises:
        UsageError: there is no such trial.
    """
    trial = store.trial(trial_id)
    run = store.learning_run(trial.run_id)
    settings = settings_from_json(trial.settings)
    steps = store.trial_steps(trial_id)
    stored = _sound(store.affordances(run.id))
    tried = {step.affordance_id for step in steps}
    died = {step.affordance_id for step in steps if step.died}
    # A row that was tried had not been excluded, whatever another process did meanwhile.
    fates = around_trial(
        [row.id for row in stored], store.rows_excluded_before(trial_id) - tried, died
    )
    rows = [row.row for row in stored]
    tool, shape = (_tool(settings, name, trial) for name in (trial.spec.tool, trial.spec.shape))
    broke = "" if tool.name == shape.name else f": the shape of the {tool_words(shape.name)}"
    before = _view(f"Before trial {trial_id}", settings, tool, None, rows, fates[0])
    after = _view(f"After trial {trial_id}{broke}", settings, shape, tool, rows, fates[1])
    became = "" if tool.name == shape.name else f" that became {shape.name}"
    title = (
        f"trial {trial_id}, {tool.name}{became}{_so_far(trial, len(steps))}: "
        f"{after.count(Fate.KEPT)} rows kept, {after.count(Fate.LOST)} lost"
    )
    key = {
        Fate.KEPT: "kept",
        Fate.LOST: "lost: its probability fell to 1/2 or below in the trial",
        Fate.EXCLUDED: "excluded before the trial",
    }
    return ShownTables(title, _calls(settings), (before, after), key)


def row_shown(store: Store, row_id: int) -> tuple[str, RowView]:
    """Return a row of an affordance table with a title.

    Raises:
        UsageError: there is no such row.
    """
    (stored,) = _sound([store.affordance(row_id)])
    run = store.learning_run(stored.run_id)
    settings = settings_from_json(run.spec.settings)
    tool = _tool(settings, stored.tool, run)
    title = f"row {row_id}, {tool.name}, {one_line(stored.row.exploratory, 60)} (run {run.id})"
    return title, RowView(stored.row, tool, settings.workspace.puck.radius)


def _view(
    heading: str,
    settings: Settings,
    tool: Tool,
    was: Tool | None,
    rows: Sequence[Affordance],
    fates: Sequence[Fate],
) -> TableView:
    """Return a table over a tool; with `was`, what that had and the tool lacks is missing."""
    missing = () if was is None else was.parts_missing_in(tool)
    radius = settings.workspace.puck.radius
    return TableView(heading, tool.parts, missing, radius, list(zip(rows, fates, strict=True)))


def _tool(settings: Settings, name: str, of: LearningRunInfo | TrialInfo) -> Tool:
    """Return a tool by the name that a record holds."""
    if name not in TOOL_PARTS:
        what = "run" if isinstance(of, LearningRunInfo) else "trial"
        raise DatabaseError(f"{what} {of.id} holds a tool that affcli does not know")
    return paper_tools(settings.workspace.tools)[ToolName(name)]


def _rows(store: Store, run: LearningRunInfo) -> list[Affordance]:
    """Return the rows of a run with their counters as they are now."""
    return [stored.row for stored in _sound(store.affordances(run.id))]


def _sound(rows: Sequence[StoredRow]) -> Sequence[StoredRow]:
    """Return the rows; DatabaseError when one lies where there is no table."""
    for row in rows:
        check_numbers(f"affordance {row.id}", (*row.row.start, *row.row.end))
    return rows


def _calls(settings: Settings) -> Sequence[BehaviorCall]:
    """Return the exploratory behaviors, each with its distances."""
    workspace = settings.workspace
    return paper_behaviors(workspace.arm, workspace.motion, workspace.tools).exploratory


def _heading(run: LearningRunInfo) -> str:
    """Return what stands over the table of one of several runs."""
    return f"Run {run.id}: {tool_words(run.spec.tool)}{_unfinished(run)}"


def _unfinished(run: LearningRunInfo) -> str:
    """Return in words how far a run came that is not finished; empty if it is."""
    return "" if run.status == "done" else f" (unfinished, {clock(run.robot_seconds)} so far)"


def _so_far(trial: TrialInfo, steps: int) -> str:
    """Return in words how far a trial came that has not ended; empty if it has."""
    taken = f"{steps} step{'' if steps == 1 else 's'}"
    return "" if trial.outcome is not None else f" (unfinished, {taken} so far)"


def _counted(rows: int) -> str:
    """Return how many rows."""
    return f"{rows} row{'' if rows == 1 else 's'}"
