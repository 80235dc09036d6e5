"""``affcli db``: the database file itself."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from affcli import store
from affcli.cli.files import require_new
from affcli.cli.options import AsJson, Database, Force
from affcli.cli.terminal import progress, say, show_json, show_rows
from affcli.errors import DatabaseError, one_line
from affcli.lab.clock import now
from affcli.lab.suggesting import DEFAULT_DATABASE


def upgrade(*, database: Database = DEFAULT_DATABASE) -> None:
    """Bring the schema of an older database up to date.

    It is upgraded whole or not at all; a copy of it as it was is made first.
    """
    store.upgrade(
        database, copied=lambda copy: say(f"a copy of it as it was: {one_line(copy, 1000)}")
    )
    say(f"{one_line(database, 1000)} is up to date")


def backup(
    *,
    database: Database = DEFAULT_DATABASE,
    out: Annotated[
        Path | None, typer.Option("--out", help="The copy; beside it if not given.", metavar="FILE")
    ] = None,
    force: Force = False,
) -> None:
    """Write a checked copy of the database.

    The copy is of one moment; others may go on reading and writing.
    """
    copy = database.with_name(f"{database.name}.backup") if out is None else out
    require_new(copy, force=force)
    store.backup(database, copy)
    say(f"a copy of {one_line(database, 1000)}: {one_line(copy, 1000)}")


def merge(
    *,
    files: Annotated[
        list[Path], typer.Argument(help="The databases.", metavar="FILE...", readable=False)
    ],
    into: Annotated[
        Path,
        typer.Option("--into", help="Where to; made if it is not there.", metavar="FILE"),
    ],
) -> None:
    """Bring robots of the same experiments together from several databases.

    Robots of experiments and reproductions are merged, each once; the same again changes nothing.
    Databases that contradict each other are refused, and nothing is changed.
    """
    store.tell_of_waiting(say)
    with progress("merging", 1.0) as bar:
        merged = store.merge(
            files,
            into,
            now(),
            lambda done, of: bar(done / of, f"{done} of {of} robots"),
        )
    there = f", {merged.there} were there already" if merged.there else ""
    say(f"{merged.new} robots merged into {one_line(into, 1000)}{there}")
    for what, count in merged.left_out.items():
        say(f"left out, for only whole experiments are merged: {count} {what}")


def check(*, database: Database = DEFAULT_DATABASE, as_json: AsJson = False) -> int:
    """Check that everything in the database is as it must be.

    That is pages, references, sums, and the counters beside the steps that changed them. Exit code
    3 when something is not. What was interrupted, or is still going on, is named.
    """
    findings = store.check(database)
    wrong = [finding for finding in findings if finding.wrong]
    if as_json:
        show_json([asdict(finding) for finding in findings])
    else:
        rows = [(one.what, _in_words(one), one_line(one.example)) for one in findings]
        show_rows(("what must hold", "does", "for example"), rows, left=("what must hold",))
    if wrong:
        say(f"{one_line(database, 1000)}: not as it must be; restore a copy of the file")
    return DatabaseError.exit_code if wrong else 0


def _in_words(finding: "store.Finding") -> str:
    """Say whether something holds."""
    if finding.wrong:
        return f"{finding.wrong} times not"
    return f"{finding.unfinished} not yet" if finding.unfinished else "yes"


def info(*, database: Database = DEFAULT_DATABASE, as_json: AsJson = False) -> None:
    """Show schema revision, size, journal mode, and how many rows each table has."""
    found = asdict(store.database_info(database))
    facts = {**found, "path": str(database)}
    if as_json:
        show_json([facts])
        return
    counts: dict[str, int] = facts.pop("counts")
    names = (*(name.replace("_", " ") for name in facts), *counts)
    values = [one_line(value) for value in (*facts.values(), *counts.values())]
    show_rows(names, [values], records=True)
