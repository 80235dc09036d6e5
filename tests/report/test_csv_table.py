"""CSV that reads back as it was (RFC 4180) and that no spreadsheet executes (fault 32)."""

import csv
import io
import math
import re
import string
import struct
from collections.abc import Iterator, Sequence

import pyarrow.csv
import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.report.csv_table import Value, csv_text

SIGNS = "=+-@\t\r\n\uff1d\uff0b\uff0d\uff20"
"""What a formula begins with; and how else a cell of text may not begin."""
awkward = st.text(
    st.sampled_from(
        SIGNS + ",;|'\"\x00\x1b\x85\u2028\ufeff \u3000" + string.ascii_letters + "é机7"
    ),
    max_size=8,
)
texts = st.one_of(awkward, st.text(st.characters(exclude_categories=["Cs"]), max_size=8))
numbers = st.one_of(st.integers(-(2**63), 2**63 - 1), st.floats())
values = st.one_of(texts, numbers, st.none(), st.binary(max_size=6))
Table = tuple[list[str], list[list[Value]]]
"""Headings and rows."""


@st.composite
def tables(draw: st.DrawFn) -> Table:
    """Return headings and rows."""
    columns = draw(st.lists(texts, min_size=1, max_size=4))
    row = st.lists(values, min_size=len(columns), max_size=len(columns))
    return columns, draw(st.lists(row, max_size=4))


def read(text: str, delimiter: str = ",") -> list[list[str]]:
    """Return the cells as Python's reader finds them; it is strict about quotes."""
    return list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True))


def as_written(value: Value) -> str:
    """Return what must stand in the cell, but for an apostrophe."""
    match value:
        case None:
            return ""
        case bytes():
            return value.hex()
        case str():
            return value
        case _:
            return repr(value)


def beside(table: Table) -> Iterator[tuple[str, Value]]:
    """Yield each cell of a table as it reads back, and the value it was."""
    columns, rows = table
    source: list[Sequence[Value]] = [columns, *rows]
    for cells, values in zip(read(csv_text(columns, rows)), source, strict=True):
        yield from zip(cells, values, strict=True)


def executed(cell: str) -> bool:
    """Tell whether a spreadsheet takes a cell of text for a formula, or drops how it begins."""
    begins = re.sub(r"^[\s\x00-\x1f\x7f-\x9f\ufeff]+", "", cell)
    return cell[:1] in tuple("\t\r\n") or begins[:1] in tuple(SIGNS)


@given(tables())
def test_it_reads_back_to_the_same_cells_but_for_the_apostrophes(table: Table) -> None:
    for cell, value in beside(table):
        wanted = as_written(value)
        assert cell == wanted or (isinstance(value, str) and cell == f"'{wanted}")


@pytest.mark.fault(32)
@given(tables())
def test_an_apostrophe_stands_where_text_would_be_executed_and_nowhere_else(table: Table) -> None:
    for cell, value in beside(table):
        if isinstance(value, str):
            assert not executed(cell)
            assert (cell != value) == executed(value)


def split_as_a_spreadsheet(text: str) -> list[str]:
    """Return the cells of a reader that splits at commas, semicolons, tabs and bars alike.

    As LibreOffice may: a quote opens a cell only where the cell begins.
    """
    cell = r'"(?:[^"]|"")*"|[^,;\t|\r\n]*'
    found = re.findall(rf"({cell})(?:[,;\t|]|\r\n)", text)
    return [one[1:-1].replace('""', '"') if one.startswith('"') else one for one in found]


@pytest.mark.fault(32)
@given(tables())
def test_no_cell_begins_in_the_middle_of_another(table: Table) -> None:
    """Whatever the reader takes for a delimiter, and for the end of a line."""
    columns, rows = table
    cells = split_as_a_spreadsheet(csv_text(columns, rows))
    source = [*columns, *(value for row in rows for value in row)]
    assert len(cells) == len(source)
    assert not any(
        executed(cell)
        for cell, value in zip(cells, source, strict=True)
        if not isinstance(value, int | float)
    )


