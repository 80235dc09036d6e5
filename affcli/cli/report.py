"""``affcli report``: what the database holds, beside the paper."""

import shlex
from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.files import require_new, save
from affcli.cli.options import LARGEST_ID, AsJson, Database, Force, check_count
from affcli.cli.terminal import progress, say, show_either
from affcli.core.limits import MOST_ROBOTS
from affcli.errors import BadInputError, UsageError, one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report import page
from affcli.report.overview import overview_json, overview_tables
from affcli.report.words import many

Html = Annotated[
    Path | None, typer.Option("--html", help="Write a page with replays, *.html.", metavar="FILE")
]
Robots = Annotated[
    list[int] | None,
    typer.Option(
        "--robot",
        help="Whose films: of a reproduction, from 0; several times for several.",
        metavar="N",
    ),
]
Runs = Annotated[
    list[int] | None,
    typer.Option(
        "--run",
        help="Whose films: of these learning runs; several times for several.",
        metavar="ID",
    ),
]
Session = Annotated[
    int | None,
    typer.Option(
        "--session", help="Which reproduction.", metavar="ID", parser=check_count("--session")
    ),
]


def report(
    *,
    html: Html = None,
    robot: Robots = None,
    run: Runs = None,
    session: Session = None,
    force: Force = False,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Show tools learned, rows by behavior, trials beside the paper's, and failures by kind.

    With --html as one page to look at and send on: the results beside the paper's, each tool with
    its arrows, and every trial of one robot to replay, with the reasons for each step; up to four
    robots more to choose from, whose films --robot or --run adds.
    """
    if html is None:
        if robot or run or session is not None:
            raise UsageError("--robot, --run and --session go with --html FILE")
        _on_terminal(database, as_json=as_json)
        return
    if as_json:
        raise UsageError("--html or --json: give one of them")
    if run and (robot or session is not None):
        raise UsageError("--run, or --robot and --session of a reproduction: not both")
    for option, numbers, first, last in (
        ("--robot", robot, 0, MOST_ROBOTS - 1),
        ("--run", run, 1, LARGEST_ID),
    ):
        for number in numbers or ():
            if not first <= number <= last:
                shown = one_line(number, 40)
                raise BadInputError(f"{option} {shown}: must lie in {first} to {last}")
    require_new(html, force=force, endings=(".html", ".htm"))
    _as_page(html, robot or [], run or [], session, database)


def _on_terminal(database: Path, *, as_json: bool) -> None:
    """Show what the database holds as tables or JSON."""
    with opened(database) as store:
        overview = lab.overview.overview_of(store)
    show_either(
        as_json=as_json,
        results=lambda: [overview_json(overview)],
        tables=lambda: overview_tables(overview),
    )


def _as_page(
    html: Path, robots: list[int], runs: list[int], session: int | None, database: Path
) -> None:
    """Write the page."""
    with opened(database) as store, progress("replaying", 1.0) as bar:
        content = lab.page.content_of(
            store,
            robots,
            session,
            lambda done, trials: bar(done / trials, f"{done} of {trials} trials"),
            runs,
        )
    # Names of files alone: the page may be sent to others.
    words = ["affcli", "report", "--db", database.name, "--html", html.name]
    words += [] if session is None else ["--session", str(session)]
    for option, numbers in (("--robot", robots), ("--run", runs)):
        words += [word for number in numbers for word in (option, str(number))]
    command = one_line(shlex.join(words), 1000)
    save(html, page.rendering.render(content, command).encode("utf-8", "backslashreplace"))
    differing = sum(bool(replay.differences) for replay in content.replays)
    say(f"{content.robot}, {many(len(content.replays), 'trial')} to replay: {one_line(html)}")
    for line in page.answers.left_out(content):
        say(line)
    if differing:
        say(f"{differing} replays DIFFER from their record; see: affcli replay --all")
