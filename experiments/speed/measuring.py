"""Medians of interleaved rounds, bars, and commands as whole processes."""

import json
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, ParamSpec, TypeVar

ROUNDS = 8
LAUNCHER = Path(__file__).with_name("launcher.py")
AFFCLI = Path(sys.executable).with_name("affcli")

P = ParamSpec("P")
R = TypeVar("R")


class Scale(NamedTuple):
    """How much is measured.

    Args:
        full: the long ones too.
        tiny: just enough to see that everything runs; the figures say nothing.
    """

    full: bool
    tiny: bool

    def of(self, usual: int, tiny: int, full: int | None = None) -> int:
        """Return the size that fits."""
        if self.tiny:
            return tiny
        return full if self.full and full is not None else usual


class Took(NamedTuple):
    """Seconds that something took: on the wall, and of the processor."""

    wall: float
    cpu: float


def took(work: Callable[P, R], *args: P.args, **named: P.kwargs) -> tuple[Took, R]:
    """Return how long `work` takes in this process with these arguments, and what it returns."""
    cpu, wall = time.process_time(), time.perf_counter()
    result = work(*args, **named)
    return Took(time.perf_counter() - wall, time.process_time() - cpu), result


class Ratios(NamedTuple):
    """Ratios of rounds: their median, and the lowest and highest."""

    median: float
    low: float
    high: float
    rounds: int

    def __str__(self) -> str:
        return f"{self.median:.3g}x [{self.low:.3g} to {self.high:.3g}]"

    def json(self, name: str = "ratio") -> dict[str, Any]:
        """Return it as JSON types, under `name`."""
        return {name: self.median, f"{name}_spread": [self.low, self.high], "rounds": self.rounds}


def ratios(above: Sequence[float], below: Sequence[float]) -> Ratios:
    """Return how the figures of one thing relate to those of another, round by round."""
    each = [a / b for a, b in zip(above, below, strict=True)]
    return Ratios(statistics.median(each), min(each), max(each), len(each))


def bar(value: float, *, least: float | None = None, most: float | None = None) -> dict[str, Any]:
    """Return a bar and whether `value` is on the right side of it."""
    if least is not None:
        return {"bar": least, "met": value >= least}
    return {"bar": most, "met": most is not None and value <= most}


def verdict(held: dict[str, Any], unit: str = "x", *, least: bool = True) -> str:
    """Return the words for what `bar` returned."""
    sign = ">=" if least else "<="
    return f"bar: {sign} {held['bar']:g}{unit}, {'met' if held['met'] else 'MISSED'}"


class Ended(NamedTuple):
    """A command that ended well.

    Args:
        wall: seconds.
        cpu: seconds of the processor, those of its own children too.
        peak: memory of its largest process (bytes).
    """

    wall: float
    cpu: float
    peak: int


def command(*words: str | Path) -> Ended:
    """Run a command as a whole process to its end.

    Raises:
        RuntimeError: it failed; with the last line it wrote.
    """
    given = [sys.executable, "-S", "-E", str(LAUNCHER), *map(str, words)]
    went = json.loads(subprocess.run(given, capture_output=True, check=True).stdout)
    if went["code"]:
        raise RuntimeError(f"{words[0]} ended with {went['code']}: {went['last']}")
    return Ended(went["wall"], went["cpu"], went["peak"])
