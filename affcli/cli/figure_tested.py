"""``affcli figure trial``, ``results`` and ``adaptation``: figures of testing trials (§7)."""

from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.figure_learned import check_out, save_figure
from affcli.cli.files import save
from affcli.cli.options import (
    DEFAULT_DATABASE,
    Database,
    FigureOut,
    Force,
    check_count,
    checked_range,
)
from affcli.cli.terminal import say
from affcli.errors import BadInputError, one_line
from affcli.report import figures
from affcli.report.figure_titles import course_note, course_title, results_note, results_title
from affcli.report.film import MOST_NAMED, shown_of

Session = Annotated[
    int | None,
    typer.Option(
        "--session",
        help="Its id; the latest finished one if not given.",
        metavar="ID",
        callback=check_count("--session"),
    ),
]


def trial(
    number: Annotated[
        int,
        typer.Argument(
            help="A trial's id in the database.", metavar="ID", callback=check_count("trial")
        ),
    ],
    *,
    out: FigureOut,
    steps: Annotated[
        str | None,
        typer.Option("--steps", help=f"Only these, {MOST_NAMED} at most.", metavar="A-B"),
    ] = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw a trial as a film strip, as in Figures 10 and 11.

    Over each panel: the step, its behavior and the row tried; whether it replicated, and the row's
    counters afterwards (successes/uses). Of a trial of many steps some are chosen.
    """
    wanted = None if steps is None else checked_range("--steps", steps)
    if wanted is not None and wanted[1] - wanted[0] >= MOST_NAMED:
        raise BadInputError(
            f"--steps {steps}: at most {MOST_NAMED} steps fit a page; ask for fewer"
        )
    check_out(out, force=force)
    with opened(database) as store:
        film = lab.film_strips.film_of(store, number, wanted)
    shown = shown_of(film.steps, wanted)
    left_out = f"; {shown.note}" if shown.note else ""
    figure = figures.trial.trial_figure(film, shown)
    save_figure(out, figure, f"{film.title}; {film.course}{left_out}")


def results(
    *,
    out: FigureOut,
    session: Session = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw our intervals with the paper's counts.

    For the 20 cells, for all trials, and for the broken tool.

    They are those of a finished reproduction; where there is none, those of affcli solve, with one
    robot for each tool.
    """
    check_out(out, force=force)
    with opened(database) as store:
        found = lab.results.results_in(store, session)
    save(out, figures.canvas.encoded(figures.results.results_figure(found), out.suffix))
    title = results_title(found)
    if found.session is None:
        say(
            f"no finished reproduction, so results of {title}: {one_line(out)}; for those of many "
            f"robots run affcli reproduce --robots 20"
        )
    else:
        words = ", ".join(filter(None, (title, results_note(found))))
        say(f"results, session {found.session.id}: {words}: {one_line(out)}")


def adaptation(
    *,
    out: FigureOut,
    session: Session = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw how robots adapt to a broken tool, step by step.

    It shows the share of tries on lost affordances, and the mean replication probability of the
    rows on the missing side, in a session of affcli break-tool or a reproduction.
    """
    check_out(out, force=force)
    with opened(database) as store:
        course = lab.adaptation.adaptation_in(store, session)
    words = ", ".join(filter(None, (course_title(course), course_note(course))))
    figure = figures.adaptation.adaptation_figure(course)
    save_figure(out, figure, f"adaptation, session {course.session.id}: {words}")
