"""Does what is done again equal its record? Column by column, to the bit."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from affcli.core.replay import Difference
from affcli.store.columns import COLUMNS
from affcli.store.rows import Row


def by_number(kept: Iterable[Mapping[str, Any]], column: str) -> dict[int, Mapping[str, Any]]:
    """Return rows by the column that numbers them."""
    return {row[column]: row for row in kept}


def differences(
    table: str, kept: Mapping[int, Mapping[str, Any]], again: Mapping[int, Row]
) -> Iterator[Difference]:
    """Yield where rows of a table differ, by number and column.

    Args:
        table: its name.
        kept: the rows of the record, by number.
        again: the rows that came out, by number, in the order of the table's columns.
    """
    for number in sorted(kept.keys() | again.keys()):
        values = dict(zip(COLUMNS[table], again.get(number, ()), strict=False))
        if number not in kept or not values:
            present = (number if number in rows else None for rows in (kept, again))
            yield Difference(number, "number", *present)
            continue
        for column, value in values.items():
            if kept[number][column] != value:
                yield Difference(number, column, kept[number][column], value)
