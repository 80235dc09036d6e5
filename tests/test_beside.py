"""A thread for which nothing waits: it has the room it needs, or is left out."""

import io
import sys
import time
from _thread import start_new_thread
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread

import pytest

from affcli import beside as home
from affcli.beside import beside
from affcli.cli import terminal
from affcli.cli.signals import _report_unraisable
from tests.cli.program import PATIENCE, done

LEARN = ("learn", "--tool", "stick", "--behaviors", "5", "--db", "my.db")


def run_out() -> None:
    raise MemoryError


def starts_and_dies(work: Callable[[], object], args: tuple[()]) -> int:
    """Start a thread for whose first call there is no memory; come back when it is dead."""
    del work
    told, dead = sys.unraisablehook, SimpleQueue[None]()

    def tell(why: "sys.UnraisableHookArgs") -> None:
        told(why)
        dead.put(None)

    sys.unraisablehook = tell
    try:
        number = start_new_thread(run_out, args)
        dead.get(timeout=PATIENCE)
    finally:
        sys.unraisablehook = told
    return number


def starts_none(work: Callable[[], object], args: tuple[()]) -> int:
    del work, args
    raise RuntimeError("can't start new thread")


def has_no_room(size: int) -> None:
    del size
    raise MemoryError


@pytest.fixture(params=[starts_and_dies, starts_none, has_no_room], ids=lambda one: one.__name__)
def too_little(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """There is too little of something for a thread."""
    name = "ask_for" if request.param is has_no_room else "start_new_thread"
    monkeypatch.setattr(home, name, request.param)
    monkeypatch.setattr(sys, "unraisablehook", _report_unraisable)


@pytest.fixture
def no_python_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing begins a thread of Python's own, which would wait for ever."""

    def start(thread: Thread) -> None:
        raise AssertionError(thread)

    monkeypatch.setattr(Thread, "start", start)


def test_it_is_done_while_the_caller_goes_on() -> None:
    began, may_end, ended = Event(), Event(), Event()

    def work() -> None:
        began.set()
        assert may_end.wait(PATIENCE)
        ended.set()

    beside(work)
    assert began.wait(PATIENCE)
    assert not ended.is_set()
    may_end.set()
    assert ended.wait(PATIENCE)


@pytest.mark.fault(46)
@pytest.mark.usefixtures("too_little", "no_python_thread")
def test_a_command_goes_on_without_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`learn` hung when memory ran out in the thread that says how far it is."""
    monkeypatch.setattr(terminal, "A_MINUTE", 0.001)
    said = done(*LEARN, cwd=tmp_path).err
    assert said.startswith("learned stick (run 1, seed 0)")
    assert said.count("\n") == 1


class Screen(io.StringIO):
    """A terminal that keeps what it got."""

    def isatty(self) -> bool:
        return True


@pytest.mark.usefixtures("no_python_thread")
def test_the_time_of_a_bar_goes_on_while_nothing_else_does(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Screen()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setenv("TERM", "xterm")
    with terminal.progress("digging", 10.0):
        patient = time.monotonic() + PATIENCE
        while "0:01" not in screen.getvalue() and time.monotonic() < patient:
            time.sleep(0.05)
    assert "digging" in screen.getvalue()
    assert "0:01" in screen.getvalue()


@pytest.mark.fault(46)
@pytest.mark.usefixtures("too_little", "no_python_thread")
def test_a_bar_moves_without_it_when_something_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Screen()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setenv("TERM", "xterm")
    with terminal.progress("digging", 10.0, "holes") as bar:
        bar(3.0, "")
    assert "3 of 10 holes" in screen.getvalue()
