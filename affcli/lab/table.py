"""Rows of affordance tables with the part of the tool that the attractor was nearest to (§6.1)."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import islice
from typing import Any, TypeVar

from affcli.config import settings_from_json
from affcli.core.geometry import Point
from affcli.core.tool import Tool, ToolName, paper_tools
from affcli.core.trial import TrialSpec
from affcli.errors import DatabaseError
from affcli.store import Column, LearningRunInfo, Relation, RowFilter, Store, StoredRow, StoredStep

Made = TypeVar("Made")
Write = Callable[[Sequence[Column], Iterable[tuple[Any, ...]]], Made]
"""Makes something of columns and their values."""

REGION = Column("region", str)
"""The column that is not in the database."""


def every_run(store: Store) -> tuple[LearningRunInfo, ...]:
    """Return all learning runs, also those of reproductions and unfinished ones."""
    robots = (store.learning_runs(session_id=s.id) for s in store.sessions("reproduce"))
    return (*store.learning_runs(), *(run for runs in robots for run in runs))


def tool_of(run: LearningRunInfo) -> Tool:
    """Return the tool as it was learned: of the sizes that the run's own settings give it.

    Raises:
        DatabaseError: affcli knows no such tool.
    """
    tool = _tools(run.spec.settings).get(ToolName(run.spec.tool))
    if tool is None:
        raise DatabaseError(
            f"learning run {run.id} holds a tool that affcli does not know; restore a copy of the "
            "database"
        )
    return tool


def region_of(tool: Tool, row: StoredRow) -> str:
    """Return the name of the part nearest to where the attractor was when the row was made."""
    return tool.part_nearest(row.row.start.wrist_to_object).name


def history_of(store: Store, row_id: int) -> list[tuple[StoredStep, TrialSpec]]:
    """Return every step that tried a row, by trial and number, each with its trial."""
    steps = store.row_steps(row_id)
    trials = {number: store.trial(number).spec for number in {step.trial_id for step in steps}}
    return [(step, trials[step.trial_id]) for step in steps]


def listed_rows(
    store: Store, runs: Sequence[LearningRunInfo], wanted: RowFilter, region: str | None
) -> list[tuple[StoredRow, str]]:
    """Return the rows that filter and region leave, each with its region, oldest first.

    Args:
        store: open.
        runs: the learning runs whose rows they are.
        wanted: which rows.
        region: only those in which the attractor was nearest to this part of the tool.
    """
    tools = {run.id: tool_of(run) for run in runs}
    found = store.select_rows(_unless_by_region(wanted, region))
    named = (
        (row, region_of(tools[row.run_id], row))
        for row in found
        if row.run_id in tools  # and not of a run that was begun since
    )
    return list(islice((one for one in named if region in (None, one[1])), wanted.limit))


def taken_out(
    store: Store,
    what: Relation,
    runs: Sequence[LearningRunInfo],
    wanted: RowFilter,
    region: str | None,
    write: Write[Made],
) -> tuple[Made, int]:
    """Return what `write` makes of all columns of the rows or records, and how many they are.

    Rows get one column more, their region.

    Args:
        store: open.
        what: rows, or the behaviors, trials or steps of the learning runs.
        runs: the learning runs.
        wanted: which of them.
        region: only rows in which the attractor was nearest to this part of the tool.
        write: is given them one after the other.
    """
    count = 0

    def counted(rows: Iterable[tuple[Any, ...]]) -> Iterator[tuple[Any, ...]]:
        nonlocal count
        for row in rows:
            count += 1
            yield row

    def write_counted(columns: Sequence[Column], rows: Iterable[tuple[Any, ...]]) -> Made:
        return write(columns, counted(rows))

    if what != "rows":
        made = store.extract(what, wanted, write_counted)
        return made, count
    tools = {run.id: tool_of(run) for run in runs}

    def write_rows(columns: Sequence[Column], rows: Iterable[tuple[Any, ...]]) -> Made:
        chosen = _with_region(columns, rows, tools, region)
        return write_counted([*columns, REGION], islice(chosen, wanted.limit))

    made = store.extract(what, _unless_by_region(wanted, region), write_rows)
    return made, count


def _with_region(
    columns: Sequence[Column],
    rows: Iterable[tuple[Any, ...]],
    tools: Mapping[int, Tool],
    region: str | None,
) -> Iterator[tuple[Any, ...]]:
    """Yield the rows with their region; only those in `region` unless it is None."""
    names = [column.name for column in columns]
    run, x, y = (
        names.index(name) for name in ("run", "start_wrist_to_object_x", "start_wrist_to_object_y")
    )
    for row in rows:
        if row[run] in tools:  # and not of a run that was begun since
            part = tools[row[run]].part_nearest(Point(row[x], row[y])).name
            if region in (None, part):
                yield (*row, part)


def _unless_by_region(wanted: RowFilter, region: str | None) -> RowFilter:
    """Return the filter without its limit when rows are left out by region afterwards."""
    return wanted if region is None else replace(wanted, limit=None)


@lru_cache(maxsize=8)
def _tools(settings: str) -> Mapping[ToolName, Tool]:
    """Return the tools as these settings make them."""
    return paper_tools(settings_from_json(settings).workspace.tools)
