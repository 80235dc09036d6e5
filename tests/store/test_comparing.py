"""Doing again is compared with the record row by row, number by number, to the bit."""

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from affcli.core.replay import Difference
from affcli.store.columns import COLUMNS
from affcli.store.comparing import by_number, differences

TABLE = "step"
values = st.tuples(*[st.sampled_from([None, 0, 1, 0.1, 0.1 + 2**-56, "x"])] * len(COLUMNS[TABLE]))
tables = st.dictionaries(st.integers(0, 5), values)


@given(tables, tables)
def test_every_value_that_differs_is_told_and_nothing_else(
    kept: dict[int, tuple[Any, ...]], again: dict[int, tuple[Any, ...]]
) -> None:
    """A row that one side lacks is one difference: the number that it has and has not."""
    stored = {n: dict(zip(COLUMNS[TABLE], row, strict=True)) for n, row in kept.items()}
    right = []
    for number in sorted({*kept, *again}):
        if number not in kept:
            right.append(Difference(number, "number", None, number))
        elif number not in again:
            right.append(Difference(number, "number", number, None))
        else:
            pairs = zip(COLUMNS[TABLE], kept[number], again[number], strict=True)
            right += [Difference(number, name, a, b) for name, a, b in pairs if a != b]
    assert list(differences(TABLE, stored, again)) == right


def test_rows_are_found_by_the_column_that_numbers_them() -> None:
    first, second = {"step": 4, "x": 1}, {"step": 2, "x": 2}
    assert by_number([first, second], "step") == {4: first, 2: second}
