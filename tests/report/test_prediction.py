"""Scores of predictions, by hand and against plain counting."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.analysis.prediction import Errors, Prediction, Push, Score, scores
from affcli.core.observation import Movement
from affcli.report.prediction import prediction_json, prediction_tables, predictions_table
from tests.report.drawn import drawn

NONE = Movement(0.0, 0.0, 0.0)


def to(dx: float, dy: float = 0.0) -> Movement:
    return Movement(dx, dy, 0.0)


def push(
    seen: Movement,
    by_row: Movement,
    by_mean: Movement = NONE,
    wrist: Movement = NONE,
    rows: int = 5,
) -> Push:
    """Return a push of which one table predicted something."""
    return Push(seen.distance > 0.5, seen, wrist, {rows: Prediction(by_row, by_mean)})


HAND_MADE = [
    push(to(2.0), to(3.0), to(2.0, 2.0), to(5.0)),
    push(to(0.0, 4.0), to(0.0, 3.0), to(1.0, 3.0), to(0.0, 5.0)),
    push(to(-2.0), NONE, to(1.0), to(-5.0)),
    push(NONE, to(1.0), to(1.0), to(5.0)),
    push(to(0.1), NONE, to(1.0), to(5.0)),
    push(NONE, NONE, NONE, to(5.0)),
]


def test_hits_and_false_alarms_are_counted_where_a_row_predicted_a_movement() -> None:
    (score,) = scores(HAND_MADE)
    assert (score.rows, score.moved, score.hits) == (5, 3, 2)
    assert (score.still, score.false_alarms) == (3, 1)


def test_errors_are_of_the_hits_alone_for_every_predictor() -> None:
    (score,) = scores(HAND_MADE)
    assert score.by_row == Errors(0.0, 0.0, 1.0, 1.0)
    turned = math.degrees(math.atan2(1.0, 3.0))
    assert score.by_mean == pytest.approx(Errors(turned, 45.0, math.sqrt(2.0), 2.0))
    assert score.as_wrist == Errors(0.0, 0.0, 1.0, 3.0)


def test_without_hits_there_are_no_errors() -> None:
    (score,) = scores([push(to(2.0), NONE), push(NONE, NONE)])
    assert score.by_row == Errors(None, None, None, None)
    assert scores([]) == []


moves = st.builds(to, st.floats(-5, 5), st.floats(-5, 5))


@given(st.lists(st.builds(push, moves, moves | st.just(NONE), moves, moves), min_size=1))
def test_scores_are_what_counting_gives(pushes: list[Push]) -> None:
    score = Score.of(pushes, 5)
    predicted = [one for one in pushes if one.predicted[5].by_row.distance > 0.0]
    assert score.moved + score.still == len(pushes)
    assert score.hits + score.false_alarms == len(predicted)
    assert score.hits == sum(one.seen.distance > 0.5 for one in predicted)
    off = sorted(math.dist(one.seen, one.predicted[5].by_row) for one in predicted if one.moved)
    if off:
        assert score.by_row.inches == off[math.ceil(len(off) / 2) - 1]
        assert score.by_row.inches_95 in off
        assert sum(value <= score.by_row.inches_95 for value in off) >= 0.95 * len(off)


def test_the_json_has_what_the_table_shows() -> None:
    (value,) = prediction_json(HAND_MADE)
    assert {k: value[k] for k in ("rows", "moved", "hits", "still", "false_alarms")} == {
        "rows": 5,
        "moved": 3,
        "hits": 2,
        "still": 3,
        "false_alarms": 1,
    }
    assert value["by_row"] == {"degrees": 0.0, "degrees_95": 0.0, "inches": 1.0, "inches_95": 1.0}
    low, high = value["hit_rate_95"]
    assert low < 2 / 3 < high


@pytest.mark.parametrize("columns", [80, 40])
def test_the_tables_fit_the_screen_and_say_the_same(columns: int) -> None:
    text = drawn(prediction_tables("Run 1, stick", 1.5, HAND_MADE), columns)
    assert "6 fresh pushes predicted, 3 of which moved the attractor" in " ".join(text.split())
    assert "0.67 (0.09 to 0.99)" in text
    assert "0.33 (0.01 to 0.91)" in text
    assert "as the wrist moved" in text


def test_where_nothing_moved_there_is_nothing_to_share() -> None:
    text = drawn(prediction_tables("Run 1, stick", 1.5, [push(NONE, NONE)]), 80)
    (line,) = (line.split() for line in text.splitlines() if line.split()[:1] == ["5"])
    assert line[1] == "-"
    assert line[-4:] == ["-"] * 4


def test_whole_tables_stand_in_one_row_each() -> None:
    """Not what they were after their first rows."""
    grown = [
        one._replace(predicted={2: Prediction(NONE, NONE), **one.predicted}) for one in HAND_MADE
    ]
    table = predictions_table([("robot 3", "t-hook", grown), ("seed 0", "stick", HAND_MADE[3:])])
    assert table.rows[0][:4] == ("robot 3", "t-hook", "6", "3")
    assert table.rows[0][4:] == (
        *("0.67 (0.09 to 0.99)", "0.33 (0.01 to 0.91)", "0.0", "0.0", "1.00", "1.00"),
    )
    assert table.rows[1] == ("seed 0", "stick", "3", "0", "-", "0.33 (0.01 to 0.91)", *("-",) * 4)
