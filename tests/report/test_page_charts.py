"""The page's charts of learning: rows made over robot time."""

from dataclasses import replace

import pytest

from affcli.analysis.curves import Band, Curve, ToolCurves
from affcli.report.page.charts import HEIGHT, WIDTH, charts
from tests.report.hand_made_page import learned

RUN = replace(learned().run, rows=6, behaviors=24)
ONE = replace(learned(), run=RUN, robot="robot 0")
CURVE = Curve(RUN, [0.0, 10.0, 20.0], [0.0, 3.0, 6.0], [0.0, 0.2, 0.25])


def points(text: str) -> list[tuple[float, float]]:
    """Return the corners of a line of SVG."""
    return [(float(x), float(y)) for x, y in (corner.split(",") for corner in text.split())]


def test_a_run_goes_from_corner_to_corner_when_it_is_the_highest() -> None:
    (chart,) = charts([ONE], {RUN.id: CURVE}, {})
    ((robot, words, line),) = chart["lines"]
    assert (chart["tool"], robot) == ("t-hook", "robot 0")
    assert words == "6 rows of 24 behaviors (25 %), half of them by minute 10"
    assert points(line) == [(0.0, 0.0), (WIDTH / 2, HEIGHT / 2), (WIDTH, HEIGHT)]
    assert chart["band"] == chart["mean"] == ""
    assert [tick for _, tick in chart["across"]] == [0, 5, 10, 15, 20]
    assert chart["across"][-1][0] == WIDTH
    assert [tick for _, tick in chart["up"]] == [0, 2, 4, 6]


def test_what_all_robots_did_lies_around_it_on_the_same_axes() -> None:
    band = Band([0.0, 4.0], [0.0, 2.0], [0.0, 12.0], [0.0, 3.0], [0.0, 6.0])
    bands = {"t-hook": ToolCurves("t-hook", 9, [0.0, 10.0], band, band)}
    (chart,) = charts([ONE], {RUN.id: CURVE}, bands)
    assert points(chart["lines"][0][2])[-1] == (WIDTH, HEIGHT / 2)
    assert points(chart["mean"]) == [(0.0, 0.0), (WIDTH / 2, HEIGHT / 3)]
    # Along the upper edge, and back along the lower.
    assert points(chart["band"]) == [
        *((0.0, 0.0), (WIDTH / 2, HEIGHT), (WIDTH / 2, HEIGHT / 6), (0.0, 0.0)),
    ]


@pytest.mark.parametrize("most", [0.3, 1.0, 7.0, 60.0, 158.0, 4321.0])
def test_an_axis_has_a_handful_of_ticks(most: float) -> None:
    curve = replace(CURVE, minutes=[0.0, most], rows=[0.0, most])
    (chart,) = charts([ONE], {RUN.id: curve}, {})
    for axis in ("across", "up"):
        ticks = [tick for _, tick in chart[axis]]
        assert 1 <= len(ticks) <= 6
        assert ticks[0] == 0
        assert ticks[-1] <= max(most, 1.0)


def test_a_tool_that_has_not_begun_has_no_chart() -> None:
    assert charts([ONE], {}, {}) == []
