"""The statistics against their definitions and against scipy."""

from collections.abc import Sequence
from fractions import Fraction
from statistics import fmean

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from affcli.analysis.statistics import (
    ENOUGH_OFF,
    ENOUGH_ROBOTS,
    FEWEST,
    HIGH,
    LOW,
    Spread,
    exact_interval,
    mean_interval,
    quantile,
    saturates,
    t95,
)

successes = st.lists(st.integers(0, 80), min_size=1, max_size=250)


def smallest(counts: Sequence[int], share: Fraction) -> int:
    """Return the smallest k with P(X <= k) >= share, trying every k."""
    share_of = {k: Fraction(sum(x <= k for x in counts), len(counts)) for k in range(81)}
    return next(k for k in range(81) if share_of[k] >= share)


@given(successes)
def test_low_and_high_are_the_smallest_k_with_so_much_below(counts: list[int]) -> None:
    """low = smallest k with P(X <= k) >= 0.025, high = smallest k with P(X <= k) >= 0.975."""
    spread = Spread.of(counts)
    assert spread.low == smallest(counts, Fraction(25, 1000))
    assert spread.high == smallest(counts, Fraction(975, 1000))


@pytest.mark.parametrize("robots", [1, 2, 39, 40, 41, 80, 200, 1000])
def test_exactly_the_share_is_enough(robots: int) -> None:
    """Of 200 robots 5 are 0.025, whatever the last bit of the product says."""
    for rare in range(min(robots, 60)):
        counts = [0] * rare + [1] * (robots - rare)
        assert quantile(counts, LOW) == smallest(counts, Fraction(25, 1000))
        counts = [0] * (robots - rare) + [1] * rare
        assert quantile(counts, HIGH) == smallest(counts, Fraction(975, 1000))


@given(successes, st.integers(0, 80))
def test_the_papers_count_is_inside_from_low_to_high_of_many_robots(
    counts: list[int], paper: int
) -> None:
    spread = Spread.of(counts)
    assert min(counts) <= spread.low <= spread.high <= max(counts)
    if len(counts) < ENOUGH_ROBOTS:
        assert (spread.low, spread.high) == (min(counts), max(counts))
        assert spread.holds(paper) is None
    else:
        assert spread.holds(paper) is (spread.low <= paper <= spread.high)


@given(st.lists(st.integers(0, 80), min_size=FEWEST, max_size=250))
def test_the_interval_of_the_mean_is_scipys_where_there_is_one(counts: list[int]) -> None:
    found = mean_interval(counts)
    assert (found is None) == saturates(counts)
    if found is not None:
        error = stats.sem(counts)
        theirs = stats.t.interval(0.95, len(counts) - 1, loc=fmean(counts), scale=error)
        assert found == pytest.approx(theirs)
        assert Spread.of(counts, 80).mean_ci == (max(0.0, found[0]), min(80.0, found[1]))


@given(st.integers(FEWEST, 300), st.integers(0, 150))
def test_a_mean_saturates_when_few_robots_are_off_the_commonest_value(n: int, off: int) -> None:
    counts = [4] * n + [3] * off
    fewer, more = sorted((n, off))
    assert saturates(counts) == (more > (n + off + 1) // 2 and fewer < ENOUGH_OFF)
    assert saturates(counts[::-1]) == saturates(counts)


@pytest.mark.parametrize("robots", range(1, FEWEST))
def test_few_robots_have_no_interval(robots: int) -> None:
    assert mean_interval([60.6, 74.4, 68.0, 70.0][:robots]) is None


@pytest.mark.parametrize("freedom", [1, 2, 3, 4, 5, 7, 15, 19, 30, 99, 1000])
def test_the_quantile_of_students_t_is_scipys(freedom: int) -> None:
    assert t95(freedom) == pytest.approx(stats.t.ppf(0.975, freedom))


def test_one_robot_has_no_spread() -> None:
    assert Spread.of([3]) == Spread(3.0, None, 3, 3, 1)


def test_no_robots_are_an_error() -> None:
    with pytest.raises(ValueError, match="mean requires at least one data point"):
        Spread.of([])


@given(st.integers(1, 5000).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_the_interval_of_a_share_is_scipys(share: tuple[int, int]) -> None:
    theirs = stats.binomtest(*share).proportion_ci(0.95, method="exact")
    assert exact_interval(*share) == pytest.approx((theirs.low, theirs.high), abs=1e-9)


def test_all_or_none_end_the_interval_and_nothing_leaves_it_open() -> None:
    assert exact_interval(0, 7) == pytest.approx((0.0, 1.0 - 0.025 ** (1 / 7)))
    assert exact_interval(7, 7) == pytest.approx((0.025 ** (1 / 7), 1.0))
    assert exact_interval(0, 0) == (0.0, 1.0)


def test_the_exact_interval_is_that_of_a_published_table() -> None:
    """Newcombe 1998 (Statistics in Medicine 17), table I, method 5."""
    for kind, n, low, high in (
        (81, 263, 0.2527, 0.3676),
        (15, 148, 0.0578, 0.1617),
        (0, 20, 0.0, 0.1684),
        (1, 29, 0.0009, 0.1776),
    ):
        assert exact_interval(kind, n) == pytest.approx((low, high), abs=5e-5)
