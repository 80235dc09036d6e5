"""Where the commands' words go: results to stdout, messages and progress to stderr."""

import io
import json
import os
import sys
import time
from collections import deque
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from textwrap import fill
from threading import Event, Lock
from typing import TYPE_CHECKING, Any, TextIO, TypeVar

from affcli.beside import beside
from affcli.errors import AffcliError, one_line

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from rich.console import Console, RenderableType


T = TypeVar("T")
JSON_FORMAT = 1
"""Of what `show_json` writes: raised when a key gets another name or meaning, or is no more."""
NARROWEST = 20
"""A terminal of fewer columns is written to as if it had these."""
WIDE_ENOUGH_FOR_BARS = 72
A_MINUTE = 60.0
"""Seconds between two lines that say how far something is, where there is no terminal."""
A_MOMENT = 0.1
"""Seconds between two looks of the bars on a terminal."""
_command = ""


def prepare_streams() -> None:
    """Make sure that whatever the commands say can be written somewhere.

    A closed stream (``>&-``) becomes one that forgets; what an encoding lacks is shown escaped, and
    what is no character in it is read so.
    """
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            forgetful = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 open to the end
            setattr(sys, name, forgetful)
        elif isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="backslashreplace")


def say(message: str) -> None:
    """Write a message to stderr."""
    _write(sys.stderr, f"{_fitting(message)}\n")


def _fitting(message: str) -> str:
    """Return a message for stderr, on a terminal with its words whole: what is longer is left so.

    Elsewhere it stays one line, for other programs.
    """
    if not sys.stderr.isatty():
        return message
    with suppress(OSError, ValueError):
        columns = int(os.environ.get("COLUMNS") or 0) or os.get_terminal_size(2).columns
        if len(message) > columns >= NARROWEST:
            return fill(message, columns, break_long_words=False, break_on_hyphens=False)
    return message


def show(*renderables: "RenderableType") -> None:
    """Write tables and text to stdout, with an empty line between two."""
    page = _Page(sys.stdout)
    console = _console(page)
    for number, renderable in enumerate(renderables):
        if number:
            console.print()
        console.print(renderable)
    _write(sys.stdout, page.getvalue())


def show_text(text: str) -> None:
    """Write text to stdout as it is; to a terminal with all escaped that might command it."""
    if sys.stdout.isatty():
        lines = text.replace("\r\n", "\n").split("\n")
        text = "\n".join(one_line(line, sys.maxsize) for line in lines)
    _write(sys.stdout, text)


def answer_as(command: str) -> None:
    """Name the command that is run, for what it answers in JSON."""
    global _command  # noqa: PLW0603  # a process runs one
    _command = command


def show_json(results: "Iterable[Mapping[str, Any]]") -> None:
    """Write the results of the command to stdout as JSON, all commands in one shape.

    Args:
        results: one for each thing that was asked for; any reader knows their values (see
            `report.json_table.plain`).
    """
    from affcli.report.json_table import plain

    answer = {"command": _command, "format": JSON_FORMAT, "results": plain(list(results))}
    show_text(json.dumps(answer, indent=2) + "\n")


def show_either(
    *,
    as_json: bool,
    results: "Callable[[], Iterable[Mapping[str, Any]]]",
    tables: "Callable[[], Iterable[RenderableType]]",
) -> None:
    """Write results to stdout: as JSON, or their tables."""
    if as_json:
        show_json(results())
    else:
        show(*tables())


def show_rows(
    columns: tuple[str, ...],
    rows: "Iterable[Iterable[str]]",
    *,
    left: tuple[str, ...] = (),
    wraps: bool = True,
    records: bool = False,
) -> None:
    """Write rows of text to stdout under headings (see `report.sheet.Sheet`)."""
    from affcli.report.sheet import Sheet

    sheet = Sheet(columns, left=left, wraps=wraps, records=records)
    for row in rows:
        sheet.add(*row)
    show(sheet)


