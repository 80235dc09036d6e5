"""Tables as Parquet for other programs: typed columns."""

import io
from collections.abc import Iterable, Sequence
from itertools import islice

import pyarrow as pa
import pyarrow.parquet as pq

from affcli.report.csv_table import Value

TYPES = {int: pa.int64(), float: pa.float64(), str: pa.string()}
ROWS_AT_ONCE = 20_000
"""More than this many rows are not held as Python values; they also become one row group."""


def parquet_bytes(columns: Sequence[tuple[str, type]], rows: Iterable[Sequence[Value]]) -> bytes:
    """Return a table as a Parquet file.

    The types of the columns do not depend on what is in them, so the files of several databases go
    together.

    Args:
        columns: the names, each with its kind: int, float or str. NULL is allowed in all.
        rows: as many values in each, of these kinds.
    """
    schema = pa.schema([(name, TYPES[kind]) for name, kind in columns])
    page = io.BytesIO()
    rest = iter(rows)
    with pq.ParquetWriter(page, schema) as writer:
        while chunk := list(islice(rest, ROWS_AT_ONCE)):
            arrays = [
                pa.array(values, TYPES[kind])
                for (_, kind), values in zip(columns, zip(*chunk, strict=True), strict=True)
            ]
            writer.write_table(pa.Table.from_arrays(arrays, schema=schema))
    return page.getvalue()
