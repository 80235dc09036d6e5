"""What every figure has on the command line: where to, how wide, what stands over and under it.

A figure is a function under `@figure` that returns what to draw, and a line in
`affcli.cli.commands`: its own options are the function's, those below it gets.
"""

import inspect
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from affcli.cli.files import require_new, save
from affcli.cli.options import FIGURE_ENDINGS, Force
from affcli.cli.terminal import say
from affcli.errors import BadInputError, one_line
from affcli.lab.drawing import require_figures
from affcli.report import figures
from affcli.report.captions import Words

if TYPE_CHECKING:
    from affcli.report.figures.canvas import Drawing

NARROWEST, WIDEST = 3.0, 15.0
"""Widths of figures (in): narrower than any journal's column, as wide as a poster's."""
COARSEST, FINEST = 50, 600
"""Pixels an inch of a PNG."""
LONGEST_TITLE = 200
"""Letters of a title."""
MOST_SAID = 800
"""Letters of what is said of a figure on the terminal."""


class Figure(NamedTuple):
    """A figure that a command draws.

    Args:
        words: its title and its caption.
        draw: draws it as wide as asked (in), or as suits it.
        note: said on the terminal alone; may be empty.
    """

    words: Words
    draw: "Callable[[float | None], Drawing]"
    note: str = ""


def _within(option: str, low: float, high: float) -> Callable[[Any], Any]:
    """Return a check for an option that is a number, which nan is not."""

    def checked(value: float | None) -> float | None:
        if value is not None and not low <= value <= high:
            shown = one_line(value, 40)
            raise BadInputError(f"{option} {shown}: must lie in {low:g} to {high:g}")
        return value

    return checked


def _checked_title(title: str | None) -> str | None:
    if title is not None and len(title) > LONGEST_TITLE:
        raise BadInputError(f"--title of {len(title)} letters: at most {LONGEST_TITLE} fit")
    return title


def _page(
    *,
    out: Annotated[
        Path, typer.Option("--out", help="The figure: *.png, *.svg or *.pdf.", metavar="FILE")
    ],
    width: Annotated[
        float | None,
        typer.Option(
            "--width",
            help="Inches: 3.5 for a column, 7 for two.",
            metavar="INCHES",
            callback=_within("--width", NARROWEST, WIDEST),
        ),
    ] = None,
    dpi: Annotated[
        int,
        typer.Option(
            "--dpi",
            help="Pixels an inch of a PNG.",
            metavar="N",
            callback=_within("--dpi", COARSEST, FINEST),
        ),
    ] = 300,
    title: Annotated[
        str | None,
        typer.Option(
            "--title",
            help='In place of its own title; "" for none.',
            metavar="TEXT",
            callback=_checked_title,
        ),
    ] = None,
    no_caption: Annotated[
        bool,
        typer.Option("--no-caption", help="Without the line that says of what it is."),
    ] = False,
    force: Force = False,
) -> None:
    """Say which options every figure has."""


def figure(draws: Callable[..., Figure]) -> Callable[..., None]:
    """Make a command of a function that says what to draw: with the options that all figures have.

    Whether the file can be written is looked at before any work.
    """
    own, shared = (inspect.signature(f, eval_str=True).parameters for f in (draws, _page))

    @wraps(draws)
    def command(
        *,
        out: Path,
        width: float | None,
        dpi: int,
        title: str | None,
        no_caption: bool,
        force: bool,
        **given: Any,
    ) -> None:
        require_new(out, force=force, endings=FIGURE_ENDINGS)
        require_figures()
        asked = draws(**given)
        over, under = asked.words
        save(
            out,
            figures.canvas.encoded(
                asked.draw(width),
                out.suffix,
                title=over if title is None else title,
                caption="" if no_caption else under,
                dpi=dpi,
            ),
        )
        said = one_line(f"{over}; {under}", MOST_SAID)
        say(f"{said}: {one_line(out)}{asked.note}")

    options = {**own, **shared}
    command.__annotations__ = {name: one.annotation for name, one in options.items()}
    # Typer reads it for the options.
    setattr(command, "__signature__", inspect.Signature([*options.values()]))  # noqa: B010
    return command
