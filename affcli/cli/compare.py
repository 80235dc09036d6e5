"""``affcli compare``: did it matter? Conditions compared robot by robot."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.files import require_new, save
from affcli.cli.options import LARGEST_ID, AsJson, Database, Force, checked_count
from affcli.cli.terminal import say, show_either, show_text
from affcli.core.names import one_of
from affcli.errors import BadInputError, UsageError, one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.csv_table import csv_text
from affcli.report.paired import COLUMNS, comparison_json, comparison_rows, comparison_tables
from affcli.report.text_tables import latex, markdown

if TYPE_CHECKING:
    from collections.abc import Callable

    from affcli.analysis.paired import Comparison


def checked_by(text: str) -> list[str]:
    """Return what trials are told apart by, each once; UsageError for what does not tell."""
    known = list(lab.conditions.BY)
    return list(
        dict.fromkeys(one_of("way to tell trials apart", n, known) for n in text.split(","))
    )


def checked_sessions(numbers: list[int] | None) -> list[int]:
    """Return the ids of sessions; BadInputError when one is none that a database has."""
    return [checked_count("--session", number, LARGEST_ID) for number in numbers or ()]


By = Annotated[
    str,
    typer.Option(
        "--by",
        help="tool, goal, start, task, protocol, or several.",
        metavar="NAMES",
        callback=checked_by,
    ),
]
Experiment = Annotated[
    str | None,
    typer.Argument(help="Its conditions; else of each --session.", metavar="EXPERIMENT"),
]
Sessions = Annotated[
    list[int] | None,
    typer.Option(
        "--session",
        help="A reproduction; give it once for each.",
        metavar="ID",
        callback=checked_sessions,
    ),
]
Against = Annotated[
    str | None,
    typer.Option("--against", help="A condition; the first if not given.", metavar="NAME"),
]


def compare(
    *,
    experiment: Experiment = None,
    sessions: Sessions = None,
    against: Against = None,
    by: By = "tool,goal",
    kind: Annotated[
        str | None,
        typer.Option(
            "--format",
            help="markdown, latex or csv; else by the file's ending.",
            metavar="NAME",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="A file: *.md, *.tex or *.csv.", metavar="FILE"),
    ] = None,
    database: Database = DEFAULT_DATABASE,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Compare conditions robot by robot: did it matter?

    A robot is paired with the one of the same seed and number. Each difference has the exact
    sign-flip test of its pairs, which holds for any number of robots; p is corrected by Holm's
    method for all that stands in one table. The mean difference has Student's 95 % interval, from
    five robots on and where enough of them differ. Robots better and worse are counts; the share
    of the better among them has the exact interval (in CSV and JSON). Cells in which all robots
    agree stand apart. How often this was right when measured: affcli/analysis/README.md.
    """
    form = _checked_format(kind, out)
    if as_json and form:
        raise UsageError("--json writes to stdout: leave out --format and --out")
    if out is not None:
        require_new(out, force=force)
    with opened(database) as store:
        result = lab.conditions.compared(
            store, lab.conditions.conditions_named(store, experiment, sessions, 2), against, by
        )
    if form is None:
        show_either(
            as_json=as_json,
            results=lambda: [comparison_json(result)],
            tables=lambda: comparison_tables(result),
        )
    elif out is None:
        show_text(FORMATS[form](result))
    else:
        save(out, FORMATS[form](result).encode())
        count = len(result.totals) + len(result.cells)
        say(f"{count} differences, {len(result.same)} cells without: {one_line(out)}")


def _checked_format(kind: str | None, out: Path | None) -> str | None:
    """Return the format asked for, by name or by a file's ending; None for the terminal's."""
    if kind is not None:
        return one_of("format", kind, list(FORMATS))
    if out is None:
        return None
    if out.suffix.lower() not in ENDINGS:
        raise BadInputError(
            f"{one_line(out)}: name it {' or '.join(f'*{e}' for e in ENDINGS)}, or give --format"
        )
    return ENDINGS[out.suffix.lower()]


FORMATS: "dict[str, Callable[[Comparison], str]]" = {
    "markdown": lambda result: markdown(comparison_tables(result)),
    "latex": lambda result: latex(comparison_tables(result)),
    "csv": lambda result: csv_text(COLUMNS, comparison_rows(result)),
}
ENDINGS = {".md": "markdown", ".tex": "latex", ".csv": "csv"}
