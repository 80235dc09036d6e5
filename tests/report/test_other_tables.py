"""JSON and Parquet of tables: the same values, read back by other programs."""

import io
import json
import math
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
from hypothesis import given
from hypothesis import strategies as st

from affcli.report.csv_table import Value
from affcli.report.json_table import json_lines
from affcli.report.parquet_table import ROWS_AT_ONCE, parquet_bytes

texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=6)
integers = st.integers(-(2**63), 2**63 - 1)
exact = st.integers(-(2**53) + 1, 2**53 - 1)
COLUMNS = [("whole", int), ("real", float), ("words", str)]
rows = st.lists(
    st.tuples(*(st.one_of(kind, st.none()) for kind in (integers, st.floats(), texts))), max_size=5
)


def read_parquet(data: bytes) -> pa.Table:
    """Return the table that a Parquet file holds."""
    return pq.read_table(io.BytesIO(data))


def same(a: Any, b: Any) -> bool:
    """Tell whether two values are the same; NaN is itself."""
    return type(a) is type(b) and (a == b or (isinstance(a, float) and math.isnan(a + b)))


@given(st.lists(st.lists(st.one_of(texts, exact, st.none()), min_size=2, max_size=2)))
def test_json_has_a_line_a_row_and_the_same_values(table: list[list[Value]]) -> None:
    text = "".join(json_lines(["a", "b"], table))
    assert json.loads(text) == [dict(zip("ab", row, strict=True)) for row in table]
    assert text.endswith("]\n")
    lines = text.splitlines()
    assert len(lines) == len(table) + 2 if table else lines == ["[]"]
    for line in lines[1:-1]:
        json.loads(line.removesuffix(","))


def test_json_knows_no_nan_and_no_bytes() -> None:
    (line,) = "".join(json_lines("abcd", [[math.nan, -math.inf, b"\x00\xff", 0.1]])).splitlines()[
        1:-1
    ]
    assert line == '{"a": null, "b": null, "c": "00ff", "d": 0.1}'


@given(rows)
def test_parquet_reads_back_to_the_same_values(table: list[tuple[Value, ...]]) -> None:
    found = read_parquet(parquet_bytes(COLUMNS, iter(table)))
    for (name, _), values in zip(COLUMNS, zip(*table, strict=True), strict=False):
        for value, wanted in zip(found[name].to_pylist(), values, strict=True):
            assert same(value, wanted)
    assert found.num_rows == len(table)


def test_the_types_do_not_depend_on_the_values() -> None:
    wanted = pa.schema([("whole", pa.int64()), ("real", pa.float64()), ("words", pa.string())])
    for table in ([], [(None, None, None)], [(1, 2.0, "x")]):
        assert read_parquet(parquet_bytes(COLUMNS, table)).schema == wanted


def test_more_rows_than_are_held_at_once_are_all_there() -> None:
    count = 2 * ROWS_AT_ONCE + 1
    data = parquet_bytes([("n", int)], ((n,) for n in range(count)))
    assert read_parquet(data)["n"].to_pylist() == list(range(count))
