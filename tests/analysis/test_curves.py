"""How learning went over time: sums of what each interval brought."""

import math
from dataclasses import replace
from statistics import fmean

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.analysis.curves import ENOUGH_BEHAVIORS, Band, Curve, ToolCurves
from affcli.analysis.statistics import HIGH, LOW, mean_interval, quantile
from affcli.core.results import LearningInterval
from tests.factories import learning_spec
from tests.report.hand_made import learned_run

RUN = learned_run(1, learning_spec())


@st.composite
def runs(draw: st.DrawFn) -> list[tuple[float, bool]]:
    """Return a run's behaviors: when each ended (s), and whether it had an effect."""
    gaps = draw(st.lists(st.integers(1, 40), min_size=1, max_size=60))
    clocks = [sum(gaps[: i + 1]) / 4 for i in range(len(gaps))]
    return [(clock, draw(st.booleans())) for clock in clocks]


def intervals(run: list[tuple[float, bool]], seconds: float) -> list[LearningInterval]:
    """Count as the database does."""
    numbers = sorted({int(clock / seconds) for clock, _ in run})
    return [
        LearningInterval(
            1,
            number,
            sum(int(clock / seconds) == number for clock, _ in run),
            sum(effect and int(clock / seconds) == number for clock, effect in run),
        )
        for number in numbers
    ]


@given(runs(), st.sampled_from([0.5, 2.0, 7.0, 16.0, 1000.0]))
def test_a_curve_counts_what_was_done_by_then(
    run: list[tuple[float, bool]], seconds: float
) -> None:
    end = run[-1][0]
    curve = Curve.of(replace(RUN, robot_seconds=end), intervals(run, seconds), seconds)
    assert len(curve.minutes) == len(curve.rows) == len(curve.share)
    assert (curve.minutes[0], curve.rows[0]) == (0.0, 0.0)
    assert curve.minutes[-1] == pytest.approx(end / 60.0)
    assert curve.rows[-1] == sum(effect for _, effect in run)
    for minutes, rows, share in zip(
        curve.minutes[:-1], curve.rows[:-1], curve.share[:-1], strict=True
    ):
        by_then = [effect for clock, effect in run if clock < round(minutes * 60.0, 6)]
        assert rows == sum(by_then)
        if len(by_then) < ENOUGH_BEHAVIORS:
            assert math.isnan(share)
        else:
            assert share == sum(by_then) / len(by_then)


@given(st.lists(runs(), min_size=1, max_size=6))
def test_robots_are_compared_while_all_of_them_learn(
    robots: list[list[tuple[float, bool]]],
) -> None:
    seconds = max(run[-1][0] for run in robots) / 10
    curves = [
        Curve.of(replace(RUN, robot_seconds=run[-1][0]), intervals(run, seconds), seconds)
        for run in robots
    ]
    tool = ToolCurves.of("t-hook", curves)
    assert tool.robots == len(robots)
    assert len(tool.minutes) == len(tool.rows.mean) == len(tool.share.mean)
    shortest = min(run[-1][0] for run in robots)
    assert all(minutes * 60.0 <= shortest + 1e-9 for minutes in tool.minutes)
    for i, _ in enumerate(tool.minutes):
        rows = [curve.rows[i] for curve in curves]
        assert tool.rows.mean[i] == pytest.approx(fmean(rows))
        assert (tool.rows.low[i], tool.rows.high[i]) == (quantile(rows, LOW), quantile(rows, HIGH))
        assert math.isnan(tool.rows.mean_low[i]) is (mean_interval(rows) is None)


@pytest.mark.parametrize(("robots", "certain"), [(4, False), (5, True)])
def test_the_interval_is_that_of_the_mean_and_of_enough_robots(robots: int, certain: bool) -> None:
    values = [float(n % 7) for n in range(robots)]
    band = Band.of([[value] for value in values])
    if certain:
        assert (band.mean_low[0], band.mean_high[0]) == mean_interval(values)
        assert band.mean_low[0] < band.mean[0] < band.mean_high[0]
    else:
        assert math.isnan(band.mean_low[0])
        assert math.isnan(band.mean_high[0])


def test_a_share_that_one_robot_lacks_is_nobodys() -> None:
    band = Band.of([(math.nan, 0.25), (0.5, 0.75)])
    assert math.isnan(band.mean[0])
    assert math.isnan(band.low[0])
    assert math.isnan(band.high[0])
    assert (band.mean[1], band.low[1], band.high[1]) == (0.5, 0.25, 0.75)
