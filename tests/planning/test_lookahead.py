"""Planning ahead: what rows are expected to do from elsewhere, and which path of them is taken."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli import registry
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.choice import Reason
from affcli.core.geometry import Point
from affcli.errors import BadInputError
from affcli.planning.lookahead import (
    NO_WAY,
    Lookahead,
    _apart,
    _Layer,
)
from affcli.planning.one_step import OneStep
from affcli.planning.plans import INSIDE, SMALL_GOAL, HalfPlanes
from affcli.planning.row_model import RowModel
from tests.factories import affordance, goal_at, places, table_of
from tests.fakes import FakeRobot, FakeTable
from tests.planning.moving import AWAY, HERE, RIGHT, row, standing, steps_of


@settings(deadline=None)
@given(st.lists(st.tuples(places, places), min_size=1, max_size=8), places, st.integers(-40, 40))
def test_a_row_is_expected_to_do_no_more_than_it_did_and_stops_where_the_reach_ends(
    drawn: list[tuple[Point, Point]], at: Point, edge: int
) -> None:
    """Predicted travel: the row's own, or what the reach allows; the movement is shorter by as much
    as the travel is."""
    table = table_of(*(row(k, moved, offset) for k, (moved, offset) in enumerate(drawn)))
    robot = FakeRobot(FakeTable(), reachable=lambda p: p.x <= edge)
    model = RowModel.of(table)
    ends = model.ends(np.arange(len(table)), np.array([at.x]), np.array([at.y]), robot.reaches)
    found = dict(zip(ends.row.tolist(), zip(ends.x, ends.y, strict=True), strict=True))
    for k, (moved, offset) in enumerate(drawn):
        wrist, whole = at.x - offset.x, float(np.hypot(*moved))
        room = (edge - wrist) / moved.x if moved.x > 0.0 else 1.0
        length = whole * min(1.0, room)
        error = whole / 64.0
        if wrist > edge or length <= MOVEMENT_THRESHOLD - error:
            assert k not in found
        elif length > MOVEMENT_THRESHOLD + error:
            x, y = found[k]
            assert np.hypot(x - at.x, y - at.y) == pytest.approx(length, abs=error)
            assert np.hypot(x - at.x, y - at.y) <= whole + 1e-9


def test_a_slide_goes_on_where_the_tool_can_be_held_but_not_set_down() -> None:
    """A pull that begins within reach ends nearer to the robot than the tool could be lowered."""
    table = table_of(row(1, (-5.0, 0.0)))
    set_down = FakeRobot(FakeTable(), reachable=lambda p: p.x >= -2.0).reaches
    held = FakeRobot(FakeTable(), reachable=lambda p: p.x >= -4.0).reaches
    at, rows = np.zeros(1), np.arange(1)
    for slides, ends in ((None, -2.0), (held, -4.0)):
        found = RowModel.of(table).ends(rows, at, at, set_down, slides)
        assert found.x[0] == pytest.approx(ends, abs=0.1)


def test_a_truncated_row_that_will_go_further_is_known() -> None:
    made = row(1, (2.0, 0.0))
    table = AffordanceTable([replace(made, truncated=True), replace(made, step=2)])
    near, far = (
        FakeRobot(FakeTable(), reachable=rule).reaches
        for rule in (lambda p: p.x <= 2.1, lambda p: p.x <= 9.0)
    )
    for reaches, further in ((near, [False, False]), (far, [True, False])):
        found = RowModel.of(table).ends(np.arange(2), np.zeros(1), np.zeros(1), reaches)
        assert found.further.tolist() == further


def test_the_model_of_a_table_is_that_of_its_rows_whatever_their_counters() -> None:
    table = table_of(row(1, RIGHT), row(2, AWAY))
    before = RowModel.of(table)
    table.count_use(0, success=False)
    assert RowModel.of(table) is before is RowModel.of(table.as_learned())


def test_two_moves_are_found_where_the_best_single_one_leads_nowhere() -> None:
    """Around a corner: the row that ends nearest leaves none that goes on."""
    tempting, aside, last = (4.0, 3.0), AWAY, (6.0, 0.0)
    rows = [
        affordance(1, moved=tempting, offset=Point(9.0, 9.0)),
        affordance(2, moved=aside, offset=HERE),
        affordance(3, moved=last, offset=Point(0.0, 1.0)),
    ]
    here = standing(rows, goal_at(6.0, 5.0, 1.0), lambda p: p.x in (-9.0, 0.0))
    assert OneStep().choose(here).position == 0
    assert sorted(steps_of(Lookahead(depth=2).choose(here))) == [2, 3]


def test_a_path_to_the_goal_of_fewer_moves_is_better() -> None:
    rows = [row(1, RIGHT), row(2, AWAY), row(3, (5.0, 5.0))]
    assert steps_of(Lookahead(depth=3).choose(standing(rows, goal_at(5.0, 5.0, 1.0)))) == [3]


@pytest.mark.parametrize(("used", "successful", "taken"), [(2, 1, [1, 2]), (3, 2, [3])])
def test_an_uncertain_row_costs_what_its_probability_says(
    used: int, successful: int, taken: list[int]
) -> None:
    """Of probability 2/3 it takes 1.5 steps, which is less than two sure ones; of 1/2, two, and the
    two end nearer."""
    risky = row(3, (5.5, 5.0), used=used, successful=successful)
    here = standing([row(1, RIGHT), row(2, AWAY), risky], goal_at(5.0, 5.0, 1.0))
    found = steps_of(Lookahead(depth=2, threshold=0.1).choose(here))
    assert sorted(found) == taken


def test_an_end_that_leaves_no_row_is_avoided() -> None:
    """Short of the goal, the nearest end is not the best where nothing can be done from there."""
    rows = [row(1, (8.0, 0.0)), row(2, (4.0, 0.0))]
    here = standing(rows, goal_at(30.0, 0.0), lambda p: p.x < 7.0)
    assert Lookahead(depth=1).choose(here).position == 1


def test_of_equally_good_paths_the_one_with_the_least_repositioning_is_taken() -> None:
    rows = [row(1, RIGHT, Point(-3.0, 0.0)), row(2, RIGHT, Point(3.0, 0.0))]
    for x, nearer in ((3.0, 0), (-3.0, 1)):
        here = standing(rows, goal_at(5.0, 0.0), wrist=Point(x, 0.0))
        assert Lookahead().choose(here).position == nearer


def test_paths_that_end_near_each_other_count_as_one_and_still_the_goal_is_found() -> None:
    rng = np.random.default_rng(0)
    crowd = [row(k, tuple(rng.normal(RIGHT, 0.05))) for k in range(200)]
    last = row(999, (0.0, 6.0))
    here = standing([*crowd, last], goal_at(5.0, 6.0, 1.0))
    for beam in (1, 3, 60):
        assert len(steps_of(Lookahead(depth=2, beam=beam).choose(here))) == 2


@settings(deadline=None, max_examples=40)
@given(st.lists(st.tuples(places, places), min_size=1, max_size=10), places, st.integers(1, 3))
def test_a_plan_ends_where_its_moves_lead_and_begins_with_the_row_chosen(
    drawn: list[tuple[Point, Point]], goal: Point, depth: int
) -> None:
    rows = [row(k, moved, offset) for k, (moved, offset) in enumerate(drawn)]
    choice = Lookahead(depth=depth).choose(standing(rows, goal_at(*goal)))
    if choice.position is None:
        assert all(np.hypot(*moved) <= MOVEMENT_THRESHOLD for moved, _ in drawn)
        return
    told = [reason for reason in choice.reasons if reason.moves]
    assert told[0].moves[0].step == choice.position
    assert len({reason.moves[0].step for reason in told}) == len(told)
    for reason in told:
        x = y = 0.0
        for move in reason.moves:
            dx, dy = drawn[move.step][0]
            x, y = x + dx, y + dy
            assert (move.x, move.y) == pytest.approx((x, y))
        assert 1 <= len(reason.moves) <= depth


@settings(deadline=None, max_examples=30)
@given(st.lists(st.tuples(places, places), min_size=1, max_size=6), places)
def test_looking_one_move_ahead_finds_the_goal_whenever_a_row_leads_there(
    drawn: list[tuple[Point, Point]], goal: Point
) -> None:
    rows = [row(k, moved, offset) for k, (moved, offset) in enumerate(drawn)]
    region = goal_at(*goal)
    there = {
        k
        for k, (moved, _) in enumerate(drawn)
        if max(abs(moved.x - goal.x), abs(moved.y - goal.y)) <= region.half_width - 0.1
        and np.hypot(*moved) > MOVEMENT_THRESHOLD
    }
    chosen = Lookahead(depth=1).choose(standing(rows, region)).position
    assert not there or chosen in there


def test_a_plan_is_told_as_json_and_read_again() -> None:
    rows = [row(1, RIGHT), row(2, AWAY)]
    choice = Lookahead().choose(standing(rows, goal_at(5.0, 5.0, 1.0)))
    assert [Reason.from_json(reason.json()) for reason in choice.reasons] == list(choice.reasons)
    assert "moves" not in choice.reasons[0].json()
    assert choice.reasons[-1].json()["moves"]


@pytest.mark.parametrize("text", ["lookahead:depth=9", "lookahead:depth=0", "lookahead:beam=401"])
def test_a_search_that_cannot_be_done_names_its_limit(text: str) -> None:
    with pytest.raises(BadInputError, match=r"must lie in \[1, (8|400)\]"):
        registry.component("planners", text)


def test_of_equally_good_paths_the_one_that_needs_no_new_grasp_is_taken() -> None:
    """Unless the other spares the wrist more than the grasp costs."""
    rows = [row(1, (5.0, 5.0)), row(2, (5.0, 5.0))]
    other = replace(rows[0], binding=BehaviorCall.of(GRASP, {"grasp_point": 9.0}))
    here = standing([other, rows[1]], goal_at(5.0, 5.0, 1.0))
    assert Lookahead().choose(replace(here, holding=rows[1].binding)).position == 1
    assert Lookahead().choose(replace(here, holding=other.binding)).position == 0
    assert Lookahead(regrasp=0.0).choose(replace(here, holding=rows[1].binding)).position == 0


@pytest.mark.parametrize(("half_width", "margin"), [(2.25, INSIDE), (0.1, SMALL_GOAL * 0.1)])
def test_a_path_ends_at_the_goal_where_it_ends_well_inside_each_edge(
    half_width: float, margin: float
) -> None:
    goal, off = goal_at(3.0, 20.0, half_width), half_width - margin
    ways = np.array([(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)])
    for out, held in ((off - 1e-6, True), (off + 1e-6, False)):
        x, y = ((3.0, 20.0) + out * ways).T
        assert HalfPlanes(goal).hold(x, y).tolist() == [held] * 4


def test_of_the_paths_those_are_gone_on_from_that_may_still_be_the_best() -> None:
    """Not one that is at the goal, nor one that is as long as the best already."""
    x, y, none = np.array([0.0, 5.0, 10.0, 15.0]), np.zeros(4), np.zeros(4, dtype=np.intp)
    worth = np.array([2.0, NO_WAY + 3.0, NO_WAY + 1.0, NO_WAY + 2.0])
    cost = np.array([2.0, 1.0, 2.0, 0.5])
    layer = _Layer(x, y, cost, none, none, none, worth)
    assert _apart(layer, beam=9, best=3.0).tolist() == [3, 1]
    assert _apart(layer, beam=1, best=3.0).tolist() == [3]
