"""``affcli figure``: what was learned (Figs. 5 and 6), and the laboratory (Figs. 1, 8 and 9)."""

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from affcli import lab, registry
from affcli import store as stores
from affcli.cli.database import opened
from affcli.cli.figure import Figure, figure
from affcli.cli.options import (
    DEFAULT_BROKEN,
    DEFAULT_TOOL,
    LARGEST_ID,
    Becomes,
    Changes,
    Config,
    Database,
    Run,
    check_count,
    checked_count,
    checked_tool,
    names_given,
)
from affcli.config import load_settings
from affcli.core.identity import canonical_json
from affcli.core.records import LearningRunInfo
from affcli.core.specs import LIVES
from affcli.errors import UsageError
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report import figures
from affcli.report.captions import (
    LEARNING,
    curves_words,
    experiment_words,
    robots_words,
    tools_words,
    workspace_words,
)
from affcli.simulation.arm import reach_at
from affcli.simulation.tasks.extension_of_reach import extension_of_reach
from affcli.simulation.tools.paper import TOOL_PARTS

OneTool = Annotated[
    str | None,
    typer.Option(
        "--tool",
        help="Or the latest run of this tool.",
        metavar="NAME",
    ),
]


def _checked_ids(runs: Sequence[int] | None) -> list[int]:
    """Return the ids of learning runs; BadInputError when one is none that a database has."""
    return [checked_count("--run", run, LARGEST_ID) for run in runs or ()]


