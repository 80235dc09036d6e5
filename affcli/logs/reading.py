"""A log read by its map: every line is a trial, or is named with what is wrong in it."""

import csv
import hashlib
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from affcli.bounded import file_bytes
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import Point
from affcli.core.log import NOT_LOGGED, LogFile
from affcli.errors import BadInputError, one_line
from affcli.logs.mapping import NAMES, LogMap
from affcli.own_files.words import checked_name

LARGEST_LOG = 20_000_000
"""Bytes of one file of a log."""
LONGEST_LINE = 20_000
"""Letters of a line of a log."""
MOST_FILES = 10_000
MOST_TRIALS = 30_000
"""Trials that are imported at once, of all files; the 80,000 that a megabyte can hold would take
3 s and 160 MB."""
MOST_CALLS = 300
"""Behaviors, with their parameters, that one robot has: they are one value of the database."""
MOST_TOOLS = 100
FARTHEST = 10_000.0
"""No place, length or angle of a log lies beyond (in, degrees)."""
LONGEST_TIME = 1e9
"""No time of a log is later (s)."""
NAMED = 100
"""So many lines that could not be read are remembered, each with the reason; all are counted."""
ABSENT = frozenset({"", "nan", "na", "n/a", "null", "none", "-"})
"""What stands, in small letters, where a log does not know a number."""


class LoggedTrial(NamedTuple):
    """One trial of a log: what one line says.

    Args:
        file, line: where it stands, both counting from 1.
        tool: what was held, by name.
        object: what was moved, by name; None where the log does not say.
        call: what was done with it.
        start, end: where the object was before and after (in, table frame).
        offset: where it was before as seen from the wrist (in); NaN where the log does not say.
        clock, duration: when it ended and how long it took (s); NaN likewise.
    """

    file: int
    line: int
    tool: str
    object: str | None
    call: BehaviorCall
    start: Point
    end: Point
    offset: Point
    clock: float
    duration: float


class BadLine(NamedTuple):
    """A line that could not be read, and why."""

    file: str
    line: int
    why: str

    def __str__(self) -> str:
        return f"{one_line(self.file)}:{self.line}: {self.why}"


@dataclass(slots=True)
class Log:
    """A log that was read.

    Args:
        map: by which it was read.
        files: in the order in which they were read.
        trials: in the order of files and lines.
        bad: the first `NAMED` lines that could not be read.
        left_out: how many these are.
    """

    map: LogMap
    files: list[LogFile] = field(default_factory=list)
    trials: list[LoggedTrial] = field(default_factory=list)
    bad: list[BadLine] = field(default_factory=list)
    left_out: int = 0

    def require_whole(self) -> None:
        """Make sure that all lines could be read; BadInputError names the first that could not."""
        if self.left_out:
            raise BadInputError(f"a line of the log cannot be read: {self.left_out_words()}")

    def left_out_words(self) -> str:
        """Return how many lines could not be read, and the first of them."""
        many = "1 line" if self.left_out == 1 else f"{self.left_out} lines"
        return f"{many}; the first: {self.bad[0]}"

    def leave_out(self, file: str, line: int, why: str) -> None:
        """Take note of a line that could not be read."""
        self.left_out += 1
        if len(self.bad) < NAMED:
            self.bad.append(BadLine(file, line, why))


def read_log(paths: Sequence[Path], how: LogMap) -> Log:
    """Read the files of a log, line by line.

    Raises:
        BadInputError: a file cannot be read, a column is nowhere in it, or no line of all files is
            a trial.
    """
    if len(paths) > MOST_FILES:
        raise BadInputError(f"{len(paths)} files: at most {MOST_FILES} at once; import some")
    log = Log(how)
    for number, path in enumerate(paths, 1):
        data = file_bytes(
            path, f"log {one_line(path)}", "name a file that can be read", LARGEST_LOG
        )
        log.files.append(LogFile(one_line(path, 1_000), hashlib.sha256(data).hexdigest()))
        _File(log, number, path, _text(data, path)).read()
    if not log.trials:
        first = f"; the first: {log.bad[0]}" if log.bad else ""
        raise BadInputError(f"no trial in {one_line(paths[0])}: no line fits the map{first}")
    return log


