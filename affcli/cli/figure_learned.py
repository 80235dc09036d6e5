"""``affcli figure``: what was learned (Figs. 5 and 6), and the laboratory (Figs. 1, 8 and 9)."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from affcli.cli.files import require_new, save
from affcli.cli.options import (
    DEFAULT_DATABASE,
    Config,
    Database,
    Force,
    checked_count,
    checked_tool,
    checked_tools,
)
from affcli.cli.solve import learned_runs
from affcli.cli.terminal import say
from affcli.errors import UsageError, one_line

if TYPE_CHECKING:
    from affcli.store import LearningRunInfo, Store

ENDINGS = (".png", ".svg", ".pdf")
"""Of the files that figures can be."""
LARGEST_ID = 2**63 - 1
Out = Annotated[Path, typer.Option("--out", help="*.png, *.svg or *.pdf.", metavar="FILE")]
Run = Annotated[int | None, typer.Option("--run", help="A learning run's id.", metavar="ID")]
OneTool = Annotated[
    str | None,
    typer.Option("--tool", help="Or the latest run of this tool.", metavar="NAME"),
]


def affordances(
    *,
    out: Out,
    run: Run = None,
    tool: OneTool = None,
    compare: Annotated[
        int | None,
        typer.Option("--compare", help="Another run, beside it.", metavar="ID"),
    ] = None,
    after_trial: Annotated[
        int | None,
        typer.Option("--after-trial", help="The table before and after it.", metavar="ID"),
    ] = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw what a tool affords, as arrows over its outline.

    As in Fig. 6, an arrow a row: where the attractor was from the wrist, and how it moved. Of the
    latest finished run of the T-hook if nothing else is said.

    With --compare a row is kept when the other run has one of the same behavior and distance that
    starts within 1.5 in of it and moves within 40 degrees of it; else it is lost, or won: some 8 %
    of the rows by chance alone, between two robots with the same tool.
    """
    if run is not None and tool is not None:
        raise UsageError("give --run or --tool, not both")
    if after_trial is not None and (run, tool, compare) != (None, None, None):
        raise UsageError("--after-trial has a run: leave out --run, --tool and --compare")
    _check_ids(("--run", run), ("--compare", compare), ("--after-trial", after_trial))
    if tool is not None:
        checked_tool(tool)
    _check_out(out, force=force)

    from affcli.lab.affordance_views import table_of_run, tables_around_trial, tables_compared
    from affcli.report.figures.affordances import affordances_figure
    from affcli.report.figures.canvas import encoded
    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        if after_trial is not None:
            shown = tables_around_trial(store, after_trial)
        else:
            chosen = _chosen_run(store, run, tool, database)
            if compare is not None:
                shown = tables_compared(store, chosen, store.learning_run(compare))
            else:
                shown = table_of_run(store, chosen)
    figure = affordances_figure(shown.calls, shown.views, shown.key)
    _save(out, encoded(figure, out.suffix), shown.title)


