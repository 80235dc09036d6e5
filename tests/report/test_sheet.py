"""A sheet fits any width and loses nothing."""

import io
import string
from collections import Counter

from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len
from rich.console import Console

from affcli.report.sheet import GAP, Sheet

WIDE = "机器人手"
letters = st.sampled_from(string.ascii_letters + string.digits + "[]/\\*_:,.-|" + WIDE)
words = st.text(letters, min_size=1, max_size=14)
cells = st.lists(words, max_size=6).map(" ".join)
titles = st.lists(words, max_size=8).map(" ".join)


@st.composite
def sheets(draw: st.DrawFn) -> Sheet:
    columns = tuple(draw(st.lists(words, min_size=1, max_size=8, unique=True)))
    left = draw(st.sets(st.sampled_from(columns)))
    wraps, records = draw(st.booleans()), draw(st.booleans())
    sheet = Sheet(columns, draw(titles), draw(titles), tuple(left), wraps, records)
    row = st.tuples(*[cells] * len(columns))
    for line in draw(st.lists(row, max_size=5)):
        sheet.add(*line)
    return sheet


def drawn(sheet: Sheet, width: int) -> list[str]:
    """Return the lines of a sheet on a screen of this width."""
    file = io.StringIO()
    Console(file=file, width=width, markup=False, highlight=False, emoji=False).print(sheet)
    return file.getvalue().splitlines()


def ink(text: str) -> Counter[str]:
    """Return the characters of a text that can be seen."""
    return Counter("".join(text.split()))


@given(sheets(), st.integers(20, 120))
def test_no_line_is_wider_than_the_screen(sheet: Sheet, width: int) -> None:
    assert max(map(cell_len, drawn(sheet, width)), default=0) <= width


@given(sheets(), st.integers(20, 120))
def test_nothing_is_lost(sheet: Sheet, width: int) -> None:
    """However narrow the screen, every character of every cell is there, and markup is text."""
    wanted = ink(sheet.title + sheet.caption)
    for row in sheet.rows:
        wanted += ink("".join(map(str, row)))
    assert wanted <= ink("".join(drawn(sheet, width)))


def test_columns_stand_side_by_side_while_they_fit() -> None:
    sheet = Sheet(("tool", "mean rows"), left=("tool",))
    sheet.add("t-hook", "97")
    assert drawn(sheet, 80) == ["tool    mean rows", "─────────────────", "t-hook         97"]


def test_headings_and_words_wrap_before_records_are_made() -> None:
    sheet = Sheet(("kind of end", "trials"), left=("kind of end",))
    sheet.add("attractor out of reach", "40")
    least = len("attractor") + GAP + len("trials")
    assert drawn(sheet, least) == [
        "kind of          ",
        "end        trials",
        "─────────────────",
        "attractor      40",
        "out of           ",
        "reach            ",
    ]
    assert [line.rstrip() for line in drawn(sheet, least - 1)] == [
        "kind of   attrac",
        "end       tor",
        "          out of",
        "          reach",
        "trials    40",
    ]


def test_numbers_never_wrap() -> None:
    sheet = Sheet(("clock", "rows"))
    sheet.add("1 h 00 min", "97")
    wide = len("1 h 00 min") + GAP + len("rows")
    assert drawn(sheet, wide)[-1] == "1 h 00 min    97"
    assert drawn(sheet, wide - 1)[0].split() == ["clock", "1", "h", "00"]


def test_without_wrapping_records_come_at_once() -> None:
    sheet = Sheet(("name", "value"), left=("name", "value"), wraps=False)
    sheet.add("a b", "c d e f")
    sheet.add("g", "h")
    assert len(drawn(sheet, 13)) == 2 + 2
    lines = [line.rstrip() for line in drawn(sheet, 12)]
    assert lines == ["name   a b", "value  c d e", "       f", "", "name   g", "value  h"]


def test_records_can_be_asked_for() -> None:
    sheet = Sheet(("name", "value"), records=True)
    sheet.add("a", "b")
    assert [line.rstrip() for line in drawn(sheet, 80)] == ["name   a", "value  b"]


def test_without_rows_there_are_headings() -> None:
    assert drawn(Sheet(("name", "value")), 80) == ["name  value", "───────────"]