def _text(data: bytes, path: Path) -> str:
    """Return the text of a file."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise BadInputError(
            f"log {one_line(path)}: no text in UTF-8 at byte {error.start}; save it so"
        ) from error
    if "\0" in text:
        raise BadInputError(f"log {one_line(path)}: no text, there is a NUL in it; export it")
    return text


class _BadError(ValueError):
    """What is wrong in a line."""


class _File:
    """One file of a log, and the log that its trials are added to."""

    def __init__(self, log: Log, number: int, path: Path, text: str) -> None:
        self._log, self._number, self._path = log, number, path
        self._how = log.map
        self._lines = text.split("\n")
        self._names: dict[tuple[str, str], str] = {}
        self._calls: dict[tuple[str, ...], BehaviorCall] = {}

    def read(self) -> None:
        """Add each line that is a trial to the log, and take note of the others."""
        lines = self._content()
        first = next(lines, None)
        if first is None:
            return
        if self._how.header:
            if len(first[1]) > LONGEST_LINE:
                raise BadInputError(
                    f"log {one_line(self._path)}: its header has more than {LONGEST_LINE} letters; "
                    "is this the right file?"
                )
            where = self._columns([name.strip() for name in self._split(first[1])])
        else:
            where, lines = self._columns(None), self._content()
        least = max(where.values(), default=-1) + 1
        sizes = Counter(len(self._split(text)) for _, text in self._counted(lines))
        enough = {size: count for size, count in sizes.items() if size >= least}
        usual = max(enough, key=enough.__getitem__, default=0)
        lines = self._content()
        if self._how.header:
            next(lines)
        for number, text in lines:
            try:
                self._add(number, text, usual, where)
            except _BadError as error:
                self._log.leave_out(self._log.files[-1].name, number, str(error))

    def _content(self) -> Iterator[tuple[int, str]]:
        """Yield the lines that say something, with their numbers."""
        comment = self._how.comment
        for number, line in enumerate(self._lines, 1):
            if line.strip() and not (comment and line.startswith(comment)):
                yield number, line.rstrip("\r")

    @staticmethod
    def _counted(lines: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
        """Yield the lines that are not too long to be looked at."""
        return ((number, text) for number, text in lines if len(text) <= LONGEST_LINE)

    def _split(self, text: str) -> list[str]:
        """Return the columns of a line."""
        separator = self._how.separator
        if separator is not None and '"' in text:
            return next(csv.reader([text], delimiter=separator), [])
        return text.split(separator)

    def _columns(self, header: list[str] | None) -> Mapping[str, int]:
        """Return the place of each column of the map in a line, from 0."""
        named = {
            **self._how.columns,
            **{f"parameters.{k}": v for k, v in self._how.parameters.items()},
        }
        places = {}
        for name, column in named.items():
            if isinstance(column, int):
                places[name] = column - 1
            elif header is not None and header.count(column) == 1:
                places[name] = header.index(column)
            else:
                known = ", ".join(one_line(one, 40) for one in (header or [])[:20])
                twice = "twice" if header and column in header else "nowhere"
                raise BadInputError(
                    f"log {one_line(self._path)}: column {one_line(column, 40)} ({name}) stands "
                    f"{twice} in its first line, which has: {one_line(known, 200)}"
                )
        return places

    def _add(self, number: int, text: str, usual: int, where: Mapping[str, int]) -> None:
        """Add the trial of a line to the log; `_BadError` says what is wrong in it."""
        if len(text) > LONGEST_LINE:
            raise _BadError(f"more than {LONGEST_LINE} letters")
        cells = self._split(text)
        least = max(where.values(), default=-1) + 1
        if len(cells) < least:
            raise _BadError(f"{len(cells)} columns, the map names {least}")
        if len(cells) != usual:
            raise _BadError(f"{len(cells)} columns, the others have {usual}")
        if len(self._log.trials) >= MOST_TRIALS:
            raise BadInputError(
                f"log {one_line(self._path)}: with it there are more than {MOST_TRIALS} trials; "
                "import them in parts"
            )
        how, line = self._how, _Line(cells, where, self._how)
        tool, behavior, thing = (self._named(kind, line.said(kind)) for kind in NAMES)
        if tool is None or behavior is None:
            raise _BadError("no tool" if tool is None else "no behavior")
        start, end = line.place("start"), line.place("end")
        for name, place in (("start", start), ("end", end)):
            if math.isnan(place.x + place.y):
                raise _BadError(f"where the object was is not said: {name}")
        trial = LoggedTrial(
            *(self._number, number, tool, thing, self._call(behavior, line), start, end),
            line.offset(start),
            *(line.number(name, how.time, LONGEST_TIME) for name in ("clock", "duration")),
        )
        self._log.trials.append(trial)

    def _named(self, kind: str, text: str | None) -> str | None:
        """Return what a tool, behavior or object is called."""
        if text is None or (not text and kind == "object"):
            return None
        found = self._names.get((kind, text))
        if found is None:
            named = self._how.names.get(kind)
            if named is not None and text not in named:
                raise _BadError(f"{kind} {one_line(text, 40)}: [names.{kind}] has no such name")
            try:
                found = checked_name(text if named is None else named[text], kind)
            except BadInputError as error:
                raise _BadError(str(error)) from error
            if len(self._names) < MOST_CALLS:
                self._names[kind, text] = found
        return found

    def _call(self, behavior: str, line: "_Line") -> BehaviorCall:
        """Return what was done: the behavior with its parameters."""
        how = self._how
        texts = (behavior, *(line.said(f"parameters.{name}") or "" for name in how.parameters))
        found = self._calls.get(texts)
        if found is None:
            params = {}
            for name in how.parameters:
                turn = name.endswith(("angle", "direction"))
                value = line.number(f"parameters.{name}", how.angle if turn else how.length)
                if not math.isnan(value):
                    params[name] = value
            found = BehaviorCall.of(BehaviorName(behavior), params)
            if len(self._calls) < MOST_CALLS:
                self._calls[texts] = found
        return found


class _Line(NamedTuple):
    """One line: its columns, where what stands in them, and the map."""

    cells: list[str]
    where: Mapping[str, int]
    how: LogMap

    def said(self, name: str) -> str | None:
        """Return what the line says of something; None when nothing is known of it."""
        place = self.where.get(name)
        if place is None:
            return self.how.constants.get(name)
        if place >= len(self.cells):
            raise _BadError(f"no column {place + 1} ({name}), it has {len(self.cells)}")
        return self.cells[place].strip()

    def number(self, name: str, unit: float, most: float = FARTHEST) -> float:
        """Return a number in our units; NaN where it is absent, `_BadError` where it is none."""
        text = self.said(name)
        if text is None or text.lower() in ABSENT:
            return NOT_LOGGED
        try:
            value = float(text.replace(",", ".") if self.how.decimal == "," else text) * unit
        except ValueError:
            value = math.inf
        if "_" in text or not abs(value) <= most:
            raise _BadError(f"{name} = {one_line(text, 40)}: no number within {most:g}")
        return value

    def place(self, name: str) -> Point:
        """Return a place, or a difference of places, in the axes of the table frame (in)."""
        how = self.how
        both = [self.number(f"{name}_{axis}", how.length) for axis in ("x", "y")]
        right, away = how.right, how.away
        return Point(both[right.coordinate] * right.sign, both[away.coordinate] * away.sign)

    def offset(self, start: Point) -> Point:
        """Return where the object was as seen from the wrist; NaN where that is not known (in)."""
        if "wrist_x" in self.where or "wrist_x" in self.how.constants:
            wrist = self.place("wrist")
            offset = Point(start.x - wrist.x, start.y - wrist.y)
        else:
            offset = self.place("offset")
        known = not math.isnan(offset.x + offset.y)
        return offset if known else Point(NOT_LOGGED, NOT_LOGGED)
