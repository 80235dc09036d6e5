"""Planning over the whole table: what every place is worth, and the row that is used."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from affcli.core.affordance import Affordance
from affcli.core.choice import Reason, Situation
from affcli.core.geometry import Point
from affcli.core.task import GoalRegion
from affcli.planning.lookahead import Lookahead
from affcli.planning.one_step import OneStep
from affcli.planning.plans import HalfPlanes
from affcli.planning.row_model import SIDE, RowModel
from affcli.planning.value_iteration import HOPELESS, ValueIteration, _around, _Ways
from tests.factories import goal_at, observation, table_of
from tests.planning.moving import AWAY, LEFT, row, standing, steps_of

CORRIDOR = [row(1, (6.0, 0.0)), row(2, (0.0, 4.0))]
"""From (0, 0) to a goal at (12, 4): nearly by the first, but by the second it goes on."""


def cross(length: float, used: int = 1, successful: int = 1) -> list[Affordance]:
    """Return rows that move the attractor to all four sides, so that no end is a loss."""
    ways = ((length, 0.0), (0.0, length), (-length, 0.0), (0.0, -length))
    return [row(i, way, used=used, successful=successful) for i, way in enumerate(ways)]


def in_the_corridor(place: Point) -> bool:
    """Tell whether a wrist is where it starts, or beside that far enough to go along."""
    return place.y >= 2.0 or abs(place.x) + abs(place.y) < 0.5


def near_the_way(place: Point) -> bool:
    """Tell whether a wrist is at most 12 in beside the way along x."""
    return abs(place.y) <= 12.0


def plan(situation: Situation, **params: float) -> Reason:
    """Return the plan that is followed."""
    reasons = ValueIteration(**params).choose(situation).reasons
    return next(reason for reason in reasons if reason.moves)


def steps_to(situation: Situation, **params: float) -> float:
    """Return the expected steps to the goal."""
    steps = plan(situation, **params).value
    assert steps is not None
    return steps


def test_a_way_of_many_moves_is_found_where_nearer_ends_leave_no_row_to_use() -> None:
    here = standing(CORRIDOR, goal_at(12.0, 5.0, 2.25), in_the_corridor)
    assert OneStep().choose(here).position == 0
    chosen = ValueIteration().choose(here)
    assert chosen.position == 1
    assert steps_of(chosen) == [2, 1, 1]


def test_a_goal_beyond_what_lookahead_can_search_is_worth_its_distance() -> None:
    """Rows of 2 in: a goal that begins 36 in off is 18 steps away, some more as ends spread."""
    here = standing(cross(2.0), goal_at(40.0, 0.0, 4.0), near_the_way)
    assert 18.0 <= steps_to(here) <= 20.0
    assert Lookahead(depth=8).choose(here).reasons[-1].value is None


@pytest.mark.parametrize(("used", "successful"), [(2, 1), (3, 2), (4, 1)])
def test_a_row_costs_as_many_steps_as_it_is_tried(used: int, successful: int) -> None:
    goal = goal_at(14.0, 0.0, 4.0)
    certain, uncertain = (
        steps_to(standing(cross(4.0, *counted), goal, near_the_way), threshold=0.0)
        for counted in ((1, 1), (used, successful))
    )
    assert uncertain == pytest.approx(certain * used / successful, rel=0.02)


def test_of_two_ways_the_one_that_is_expected_to_take_fewer_steps_is_gone() -> None:
    goal = goal_at(12.0, 0.0, 2.0)
    for used, taken in ((1, 0), (9, 1)):
        rows = [row(1, (6.0, 0.0), used=used), row(2, (4.0, 0.0))]
        assert ValueIteration(threshold=0.0).choose(standing(rows, goal)).position == taken


def test_a_row_that_met_the_edge_costs_a_step_more_where_it_will_go_on() -> None:
    goal = goal_at(12.0, 0.0, 2.0)
    truncated = replace(row(1, (6.0, 0.0)), truncated=True)
    here = standing([truncated, row(2, (6.0, 0.0))], goal)
    assert ValueIteration().choose(here).position == 1


def test_a_plan_without_a_way_says_so_and_goes_where_the_goal_is_nearest() -> None:
    here = standing([row(1, LEFT), row(2, AWAY)], goal_at(20.0, 2.0, 2.0))
    chosen = ValueIteration().choose(here)
    assert chosen.position == 1
    followed = next(reason for reason in chosen.reasons if reason.moves)
    assert (followed.name, followed.value) == ("plan that ends short of the goal", None)


def test_a_way_that_no_trial_has_steps_for_is_none() -> None:
    """Of 58 in, 93 steps of 0.6 in or 28 of 2 in."""
    goal = goal_at(58.0, 0.0, 2.0)
    assert plan(standing(cross(0.6), goal, near_the_way)).value is None
    assert steps_to(standing(cross(2.0), goal, near_the_way)) < HOPELESS


def test_what_is_remembered_of_another_goal_or_of_other_counters_changes_no_answer() -> None:
    goals = goal_at(10.0, 0.0, 2.0), goal_at(-10.0, 0.0, 2.0)
    fresh = [ValueIteration().choose(standing(cross(5.0, 4, 4), goal)) for goal in goals]
    right = standing(cross(5.0, 4, 4), goals[0])
    left = replace(right, goal=goals[1])
    for _ in range(2):
        assert [ValueIteration().choose(one) for one in (right, left)] == fresh
    before = steps_to(right)
    right.table.count_use(0, success=False)
    assert before < steps_to(right) <= 1.25 * before
    assert ValueIteration().choose(left).position == fresh[1].position


def test_where_the_attractor_lay_before_changes_no_answer() -> None:
    """One place is far from where the rows were made: what lies about it is worked out apart."""
    robot = standing(cross(5.0), goal_at(10.0, 0.0, 2.0))
    elsewhere = replace(robot, seen=observation(Point(0.0, 24.0), wrist=Point(0.0, 0.0)))
    fresh = [
        ValueIteration().choose(replace(one, table=table_of(*cross(5.0))))
        for one in (robot, elsewhere)
    ]
    for _ in range(2):
        assert [ValueIteration().choose(one) for one in (robot, elsewhere)] == fresh


@pytest.mark.parametrize("rows", [cross(2.0), cross(1.5, 4, 3), CORRIDOR], ids=len)
def test_worths_are_those_that_a_plain_loop_finds(rows: list[Affordance]) -> None:
    goal = goal_at(4.0, 0.5, 1.0)
    here = standing(rows, goal, lambda p: abs(p.x) <= 3.0 and abs(p.y) <= 4.0)
    around_here = _around(np.zeros(1), np.zeros(1), 1.0)
    steps = here.table.times_used / here.table.times_successful
    ways = _Ways(here, 1.0, around_here)
    worth = ways.worth(steps, HalfPlanes(goal))
    plain = plain_worths(here, steps, goal)
    assert worth[-1] == HOPELESS
    for (x, y), steps_left in plain.items():
        number = np.array([round(x) * SIDE + round(y)])
        assert worth[ways.places.index(number)[0]] == pytest.approx(steps_left, abs=0.02)


def plain_worths(
    here: Situation, steps: NDArray[np.float64], goal: GoalRegion
) -> dict[tuple[float, float], float]:
    """Return the expected steps from whole inches near (0, 0), worked out place by place."""
    model, planes = RowModel.of(here.table), HalfPlanes(goal)
    inches = [float(n) for n in range(-12, 13)]
    moves = {}
    for x, y in product(inches, inches):
        ends = model.ends(
            np.arange(len(here.table)), np.array([x]), np.array([y]), here.reaches, here.slides
        )
        arrived = planes.hold(ends.x, ends.y)
        moves[x, y] = list(zip(steps[ends.row], arrived, ends.x, ends.y, strict=True))
    worth = dict.fromkeys(moves, HOPELESS)
    for _ in range(120):
        before = worth
        worth = {
            place: min(
                [HOPELESS]
                + [
                    float(cost) + (0.0 if there else blurred(before, float(x), float(y)))
                    for cost, there, x, y in found
                ]
            )
            for place, found in moves.items()
        }
    return worth


def blurred(worth: dict[tuple[float, float], float], x: float, y: float) -> float:
    """Return the mean worth about a place: of the four whole inches about it, each of which is
    spread over its neighbours.
    """
    mean = 0.0
    for column, line in product(
        (math.floor(x), math.floor(x) + 1), (math.floor(y), math.floor(y) + 1)
    ):
        share = (1.0 - abs(x - column)) * (1.0 - abs(y - line))
        for (i, p), (j, q) in product(zip((-1, 0, 1), (0.25, 0.5, 0.25), strict=True), repeat=2):
            mean += share * p * q * worth.get((float(column + i), float(line + j)), HOPELESS)
    return mean


def test_candidates_begin_with_the_row_that_is_chosen() -> None:
    here = standing(CORRIDOR, goal_at(12.0, 5.0, 2.25), in_the_corridor)
    assert [one.position for one in ValueIteration().candidates(here)] == [1, 0]


def test_places_nearer_together_tell_the_same_steps() -> None:
    here = standing(cross(3.0), goal_at(20.0, 0.0, 3.0), near_the_way)
    finer, coarser = (steps_to(here, cell=cell) for cell in (0.5, 1.0))
    assert finer == pytest.approx(coarser, abs=0.5)
