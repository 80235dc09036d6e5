"""The map of a log: a TOML file that says what stands where in the log's lines, and in which units.

    [log]
    source = "the robot of room 4"
    [columns]                       # by number, from 1, or by name where the log has a header
    tool = 1
    behavior = 2
    start_x = 3
    start_y = 4
    end_x = 5
    end_y = 6

All that it may say stands in ``affcli/logs/README.md``. What every line has alike stands under
``[constants]`` instead of ``[columns]``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from affcli.config import toml_file
from affcli.core.behavior import LONGEST_NAME as LONGEST_PARAMETER
from affcli.core.behavior import MOST_PARAMETERS
from affcli.core.names import one_of
from affcli.errors import BadInputError, UsageError, one_line
from affcli.own_files.words import checked_name

TABLES = ("log", "columns", "constants", "parameters", "units", "axes", "names")
HEAD = ("source", "licence", "citation", "header", "separator", "decimal", "comment")
NEEDED = ("tool", "behavior", "start_x", "start_y", "end_x", "end_y")
NAMES = ("tool", "behavior", "object")
PLACES = ("start_x", "start_y", "end_x", "end_y", "wrist_x", "wrist_y", "offset_x", "offset_y")
FIELDS = (*NAMES, *PLACES, "clock", "duration")
"""What a column, or a constant, can be of."""
PAIRS = (("wrist_x", "wrist_y"), ("offset_x", "offset_y"))

SEPARATORS: Mapping[str, str | None] = {"blank": None, "comma": ",", "semicolon": ";", "tab": "\t"}
LENGTHS = {"m": 1.0 / 0.0254, "dm": 0.1 / 0.0254, "cm": 0.01 / 0.0254, "mm": 0.001 / 0.0254}
LENGTHS |= {"in": 1.0, "ft": 12.0}
ANGLES = {"degrees": 1.0, "radians": 57.29577951308232}
TIMES = {"s": 1.0, "ms": 0.001, "us": 1e-6, "ns": 1e-9, "min": 60.0}
AXES = {"x": (0, 1.0), "-x": (0, -1.0), "y": (1, 1.0), "-y": (1, -1.0)}

MOST_COLUMNS = 1_000
LONGEST_REMARK = 2_000
"""Letters of source, licence and citation, each."""


class Axis(NamedTuple):
    """Which coordinate of the log runs along an axis of the table frame, and in which sense."""

    coordinate: int
    sign: float


@dataclass(frozen=True, slots=True)
class LogMap:
    """How the lines of a log are read.

    Args:
        source, licence, citation: as in `core.log.LogSource`.
        header: the first line of each file names the columns.
        separator: between columns; None for any run of blanks.
        decimal: what stands before the decimals of a number: a point or a comma.
        comment: lines that begin with it say nothing; empty for none.
        columns: where each of `FIELDS` stands: number from 1, or name.
        constants: what each of `FIELDS` is in all lines, as text.
        parameters: where each parameter of the behaviors stands.
        length, angle, time: of one unit of the log, in inches, degrees and seconds.
        right, away: the axes of the table frame.
        names: what a tool, behavior or object is called, by what stands in the log.
        tables: all that it was made of but for source, licence and citation.
    """

    source: str
    licence: str | None
    citation: str | None
    header: bool
    separator: str | None
    decimal: str
    comment: str
    columns: Mapping[str, int | str]
    constants: Mapping[str, str]
    parameters: Mapping[str, int | str]
    length: float
    angle: float
    time: float
    right: Axis
    away: Axis
    names: Mapping[str, Mapping[str, str]]
    tables: Mapping[str, Any] = field(repr=False, compare=False)


def log_map(path: Path) -> LogMap:
    """Return the map that a file holds.

    Raises:
        BadInputError: it cannot be read, or something in it is not as it must be; the message names
            the file and the place in it.
    """
    source = f"map {one_line(path)}"
    return map_of_tables(toml_file(path, source), source)


def map_of_tables(tables: Mapping[str, Any], source: str) -> LogMap:
    """Return the map that tables hold, as a file has them; see `log_map`."""
    try:
        return _map(tables)
    except (BadInputError, UsageError) as error:
        raise BadInputError(f"{source}: {error}") from error


def _map(tables: Mapping[str, Any]) -> LogMap:
    """Return the map that tables hold; the message says at which place something is wrong."""
    for name in tables:
        one_of("table", name, TABLES)
    head = _table(tables, "log", HEAD)
    if "source" not in head:
        raise BadInputError('[log] needs source = "...": who made the log, or where it was found')
    header = head.get("header", False)
    if not isinstance(header, bool):
        raise BadInputError(f"log.header = {one_line(header, 40)}: must be true or false")
    columns = {k: _column(f"columns.{k}", v, header=header) for k, v in _fields(tables, "columns")}
    constants = {k: _constant(f"constants.{k}", v) for k, v in _fields(tables, "constants")}
    for name in columns.keys() & constants.keys():
        raise BadInputError(f"{name} stands under [columns] and [constants]: leave one of them out")
    _require(columns.keys() | constants.keys())
    units = _table(tables, "units", ("length", "angle", "time"))
    axes = _table(tables, "axes", ("right", "away"))
    right, away = (_choice(f"axes.{k}", axes.get(k, d), AXES) for k, d in _AXES.items())
    if right[0] == away[0]:
        raise BadInputError("axes: right and away must be one of x and one of y")
    separator = _choice("log.separator", head.get("separator", "blank"), SEPARATORS)
    decimal = head.get("decimal", ".")
    if decimal not in (".", ",") or decimal == separator:
        raise BadInputError(f"log.decimal = {one_line(decimal, 40)}: must be . or , (no separator)")
    own = {name: value for name, value in head.items() if name not in HEAD[:3]}
    return LogMap(
        source=_remark("log.source", head["source"]),
        licence=_remark("log.licence", head["licence"]) if "licence" in head else None,
        citation=_remark("log.citation", head["citation"]) if "citation" in head else None,
        header=header,
        separator=separator,
        decimal=decimal,
        comment=_comment(head.get("comment", "")),
        columns=columns,
        constants=constants,
        parameters=_parameters(tables.get("parameters", {}), header=header),
        length=_choice("units.length", units.get("length", "in"), LENGTHS),
        angle=_choice("units.angle", units.get("angle", "degrees"), ANGLES),
        time=_choice("units.time", units.get("time", "s"), TIMES),
        right=Axis(*right),
        away=Axis(*away),
        names=_names(tables),
        tables={**tables, "log": own},
    )


_AXES = {"right": "x", "away": "y"}


def _table(tables: Mapping[str, Any], name: str, keys: Sequence[str]) -> Mapping[str, Any]:
    """Return a table of the map, whose keys are among those that are known."""
    table = tables.get(name, {})
    if not isinstance(table, dict):
        raise BadInputError(f"{name}: must be a table, [{name}]")
    for key in table:
        one_of(f"key of {name}", key, keys)
    return table


def _fields(tables: Mapping[str, Any], name: str) -> Sequence[tuple[str, Any]]:
    """Return what a table says of `FIELDS`."""
    return tuple(_table(tables, name, FIELDS).items())


def _require(known: "frozenset[str] | set[str]") -> None:
    """Make sure that the map says all that a behavior is made of, and no half of a place."""
    for name in NEEDED:
        if name not in known:
            raise BadInputError(
                f"where does {name} stand? give it under [columns], or under [constants] where it "
                "is the same in all lines"
            )
    for x, y in PAIRS:
        if (x in known) != (y in known):
            raise BadInputError(f"give both {x} and {y}, or none of them")
    if {"wrist_x", "offset_x"} <= known:
        raise BadInputError("give the wrist or the offset from it, not both: one follows")


def _column(place: str, value: object, *, header: bool) -> int | str:
    """Return where something stands: a number from 1, or a name where there is a header."""
    if isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= MOST_COLUMNS:
        return value
    if isinstance(value, str) and value and header:
        return value
    names = ", or a name of the header" if header else " (by name with header = true alone)"
    raise BadInputError(
        f"{place} = {one_line(value, 40)}: must be a column from 1 to {MOST_COLUMNS}{names}"
    )


def _constant(place: str, value: object) -> str:
    """Return what stands in all lines, as a line would have it."""
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise BadInputError(f"{place} = {one_line(value, 40)}: must be a number or a text")
    return str(value)


def _parameters(table: object, *, header: bool) -> Mapping[str, int | str]:
    """Return where the parameters of behaviors stand."""
    if not isinstance(table, dict) or len(table) > MOST_PARAMETERS:
        raise BadInputError(f"[parameters] names at most {MOST_PARAMETERS}, each with its column")
    for name in table:
        if not (name.isidentifier() and name.isascii() and len(name) <= LONGEST_PARAMETER):
            raise BadInputError(
                f"parameters: {one_line(name, 40)}: must be a word of letters, digits and _"
            )
    return {k: _column(f"parameters.{k}", v, header=header) for k, v in table.items()}


def _names(tables: Mapping[str, Any]) -> Mapping[str, Mapping[str, str]]:
    """Return what tools, behaviors and objects are called."""
    named = {}
    for kind, table in _table(tables, "names", NAMES).items():
        if not isinstance(table, dict):
            raise BadInputError(f"names.{kind}: must be a table, [names.{kind}]")
        named[kind] = {
            said: checked_name(name, f"names.{kind}.{one_line(said, 40)}")
            for said, name in table.items()
        }
    return named


def _remark(place: str, value: object) -> str:
    """Return what is said of a log."""
    if not isinstance(value, str) or not 0 < len(value) <= LONGEST_REMARK:
        raise BadInputError(
            f"{place} = {one_line(value, 40)}: must be text of 1 to {LONGEST_REMARK} letters"
        )
    return one_line(" ".join(value.split()), LONGEST_REMARK)  # BibTeX stands on several lines


def _comment(value: object) -> str:
    if not isinstance(value, str) or len(value) > 10:
        raise BadInputError(f"log.comment = {one_line(value, 40)}: must be 1 to 10 letters")
    return value


def _choice(place: str, value: object, known: Mapping[str, Any]) -> Any:
    """Return what one of several words stands for."""
    if not isinstance(value, str) or value not in known:
        raise BadInputError(f"{place} = {one_line(value, 40)}: must be one of {', '.join(known)}")
    return known[value]
