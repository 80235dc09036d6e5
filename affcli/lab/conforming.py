"""A part of the registry held to the contract of its kind (`affcli.testing`)."""

import sys
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from typing import Any, NamedTuple

from affcli.child import GONE, Child
from affcli.core.part import Kind
from affcli.core.setting import Value
from affcli.errors import UsageError, one_line

LONGEST_LOADING, LONGEST_TEST = 120.0, 120.0
"""Seconds after which the suite is taken to load, or a test to go on, for ever."""


class Verdict(NamedTuple):
    """What came of a test.

    Args:
        what: which, in words.
        outcome: ``passed``, ``failed`` or ``skipped``.
        why: it failed.
    """

    what: str
    outcome: str
    why: str = ""


def conforming(kind: Kind, name: str, values: Mapping[str, Value]) -> Iterator[Verdict]:
    """Yield what comes of each test of a part's suite, in a process of its own.

    Args:
        kind: what it is one of.
        name: of the part.
        values: its parameters.

    Raises:
        UsageError: pytest is not installed.
    """
    if find_spec("pytest") is None:
        raise UsageError("the suites need pytest; install it: pip install pytest")
    child = Child("affcli.testing.serving:serve")
    try:
        child.pipe.send(sys.path)
        child.pipe.send((kind, name, dict(values)))
        yield from _verdicts(child)
    finally:
        child.end()


def _verdicts(child: Child) -> Iterator[Verdict]:
    """Yield what a process says of its tests, or how it ended before it had said all."""
    doing, longest = "it is loaded", LONGEST_LOADING
    while True:
        try:
            told: Any = child.pipe.recv() if child.pipe.poll(longest) else None
        except GONE:
            code = child.process.wait()
            how = f"signal {-code}" if code < 0 else f"exit code {code}"
            yield Verdict(doing, "failed", f"the process ended ({how})")
            return
        if told is None:
            yield Verdict(doing, "failed", f"no end within {longest:g} s")
            return
        longest = LONGEST_TEST
        what, test, *why = told
        if what == "ended":
            return
        if what == "begun":
            doing = _words(test)
        else:
            yield Verdict(_words(test), what, one_line("".join(why).partition("\n")[0], 300))


def _words(test: str) -> str:
    """Return the name of a test as a sentence: it is one."""
    return one_line(test.rpartition("::")[2].removeprefix("test_").replace("_", " "), 120)
