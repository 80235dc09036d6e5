"""How many cases: a few and always the same ones, or as many as some minutes hold."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import hypothesis
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st

MINUTES = "AFFCLI_FUZZ_MINUTES"
"""How long all the tests of this folder take together, in minutes of wall clock, one after the
other, when they are tortured."""
FIRST_SEED = "AFFCLI_FUZZ_SEED"
"""Where the seeds begin; else at the time, so that no two runs are alike."""
USUAL_MINUTES = 10.0


@dataclass(frozen=True, slots=True)
class Fuzzed:
    """What was tried: a word for it, how many cases, the seeds, and how long it took (s)."""

    kind: str
    cases: int
    seeds: str
    seconds: float

    def __str__(self) -> str:
        return f"{self.kind}: {self.cases} cases, {self.seeds}, {self.seconds / 60.0:.1f} min"


def fuzz(
    kind: str,
    check: Callable[[Any], None],
    cases: st.SearchStrategy[Any],
    *,
    few: int,
    share: float | None,
) -> Fuzzed:
    """Try cases until one fails.

    Args:
        kind: a word for what is tried.
        check: fails when something does not hold of a case.
        cases: to draw from.
        few: how many without a share; always the same ones.
        share: of the minutes that all tests may take; None for a normal run.
    """
    tried = 0

    def counted(case: Any) -> None:
        nonlocal tried
        tried += 1
        check(case)

    began = time.monotonic()
    bounds = settings(
        database=None,
        deadline=None,
        print_blob=True,
        suppress_health_check=list(HealthCheck),
        phases=(Phase.explicit, Phase.generate, Phase.shrink),
    )
    given = hypothesis.given(cases)
    if share is None:
        settings(bounds, max_examples=few, derandomize=True)(given(counted))()
        return Fuzzed(kind, tried, "derandomized", time.monotonic() - began)
    minutes = share * float(os.environ.get(MINUTES, USUAL_MINUTES))
    first = seed = int(os.environ.get(FIRST_SEED, time.time_ns() // 1_000_000_000))
    while time.monotonic() < began + 60.0 * minutes:
        hypothesis.seed(seed)(settings(bounds, max_examples=max(few, 100))(given(counted)))()
        seed += 1
    return Fuzzed(kind, tried, f"seeds {first} to {seed - 1}", time.monotonic() - began)
