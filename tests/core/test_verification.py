"""The sequential test behind a verdict, against its definition and Wald's bounds."""

import math
from collections.abc import Sequence
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.core.affordance import PROBABILITY_THRESHOLD
from affcli.core.behavior import Execution, ExecutionStatus
from affcli.core.geometry import Pose
from affcli.core.trial import Attempt
from affcli.core.verification import (
    CHANGED,
    ERROR,
    INTACT,
    Evidence,
    Verdict,
    decided_after,
)
from tests.factories import EXTEND_5, affordance, moved_by, observation

ODDS = Fraction(99, 1)
"""(1 - ERROR) / ERROR."""


def attempt(*, replicated: bool, used: int = 1, successful: int = 1) -> Attempt:
    """Return a try of a row with these counters before it."""
    done = Execution(EXTEND_5, ExecutionStatus.DONE, Pose(0.0, 0.0), Pose(0.0, 5.0), 1.0)
    seen = moved_by(0.0, 5.0 if replicated else 0.0)
    row = affordance(used=used, successful=successful)
    start = observation()
    return Attempt(
        *(row, done, done, start, start, moved_by(0.0, 5.0), seen),
        replicated=replicated,
        regrasped=False,
        threshold=PROBABILITY_THRESHOLD,
    )


def tries(outcomes: Sequence[bool]) -> list[Attempt]:
    """Return tries of fresh rows."""
    return [attempt(replicated=replicated) for replicated in outcomes]


def naive(outcomes: Sequence[bool]) -> Verdict:
    """Return the verdict by multiplying the chances of all tries, in fractions."""
    ratio = Fraction(1)
    for replicated in outcomes:
        changed, intact = Fraction(1, 10), Fraction(1, 50)
        ratio *= (1 - changed) / (1 - intact) if replicated else changed / intact
    if ratio >= ODDS:
        return Verdict.CHANGED
    return Verdict.HOLDS if 1 / ratio >= ODDS else Verdict.UNDECIDED


outcomes = st.lists(st.booleans() | st.just(value=True) | st.just(value=True), max_size=120)
"""Mostly replications, as it is with an intact tool."""


@given(outcomes)
def test_the_verdict_is_that_of_the_product_of_all_chances(seen: list[bool]) -> None:
    evidence = Evidence.of(tries(seen))
    assert (evidence.tries, evidence.failures) == (len(seen), seen.count(False))
    assert evidence.verdict is naive(seen)


@given(outcomes)
def test_the_verdict_is_told_at_the_first_prefix_that_has_it(seen: list[bool]) -> None:
    prefixes = [naive(seen[:count]) for count in range(1, len(seen) + 1)]
    told = decided_after(tries(seen))
    if naive(seen) is Verdict.UNDECIDED:
        assert told is None
    else:
        assert told == prefixes.index(naive(seen)) + 1


@given(outcomes)
def test_the_order_of_the_tries_does_not_matter_to_the_evidence(
    seen: list[bool],
) -> None:
    assert Evidence.of(tries(seen)) == Evidence.of(tries(sorted(seen)))


def test_three_failures_at_once_are_enough_and_two_are_not() -> None:
    """ln 5 each, of ln 99."""
    assert Evidence(2, 2).verdict is Verdict.UNDECIDED
    assert Evidence(3, 3).verdict is Verdict.CHANGED


def test_an_unbroken_row_of_replications_is_enough_after_54() -> None:
    """ceil(ln 99 / ln(0.98 / 0.9)) = 54."""
    needed = math.ceil(math.log((1 - ERROR) / ERROR) / math.log((1 - INTACT) / (1 - CHANGED)))
    assert needed == 54
    assert Evidence(53, 0).verdict is Verdict.UNDECIDED
    assert Evidence(54, 0).verdict is Verdict.HOLDS


def test_without_tries_nothing_can_be_told() -> None:
    assert Evidence.of([]).verdict is Verdict.UNDECIDED
    assert decided_after([]) is None


@pytest.mark.parametrize(("used", "successful"), [(2, 1), (3, 1), (4, 0)])
def test_tries_of_excluded_rows_say_nothing(used: int, successful: int) -> None:
    """Of a row at 1/2 or less nothing is expected: a table that has adapted holds."""
    dead = [attempt(replicated=bool(n % 2), used=used, successful=successful) for n in range(99)]
    assert Evidence.of(dead) == Evidence()
    both = [*dead, *tries([True] * 54)]
    assert Evidence.of(both).verdict is Verdict.HOLDS
    assert decided_after(both) == 99 + 54


def wrong(failing: float, wrong_one: Verdict, most: int = 2000) -> float:
    """Return how often the first verdict is the wrong one, where tries fail independently.

    By the chances of all numbers of failures after each try that have come to no verdict so far.
    """
    alive, taken = {0: 1.0}, 0.0
    for count in range(1, most + 1):
        following: dict[int, float] = {}
        for failures, chance in alive.items():
            for failed, share in ((0, 1.0 - failing), (1, failing)):
                verdict = Evidence(count, failures + failed).verdict
                if verdict is Verdict.UNDECIDED:
                    now = following.get(failures + failed, 0.0)
                    following[failures + failed] = now + chance * share
                elif verdict is wrong_one:
                    taken += chance * share
        alive = following
    assert sum(alive.values()) < 1e-6
    return taken


@pytest.mark.parametrize(
    ("failing", "wrong_one"), [(INTACT, Verdict.CHANGED), (CHANGED, Verdict.HOLDS)]
)
def test_each_is_taken_for_the_other_no_oftener_than_wald_allows(
    failing: float, wrong_one: Verdict
) -> None:
    """Wald (1945): at most ERROR / (1 - ERROR), where tries fail independently."""
    assert wrong(failing, wrong_one) <= ERROR / (1.0 - ERROR)


def test_what_fails_less_or_more_is_mistaken_more_rarely_still() -> None:
    assert wrong(0.005, Verdict.CHANGED) < wrong(INTACT, Verdict.CHANGED) / 10
    assert wrong(0.3, Verdict.HOLDS) < wrong(CHANGED, Verdict.HOLDS) / 10
