"""``affcli table export``: rows and records for other programs, as CSV, JSON or Parquet."""

from collections.abc import Callable, Iterable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any

import typer

from affcli import lab, report
from affcli.cli.database import opened
from affcli.cli.files import require_new, save
from affcli.cli.options import Database, Force
from affcli.cli.table_choice import (
    AllRuns,
    Behavior,
    Limit,
    Probability,
    Region,
    Run,
    Tool,
)
from affcli.cli.terminal import say, show_text
from affcli.core.names import one_of
from affcli.core.row_filter import Column, Relation
from affcli.errors import BadInputError, UsageError, one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.csv_table import csv_lines
from affcli.report.json_table import json_lines

RELATIONS: tuple[Relation, ...] = ("rows", "behaviors", "trials", "steps")
STDOUT = Path("-")


def export(
    *,
    out: Annotated[
        Path, typer.Option("--out", help="The file; stdout if not given, or -.", metavar="FILE")
    ] = STDOUT,
    kind: Annotated[
        str | None,
        typer.Option(
            "--format", help="csv, json or parquet; else by the file's ending.", metavar="NAME"
        ),
    ] = None,
    what: Annotated[
        str, typer.Option("--what", help="rows, behaviors, trials or steps.", metavar="NAME")
    ] = "rows",
    tool: Tool = None,
    run: Run = None,
    all_runs: AllRuns = False,
    behavior: Behavior = None,
    probability: Probability = None,
    region: Region = None,
    limit: Limit = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
) -> None:
    """Write rows of the affordance tables for other programs.

    All columns of the view affordance_wide, and the region: the part of the tool that the attractor
    was nearest to. Or all columns of the tables behavior, trial or step, for the same runs.
    """
    relation = one_of("kind of record", what, RELATIONS)
    if relation != "rows" and (behavior, probability, region) != (None, None, None):
        raise UsageError(f"--behavior, --probability and --region choose rows: not --what {what}")
    if out != STDOUT:
        require_new(out, force=force, dash=True)
        if out.exists() and database.exists() and out.samefile(database):
            raise BadInputError(f"{one_line(out)}: the database itself; name another file")
    write = _checked_format(kind, out)

    with opened(database) as store:
        runs, wanted = lab.choosing.chosen_rows(
            store,
            tool=tool,
            run=run,
            all_runs=all_runs,
            behavior=behavior,
            probability=probability,
            region=region,
            limit=limit,
        )
        data, count = lab.table.taken_out(store, relation, runs, wanted, region, write)
    counted = f"{count or 'no'} {what if count != 1 else what[:-1]}"
    if out != STDOUT:
        save(out, data)
        say(f"{counted}: {one_line(out)}")
    else:
        show_text(data.decode())
        if not count:
            say(counted)


def _checked_format(kind: str | None, out: Path) -> "lab.table.Write[bytes]":
    """Return what writes the format that was named, or else that of the file's ending.

    Raises:
        UsageError: there is no such format, or it cannot be had; Parquet without a file.
        BadInputError: the ending names none.
    """
    if kind is None:
        kind = "csv" if out == STDOUT else out.suffix.lower().removeprefix(".")
        if kind not in FORMATS:
            wanted = " or ".join(f"*.{name}" for name in FORMATS)
            raise BadInputError(f"{one_line(out)}: name it {wanted}, or give --format")
    form = one_of("format", kind, list(FORMATS))
    if form == "parquet":
        if find_spec("pyarrow") is None:
            raise UsageError("Parquet needs pyarrow; install it: pip install 'affcli[parquet]'")
        if out == STDOUT:
            raise UsageError("Parquet is not text: give --out FILE.parquet")
    return FORMATS[form]


def _as_text(
    lines: Callable[[list[str], Iterable[Any]], Iterable[str]],
) -> "lab.table.Write[bytes]":
    """Return what writes lines in UTF-8."""
    return lambda columns, rows: b"".join(
        line.encode() for line in lines([column.name for column in columns], rows)
    )


def _parquet(columns: Sequence[Column], rows: Iterable[tuple[Any, ...]]) -> bytes:
    """Write Parquet."""
    return report.parquet_table.parquet_bytes(columns, rows)


FORMATS: "dict[str, lab.table.Write[bytes]]" = {
    "csv": _as_text(csv_lines),
    "json": _as_text(json_lines),
    "parquet": _parquet,
}
