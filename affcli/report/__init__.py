"""What is shown: rich tables and plain numbers, returned to the caller; never printed here.

`parquet_table` is imported when it is first used: pyarrow need not be installed.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_modules

if TYPE_CHECKING:
    from affcli.report import parquet_table as parquet_table

__getattr__ = lazy_modules(__name__)