def play(pages: "Iterable[RenderableType]", pages_a_second: float) -> None:
    """Show pages one after the other in one place of the terminal; the last one stays.

    Pages for which there is no time are left out, but for the last. A terminal that cannot go back
    (``TERM=dumb``) shows the last alone.
    """
    from rich.live import Live

    console = _console(sys.stdout)
    if console.is_dumb_terminal:
        show(*deque(pages, maxlen=1))
        return
    try:
        with Live(console=console, auto_refresh=False) as live:
            began = time.monotonic()
            page: RenderableType = ""
            for number, page in enumerate(pages, 1):
                until = began + number / pages_a_second
                if time.monotonic() < until:
                    live.update(page, refresh=True)
                    time.sleep(max(0.0, until - time.monotonic()))
            live.update(page, refresh=True)
    finally:
        # A signal may fall between the hiding of the cursor and the block that shows it again.
        console.show_cursor(True)


def on_terminal() -> bool:
    """Tell whether a person sees what is written to stdout."""
    return sys.stdout.isatty()


def interactive() -> bool:
    """Tell whether a person sees what is written and asked, and can answer."""
    streams = (sys.stdin, sys.stdout, sys.stderr)
    return all(stream is not None and stream.isatty() for stream in streams)


def asked(question: str) -> str | None:
    """Ask on stderr; return the answer without blanks around it, None at the end of the input."""
    answer = ""
    try:
        _write(sys.stderr, _fitting(question.rstrip()) + " ")
        answer = sys.stdin.readline()
    finally:
        # After ctrl-D or ctrl-C the next words begin a line of their own.
        if not answer.endswith("\n"):
            _write(sys.stderr, "\n")
    return answer.strip() if answer else None


def shows_braille() -> bool:
    """Tell whether stdout can be written in Unicode, to a terminal that has braille letters.

    The Linux console (``TERM=linux``) has a font of 512 letters without them.
    """
    unicode = (sys.stdout.encoding or "").lower().startswith("utf")
    return unicode and not (on_terminal() and os.environ.get("TERM") == "linux")


@contextmanager
def progress(
    description: str, total: float, noun: str = ""
) -> "Iterator[Callable[[float, str], object]]":
    """Give what is told how much is done, and a status, and shows it on stderr from the beginning.

    To a terminal it is a bar that leaves nothing behind; otherwise, to a log file for one, a line a
    minute. Both tell how long it has taken and how long it will.

    Args:
        description: of what is done.
        total: how much there is to do.
        noun: what is counted, where the count itself is the status.
    """
    with bars({0: (description, total)}, noun) as tell:
        yield partial(tell, 0)


