"""Shares of vain tries and mean probabilities, against hand-made trials and a naive count."""

from collections.abc import Sequence
from dataclasses import replace
from statistics import fmean

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.lines import Line2D
from matplotlib.text import Text

from affcli.analysis.adaptation import (
    AdaptationCourse,
    MeanProbability,
    Share,
    probabilities_of,
    share_interval,
    shares_of,
)
from affcli.analysis.statistics import exact_interval, t95
from affcli.core.results import StepSums, TrialGroup
from affcli.report.captions import adaptation_words
from affcli.report.figures.adaptation import adaptation_figure
from affcli.report.figures.canvas import BLUE, ONE_COLUMN, VERMILION, encoded
from tests.report.hand_made import session_of

Course = list[tuple[bool, float]]
"""A trial by its steps: whether the row tried was lost; change of the mean probability."""

courses: st.SearchStrategy[Course] = st.lists(
    st.tuples(st.booleans(), st.floats(-0.01, 0.0)), max_size=12
)
robots = st.lists(st.lists(courses, min_size=3, max_size=3), min_size=1, max_size=30)


def group_of(trials: Sequence[Course]) -> TrialGroup:
    """Sum trials as the database does."""
    steps = []
    for number in range(1, max(map(len, trials), default=0) + 1):
        taken = [trial[number - 1] for trial in trials if len(trial) >= number]
        changes = sum(change for _, change in taken)
        steps.append(StepSums(number, len(taken), sum(lost for lost, _ in taken), changes))
    return TrialGroup(1, len(trials), len(trials), tuple(steps))


def single(*trials: Course) -> list[TrialGroup]:
    """Return trials that stand for themselves."""
    return [group_of([trial]) for trial in trials]


def test_the_share_is_of_the_trials_that_still_run() -> None:
    groups = single(
        [(True, -0.1)],
        [(True, -0.1), (True, -0.1), (False, 0.0)],
        [(False, 0.0), (False, 0.0)],
        [],
    )
    shares = shares_of(groups)
    assert [(s.number, s.trials, s.share) for s in shares] == [
        (1, 3, pytest.approx(2 / 3)),
        (2, 2, 0.5),
        (3, 1, 0.0),
    ]


def test_a_trial_that_ended_keeps_its_last_probability() -> None:
    groups = single([(True, -0.1)], [(True, -0.1), (True, -0.1), (False, 0.05)], [])
    means = probabilities_of(groups, 4)
    assert [m.number for m in means] == [0, 1, 2, 3, 4]
    assert [m.mean for m in means] == pytest.approx(
        [1.0, (0.9 + 0.9 + 1) / 3, (0.9 + 0.8 + 1) / 3, (0.9 + 0.85 + 1) / 3, (0.9 + 0.85 + 1) / 3]
    )


@given(robots)
def test_summed_by_robot_or_not_shares_and_probabilities_are_those_of_the_trials(
    lives: list[list[Course]],
) -> None:
    trials = [trial for life in lives for trial in life]
    longest = max(map(len, trials))
    by_robot = [group_of(life) for life in lives]
    for groups in (by_robot, single(*trials)):
        shares = shares_of(groups)
        assert [s.number for s in shares] == list(range(1, longest + 1))
        for share in shares:
            taken = [trial[share.number - 1][0] for trial in trials if len(trial) >= share.number]
            assert share.trials == len(taken)
            assert share.share == pytest.approx(fmean(taken))
            if share.interval is not None:
                low, high = share.interval
                assert 0.0 <= low <= share.share <= high <= 1.0
        means = probabilities_of(groups, longest + 2)
        assert means[0].mean == 1.0
        for mean in means:
            after = [1.0 + sum(change for _, change in trial[: mean.number]) for trial in trials]
            assert mean.mean == pytest.approx(fmean(after))
            if mean.interval is not None:
                low, high = mean.interval
                assert 0.0 <= low <= mean.mean <= high <= 1.0


def test_trials_without_rows_on_the_missing_side_have_no_probability() -> None:
    some, none = group_of([[(True, -0.2)]]), replace(group_of([[(False, 0.0)]]), with_rows=0)
    assert [m.mean for m in probabilities_of([some, none], 1)] == [1.0, pytest.approx(0.8)]
    assert probabilities_of([none, none], 1) == ()
    half = replace(group_of([[(True, -0.2)], [(False, 0.0)]]), with_rows=1)
    assert probabilities_of([half], 1)[1].mean == pytest.approx(0.8)


