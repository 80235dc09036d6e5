"""Tables, names, numbers and places in a person's file, each checked as it is read."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from affcli.core.geometry import Point
from affcli.core.names import one_of
from affcli.errors import BadInputError, UsageError, one_line

LONGEST_NAME = 40
"""Letters of a name."""
NOT_IN_NAMES = "/\\:,=@"
"""What means something else in an option, or in a path."""
LARGEST = 40.0
"""Nothing lies farther from the origin, to either side (in): the table is 32 by 20."""


@contextmanager
def at(source: str) -> Iterator[None]:
    """Say in which file something is wrong."""
    try:
        yield
    except (BadInputError, UsageError) as error:
        raise BadInputError(f"{source}: {error}") from error


def require_tables(tables: Mapping[str, Any], known: Iterable[str]) -> None:
    """Refuse a table that a file of this kind has not."""
    for table in tables:
        one_of("table", table, known)


def head(tables: Mapping[str, Any], name: str, keys: Iterable[str]) -> Mapping[str, Any]:
    """Return the one table of a name, if it has no other keys."""
    table = tables.get(name)
    if not isinstance(table, dict):
        raise BadInputError(f"it needs a table [{name}] with {' and '.join(list(keys)[:2])}")
    for key in table:
        one_of(f"key of {name}", key, keys)
    return table


def listed(
    tables: Mapping[str, Any], name: str, keys: Iterable[str]
) -> list[tuple[str, dict[str, Any]]]:
    """Return each of the tables of a name with its place, if they have no other keys."""
    found = tables.get(name, [])
    if not isinstance(found, list) or not all(isinstance(one, dict) for one in found):
        raise BadInputError(
            f"{name}: write each {name} under [[{name}]], with {' and '.join(keys)}"
        )
    places = [(f"{name} {number}", one) for number, one in enumerate(found, 1)]
    for place, one in places:
        for key in one:
            one_of(f"key of {place}", key, keys)
    return places


def checked_name(value: object, place: str) -> str:
    """Return a name that can be said in an option and shown on a terminal; else BadInputError."""
    if (
        not isinstance(value, str)
        or not 1 <= len(value) <= LONGEST_NAME
        or not value.isprintable()
        or value != value.strip()
        or value.startswith("-")
        or set(value) & set(NOT_IN_NAMES)
    ):
        raise BadInputError(
            f"{place}{_said(value)}: must be a word of 1 to {LONGEST_NAME} letters without any of "
            f"{' '.join(NOT_IN_NAMES)}"
        )
    return value


def are_numbers(values: list[Any], least: float, largest: float) -> bool:
    """Tell whether values of TOML are numbers within limits: no nan, nor of a thousand digits."""
    return all(
        isinstance(value, int | float) and not isinstance(value, bool) and least <= value <= largest
        for value in values
    )


def number(value: object, place: str, least: float, largest: float, unit: str) -> float:
    """Return a number within limits; BadInputError for anything else."""
    if not are_numbers([value], least, largest):
        limits = f"{least:g} to {largest:g} {unit}"
        raise BadInputError(f"{place}{_said(value)}: must be a number in {limits}")
    return float(value)  # type: ignore[arg-type]


def point(value: object, place: str) -> Point:
    """Return a place; BadInputError for anything else."""
    if not isinstance(value, list) or len(value) != 2:
        raise BadInputError(f"{place}: must be [x, y] in inches")
    if not are_numbers(value, -LARGEST, LARGEST):
        raise BadInputError(
            f"{place}: {one_line(value, 60)}: each must be a number in "
            f"-{LARGEST:g} to {LARGEST:g} in"
        )
    return Point(*map(float, value))


def _said(value: object) -> str:
    return "" if value is None else f" = {one_line(value, 60)}"
