"""``affcli figure trial``, ``results`` and ``adaptation``: figures of testing trials (§7)."""

from pathlib import Path
from typing import Annotated

import typer

from affcli.cli.files import require_new, save
from affcli.cli.options import DEFAULT_DATABASE, Database, Force, checked_count, checked_range
from affcli.cli.terminal import say
from affcli.errors import BadInputError, one_line
from affcli.report.film import MOST_NAMED

LARGEST_ID = 2**63 - 1
ENDINGS = (".png", ".svg", ".pdf")
Out = Annotated[Path, typer.Option("--out", help="*.png, *.svg or *.pdf.", metavar="FILE")]
Session = Annotated[
    int | None,
    typer.Option("--session", help="Its id; the latest finished one if not given.", metavar="ID"),
]


def trial(
    number: Annotated[int, typer.Argument(help="A trial's id in the database.", metavar="ID")],
    *,
    out: Out,
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
    checked_count("trial", number, LARGEST_ID)
    wanted = None if steps is None else checked_range("--steps", steps)
    if wanted is not None and wanted[1] - wanted[0] >= MOST_NAMED:
        raise BadInputError(
            f"--steps {steps}: at most {MOST_NAMED} steps fit a page; ask for fewer"
        )
    require_new(out, force=force, endings=ENDINGS)

    from affcli.lab.drawing import require_figures
    from affcli.lab.film_strips import film_of
    from affcli.report.film import shown_of
    from affcli.store import open_store

    require_figures()
    with open_store(database, create=False, write=False) as store:
        film = film_of(store, number, wanted)
    from affcli.report.figures.canvas import encoded
    from affcli.report.figures.trial import trial_figure

    shown = shown_of(film.steps, wanted)
    save(out, encoded(trial_figure(film, shown), out.suffix))
    left_out = f"; {shown.note}" if shown.note else ""
    say(f"{film.title}; {film.course}{left_out}: {one_line(out)}")


def results(
    *,
    out: Out,
    session: Session = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw our intervals with the paper's counts.

    Of the 20 cells, of all trials, and of the broken tool.

    Of a finished reproduction; where there is none, what affcli solve gave, one robot a tool.
    """
    checked_session(session)
    require_new(out, force=force, endings=ENDINGS)

    from affcli.lab.drawing import require_figures
    from affcli.lab.results import results_in
    from affcli.store import open_store

    require_figures()
    with open_store(database, create=False, write=False) as store:
        found = results_in(store, session)
    from affcli.report.figures.canvas import encoded
    from affcli.report.figures.results import results_figure
    from affcli.report.reproduction import ENOUGH_ROBOTS

    save(out, encoded(results_figure(found), out.suffix))
    if found.session is None:
        say(
            f"no finished reproduction, so results of {found.title}: {one_line(out)}; for those of "
            f"many robots run affcli reproduce --robots {ENOUGH_ROBOTS}"
        )
    else:
        note = f", {found.note}" if found.note else ""
        say(f"results, session {found.session}: {found.title}{note}: {one_line(out)}")


def adaptation(
    *,
    out: Out,
    session: Session = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Draw how robots adapt to a broken tool, step by step.

    The share of tries on lost affordances, and the mean replication probability of the rows on the
    missing side; of a session of affcli break-tool, or of a reproduction.
    """
    checked_session(session)
    require_new(out, force=force, endings=ENDINGS)

    from affcli.lab.adaptation import adaptation_in
    from affcli.lab.drawing import require_figures
    from affcli.store import open_store

    require_figures()
    with open_store(database, create=False, write=False) as store:
        course = adaptation_in(store, session)
    from affcli.report.figures.adaptation import adaptation_figure
    from affcli.report.figures.canvas import encoded

    save(out, encoded(adaptation_figure(course), out.suffix))
    note = f", {course.note}" if course.note else ""
    say(f"adaptation, session {course.session}: {course.title}{note}: {one_line(out)}")


def checked_session(session: int | None) -> None:
    """Refuse a number that no session has."""
    if session is not None:
        checked_count("--session", session, LARGEST_ID)
