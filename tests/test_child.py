"""A process at the other end of a pipe: it ends when this one does, whatever it does then."""

import sys
import time
from collections.abc import Iterator
from multiprocessing.connection import Connection
from typing import Any

import pytest

from affcli import beside
from affcli.child import Child, received
from tests.cli.program import PATIENCE
from tests.test_beside import run_out, starts_and_dies


def busy(pipe: "Connection[Any, Any]") -> None:
    """Be busy for longer than any test, with the first piece."""
    pipe.send(received(pipe)())
    time.sleep(10.0 * PATIENCE)


def answering(pipe: "Connection[Any, Any]") -> None:
    """Send back what comes, without memory for a thread."""
    vars(beside)["start_new_thread"] = starts_and_dies
    following = received(pipe)
    while True:
        pipe.send(following())


class TooLarge:
    """There is no memory to unpack it."""

    def __reduce__(self) -> Any:
        return run_out, ()


@pytest.fixture
def begun(request: pytest.FixtureRequest) -> Iterator[Child]:
    child = Child(f"tests.test_child:{request.param}")
    child.pipe.send(sys.path)
    yield child
    child.end()


def answer(child: Child, piece: object) -> Any:
    child.pipe.send(piece)
    assert child.pipe.poll(PATIENCE)
    return child.pipe.recv()


@pytest.mark.parametrize("begun", ["busy", "answering"], indirect=True)
def test_it_ends_when_the_other_end_is_closed(begun: Child) -> None:
    """Also where there was no memory for the thread that sees to it: once it asks for more."""
    assert answer(begun, "piece") == "piece"
    begun.pipe.close()
    assert begun.process.wait(PATIENCE) == 1


@pytest.mark.fault(46)
@pytest.mark.parametrize("begun", ["answering"], indirect=True)
def test_it_ends_when_it_has_no_memory_for_what_comes(begun: Child) -> None:
    """It waited for ever for the thread that reads, which had died of it."""
    assert answer(begun, "piece") == "piece"
    with pytest.raises(EOFError):
        answer(begun, TooLarge())
    assert begun.process.wait(PATIENCE) == 1
