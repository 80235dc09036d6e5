"""The key of a figure: what stands for what, in as many columns as there is room for."""

from collections.abc import Sequence
from typing import Any, Literal

from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.legend_handler import HandlerPatch, HandlerTuple
from matplotlib.patches import Circle, Patch

from affcli.report.figures.arrows import ArrowKey, Look
from affcli.report.figures.canvas import width_of

HANDLE = 2.6
"""Length of what stands before a label, over the size of the letters."""
Place = Literal["outside lower center", "outside lower left", "outside upper center"]


def draw_key(
    figure: Figure,
    entries: Sequence[tuple[Any, str]],
    place: Place = "outside lower center",
    size: float = 6.5,
) -> Legend:
    """Explain below or above a figure what is drawn in it.

    Args:
        figure: which.
        entries: what is drawn, with its words: an artist, several, or the look of arrows.
        place: where; the figure makes room for it.
        size: of the letters (points).
    """
    longest = max(width_of(line, size) for _, words in entries for line in words.split("\n"))
    column = longest + (HANDLE + 2.5) * size / 72.0
    return figure.legend(
        [handle for handle, _ in entries],
        [words for _, words in entries],
        handler_map={
            Look: ArrowKey(),
            Circle: HandlerPatch(patch_func=_disc),
            tuple: HandlerTuple(ndivide=None),
        },
        loc=place,
        ncols=max(1, min(len(entries), int(figure.get_figwidth() / column))),
        handlelength=HANDLE,
        columnspacing=1.6,
        borderpad=0.2,
        fontsize=size,
    )


def _disc(
    *, xdescent: float, ydescent: float, width: float, height: float, **_: Legend | Artist | float
) -> Patch:
    """Return a disc in the middle of the place for a handle."""
    return Circle((0.5 * width - xdescent, 0.5 * height - ydescent), 0.55 * height)
