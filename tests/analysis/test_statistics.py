"""The statistics against their definitions and against scipy."""

from collections.abc import Sequence
from fractions import Fraction
from statistics import fmean

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from affcli.analysis.statistics import HIGH, LOW, Spread, quantile, t95, wilson

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
def test_the_papers_count_is_inside_from_low_to_high(counts: list[int], paper: int) -> None:
    spread = Spread.of(counts)
    assert min(counts) <= spread.low <= spread.high <= max(counts)
    assert spread.holds(paper) == (spread.low <= paper <= spread.high)
    assert spread.holds(spread.low)
    assert spread.holds(spread.high)


@given(st.lists(st.integers(0, 80), min_size=2, max_size=250))
def test_the_interval_of_the_mean_is_scipys(counts: list[int]) -> None:
    spread = Spread.of(counts)
    assert spread.mean == pytest.approx(fmean(counts))
    assert spread.mean_ci is not None
    error = stats.sem(counts)
    if error == 0:
        assert spread.mean_ci == (spread.mean, spread.mean)
    else:
        theirs = stats.t.interval(0.95, len(counts) - 1, loc=fmean(counts), scale=error)
        assert spread.mean_ci == pytest.approx(theirs, abs=0.002 * error * 3.2)


@pytest.mark.parametrize("freedom", [1, 2, 3, 4, 5, 7, 15, 19, 30, 99, 1000])
def test_the_quantile_of_students_t_is_scipys(freedom: int) -> None:
    assert t95(freedom) == pytest.approx(stats.t.ppf(0.975, freedom), rel=0.002)


def test_one_robot_has_no_spread() -> None:
    assert Spread.of([3]) == Spread(3.0, None, 3, 3)


def test_no_robots_are_an_error() -> None:
    with pytest.raises(ValueError, match="mean requires at least one data point"):
        Spread.of([])


@given(st.integers(1, 5000).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_the_interval_of_a_share_is_scipys(share: tuple[int, int]) -> None:
    theirs = stats.binomtest(*share).proportion_ci(0.95, method="wilson")
    assert wilson(*share) == pytest.approx((theirs.low, theirs.high), abs=1e-12)


def test_all_or_none_end_the_interval_and_nothing_leaves_it_open() -> None:
    assert wilson(0, 7)[0] == 0.0
    assert wilson(7, 7)[1] == 1.0
    assert wilson(0, 0) == (0.0, 1.0)


def test_wilson_s_interval_is_that_of_a_published_table() -> None:
    """Newcombe 1998 (Statistics in Medicine 17), table I."""
    for kind, n, low, high in (
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ):
        assert wilson(kind, n) == pytest.approx((low, high), abs=5e-5)
