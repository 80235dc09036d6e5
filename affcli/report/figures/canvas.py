"""What all figures share: fonts, colours, sizes, and how one becomes a file's bytes."""

import io
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.typing import RcKeyType

from affcli.errors import BadInputError

ONE_COLUMN, TWO_COLUMNS = 3.4, 7.1
"""Widths of figures in a two-column journal (in)."""

BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY = (
    *("#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9"),
)
"""Colours that people with any kind of colour vision tell apart (Okabe and Ito, 2008)."""
INK, FAINT, PALE = "#222222", "#8c8c8c", "#e8e8e8"
WOOD = "#d9d2c5"
"""A tool under arrows: light enough that all of them stand out on it, also in grey."""

HEAD_SIZE = 7.0
"""Of the letters over a figure (points)."""
LETTER = 0.58
"""How wide a letter is on average, over its size."""

STYLE: dict[RcKeyType, Any] = {
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same everywhere
    "font.size": 7.0,
    "axes.titlesize": 7.5,
    "axes.labelsize": 7.0,
    "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5,
    "legend.fontsize": 6.5,
    "axes.linewidth": 0.6,
    "axes.edgecolor": INK,
    "text.color": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "text.parse_math": False,  # a $ in a name is a $
    "lines.linewidth": 1.0,
    "hatch.linewidth": 0.5,
    "figure.constrained_layout.use": True,
    "figure.constrained_layout.w_pad": 0.03,
    "figure.constrained_layout.h_pad": 0.03,
    "savefig.dpi": 300,
    "figure.dpi": 100,
    "pdf.fonttype": 42,  # whole fonts in the file, as journals ask
    "svg.fonttype": "path",  # letters as shapes: nothing to be missing elsewhere
    "svg.hashsalt": "affcli",  # the same ids in every file
}

FORMATS = {".png": "png", ".svg": "svg", ".pdf": "pdf"}
"""By the ending of a file's name."""
METADATA: dict[str, dict[str, None]] = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
"""Nothing of when or with what: the same figure gives the same file."""
Drawing = Figure
"""What the figures return, for those who may not know Matplotlib."""


@contextmanager
def style() -> Iterator[None]:
    """Draw as affcli does inside the ``with`` block, whatever a ``matplotlibrc`` says."""
    # mpl.rcdefaults() would first read the styles in the person's home, which may be closed to us.
    settings: dict[Any, Any] = {**mpl.rcParamsDefault, **STYLE}
    del settings["backend"]
    with mpl.rc_context(settings):
        yield


@contextmanager
def canvas(width: float, height: float = 4.0) -> Iterator[Figure]:
    """Give an empty figure in affcli's style; draw on it inside the ``with`` block.

    Args:
        width, height: in inches; maps change the height (`affcli.report.figures.maps.fit_maps`).
    """
    with style():
        figure = Figure(figsize=(width, height))
        FigureCanvasAgg(figure)
        yield figure


def encoded(figure: Figure, ending: str) -> bytes:
    """Return a figure as the bytes of a file; the same figure gives the same bytes.

    Args:
        figure: what to write.
        ending: of the file's name: a key of `FORMATS`.

    Raises:
        BadInputError: another ending.
    """
    kind = FORMATS.get(ending.lower())
    if kind is None:
        raise BadInputError(f"{ending or 'no ending'}: figures are {', '.join(FORMATS)}")
    page = io.BytesIO()
    with style():
        figure.savefig(page, format=kind, metadata=METADATA[kind])
    return page.getvalue()


def head(figure: Figure, *lines: str) -> None:
    """Write lines over a figure, from its left edge; what is too long for one goes on below."""
    width = figure.get_figwidth()
    letters = int(72.0 * width / (LETTER * HEAD_SIZE))
    words = "\n".join(textwrap.fill(line, letters) for line in lines if line)
    figure.suptitle(words, x=0.03 / width, ha="left", fontsize=HEAD_SIZE)
