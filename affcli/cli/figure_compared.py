"""``affcli figure compare`` and ``curve``: conditions beside each other."""

from functools import partial
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.compare import Against, By, Experiment, Sessions
from affcli.cli.database import opened
from affcli.cli.figure import Figure, figure
from affcli.cli.options import Database
from affcli.errors import UsageError
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report import figures
from affcli.report.captions import comparison_words, conditions_words, experiment_words


@figure
def compare(
    *,
    experiment: Experiment = None,
    sessions: Sessions = None,
    against: Against = None,
    by: By = "tool,goal",
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw differences between conditions with their intervals.

    What `affcli compare` says, a row a cell: filled where significant after the correction.
    """
    with opened(database) as store:
        conditions = lab.conditions.conditions_named(store, experiment, sessions, 2)
        if len(conditions) > 1 + figures.compare.MOST_CONDITIONS:
            most = figures.compare.MOST_CONDITIONS
            raise UsageError(f"{most} conditions beside the first fit; name fewer with --session")
        result = lab.conditions.compared(store, conditions, against, by)
    return Figure(comparison_words(result), partial(figures.compare.compare_figure, result))


@figure
def curve(
    *,
    experiment: Experiment = None,
    sessions: Sessions = None,
    y: Annotated[
        str,
        typer.Option(
            "--y", help="solved, steps, seconds, error, rows or share.", metavar="MEASURE"
        ),
    ] = "solved",
    x: Annotated[
        str | None,
        typer.Option(
            "--x",
            help="minutes, rows or a setting; else the setting that differs.",
            metavar="AXIS",
        ),
    ] = None,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw a measure of conditions against robot time, rows or a swept setting.

    Of trials: solved ones; steps or robot seconds of a solved one; the error of a step, which is
    how far it left the puck from where its row said. Of learning: rows of a table, or the share of
    behaviors with an effect. Drawn is the mean of the robots with its 95 % interval. Rows and share
    are followed over minutes or rows; what is of trials is a mark for each condition there, joined
    along minutes with those whose names differ in minutes alone. Against a setting each condition
    is a point, joined with those that differ in nothing else.
    """
    with opened(database) as store:
        conditions = lab.conditions.conditions_named(store, experiment, sessions, 1)
        found = lab.courses.curves_of(store, conditions, y, x)
    figures.curve.require_few(found.lines)
    title = f"{found.y.capitalize()} against {found.x}"
    named = [one[:3] for one in conditions]
    words = conditions_words(title, named)
    if experiment is not None:
        words = experiment_words(title, experiment, named)
    return Figure(words, partial(figures.curve.curve_figure, found.lines, found.x, found.y))
