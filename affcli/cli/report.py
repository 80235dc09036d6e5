"""``affcli report``: what the database holds, beside the paper."""

import shlex
from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.files import require_new, save
from affcli.cli.options import DEFAULT_DATABASE, AsJson, Database, Force, check_count
from affcli.cli.terminal import progress, say, show_either
from affcli.core.limits import MOST_ROBOTS
from affcli.errors import BadInputError, UsageError, one_line
from affcli.report import page
from affcli.report.overview import overview_json, overview_tables

Html = Annotated[
    Path | None, typer.Option("--html", help="Write a page with replays, *.html.", metavar="FILE")
]
Robot = Annotated[
    int | None,
    typer.Option("--robot", help="Whose trials: of a reproduction, from 0.", metavar="N"),
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
    robot: Robot = None,
    session: Session = None,
    force: Force = False,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """Show tools learned, rows by behavior, trials beside the paper's, and failures by kind.

    With --html as one page to look at and send on: the results beside the paper's, each tool with
    its arrows, and every trial of one robot to replay, with the reasons for each step.
    """
    if html is None:
        if robot is not None or session is not None:
            raise UsageError("--robot and --session go with --html FILE")
        _on_terminal(database, as_json=as_json)
        return
    if as_json:
        raise UsageError("--html or --json: give one of them")
    if robot is not None and not 0 <= robot < MOST_ROBOTS:
        raise BadInputError(f"--robot {one_line(robot, 40)}: must lie in 0 to {MOST_ROBOTS - 1}")
    require_new(html, force=force, endings=(".html", ".htm"))
    _as_page(html, robot, session, database)


def _on_terminal(database: Path, *, as_json: bool) -> None:
    """Show what the database holds as tables or JSON."""
    with opened(database) as store:
        overview = lab.overview.overview_of(store)
    show_either(
        as_json=as_json,
        results=lambda: [overview_json(overview)],
        tables=lambda: overview_tables(overview),
    )


def _as_page(html: Path, robot: int | None, session: int | None, database: Path) -> None:
    """Write the page."""
    with opened(database) as store, progress("replaying", 1.0) as bar:
        content = lab.page.content_of(
            store,
            robot,
            session,
            lambda done, trials: bar(done / trials, f"{done} of {trials} trials"),
        )
    # Names of files alone: the page may be sent to others.
    words = ["affcli", "report", "--db", database.name, "--html", html.name]
    for option, number in (("--session", session), ("--robot", robot)):
        words += [] if number is None else [option, str(number)]
    command = one_line(shlex.join(words), 1000)
    save(html, page.rendering.render(content, command).encode("utf-8", "backslashreplace"))
    differing = sum(bool(replay.differences) for replay in content.replays)
    say(f"{content.robot}, {len(content.replays)} trials to replay: {one_line(html)}")
    for line in page.answers.left_out(content):
        say(line)
    if differing:
        say(f"{differing} replays DIFFER from their record; see: affcli replay --all")
