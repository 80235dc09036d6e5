"""``affcli cite``: how to cite the paper and this software."""

from pathlib import Path
from typing import Annotated

import typer

from affcli.cli.database import opened
from affcli.cli.options import waited_for
from affcli.cli.terminal import show_text
from affcli.core.log import LogSource
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
    trials were made with; and each log that was imported has an entry.
    """
    records: list[LearningRunInfo | SessionInfo] = []
    logs: list[LogSource] = []
    if database is not None:
        with opened(database) as store:
            runs = store.learning.runs()
            records = [*runs, *store.sessions.all()]
            found = (store.logs.source(run.id) for run in runs if run.spec.logged)
            logs = [log for log in found if log is not None]
    made = ({**one.versions, "world": _world(one)} for one in records)
    show_text(bibtex(made, logs))


def _world(one: LearningRunInfo | SessionInfo) -> str:
    """Return the world of a record: of a log without what tells it from others."""
    return one.spec.world.name if one.spec.logged else str(one.spec.world)
