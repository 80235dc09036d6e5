"""The process in which a part of another package runs, and what it answers to this one."""

import traceback
from collections.abc import Callable
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from typing import Any

from affcli.child import received
from affcli.core.identity import Component
from affcli.core.part import Part
from affcli.errors import one_line
from affcli.plugins.entry_points import Offer

LONGEST_WORDS = 300
"""Letters of what is said of an error."""


def loaded(offer: Offer) -> Part:
    """Return the part that a package offers; ValueError or TypeError when it is none."""
    part = offer.entry_point.load()
    if not isinstance(part, Part):
        raise TypeError(f"{offer.value} is no affcli.core.part.Part")
    if (part.kind, part.name) != (offer.kind, offer.name):
        raise ValueError(f"{offer.value} is the {part.kind} {one_line(part.name, 40)}")
    if part.told:
        raise ValueError("a plug-in is told nothing that no robot sees; leave told out")
    # What could not be read back from a record is no name, no version, no parameter.
    own = replace(part, package=offer.package)
    written = own.component({name: one.low for name, one in part.params.items()})
    if Component.parse(str(written)) != written:
        raise ValueError(f"{one_line(written, 80)} cannot be read back")
    return own


def not_here(*_: Any, **__: Any) -> Any:
    """Stand for what builds a part that is in another process."""
    raise NotImplementedError


class _Conversation:
    """What is said with the other process, and what was made for it.

    Args:
        pipe: to the other process.
    """

    def __init__(self, pipe: "Connection[Any, Any]") -> None:
        self.pipe, self.next = pipe, received(pipe)
        self._part: Part | None = None
        self._made: dict[int, Any] = {}
        self._streams: dict[int, Any] = {}

    def answer(self, dropped: tuple[int, ...], what: str, *args: Any) -> Any:
        """Do what is asked for; let go of what was dropped meanwhile."""
        for number in dropped:
            self._made.pop(number, None)
            self._streams.pop(number, None)
        asked: Callable[..., Any] = getattr(self, f"_{what}")
        return asked(*args)

    def _load(self, offer: Offer) -> Part:
        """Load the part; return it without what builds it, which is here."""
        self._part = loaded(offer)
        return replace(self._part, build=not_here)

    def _make(self, args: tuple[Any, ...], values: dict[str, Any]) -> Any:
        """Build what is a value."""
        assert self._part is not None  # noqa: S101  # it is loaded first
        return self._part.build(*args, **values)

    def _keep(
        self, number: int, args: tuple[Any, ...], values: dict[str, Any], stream: int | None
    ) -> None:
        """Build what is to be used here, with a random stream that is one of its arguments."""
        self._made[number] = self._make(args, values)
        if stream is not None:
            self._streams[number] = args[stream]

    def _call(self, number: int, name: str, args: tuple[Any, ...], state: Any) -> tuple[Any, Any]:
        """Call a method, or read an attribute; the random stream stands where it is told, and it is
        said where it stands then.
        """
        stream = self._streams.get(number)
        if stream is not None:
            stream.bit_generator.state = state
        found = getattr(self._made[number], name)
        answer = found(*args) if callable(found) else found
        return answer, None if stream is None else stream.bit_generator.state


@dataclass(frozen=True, slots=True)
class Question:
    """A function of the other process, which is asked when it is called.

    Args:
        number: which of those that came with a request.
    """

    number: int

    def __call__(self, *args: Any, **named: Any) -> Any:
        """Ask; TypeError for arguments that it does not take."""
        (talk,) = _talking
        talk.pipe.send(("question", self.number, args, named))
        took, answer = talk.next()
        if not took:
            raise TypeError(answer)
        return answer


_talking: list[_Conversation] = []
"""The one conversation of a process that serves."""


def serve(pipe: "Connection[Any, Any]") -> None:
    """Answer requests until the other process ends."""
    talk = _Conversation(pipe)
    _talking.append(talk)
    while True:
        request = talk.next()
        try:
            said: tuple[str, Any] = "answer", talk.answer(*request)
        except BaseException as error:  # noqa: BLE001  # whatever a stranger's code raises
            said = "failed", words_of(error)
        try:
            pipe.send(said)
        except Exception as error:  # noqa: BLE001  # what no pipe can carry
            pipe.send(("failed", f"its answer cannot be sent: {words_of(error)}"))


def words_of(error: BaseException) -> str:
    """Return an error in a line, with the place in a file where it was raised."""
    files = [one for one in traceback.extract_tb(error.__traceback__) if one.filename[:1] != "<"]
    own = [one for one in files if one.filename != __file__]
    place = f" ({own[-1].filename.rpartition('/')[2]}, line {own[-1].lineno})" if own else ""
    said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return one_line(said, LONGEST_WORDS) + place