def row(
    *,
    row: Annotated[int, typer.Argument(help="A row's id in the database.", metavar="ID")],
    out: Out,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw one row of an affordance table.

    As in Fig. 5. `affcli sql "select * from affordance_table"` shows the rows with their ids.
    """
    _check_ids(("row", row))
    _check_out(out, force=force)

    from affcli.lab.affordance_views import row_shown
    from affcli.report.figures.canvas import encoded
    from affcli.report.figures.row import row_figure
    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        title, view = row_shown(store, row)
    _save(out, encoded(row_figure(view), out.suffix), title)


def workspace(
    *,
    out: Out,
    tool: Annotated[
        str, typer.Option("--tool", help="What lies at the centre.", metavar="NAME")
    ] = "t-hook",
    config: Config = None,
    force: Force = False,
) -> None:
    """Draw the table: goals, starts, tool, reach of the arm.

    As in Fig. 8, as a trial begins.
    """
    checked_tool(tool)
    _check_out(out, force=force)

    from affcli.config import load_settings
    from affcli.core.tool import ToolName, paper_tools
    from affcli.report.figures.canvas import encoded
    from affcli.report.figures.workspace import workspace_figure
    from affcli.simulation.arm import reach_at

    place = load_settings(config).workspace
    reach = reach_at(place.arm, place.arm.flange_height)
    lying = paper_tools(place.tools)[ToolName(tool)]
    figure = workspace_figure(place, lying, reach)
    words = f"the bare arm reaches from {reach.inner:.1f} to {reach.outer:.1f} in"
    _save(out, encoded(figure, out.suffix), f"the table with the {tool}; {words}")


def tools(
    *,
    out: Out,
    tool: Annotated[str, typer.Option("--tool", help="The one that breaks.", metavar="NAME")] = (
        "t-hook"
    ),
    becomes: Annotated[
        str, typer.Option("--becomes", help="The shape that is left.", metavar="NAME")
    ] = "l-hook",
    config: Config = None,
    force: Force = False,
) -> None:
    """Draw the five tools to scale, and one that broke.

    As in Figs. 1 and 9, with the names of their parts.
    """
    checked_tool(tool)
    checked_tool(becomes)
    _check_out(out, force=force)

    from affcli.config import load_settings
    from affcli.core.tool import ToolName, paper_tools
    from affcli.report.figures.canvas import encoded
    from affcli.report.figures.tools import tools_figure

    place = load_settings(config).workspace
    known = paper_tools(place.tools)
    whole, left = known[ToolName(tool)], known[ToolName(becomes)]
    if left.parts_missing_in(whole) or not whole.parts_missing_in(left):
        raise UsageError(f"--becomes {becomes}: a {tool} does not become that by losing parts")
    figure = tools_figure(list(known.values()), (whole, left), place.puck.radius)
    _save(out, encoded(figure, out.suffix), f"five tools, and a {tool} that became {becomes}")


def learning(
    *,
    out: Out,
    run: Annotated[
        list[int] | None,
        typer.Option("--run", help="Learning runs, instead of all.", metavar="ID"),
    ] = None,
    tool: Annotated[
        list[str] | None, typer.Option("--tool", help="Only those of these.", metavar="NAME")
    ] = None,
    session: Annotated[
        int | None,
        typer.Option("--session", help="The robots of a reproduction.", metavar="ID"),
    ] = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw how learning went over robot time.

    Rows made, and the share of behaviors that had an effect so far.

    A line a learning run; with --session the mean of many robots and the central 95 % of them.
    """
    if run and (tool or session is not None):
        raise UsageError("give --run alone, without --tool and --session")
    _check_ids(*(("--run", one) for one in run or ()), ("--session", session))
    names = checked_tools(tool or ())
    _check_out(out, force=force)

    from affcli.lab.learning_curves import curves_of, curves_of_robots
    from affcli.report.figures.canvas import encoded
    from affcli.report.figures.learning import bands_figure, curves_figure
    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        if session is not None:
            title, tools = curves_of_robots(store, session, names)
            figure = bands_figure(tools)
        else:
            title, curves = curves_of(store, _runs_to_draw(store, run or (), names, database))
            figure = curves_figure(curves)
    _save(out, encoded(figure, out.suffix), title)


def _check_ids(*given: tuple[str, int | None]) -> None:
    """Refuse numbers that nothing in a database can have."""
    for option, number in given:
        if number is not None:
            checked_count(option, number, LARGEST_ID)


def _check_out(out: Path, *, force: bool) -> None:
    """Make sure, before any work, that a figure can be drawn and has a place."""
    require_new(out, force=force, endings=ENDINGS)

    from affcli.lab.drawing import require_figures

    require_figures()


def _save(out: Path, data: bytes, title: str) -> None:
    """Write a figure and say what it shows."""
    save(out, data)
    say(f"{title}: {one_line(out)}")


def _chosen_run(
    store: "Store", run: int | None, tool: str | None, database: Path
) -> "LearningRunInfo":
    """Return a learning run, finished or not, or the latest finished one of a tool."""
    if run is not None:
        return store.learning_run(run)
    name = tool or "t-hook"
    unfinished = store.learning_runs(tool=name, status="running")
    if unfinished and store.latest_run(name) is None:
        number = unfinished[-1].id
        raise UsageError(
            f"no finished run with the {name}; --run {number} draws what run {number} has so far"
        )
    return learned_runs(store, name, database)[0]


def _runs_to_draw(
    store: "Store", ids: Sequence[int], tools: Sequence[str], database: Path
) -> "list[LearningRunInfo]":
    """Return learning runs, finished or not: those asked for, or all that stand for themselves."""
    from affcli.report.figures.learning import MOST_CURVES

    if ids:
        runs = [store.learning_run(one) for one in dict.fromkeys(ids)]
    else:
        runs = [run for run in store.learning_runs() if not tools or run.spec.tool in tools]
    if not runs:
        reproduced = store.sessions("reproduce")
        if reproduced:
            raise UsageError(
                f"no learning runs but of robots: --session {reproduced[-1].id} draws these"
            )
        learned_runs(store, tools[0] if tools else None, database)
    if len(runs) > MOST_CURVES:
        raise UsageError(
            f"{len(runs)} runs are more than the {MOST_CURVES} lines that can be told apart; "
            "choose with --run or --tool"
        )
    return runs
