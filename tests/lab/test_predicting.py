"""Fresh pushes, and what a stored table predicts of them (§6.1)."""

from dataclasses import replace

import pytest

from affcli.analysis.prediction import Push, Score
from affcli.config import Settings
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.records import LearningRunInfo
from affcli.core.specs import VerificationSpec
from affcli.core.trial import BabblingRecord
from affcli.errors import UsageError
from affcli.lab.predicting import StagedTable, fresh_pushes, predict, prediction_spec
from affcli.planning.prediction import TablePredictor
from affcli.store import Store
from tests.factories import tool_named, verification_spec
from tests.lab.quick import learned, spec_of, stored

SETTINGS = Settings()


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A T-hook's learning run, in the store."""
    return stored(store, spec_of("t-hook", 400))


def pushes(count: int = 60, seed: int = 0) -> list[BabblingRecord]:
    run = spec_of("t-hook", 400)
    return list(fresh_pushes(verification_spec(run, seed=seed, tries=count), run))


def spec_for(
    run: LearningRunInfo, count: int, shape: str = "t-hook", seed: int = 0
) -> VerificationSpec:
    return prediction_spec(run, tool_named(shape), seed, None, count)


def test_pushes_are_drawn_as_in_babbling_from_new_places_each_time() -> None:
    box = SETTINGS.babbling
    records = pushes()
    assert [record.step for record in records] == list(range(1, 61))
    assert all(record.resets >= 1 for record in records)
    for record in records:
        x, y = record.placing.call["x"], record.placing.call["y"]
        assert abs(x) <= box.offset_x_max
        assert box.offset_y_min <= y <= box.offset_y_max
    assert len({record.start.object_position for record in records}) == 60
    assert len({record.execution.call for record in records}) == 8


def test_they_are_others_than_those_of_learning() -> None:
    """The same seed, and not one place the same: what is asked was never learned."""
    known = {r.start.object_position for r, _ in learned(spec_of("t-hook", 60))}
    assert not known & {record.start.object_position for record in pushes()}


def test_the_same_seed_gives_the_same_pushes_and_another_does_not() -> None:
    assert pushes(20) == pushes(20)
    assert pushes(20) != pushes(20, seed=1)


def test_a_push_says_what_was_predicted_before_it_and_what_came_of_it(
    store: Store, run: LearningRunInfo
) -> None:
    rows = list(store.learning.table(run.id)[0])
    done = list(predict(store, run, spec_for(run, 60)))
    for push, record in zip(done, pushes(), strict=True):
        assert push.moved is (record.affordance is not None)
        assert push.moved is (push.seen.distance > MOVEMENT_THRESHOLD)
        assert sorted(push.predicted) == [5, 10, 20, 40, 80, run.rows]
        for count, predicted in push.predicted.items():
            table = TablePredictor(rows[:count])
            call, offset = record.execution.call, record.start.wrist_to_object
            assert predicted == (table.predict(call, offset), table.mean_movement(call))


def test_more_rows_predict_more(store: Store, run: LearningRunInfo) -> None:
    done = list(predict(store, run, spec_for(run, 300)))
    few, all_of_them = (Score.of(done, rows) for rows in (5, run.rows))
    assert few.hits < all_of_them.hits
    assert all_of_them.hits > 0.7 * all_of_them.moved
    assert all_of_them.false_alarms < 0.3 * all_of_them.still


def test_a_small_table_is_asked_as_far_as_it_goes() -> None:
    rows = [r.affordance for r, _ in learned(spec_of("t-hook", 60)) if r.affordance is not None]
    (record,) = pushes(1)
    assert sorted(StagedTable(rows[:7]).push(record).predicted) == [5, 7]
    assert sorted(StagedTable(rows[:5]).push(record).predicted) == [5]
    assert sorted(StagedTable([]).push(record).predicted) == [0]


def test_rows_that_were_excluded_predict_nothing(store: Store, run: LearningRunInfo) -> None:
    def predicted() -> list[Push]:
        return list(predict(store, run, spec_for(run, 40)))

    before = predicted()
    with store.database.writing() as connection:
        connection.exec_driver_sql("UPDATE affordance SET times_used = 2")
    after = predicted()
    assert [push.seen for push in before] == [push.seen for push in after]
    assert all(push.predicted[0].by_row.distance == 0.0 for push in after)
    assert any(push.predicted[run.rows].by_row.distance > 0.0 for push in before)


def test_the_broken_tool_moves_less_than_was_predicted(store: Store, run: LearningRunInfo) -> None:
    whole, broken = (
        Score.of(list(predict(store, run, spec_for(run, 300, shape, 3))), run.rows)
        for shape in ("t-hook", "l-hook")
    )
    assert broken.false_alarms > whole.false_alarms


def test_a_blank_table_predicts_nothing_worth_asking(store: Store, run: LearningRunInfo) -> None:
    with pytest.raises(UsageError, match=r"made no rows: there is nothing to predict by"):
        spec_for(replace(run, rows=0), 10)


def test_the_sensor_is_that_of_learning_unless_told(store: Store, run: LearningRunInfo) -> None:
    assert spec_for(run, 10).sensor == "noisy"
    exact = prediction_spec(run, tool_named("t-hook"), 0, "exact", 10)
    for record in fresh_pushes(exact, run.spec):
        assert record.start.colors == record.end.colors
