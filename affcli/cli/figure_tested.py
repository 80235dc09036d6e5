"""``affcli figure trial``, ``plan``, ``results``, ``adaptation``: figures of trials (§7)."""

from functools import partial
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.figure import Figure, figure
from affcli.cli.options import Database, check_count, checked_range
from affcli.errors import BadInputError, UsageError
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report import figures
from affcli.report.captions import Words, adaptation_words, joined, results_words
from affcli.report.film import MOST_NAMED, shown_of
from affcli.report.words import plan_words

Session = Annotated[
    int | None,
    typer.Option(
        "--session",
        help="Its id; the latest finished one if not given.",
        metavar="ID",
        parser=check_count("--session"),
    ),
]


@figure
def trial(
    number: Annotated[
        int,
        typer.Argument(
            help="A trial's id in the database.", metavar="ID", parser=check_count("trial")
        ),
    ],
    *,
    steps: Annotated[
        str | None,
        typer.Option("--steps", help=f"Only these, {MOST_NAMED} at most.", metavar="A-B"),
    ] = None,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw a trial as a film strip, as in Figures 10 and 11.

    Over each panel: the step, its behavior and the row tried; whether it replicated, and the row's
    counters afterwards (successes/uses). Of a trial of many steps some are chosen.
    """
    wanted = None if steps is None else checked_range("--steps", steps)
    if wanted is not None and wanted[1] - wanted[0] >= MOST_NAMED:
        raise BadInputError(
            f"--steps {steps}: at most {MOST_NAMED} steps fit a page; ask for fewer"
        )
    with opened(database) as store:
        film = lab.film_strips.film_of(store, number, wanted)
    shown = shown_of(film.steps, wanted)
    words = Words(film.title, joined(film.course, shown.note, film.caption))
    return Figure(words, partial(figures.trial.trial_figure, film, shown))


@figure
def plan(
    number: Annotated[
        int,
        typer.Argument(
            help="A trial's id in the database.", metavar="TRIAL", parser=check_count("TRIAL")
        ),
    ],
    step: Annotated[
        int,
        typer.Argument(help="One of its steps.", metavar="STEP", parser=check_count("STEP")),
    ],
    *,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw what a planner looked at in one step of a trial.

    The moves ahead as it expected them, the plans that came close, and where the step left the
    attractor. Only planners that look ahead tell plans.
    """
    with opened(database) as store:
        film = lab.film_strips.film_of(store, number, (step, step))
    shown = next(one for one in film.steps if one.number == step)
    said = plan_words(shown.reasons)
    if not said:
        raise UsageError(
            f"step {step} of trial {number} has no plan: its planner does not look ahead; solve "
            "with --planner lookahead"
        )
    words = Words(f"{film.title}, step {step}", joined(said[0], film.caption))
    return Figure(words, partial(figures.plan.plan_figure, film, shown))


@figure
def results(
    *,
    session: Session = None,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw our intervals with the paper's counts.

    For the 20 cells, for all trials, and for the broken tool.

    They are those of a finished reproduction; where there is none, those of affcli solve, with one
    robot for each tool.
    """
    with opened(database) as store:
        found = lab.results.results_in(store, session)
    note = ""
    if found.session is None:
        note = (
            "; there is no finished reproduction; for results of many robots run "
            "affcli reproduce --robots 20"
        )
    return Figure(results_words(found), partial(figures.results.results_figure, found), note)


@figure
def adaptation(
    *,
    session: Session = None,
    database: Database = DEFAULT_DATABASE,
) -> Figure:
    """Draw how robots adapt to a broken tool, step by step.

    It shows the share of tries on lost affordances, and the mean replication probability of the
    rows on the missing side, in a session of affcli break-tool or a reproduction.
    """
    with opened(database) as store:
        course = lab.adaptation.adaptation_in(store, session)
    draw = partial(figures.adaptation.adaptation_figure, course)
    return Figure(adaptation_words(course), draw)