@figure
def affordances(
    *,
    run: Run = None,
    tool: OneTool = None,
    compare: Annotated[
        int | None,
        typer.Option(
            "--compare",
            help="Another run, beside it.",
            metavar="ID",
            parser=check_count("--compare"),
        ),
    ] = None,
    after_trial: Annotated[
        int | None,
        typer.Option(
            "--after-trial",
            help="The table before and after it.",
            metavar="ID",
            parser=check_count("--after-trial"),
        ),
    ] = None,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw what a tool affords, as arrows over its outline.

    As in Fig. 6, an arrow for each row: where the attractor was from the wrist, and how it moved.
    Of the latest finished run of the T-hook if nothing else is said.

    With --compare a row is kept when the other run has one of the same behavior and distance that
    starts within 1.5 in of it and moves within 40 degrees of it; else it is lost, or won: some 8 %
    of the rows by chance alone, between two robots with the same tool.
    """
    if run is not None and tool is not None:
        raise UsageError("give --run or --tool, not both")
    if after_trial is not None and (run, tool, compare) != (None, None, None):
        raise UsageError("--after-trial has a run: leave out --run, --tool and --compare")
    with opened(database) as store:
        if after_trial is not None:
            shown = lab.affordance_views.tables_around_trial(store, after_trial)
        else:
            chosen = _chosen_run(store, run, tool)
            if compare is not None:
                shown = lab.affordance_views.tables_compared(
                    store, chosen, store.learning.run(compare)
                )
            else:
                shown = lab.affordance_views.table_of_run(store, chosen)
    draw = figures.affordances.affordances_figure
    return Figure(shown.words, partial(draw, shown.calls, shown.views, shown.key))


@figure
def row(
    *,
    row: Annotated[
        int,
        typer.Argument(help="A row's id in the database.", metavar="ID", parser=check_count("row")),
    ],
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw one row of an affordance table.

    As in Fig. 5. `affcli sql "select * from affordance_table"` shows the rows with their ids.
    """
    with opened(database) as store:
        words, view = lab.affordance_views.row_shown(store, row)
    return Figure(words, partial(figures.row.row_figure, view))


@figure
def transfer(
    *,
    run: Run = None,
    tool: OneTool = None,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw what a run borrowed from others, and what it became.

    A panel for each tool that lent, and one for the new tool, over the tools as the camera saw them
    (§8).
    """
    if (run is None) == (tool is None):
        raise UsageError("which run that borrowed? give --run or --tool")
    with opened(database) as store:
        words, tables = lab.transferring.lending(store, _chosen_run(store, run, tool))
    return Figure(words, partial(figures.transfer.transfer_figure, tables))


@figure
def workspace(
    *,
    tool: Annotated[
        str,
        typer.Option(
            "--tool", help="What lies at the centre.", metavar="NAME", callback=checked_tool
        ),
    ] = DEFAULT_TOOL,
    config: Config = None,
    changes: Changes = None,
) -> Figure:
    """Draw the table: goals, starts, tool, reach of the arm.

    As in Fig. 8, as a trial begins.
    """
    settings = load_settings(config, changes or ())
    place = settings.workspace
    reach = reach_at(place.arm, place.arm.flange_height)
    lying = registry.tool(tool, place.tools)
    tasks = extension_of_reach(place.layout)
    draw = partial(figures.workspace.workspace_figure, place, lying, reach, tasks)
    return Figure(workspace_words(lying, reach, canonical_json(settings.differing())), draw)


@figure
def tools(
    *,
    tool: Annotated[
        str,
        typer.Option("--tool", help="The one that breaks.", metavar="NAME", callback=checked_tool),
    ] = DEFAULT_TOOL,
    becomes: Becomes = None,
    config: Config = None,
    changes: Changes = None,
) -> Figure:
    """Draw the five tools to scale, and one that broke.

    As in Figs. 1 and 9, with the names of their parts.
    """
    settings = load_settings(config, changes or ())
    place = settings.workspace
    known = [registry.tool(name, place.tools) for name in TOOL_PARTS]
    becomes = becomes or DEFAULT_BROKEN
    whole, left = (registry.tool(name, place.tools) for name in (tool, becomes))
    if left.parts_missing_in(whole) or not whole.parts_missing_in(left):
        raise UsageError(f"--becomes {becomes}: a {tool} does not become that by losing parts")
    draw = partial(figures.tools.tools_figure, known, (whole, left), place.puck.radius)
    return Figure(tools_words(whole, left, canonical_json(settings.differing())), draw)


@figure
def learning(
    *,
    experiment: Annotated[
        str | None,
        typer.Argument(help="What its robots solved after so long.", metavar="EXPERIMENT"),
    ] = None,
    run: Annotated[
        list[int] | None,
        typer.Option(
            "--run",
            help="Only this learning run; several times for several.",
            metavar="ID",
            callback=_checked_ids,
        ),
    ] = None,
    tool: Annotated[
        list[str] | None,
        typer.Option(
            "--tool", help="Only runs of this tool.", metavar="NAME", callback=names_given
        ),
    ] = None,
    session: Annotated[
        int | None,
        typer.Option(
            "--session",
            help="The robots of a reproduction.",
            metavar="ID",
            parser=check_count("--session"),
        ),
    ] = None,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw how learning went over robot time.

    Of an experiment: solved trials by how long its robots learned, the mean of the robots with its
    95 % interval. Conditions whose names differ in nothing but "minutes=N" are joined: a line for
    each way to explore.

    Else rows made, and the share of behaviors that had an effect so far.

    One line for each learning run. Of more than 12, and with --session of the robots of a
    reproduction, the mean with its 95 % interval and the central 95 % of robots, a panel a tool.
    """
    if run and (tool or session is not None or experiment is not None):
        raise UsageError("give --run alone, without EXPERIMENT, --tool and --session")
    names = tool or ()
    if experiment is not None:
        if session is not None:
            raise UsageError("give EXPERIMENT or --session, not both")
        return _success(experiment, names, database)
    with opened(database) as store:
        if session is not None:
            info, kinds = lab.learning_curves.curves_of_robots(store, session, names)
            words = robots_words(info, max(kind.robots for kind in kinds))
            return Figure(words, partial(figures.learning.bands_figure, kinds))
        curves = lab.learning_curves.curves_of(store, _runs_to_draw(store, run or (), names))
    draw = partial(figures.learning.curves_figure, curves)
    if len(curves) > figures.learning.MOST_CURVES:
        draw = partial(figures.learning.bands_figure, lab.learning_curves.by_kind(curves))
    return Figure(curves_words(curves), draw)


def _success(experiment: str, tools: Sequence[str], database: Path) -> Figure:
    """Return the figure of what robots of an experiment solved by how long they learned."""
    with opened(database) as store:
        conditions = lab.conditions.experiment_named(store, experiment)
        found = lab.courses.curves_of(store, conditions, "solved", "minutes", tools)
    figures.curve.require_few(found.lines)
    words = experiment_words(LEARNING, experiment, [one[:3] for one in conditions], tools)
    return Figure(words, partial(figures.curve.curve_figure, found.lines, found.x, found.y))


def _chosen_run(store: "stores.Store", run: int | None, tool: str | None) -> LearningRunInfo:
    """Return a learning run, finished or not, or the latest finished one of a tool."""
    if run is not None:
        return store.learning.run(run)
    name = tool or DEFAULT_TOOL
    unfinished = [one for one in store.learning.runs(status="running") if one.spec.tool == name]
    if unfinished and store.learning.latest(name) is None:
        number = unfinished[-1].id
        raise UsageError(
            f"no finished run with the {name}; --run {number} draws what run {number} has so far"
        )
    return lab.choosing.learned_runs(store, name)[0]


def _runs_to_draw(
    store: "stores.Store", ids: Sequence[int], tools: Sequence[str]
) -> list[LearningRunInfo]:
    """Return learning runs, finished or not: those asked for, or all that stand for themselves."""
    if ids:
        runs = [store.learning.run(one) for one in dict.fromkeys(ids)]
    else:
        begun = [run for run in store.learning.runs() if run.behaviors]
        meant = [run for run in begun if not tools or run.spec.tool in tools]
        # A log without times has no curve; it is refused where nothing else is there.
        runs = [run for run in meant if not math.isnan(run.robot_seconds)] or meant
    if not runs:
        reproduced = store.sessions.all(*LIVES)
        if reproduced:
            raise UsageError(
                f"no learning runs but of robots: --session {reproduced[-1].id} draws these"
            )
        # There is none, which this says; or it only borrowed, which its curve says.
        return lab.choosing.learned_runs(store, tools[0] if tools else None)
    return runs
