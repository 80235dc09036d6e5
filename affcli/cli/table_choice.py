"""Which rows of the affordance tables a command is about: its options, and their checks."""

from typing import Annotated

import typer

from affcli.cli.options import check_count

Tool = Annotated[
    str | None,
    typer.Option(
        "--tool",
        help="Rows of this tool alone.",
        metavar="NAME",
    ),
]
Run = Annotated[
    int | None,
    typer.Option(
        "--run",
        help="Of this learning run, not the latest ones.",
        metavar="ID",
        parser=check_count("--run"),
    ),
]
AllRuns = Annotated[
    bool,
    typer.Option("--all-runs", help="Of every run, also of reproductions and unfinished ones."),
]
Behavior = Annotated[
    str | None,
    typer.Option("--behavior", help='"extend arm", or "extend arm 5".', metavar="NAME"),
]
Probability = Annotated[
    str | None,
    typer.Option(
        "--probability", help='Of replication: "<=0.5", ">0.5", "0.2..0.8".', metavar="RANGE"
    ),
]
Region = Annotated[
    str | None,
    typer.Option(
        "--region",
        help='The part of the tool nearest the attractor: "right hook".',
        metavar="PART",
    ),
]
Limit = Annotated[
    int | None,
    typer.Option(
        "--limit",
        help="No more than so many, the oldest.",
        metavar="N",
        parser=check_count("--limit"),
    ),
]
