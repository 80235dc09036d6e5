"""``affcli cite``: how to cite the paper and this software."""

from pathlib import Path
from typing import Annotated

import typer

from affcli.cli.database import opened
from affcli.cli.options import waited_for
from affcli.cli.terminal import show_text
from affcli.core.records import LearningRunInfo, SessionInfo
from affcli.report.citation import bibtex


def cite(
    *,
    database: Annotated[
        Path | None,
        typer.Option(
            "--db",
            envvar="AFFCLI_DB",
            help="Say what the results in this SQLite file were made with.",
            metavar="FILE",
            readable=False,
            callback=waited_for,
        ),
    ] = None,
) -> None:
    """Say how to cite the paper and this software, in BibTeX.

    With a database the software's entry says which versions, in which world, its learning runs and
    trials were made with.
    """
    records: list[LearningRunInfo | SessionInfo] = []
    if database is not None:
        with opened(database) as store:
            records = [*store.learning.runs(), *store.sessions.all()]
    show_text(bibtex({**one.versions, "world": str(one.spec.world)} for one in records))
