"""Paired differences: what must hold whatever the counts, and SciPy's own numbers."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from affcli.analysis.paired import Comparison, Difference, all_tried, holm, sign_flip_p
from affcli.core.results import Cell, ConditionCounts
from affcli.core.specs import Protocol
from tests.report.hand_made import TASK_SET, session_of

REACH = Protocol.EXTENSION_OF_REACH.value
STICK, HOOK = (Cell(REACH, TASK_SET, tool, tool, "1") for tool in ("stick", "t-hook"))
BROKEN = Cell(Protocol.TOOL_ADAPTATION.value, TASK_SET, "t-hook", "l-hook", "1")

counts = st.integers(0, 4)
pairs = st.lists(st.tuples(counts, counts), min_size=1, max_size=40)
small = st.lists(st.integers(-4, 4), min_size=2, max_size=10)


def condition(
    name: str, *cells: list[int], seed: int = 1000, first: int = 0, trials: int = 4
) -> ConditionCounts:
    """Return a condition by what its robots solved: with stick, T-hook, broken T-hook."""
    found = {
        cell: {robot: (trials, solved) for robot, solved in enumerate(own, first)}
        for cell, own in zip((STICK, HOOK, BROKEN), cells, strict=False)
    }
    return ConditionCounts(name, session_of(1, seed=seed), found)


def difference(found: list[tuple[int, int]]) -> Difference:
    return Difference.of("other", STICK, found, 4)


@given(small)
def test_the_test_is_scipys_that_tries_all_signs(differences: list[int]) -> None:
    theirs = stats.permutation_test(
        (np.array(differences),),
        lambda x, axis: x.sum(axis=axis),
        permutation_type="samples",
        n_resamples=np.inf,
    )
    assert sign_flip_p(differences) == pytest.approx(theirs.pvalue)


@given(st.integers(0, 60), st.integers(0, 60), st.integers(0, 60))
def test_of_differences_of_one_size_it_is_the_sign_test(up: int, down: int, none: int) -> None:
    p = stats.binomtest(up, up + down).pvalue if up + down else 1.0
    assert sign_flip_p([2] * up + [-2] * down + [0] * none) == pytest.approx(p)


@given(pairs)
def test_swapping_the_conditions_flips_the_signs_and_nothing_else(
    found: list[tuple[int, int]],
) -> None:
    one, other = difference(found), difference([(after, before) for before, after in found])
    assert other.mean == pytest.approx(-one.mean)
    assert (other.better, other.worse, other.p) == (one.worse, one.better, one.p)
    assert (one.interval is None) == (other.interval is None)
    if one.interval and other.interval:
        assert other.interval == pytest.approx((-one.interval[1], -one.interval[0]))
    if one.effect is not None:
        assert other.effect == pytest.approx(-one.effect)
    assert other.better_share == pytest.approx([1.0 - x for x in one.better_share[::-1]], abs=1e-9)


@given(pairs, st.randoms())
def test_the_order_of_the_robots_does_not_matter(
    found: list[tuple[int, int]], random: st.DataObject
) -> None:
    mixed = found.copy()
    random.shuffle(mixed)  # type: ignore[attr-defined]
    one, other = difference(found), difference(mixed)
    assert other.p == pytest.approx(one.p)
    assert replace(one, p=0.0, corrected=0.0, effect=None) == replace(
        other, p=0.0, corrected=0.0, effect=None
    )


@given(st.lists(counts, min_size=1, max_size=40))
def test_equal_conditions_give_zero_and_are_reported_apart(own: list[int]) -> None:
    result = Comparison.of(condition("a", own, own), [condition("b", own, own)])
    assert result.cells == ()
    assert [one.cell for one in result.same] == [STICK, HOOK]
    (total,) = result.totals
    assert (total.mean, total.p, total.significant, total.effect) == (0.0, 1.0, False, None)
    assert total.agree


def test_a_difference_has_student_s_interval_where_it_holds() -> None:
    found = [(2, 3), (1, 3), (2, 2), (0, 3), (2, 1), (1, 2)]
    one = difference(found)
    gains = [after - before for before, after in found]
    theirs = stats.ttest_1samp(gains, 0.0).confidence_interval(0.95)
    assert one.interval == pytest.approx((theirs.low, theirs.high))
    assert one.effect == pytest.approx(np.mean(gains) / np.std(gains, ddof=1))
    assert (one.better, one.worse) == (4, 1)
    exact = stats.binomtest(4, 5).proportion_ci(0.95, method="exact")
    assert one.better_share == pytest.approx((exact.low, exact.high))
    assert difference([(4, 4)] * 30 + [(4, 3)] * 3).interval is None
    assert difference(found[:4]).interval is None


@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=30))
def test_corrected_p_are_those_of_holm(ps: list[float]) -> None:
    """Each the largest of (m - k + 1) p(k) over those that are no larger, at most 1."""
    found = holm([replace(difference([(1, 2)]), p=p) for p in ps])
    for one in found:
        steps = [(len(ps) - rank) * p for rank, p in enumerate(sorted(ps)) if p <= one.p]
        assert one.corrected == pytest.approx(min(1.0, max(steps)))
        assert one.corrected >= one.p
        assert one.significant == (one.corrected <= 0.05)


def test_totals_are_sums_by_protocol_and_each_table_is_corrected_by_itself() -> None:
    base = condition("base", [1] * 12, [2] * 12, [4] * 12)
    better = condition("better", [3] * 12, [2] * 12, [3] * 11 + [4])
    result = Comparison.of(base, [better])
    reach, broken = result.totals
    assert (reach.cell, broken.cell) == (Cell(REACH, TASK_SET), Cell(BROKEN.protocol, TASK_SET))
    assert (reach.before, reach.after, reach.trials) == (3.0, 5.0, 8.0)
    assert [one.cell for one in result.cells] == [STICK, BROKEN]
    assert [one.cell for one in result.same] == [HOOK]
    for table in (result.totals, result.cells):
        assert min(one.corrected for one in table) == 2 * min(one.p for one in table)
    assert result.left_out == {}


def test_totals_in_which_all_robots_agree_take_nothing_from_the_others() -> None:
    base = condition("base", [1] * 12, [2] * 12, [4] * 12)
    reach, broken = Comparison.of(base, [condition("b", [3] * 12, [2] * 12, [4] * 12)]).totals
    assert reach.corrected == reach.p == 2 * 0.5**12
    assert (broken.agree, broken.corrected) == (True, 1.0)


def test_robots_pair_by_number_and_those_that_do_not_are_said() -> None:
    base, other = condition("base", [1, 2, 3, 4]), condition("other", [2, 3, 4, 4], first=1)
    cells = {STICK: {**other.cells[STICK], 3: (3, 3)}}
    result = Comparison.of(base, [replace(other, cells=cells)])
    (one,) = result.same
    assert (one.robots, one.before, one.after) == (2, 2.5, 2.5)
    assert result.left_out == {"other": (0, 3, 4)}


@pytest.mark.parametrize(
    "other", [condition("other", [1, 2], seed=7), condition("other", [1, 2], first=5)]
)
def test_without_a_robot_in_common_nothing_is_compared(other: ConditionCounts) -> None:
    with pytest.raises(ValueError, match="base and other have no robot in common"):
        Comparison.of(condition("base", [1, 2]), [other])


def test_cells_that_only_one_condition_has_are_named_and_not_summed() -> None:
    base, other = condition("base", [1] * 6, [2] * 6), condition("other", [3] * 6)
    result = Comparison.of(base, [other, condition("third", [1] * 6, [2] * 6, [4] * 6)])
    hook, broken = HOOK._replace(goal=""), Cell(BROKEN.protocol, TASK_SET)
    assert result.unshared == {"other": (hook,), "third": (broken,)}
    assert [(d.condition, d.cell, d.trials, d.mean) for d in result.totals] == [
        ("other", Cell(REACH, TASK_SET), 4.0, 2.0),
        ("third", Cell(REACH, TASK_SET), 8.0, 0.0),
    ]
    assert result.left_out == {}


@pytest.mark.parametrize("by", [(), ("tool", "shape"), ("goal",), ("tool", "shape", "goal")])
def test_what_tells_cells_apart_does_not_change_the_totals(by: tuple[str, ...]) -> None:
    """A tool, and a goal of the other, that one condition alone has are in no total."""
    again = STICK._replace(goal="2")
    base, other = condition("base", [1, 2, 3], [4, 4, 4]), condition("other", [2, 2, 3])
    base = replace(base, cells={**base.cells, again: dict.fromkeys(range(3), (4, 4))})
    result = Comparison.of(base, [other], by)
    (total,) = result.totals
    assert (total.trials, total.before, total.changes) == (4.0, 2.0, (0, 0, 1))
    assert [one.trials for one in (*result.cells, *result.same)] == [4.0] * bool(by)
    assert result.unshared == {"other": (HOOK._replace(goal=""), again)}


def test_robots_with_an_invalid_trial_have_not_tried_all() -> None:
    assert all_tried({0: (4, 3), 1: (3, 3), 2: (4, 0)}) == [3, 0]