def bits(value: float) -> bytes:
    """Return a number to the bit; every NaN is one."""
    return b"NaN" if math.isnan(value) else struct.pack("d", value)


@pytest.mark.fault(32)
@given(st.lists(st.tuples(st.floats(), st.integers(-(2**63), 2**63 - 1)), min_size=1, max_size=5))
def test_numbers_read_back_to_the_bit(rows: list[tuple[float, int]]) -> None:
    """Negative ones too: they are left alone. By Python, and by a reader like that of pandas."""
    text = csv_text(["real", "whole"], rows)
    found = [(float(real), int(whole)) for real, whole in read(text)[1:]]
    assert [(bits(r), w) for r, w in found] == [(bits(r), w) for r, w in rows]
    kinds = {"real": pyarrow.float64(), "whole": pyarrow.int64()}
    options = pyarrow.csv.ConvertOptions(column_types=kinds, null_values=[""])
    table = pyarrow.csv.read_csv(io.BytesIO(text.encode()), convert_options=options)
    assert list(map(bits, table["real"].to_pylist())) == [bits(real) for real, _ in rows]
    assert table["whole"].to_pylist() == [whole for _, whole in rows]


CELLS: dict[str, tuple[Value, str]] = {
    "a formula": ("=1+1", '"\'=1+1"'),
    "a command": ("=cmd|' /C calc'!A0", "\"'=cmd|' /C calc'!A0\""),
    "plus": ("+1", '"\'+1"'),
    "minus in text": ("-1", '"\'-1"'),
    "at": ("@SUM(A1)", '"\'@SUM(A1)"'),
    "tab": ("\t=1", '"\'\t=1"'),
    "carriage return": ("\r=1", '"\'\r=1"'),
    "tab before a letter": ("\tx", '"\'\tx"'),
    "line feed before a letter": ("\nx", '"\'\nx"'),
    "behind blanks": ("  =1", '"\'  =1"'),
    "double width": ("\uff1d1", '"\'\uff1d1"'),
    "after a delimiter": ("a,=1", '"a,=1"'),
    "after another delimiter": ("a;=1", '"a;=1"'),
    "another delimiter": ("a;b", '"a;b"'),
    "after a line's end": ("a\r\n=1", '"a\r\n=1"'),
    "after a quote": ('a"=1', '"a""=1"'),
    "an apostrophe": ("'=1", '"\'=1"'),
    "a sign within": ("a=1", '"a=1"'),
    "plain words": ("slide arm left", "slide arm left"),
    "a plain name": ("t-hook", "t-hook"),
    "parameters": ('{"offset_distance": 5.0}', '"{""offset_distance"": 5.0}"'),
    "blanks around": (" a ", '" a "'),
    "no text": ("", '""'),
    "NULL": (None, ""),
    "a negative number": (-5, "-5"),
    "a negative real number": (-0.1, "-0.1"),
    "a whole real number": (5.0, "5.0"),
    "infinity": (-math.inf, "-inf"),
    "bytes": (b"\x00\xff=", "00ff3d"),
}


@pytest.mark.parametrize(("value", "cell"), CELLS.values(), ids=CELLS.keys())
def test_a_cell(value: Value, cell: str) -> None:
    assert csv_text(["a", "b"], [[1, value]]) == f"a,b\r\n1,{cell}\r\n"


def test_a_row_of_a_single_null_is_a_line_that_readers_see() -> None:
    text = csv_text(["a"], [[None], [""], [1]])
    assert text == 'a\r\n""\r\n""\r\n1\r\n'
    assert read(text) == [["a"], [""], [""], ["1"]]


def test_headings_are_text_like_any_other() -> None:
    columns: Sequence[str] = ("=1", "a,b")
    assert csv_text(columns, []) == '"\'=1","a,b"\r\n'
