"""How many robots it takes: against SciPy's noncentral t, and against its own inverse."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy import stats

from affcli.analysis.power import (
    MOST,
    Plan,
    Untold,
    least_robots,
    plan,
    power,
    robots_needed,
    visible_difference,
)
from affcli.core.results import Cell

spreads = st.floats(0.2, 20.0)
differences = st.floats(0.1, 20.0)


@given(st.integers(6, 400), differences, spreads)
def test_power_is_that_of_the_noncentral_t(robots: int, difference: float, spread: float) -> None:
    assume(difference / spread * math.sqrt(robots) < 8.0)  # beyond, SciPy has a number but for some
    bound = stats.t.ppf(0.975, robots - 1)
    theirs = stats.nct(robots - 1, difference / spread * math.sqrt(robots))
    assert power(robots, difference, spread, 0.05) == pytest.approx(
        theirs.sf(bound) + theirs.cdf(-bound), abs=1e-6
    )


@given(differences, spreads, st.sampled_from([0.05, 0.05 / 24]), st.sampled_from([0.5, 0.8, 0.9]))
def test_one_robot_fewer_is_too_few(
    difference: float, spread: float, level: float, wanted: float
) -> None:
    robots = robots_needed(difference, spread, level, wanted)
    assert robots is not None
    assert power(robots, difference, spread, level) >= wanted
    assert robots == least_robots(level) or (power(robots - 1, difference, spread, level) < wanted)
    visible = visible_difference(robots, spread, level, wanted)
    assert visible is not None
    assert visible <= difference * (1.0 + 1e-6)


def test_the_exact_test_needs_robots_of_its_own() -> None:
    """Six that all differ alike reach 2 / 2^6 = 0.031; five reach no more than 0.063."""
    assert least_robots(0.05) == 6
    assert power(5, 80.0, 0.1, 0.05) == 0.0
    assert visible_difference(5, 1.0, 0.05, 0.8) is None


def test_a_published_example() -> None:
    """Cohen 1988: an effect of 0.5 in pairs, two-sided at 5 %, has a power of 0.8 from 34 on."""
    assert robots_needed(0.5, 1.0, 0.05, 0.8) == 34


def test_more_robots_than_can_be_counted_are_none() -> None:
    assert robots_needed(1e-6, 10.0, 0.05, 0.8) is None
    assert MOST > 1_000_000


def test_counts_of_one_condition_are_taken_for_those_of_another() -> None:
    counts = [60, 64, 71, 66, 75, 69]
    paired = plan(Cell("p", "t"), counts, None, [2.0], 0.05, 0.8)
    alone = plan(Cell("p", "t"), counts, 0.0, [2.0], 0.05, 0.8)
    together = plan(Cell("p", "t"), counts, 0.5, [2.0], 0.05, 0.8)
    assert isinstance(paired, Plan)
    assert isinstance(alone, Plan)
    assert isinstance(together, Plan)
    assert alone.spread == pytest.approx(paired.spread * math.sqrt(2.0))
    assert together.spread == pytest.approx(paired.spread)


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ([1, 2, 3, 4], "fewer than 5 robots"),
        ([4] * 4, "fewer than 5 robots"),
        ([4] * 30 + [3], "too few robots differ"),
    ],
)
def test_what_tells_nothing_says_why(values: list[int], why: str) -> None:
    cell = Cell("p", "t")
    assert plan(cell, values, 0.0, [1.0], 0.05, 0.8) == Untold(cell, why)