@pytest.mark.parametrize(
    ("groups", "there_are"),
    [
        (single(*[[(True, -0.1)]] * 8, *[[(False, 0.0)]] * 8), True),
        ([group_of([[(True, -0.1 * robot)]] * 16) for robot in range(4)], False),
        ([group_of([[(True, -0.1 * robot)]] * 16) for robot in range(5)], True),
    ],
)
def test_intervals_are_over_trials_of_one_robot_or_over_five_robots(
    groups: list[TrialGroup], there_are: bool
) -> None:
    certain: list[Share | MeanProbability] = [*shares_of(groups), *probabilities_of(groups, 1)[1:]]
    for point in certain:
        assert (point.interval is not None) == there_are
    assert probabilities_of(groups, 1)[0].interval is None  # all begin at 1


@given(st.lists(st.tuples(st.integers(0, 16), st.just(16)), min_size=5, max_size=40))
def test_trials_that_share_a_robot_never_tell_more_than_as_many_that_do_not(
    groups: list[tuple[int, int]],
) -> None:
    kind, n = sum(k for k, _ in groups), sum(m for _, m in groups)
    found = share_interval(groups)
    assert found is not None
    alone = exact_interval(kind, n)
    assert found[0] <= alone[0] + 1e-9
    assert found[1] >= alone[1] - 1e-9


def test_robots_that_are_each_of_one_mind_count_as_less_than_one_trial_each() -> None:
    """Their number less one, for the variance, and as much less as Student's t asks for."""
    agreed = [(16, 16)] * 10 + [(0, 16)] * 10
    n = 19 * (t95(319) / t95(19)) ** 2
    assert share_interval(agreed) == pytest.approx(exact_interval(n / 2, n))
    assert share_interval([(8, 16)] * 20) == exact_interval(160, 320)


@pytest.mark.parametrize("robots", [5, 30])
def test_the_interval_holds_the_truth_as_often_as_it_says(robots: int) -> None:
    """Of robots with 16 trials each, whose own shares lie around 0.4."""
    rng = np.random.default_rng(0)
    held = 0
    for _ in range(2_000):
        own = rng.beta(2.0, 3.0, size=robots)
        found = share_interval([(int(k), 16) for k in rng.binomial(16, own)])
        assert found is not None
        held += found[0] <= 0.4 <= found[1]
    assert 0.93 < held / 2_000 < 0.985


GROUPS = single([(True, -0.1)], [(True, -0.1), (True, -0.1), (False, 0.0)])
COURSE = AdaptationCourse(
    session=session_of(3, kind="break-tool", robots=1),
    robots=1,
    tool="t-hook",
    shape="l-hook",
    trials=2,
    shares=shares_of(GROUPS),
    broken=probabilities_of(GROUPS, 3),
    whole=probabilities_of(single([], [(False, -0.05)]), 3),
)


def points(line: Line2D) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in np.column_stack(line.get_data())]


def words_of(course: AdaptationCourse) -> set[str]:
    return {text.get_text() for text in adaptation_figure(course).findobj(Text)}


def test_the_figure_shows_running_trials_shares_and_probabilities() -> None:
    figure = adaptation_figure(COURSE)
    running, tries, probability = figure.axes
    assert figure.get_size_inches()[0] == ONE_COLUMN
    heights = [patch.get_height() for patch in running.patches]  # type: ignore[attr-defined]
    assert heights == [2, 1, 1]
    (line,) = tries.lines
    assert points(line) == [(s.number, s.share) for s in COURSE.shares]
    lines = {line.get_color(): points(line) for line in probability.lines}
    assert lines == {
        VERMILION: [(m.number, m.mean) for m in COURSE.broken],
        BLUE: [(m.number, m.mean) for m in COURSE.whole],
    }
    assert {"broken tool", "whole T-hook", "95 % interval"} <= words_of(COURSE)


def test_without_intervals_there_are_no_bands() -> None:
    groups = [group_of([[(True, -0.1)], [(False, 0.0)]])] * 2
    few = replace(
        COURSE,
        session=session_of(3, robots=2),
        robots=2,
        shares=shares_of(groups),
        broken=probabilities_of(groups, 1),
        whole=probabilities_of(groups, 1),
    )
    assert not any(axes.collections for axes in adaptation_figure(few).axes)
    assert "95 % interval" not in words_of(few)
    words = adaptation_words(few)
    assert words.title == "Adaptation: T-hook that became L-hook"
    assert words.caption == (
        "2 trials with the broken tool; session 3 (reproduce), 2 robots, seed 1000; "
        "default settings; too few robots for intervals: it takes 5"
    )
    assert "too few" not in adaptation_words(COURSE).caption


def test_without_a_missing_side_it_says_so() -> None:
    neither = replace(COURSE, broken=(), whole=())
    assert "no rows lie on a missing side" in words_of(neither)
    assert "whole T-hook" not in words_of(neither)


def test_dollars_are_letters() -> None:
    strange = replace(COURSE, shape="$\\frac{1}{")
    assert encoded(adaptation_figure(strange), ".svg").startswith(b"<?xml")
