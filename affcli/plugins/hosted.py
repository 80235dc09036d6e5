"""A part of another package in a process of its own: whatever it does there is one error here."""

import sys
import time
import weakref
from collections.abc import Callable, Mapping, Sequence
from itertools import count
from typing import Any

from affcli.child import GONE, Child
from affcli.core.part import Part
from affcli.errors import one_line
from affcli.plugins.entry_points import Offer

LOADING, ANSWERING = 30.0, 60.0
"""Seconds after which a part that loads, or is asked, is taken to do so for ever."""

Questions = Sequence[Callable[..., Any]]
"""What a part may ask while it is asked, by the numbers of `host.Question`."""


class Host:
    """The process in which a part runs; started when it is needed, and anew after a failure.

    Args:
        offer: the part.
    """

    def __init__(self, offer: Offer) -> None:
        self.offer = offer
        self._child: Child | None = None
        self._numbers = count()
        self._dropped: list[int] = []

    def part(self) -> Part:
        """Return the part, without what builds it; PartFailedError when it cannot be loaded."""
        told = self._ask(LOADING, (), "load", self.offer)
        if not isinstance(told, Part):
            raise self.offer.refused(f"it says that it is {one_line(told, 40)}")
        return told

    def make(self, args: tuple[Any, ...], values: Mapping[str, Any]) -> Any:
        """Return what the part builds, which is a value."""
        return self.ask("make", args, dict(values))

    def keep(
        self,
        owner: object,
        args: tuple[Any, ...],
        values: Mapping[str, Any],
        stream: int | None = None,
    ) -> int:
        """Build what is used there as long as its owner is here; return its number.

        Args:
            owner: stands for it here.
            args, values: what it is built with.
            stream: which of the arguments is a random stream, that is used here too.
        """
        number = next(self._numbers)
        self.ask("keep", number, args, dict(values), stream)
        weakref.finalize(owner, self._dropped.append, number)
        return number

    def ask(self, *request: Any, questions: Questions = ()) -> Any:
        """Return the answer to a request; the part is loaded first where it is not.

        Raises:
            PartFailedError: it raised an error, its process ended, or it takes for ever.
        """
        if self._child is None:
            self.part()
        return self._ask(ANSWERING, questions, *request)

    def end(self) -> None:
        """End the process, if there is one."""
        if self._child is not None:
            self._child.end()
        self._child = None

    def _ask(self, limit: float, questions: Questions, *request: Any) -> Any:
        """Ask the process, and answer its questions; no failure leaves a process behind."""
        try:
            kind, told = self._talk(limit, questions, request)
        except BaseException:
            self.end()
            raise
        if kind == "failed":
            raise self.offer.refused(str(told))
        return told

    def _talk(
        self, limit: float, questions: Questions, request: tuple[Any, ...]
    ) -> tuple[str, Any]:
        """Return whether it failed, and the answer, or why it did."""
        deadline = time.monotonic() + limit
        try:
            child = self._child or self._start()
            dropped = tuple(self._dropped)
            del self._dropped[: len(dropped)]
            child.pipe.send((dropped, *request))
            while child.pipe.poll(max(0.0, deadline - time.monotonic())):
                kind, *told = _received(child)
                if kind != "question":
                    return kind, told[0]
                child.pipe.send(_answered(questions, *told))
        except GONE as error:
            raise self.offer.refused(f"its process ended ({self._how_it_ended()})") from error
        except OSError as error:
            raise self.offer.refused(f"it has no process ({error.strerror})") from error
        raise self.offer.refused(f"no answer within {limit:g} s")

    def _start(self) -> Child:
        """Start a process that serves."""
        self._child = Child("affcli.plugins.host:serve")
        self._child.pipe.send(sys.path)
        return self._child

    def _how_it_ended(self) -> str:
        """Return how the process ended, which it did."""
        code = self._child.process.wait() if self._child is not None else 0
        return f"signal {-code}" if code < 0 else f"exit code {code}"


def _received(child: Child) -> tuple[Any, ...]:
    """Return what a process says; what cannot be read is said to have failed."""
    try:
        kind, *told = child.pipe.recv()
    except GONE:
        raise
    except Exception as error:  # noqa: BLE001  # classes of its own, which are not here
        return "failed", f"its answer cannot be read: {one_line(error, 100)}"
    return kind, *told


def _answered(
    questions: Questions, number: int, args: tuple[Any, ...], named: Mapping[str, Any]
) -> tuple[bool, Any]:
    """Return whether a question took its arguments, and the answer, or why it did not."""
    try:
        return True, questions[number](*args, **named)
    except Exception as error:  # noqa: BLE001  # by what a stranger's code asks
        return False, one_line(error, 100)
