"""The least expected distance, and the one that does not fall for lucky rows; and the guard."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point, Pose
from affcli.planning.neighbours import smoothed
from affcli.planning.nested_query import NestedQuery, nearer_to_goal
from affcli.planning.one_step import OneStep, Robust
from affcli.planning.row_model import RowModel
from tests.factories import EXTEND_5, affordance, goal_at, observation, places, situation
from tests.fakes import FakeRobot, FakeTable

HERE = Point(0.0, 0.0)
CONTRACT_5 = BehaviorCall.of(EXTEND_5.name, {"offset_distance": 4.0})


def rows_that_move(*movements: tuple[float, float]) -> AffordanceTable:
    return AffordanceTable(affordance(k, moved=moved) for k, moved in enumerate(movements))


@settings(deadline=None)
@given(st.lists(places, min_size=1, max_size=12), places)
def test_the_row_is_taken_that_should_end_nearest_and_of_equal_ones_the_older(
    movements: list[Point], goal: Point
) -> None:
    table = rows_that_move(*movements)
    here = situation(table, observation(HERE), goal_at(*goal), FakeRobot(FakeTable()))
    squared = [(x - goal.x) ** 2 + (y - goal.y) ** 2 for x, y in movements]
    assert OneStep().choose(here).position == squared.index(min(squared))


@settings(deadline=None)
@given(st.lists(places, max_size=12), places, st.sampled_from([0.0, 0.5, 4.0]))
def test_the_guard_keeps_rows_that_lead_nearer_and_all_when_none_does(
    movements: list[Point], goal: Point, least: float
) -> None:
    table = rows_that_move(*movements)
    rows = np.arange(len(table))
    kept = nearer_to_goal(table, rows, observation(HERE), goal_at(*goal), least)
    now = np.hypot(*goal)
    nearer = [
        k for k, m in enumerate(movements) if now - np.hypot(m.x - goal.x, m.y - goal.y) > least
    ]
    assert kept.tolist() == (nearer or rows.tolist())


def test_the_guard_stands_before_the_sort_and_says_how_many_rows_it_left() -> None:
    """The row at hand leads away, and is among the top fifth because there are few."""
    table = rows_that_move((0.0, -4.0), *[(0.0, 3.0)] * 3)
    robot = FakeRobot(FakeTable(wrist=Pose(0.0, -8.0)))
    here = situation(table, observation(HERE), goal_at(0.0, 6.0), robot)
    guarded = NestedQuery(share=1.0, guard=0.5).choose(here)
    assert [(one.name, one.rows) for one in guarded.reasons[-2:]] == [("nearer", 3), ("nearest", 3)]
    assert "nearer" not in [one.name for one in NestedQuery().choose(here).reasons]


def made(count: int, seed: int, lucky: int) -> list[Affordance]:
    """Return rows of one behavior that move the attractor by (0, 3), give or take; and some that
    slipped far off, whatever was done.
    """
    rng = np.random.default_rng(seed)
    rows = []
    for k in range(count):
        offset = Point(*(np.array([0.0, 8.0]) + rng.uniform(-0.3, 0.3, 2)))
        moved = rng.normal((0.0, 3.0), 0.1) if k >= lucky else rng.normal((2.0, 5.0), 0.1)
        rows.append(affordance(k, offset=offset, moved=tuple(moved)))
    return rows


def test_a_lucky_row_among_many_is_not_believed() -> None:
    """The least of many expected distances is that of a slip; its neighbours know better."""
    other = [
        affordance(100 + k, offset=Point(4.0 + 0.05 * k, 8.0), moved=(1.8, 4.6), call=CONTRACT_5)
        for k in range(8)
    ]
    table = AffordanceTable([*made(60, 0, lucky=1), *other])
    here = situation(table, observation(HERE), goal_at(2.0, 5.0), FakeRobot(FakeTable()))
    assert OneStep().choose(here).position == 0
    chosen = Robust().choose(here).position
    assert chosen is not None
    assert table.row(chosen).exploratory == CONTRACT_5


def test_neighbours_are_rows_of_the_same_behavior_at_nearly_the_same_place() -> None:
    near, far = Point(0.0, 8.0), Point(0.0, 9.5)
    rows = [
        affordance(1, offset=near, moved=(0.0, 4.0)),
        affordance(2, offset=near, moved=(0.0, 2.0)),
        affordance(3, offset=far, moved=(0.0, 9.0)),
        affordance(4, offset=near, moved=(5.0, 0.0), call=CONTRACT_5),
    ]
    model = smoothed(AffordanceTable(rows), 1.0)
    assert model.movement_y.tolist() == [3.0, 3.0, 9.0, 0.0]
    assert model.movement_x.tolist() == [0.0, 0.0, 0.0, 5.0]
    # Two rows an inch off their mean each; those alone are as uncertain as rows are on average.
    assert model.spread[0] == pytest.approx(1.0)
    assert 0.0 < model.spread[2] == model.spread[3]


def test_without_neighbours_rows_do_what_they_did() -> None:
    table = AffordanceTable(made(20, 3, lucky=2))
    model, plain = smoothed(table, 1e-6), RowModel.of(table)
    assert np.allclose(model.movement_x, plain.movement_x)
    assert np.allclose(model.movement_y, plain.movement_y)
    assert not model.spread.any()
