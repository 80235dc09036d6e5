"""What is shown: rich tables and plain numbers, returned to the caller; never printed here.

`parquet_bytes` is imported when it is first used: pyarrow need not be installed.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_names

if TYPE_CHECKING:
    from affcli.report.parquet_table import parquet_bytes

__all__ = ["parquet_bytes"]

__getattr__ = lazy_names(__name__, {"parquet_bytes": "parquet_table"})
