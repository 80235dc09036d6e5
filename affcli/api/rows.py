"""Rows of a database in Python: as tuples, NumPy structured arrays, pandas or Polars frames."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from affcli.core.names import one_of
from affcli.core.row_filter import Cell, Column
from affcli.errors import UsageError

Row = tuple[Cell, ...]

SOME = 8
"""So many columns are named where rows are shown in a line."""


@dataclass(frozen=True, slots=True, repr=False)
class Rows(Sequence[Row]):
    """Rows as they stand in the database: a sequence of tuples, with the columns by name.

    A number that is not known, as in a row of a log, is None in a tuple, NaN in an array.

    Args:
        columns: their names, each with the kind of its values: int, float or str.
        values: the rows.
        cut: there are more rows than were asked for, or than fit.
    """

    columns: tuple[Column, ...]
    values: tuple[Row, ...]
    cut: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the columns."""
        return tuple(column.name for column in self.columns)

    def __len__(self) -> int:
        return len(self.values)

    @overload
    def __getitem__(self, place: int) -> Row: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[Row]: ...
    def __getitem__(self, place: int | slice) -> Row | Sequence[Row]:
        """Return a row, or some, as tuples."""
        return self.values[place]

    def __iter__(self) -> Iterator[Row]:
        return iter(self.values)

    def __repr__(self) -> str:
        """Say how many rows there are, of which columns."""
        more = " and more" if self.cut else ""
        others = f", ... {len(self.names) - SOME} more" if len(self.names) > SOME else ""
        return f"<Rows: {len(self)}{more}, of {', '.join(self.names[:SOME])}{others}>"

    def column(self, name: str) -> NDArray[Any]:
        """Return one column (n,): int64; float64, NaN where nothing is known; else text.

        Text is as long as the longest, and empty where there is none.

        Raises:
            UsageError: there is no such column; the message has the nearest names.
        """
        place = self.names.index(one_of("column", name, self.names))
        values = [row[place] for row in self.values]
        kind = self.columns[place].kind
        if kind is str:
            texts = ["" if value is None else str(value) for value in values]
            return np.array(texts, dtype=np.str_)
        if kind is int and None not in values:
            return np.array(values, dtype=np.int64)
        return np.array([np.nan if value is None else value for value in values], dtype=np.float64)

    def array(self) -> NDArray[Any]:
        """Return a NumPy structured array (n,), whose fields are the columns as `column` has them.

        Example:
            ``rows.array()["movement"].mean()``
        """
        columns = [self.column(name) for name in self.names]
        kinds = [(n, column.dtype) for n, column in zip(self.names, columns, strict=True)]
        made = np.empty(len(self), dtype=kinds)
        for name, column in zip(self.names, columns, strict=True):
            made[name] = column
        return made

    def dicts(self) -> list[dict[str, Cell]]:
        """Return each row as a dictionary."""
        return [dict(zip(self.names, row, strict=True)) for row in self.values]

    def pandas(self) -> Any:
        """Return a ``pandas.DataFrame``; missing numbers are NaN, missing text is None.

        Raises:
            UsageError: pandas is not installed.
        """
        frame = _frames("pandas").DataFrame
        return frame({column.name: self._whole(column) for column in self.columns})

    def polars(self) -> Any:
        """Return a ``polars.DataFrame``; what is missing is null.

        Raises:
            UsageError: Polars is not installed.
        """
        polars = _frames("polars")
        kinds = {int: polars.Int64, float: polars.Float64, str: polars.String}
        schema = {column.name: kinds[column.kind] for column in self.columns}
        return polars.DataFrame(list(self.values), schema=schema, orient="row")

    def _whole(self, column: Column) -> Any:
        """Return a column as an array if it is of numbers, else as a list."""
        if column.kind is not str:
            return self.column(column.name)
        place = self.names.index(column.name)
        return [row[place] for row in self.values]


def rows_of(names: Sequence[str], values: Sequence[Row], *, cut: bool) -> Rows:
    """Return rows whose kinds follow from their values, as those of a query do."""
    columns = (
        Column(name, _kind([row[place] for row in values])) for place, name in enumerate(names)
    )
    return Rows(tuple(columns), tuple(map(_plain, values)), cut)


def _kind(values: Sequence[Cell]) -> type[int] | type[float] | type[str]:
    """Return the kind of some values; a float where they are none."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int} and kinds:
        return int
    return float if kinds <= {int, float} else str


def _plain(row: Row) -> Row:
    """Return a row with bytes as their hexadecimal digits, as everywhere."""
    return tuple(value.hex() if isinstance(value, bytes) else value for value in row)


def _frames(package: str) -> Any:
    """Return a package for frames, which loads only now; UsageError where it is not installed."""
    if find_spec(package) is None:
        raise UsageError(f"{package} is not installed; install it: pip install {package}")
    return import_module(package)