@contextmanager
def bars(
    tasks: "Mapping[int, tuple[str, float]]", noun: str = ""
) -> "Iterator[Callable[..., object]]":
    """Give bars on stderr, one below the other, as `progress` gives one.

    Args:
        tasks: what each is of, and how much there is to do, by a number of its own.
        noun: what is counted, where the count itself is the status.

    Yields:
        What is told of a task by its number how much is done, and a status.
    """
    far = {number: _Progress(total, noun) for number, (_, total) in tasks.items()}

    def told(number: int, done: float, status: str = "") -> None:
        far[number].update(done, status)

    if not sys.stderr.isatty():

        def tell() -> None:
            say("; ".join(f"{tasks[n][0]}: {one.words()}" for n, one in far.items()))

        with _again_and_again(tell, A_MINUTE):
            yield told
        return
    from rich.progress import BarColumn, Progress, ProgressColumn, Task, TextColumn
    from rich.table import Column
    from rich.text import Text

    console = _console(sys.stderr)
    longest = max((len(description) for description, _ in tasks.values()), default=0)
    shows_bars = console.width >= WIDE_ENOUGH_FOR_BARS
    room = console.width - longest - (12 if shows_bars else 1)

    class Words(ProgressColumn):
        """How far it is; the time goes on while nothing else does."""

        def render(self, task: Task) -> Text:
            return Text(_parts_within(far[task.fields["number"]].words(), room))

    names = Column(no_wrap=True, min_width=min(longest, console.width // 2))
    columns: list[ProgressColumn] = [
        TextColumn("{task.description}", table_column=names),
        BarColumn(10),
    ]
    columns.append(Words(table_column=Column(no_wrap=True)))
    if not shows_bars:
        del columns[1]
    with Progress(*columns, console=console, transient=True, auto_refresh=False) as shown:
        ids = {
            number: shown.add_task(description, total=total, number=number)
            for number, (description, total) in tasks.items()
        }

        def update(number: int, done: float, status: str = "") -> None:
            told(number, done, status)
            shown.update(ids[number], completed=done)

        with _again_and_again(shown.refresh, A_MOMENT):
            yield update


def _parts_within(text: str, room: int) -> str:
    """Return as many of the parts of a text, with commas between them, as there is room for."""
    while len(text) > room and ", " in text:
        text = text.rpartition(", ")[0]
    return text


class _Progress:
    """How far something is, in words."""

    def __init__(self, total: float, noun: str) -> None:
        self._total, self._noun, self._began = total, noun, time.monotonic()
        self._first: float | None = None
        self._done, self._status = 0.0, ""

    def update(self, done: float, status: str = "") -> None:
        """Take note of how much is done; what is done at first was done before."""
        if self._first is None:
            self._first = done
        self._done, self._status = done, status

    def words(self) -> str:
        """Return how much is done, how fast, how long it took and how long it will take."""
        took, new = time.monotonic() - self._began, self._done - (self._first or 0.0)
        words = [self._status] if self._status else []
        if self._noun:
            words = [f"{self._done:g} of {self._total:g} {self._noun}"]
        if self._noun and new > 0.0:
            words.append(f"{60.0 * new / took:.3g} a minute")
        words.append(_clock(took))
        if new > 0.0:
            words.append(f"{_clock(took * (self._total - self._done) / new)} left")
        return ", ".join(words)


def _clock(seconds: float) -> str:
    """Return a time as ``3:07`` or ``1:02:03``."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


@contextmanager
def _again_and_again(tell: "Callable[[], object]", seconds: float) -> "Iterator[None]":
    """Tell something every so many seconds while the block runs, whatever the block waits for."""
    over, telling = Event(), Lock()

    def keep_telling() -> None:
        # Nobody can read it: the block finds out when it has to say something.
        with suppress(AffcliError, OSError):
            while not over.wait(seconds):
                with telling:
                    if not over.is_set():
                        tell()

    beside(keep_telling)
    try:
        yield
    finally:
        over.set()
        # What is being told is told to its end, unless that never comes.
        telling.acquire(timeout=A_MINUTE)


def followed(items: "Iterable[T]", description: str, total: int, noun: str) -> "list[T]":
    """Return all of some items, while a bar counts them as they come."""
    done: list[T] = []
    with progress(description, total, noun) as bar:
        bar(0, "")
        for item in items:
            done.append(item)
            bar(len(done), "")
    return done


class _Page(io.StringIO):
    """What will be written to a stream, drawn for that stream."""

    def __init__(self, stream: TextIO) -> None:
        super().__init__()
        self._stream = stream

    @property
    def encoding(self) -> str:  # type: ignore[override]
        return self._stream.encoding

    def isatty(self) -> bool:
        return self._stream.isatty()


def _console(file: TextIO) -> "Console":
    """Return a rich console; markup and highlighting are off, for names are users' own."""
    from rich.console import Console

    console = Console(file=file, markup=False, highlight=False, emoji=False)
    console.width = max(console.width, NARROWEST)
    return console


def _write(stream: TextIO, text: str) -> None:
    """Write and flush.

    A reader who has gone (``| head``) is no failure: the command goes on, its words are forgotten.

    Raises:
        AffcliError: the stream cannot be written, a full disk for one.
    """
    try:
        stream.write(text)
        stream.flush()
    except OSError as error:
        # Or Python would try to write the rest once more on its way out, and complain.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        if not isinstance(error, BrokenPipeError):
            raise AffcliError(
                f"the output cannot be written: {error.strerror}; write it elsewhere"
            ) from error
