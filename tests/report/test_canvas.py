"""What all figures share: strips of words, and letters that can be read in every width."""

from textwrap import wrap

import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.text import Text

from affcli.analysis.paper import in_papers_order
from affcli.report.figures.canvas import SMALL, TITLE_SIZE, drawable, style, width_of, wrapped
from affcli.report.figures.words import broken_words, tool_words
from tests.report.drawn_figures import FIGURES, WIDTHS
from tests.report.reading import laid_out

FORMULA = 0.7
"""How large matplotlib writes an index, over its letters."""


@given(st.text("abi.T,V -(", max_size=60), st.floats(0.2, 4.0))
def test_words_are_broken_into_lines_that_fit_and_none_is_lost(words: str, width: float) -> None:
    """Of all ways the one of the longest lines."""

    def fits(lines: str) -> bool:
        return all(width_of(line, TITLE_SIZE) <= width for line in lines.split("\n"))

    lines = wrapped(words, TITLE_SIZE, width)
    ways = ("\n".join(wrap(words, letters)) for letters in range(len(words), 1, -1))
    assert lines == next(filter(fits, ways), words)
    assert "".join(lines.split()) == "".join(words.split())
    assert fits(lines)


def test_what_the_font_lacks_is_written_as_its_number() -> None:
    known = "T-hook, \N{GREEK SMALL LETTER BETA} = \N{VULGAR FRACTION ONE HALF}"
    assert drawable(known) == known
    assert drawable("机\n") == "\\u673a\\n"


def test_tools_have_one_name_in_figures_and_the_paper_s_order() -> None:
    assert [*map(tool_words, ("stick", "t-hook"))] == ["Stick", "T-hook"]
    assert broken_words("t-hook", "l-hook") == "T-hook that became L-hook"
    assert broken_words("rake", "rake") == "Rake"
    names = ["rake", "t-hook", "slide arm right", "hoe", "stick", "contract arm", "l-hook"]
    assert in_papers_order(names, str) == [
        *("stick", "l-hook", "t-hook", "slide arm right", "contract arm", "rake", "hoe")
    ]


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("name", FIGURES)
def test_in_a_column_and_in_two_all_can_be_read(name: str, width: float) -> None:
    """No letter is too small, none lies over another or off the page."""
    figure = FIGURES[name](width)
    assert figure.get_size_inches()[0] == pytest.approx(width)
    assert figure.get_size_inches()[1] < 9.2  # a page
    with style():
        figure.draw_without_rendering()
        shown: list[Text] = [text for text in laid_out(figure) if text.get_text().strip()]
        boxes = [(text, text.get_window_extent()) for text in shown]
    right, top = figure.bbox.max
    for text, box in boxes:
        size = float(text.get_fontsize()) * (FORMULA if text.get_parse_math() else 1.0)
        assert size >= SMALL, text
        assert min(box.x0, box.y0, right - box.x1, top - box.y1) > -1.0, text
    for number, (text, box) in enumerate(boxes):
        for other, there in boxes[:number]:
            inner = box.padded(-0.5)
            assert not inner.overlaps(there.padded(-0.5)), (text, other)


def test_a_default_width_is_a_column_s_or_two(figures: dict[str, Figure]) -> None:
    for name, figure in figures.items():
        assert figure.get_figwidth() in {3.5, 7.1}, name


@pytest.fixture
def figures() -> dict[str, Figure]:
    return {name: draw(None) for name, draw in FIGURES.items()}
