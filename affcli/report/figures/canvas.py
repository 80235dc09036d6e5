"""What all figures share: fonts, colours, sizes, and how one becomes a file's bytes."""

import io
import math
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont, get_font
from matplotlib.textpath import text_to_path
from matplotlib.transforms import Bbox
from matplotlib.typing import RcKeyType

from affcli.errors import BadInputError, one_line

ONE_COLUMN, TWO_COLUMNS = 3.5, 7.1
"""Widths of figures in a two-column journal (in)."""
DPI = 300
"""Pixels an inch of a PNG."""

BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY = (
    *("#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9"),
)
"""Colours that people with any kind of colour vision tell apart (Okabe and Ito, 2008)."""
INK, FAINT, PALE = "#222222", "#8c8c8c", "#e8e8e8"
WOOD = "#d9d2c5"
"""A tool under arrows: light enough that all of them stand out on it, also in grey."""

TITLE_SIZE, CAPTION_SIZE = 8.0, 6.5
"""Of the letters over and under a figure (points)."""
SMALL = 6.0
"""The smallest letters of any figure (points)."""
LINE = 1.25
"""From one line to the next, over the size of the letters."""
LONGEST_WORDS = 1_000
"""Letters of the longest caption that is shown."""
STRIP = 0.05
"""Around the lines over and under a figure (in)."""
FONT = "DejaVu Sans"
"""It comes with matplotlib: the same everywhere."""

STYLE: dict[RcKeyType, Any] = {
    "font.family": FONT,
    "font.size": 7.0,
    "axes.titlesize": 7.5,
    "axes.labelsize": 7.0,
    "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5,
    "legend.fontsize": 6.5,
    "figure.labelsize": 7.0,
    "figure.titlesize": 8.0,
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


def encoded(
    figure: Figure, ending: str, *, title: str = "", caption: str = "", dpi: int = DPI
) -> bytes:
    """Return a figure as the bytes of a file; the same figure gives the same bytes.

    Title and caption stand outside of what was laid out: they make the picture higher, and nothing
    in it smaller.

    Args:
        figure: what to write.
        ending: of the file's name: a key of `FORMATS`.
        title: stands over it; may be empty.
        caption: stands under it; may be empty.
        dpi: pixels an inch, where there are pixels.

    Raises:
        BadInputError: another ending.
    """
    kind = FORMATS.get(ending.lower())
    if kind is None:
        raise BadInputError(f"{ending or 'no ending'}: figures are {', '.join(FORMATS)}")
    page = io.BytesIO()
    with style():
        figure.set_dpi(dpi)
        lay_out(figure)
        figure.set_layout_engine("none")
        for key in figure.legends:
            # Below what is drawn, not below the caption.
            key.set_bbox_to_anchor((0.0, 0.0, 1.0, 1.0), figure.transFigure)
        width, height = map(float, figure.get_size_inches())
        over, under = _strip(title, TITLE_SIZE, width), _strip(caption, CAPTION_SIZE, width)
        place: dict[str, Any] = {"x": STRIP / width, "in_layout": False, "linespacing": LINE}
        figure.text(y=1.0 + STRIP / height, s=over[0], va="bottom", fontsize=TITLE_SIZE, **place)
        figure.text(y=-STRIP / height, s=under[0], va="top", fontsize=CAPTION_SIZE, **place)
        # Whole pixels, and a little more: Agg leaves out parts of one.
        across, up = round(width * dpi), math.ceil((over[1] + height + under[1]) * dpi)
        more = 0.01 if kind == "png" else 0.0
        box = Bbox.from_bounds(0.0, -under[1], (across + more) / dpi, (up + more) / dpi)
        figure.savefig(page, format=kind, dpi=dpi, bbox_inches=box, metadata=METADATA[kind])
    return page.getvalue()


def lay_out(figure: Figure) -> None:
    """Place what a figure is made of, as drawing it would; drawing takes as long again."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)


def _strip(words: str, size: float, width: float) -> tuple[str, float]:
    """Return words broken into lines for a strip as wide as a figure, and its height (in)."""
    lines = wrapped(drawable(words), size, width - 2 * STRIP)
    return lines, (lines.count("\n") + 1) * LINE * size / 72.0 + 2 * STRIP if words else 0.0


def drawable(words: str) -> str:
    """Return words as a figure can show them: of letters that its font has, in one line."""
    known = get_font(findfont(FONT)).get_charmap()
    letters = one_line(words, LONGEST_WORDS)
    return "".join(
        c if ord(c) in known else c.encode("ascii", "backslashreplace").decode() for c in letters
    )


@lru_cache(maxsize=1_000)
def width_of(words: str, size: float) -> float:
    """Return how wide a line of letters of a size is (in)."""
    font = FontProperties(family=FONT, size=size)
    return text_to_path.get_text_width_height_descent(words, font, ismath=False)[0] / 72.0


def wrapped(words: str, size: float, width: float) -> str:
    """Return words broken into lines that are at most so wide (in), between words if they can."""
    return "\n".join(_broken(line, size, width) for line in words.split("\n"))


def _broken(line: str, size: float, width: float) -> str:
    # Longer lines are too wide for certain: kerning takes less than half of a letter. Lines that
    # fit break alike whether more letters than this are allowed or not.
    narrowest = 0.5 * min((width_of(letter, size) for letter in set(line)), default=width)
    most = len(line) if narrowest * len(line) <= width else int(width / narrowest)
    for letters in range(most, 1, -1):
        parts = textwrap.wrap(line, letters)
        if all(width_of(part, size) <= width for part in parts):
            return "\n".join(parts)
    return line
