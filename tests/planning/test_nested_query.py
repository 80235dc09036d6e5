"""The four nested searches of §6.2, each against a naive one, and all of them in order."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.affordance import Affordance
from affcli.core.affordance_table import COLOR_TOLERANCE, AffordanceTable, Rows
from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.choice import Choice, Situation
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.task import GoalRegion
from affcli.core.tool import Color, ToolName
from affcli.planning.nested_query import (
    NestedQuery,
    consistent_with_colors,
    least_repositioning,
    likely_to_succeed,
    top_by_expected_distance,
    wrist_within_reach,
)
from affcli.simulation.tools.paper import TOOL_COLORS
from tests.factories import (
    EIGHTH,
    TOOL_COLOR,
    affordance,
    goal_at,
    observation,
    places,
    situation,
    table_of,
)
from tests.fakes import FakeRobot, FakeTable, everywhere
from tests.planning import naive_searches as naive

STICK_COLOR = TOOL_COLORS[ToolName("stick")]
near = st.integers(-8, 8).map(lambda n: n * EIGHTH)
near_places = st.builds(Point, near, near)
"""Few enough places that ties are common."""
rules: list[Callable[[Point], bool]] = [
    everywhere,
    lambda p: p.x >= 0.0,
    lambda p: abs(p.x) + abs(p.y) <= 1.0,
    lambda p: False,
]


@st.composite
def rows_drawn(draw: st.DrawFn, max_size: int = 24) -> list[Affordance]:
    """Draw rows of two tools with counters, movements and offsets that often tie."""
    drawn = draw(
        st.lists(
            st.tuples(
                near_places,
                near_places,
                st.integers(1, 5),
                st.integers(0, 5),
                st.sampled_from([TOOL_COLOR, TOOL_COLOR, STICK_COLOR]),
            ),
            max_size=max_size,
        )
    )
    return [
        affordance(
            step,
            offset=offset,
            moved=moved,
            used=used,
            successful=min(used, successful),
            tool_color=color,
        )
        for step, (offset, moved, used, successful, color) in enumerate(drawn, start=1)
    ]


def seen_at(place: Point) -> Observation:
    return observation(place, wrist=Point(0.0, 0.0))


def places_of(rows: list[naive.Aged]) -> list[int]:
    """Return where rows stand in the table, oldest first."""
    return sorted(age for age, _ in rows)


def all_of(table: AffordanceTable) -> Rows:
    return np.arange(len(table))


def robot_at(wrist: Point, reachable: Callable[[Point], bool] = everywhere) -> FakeRobot:
    return FakeRobot(FakeTable(wrist=Pose(*wrist)), reachable=reachable)


def choose_row(
    table: AffordanceTable, seen: Observation, goal: GoalRegion, robot: FakeRobot
) -> Choice:
    return NestedQuery().choose(situation(table, seen, goal, robot))


def rows_left(choice: Choice) -> tuple[int | None, ...]:
    """Return how many rows each search left."""
    return tuple(reason.rows for reason in choice.reasons)


@settings(deadline=None)
@given(rows_drawn(), st.sampled_from([TOOL_COLOR, STICK_COLOR, Color((9.0, 9.0, 9.0))]))
def test_search_1_selects_all_rows_of_the_current_tool_and_object(
    rows: list[Affordance], color: Color
) -> None:
    """§6.2: "Select all rows that have observation vectors consistent with the colors of the
    current tool and object"."""
    seen = observation(tool_color=color)
    found = consistent_with_colors(AffordanceTable(rows), seen)
    expected = naive.with_fitting_colors(list(enumerate(rows)), seen, COLOR_TOLERANCE)
    assert found.tolist() == places_of(expected)


@settings(deadline=None)
@given(rows_drawn())
def test_search_2_selects_rows_with_a_probability_greater_than_half(
    rows: list[Affordance],
) -> None:
    """§6.2: "select only those rows that have a replication probability (times_successful/
    times_used) greater than 1/2"."""
    table = AffordanceTable(rows)
    found = likely_to_succeed(table, all_of(table))
    assert found.tolist() == places_of(naive.more_likely_than_not(list(enumerate(rows))))


@pytest.mark.parametrize(
    ("used", "successful", "lives"),
    [(1, 1, True), (2, 1, False), (3, 2, True), (4, 2, False), (4, 3, True), (1, 0, False)],
)
def test_search_2_is_strict(used: int, successful: int, lives: bool) -> None:
    """§6.2: "it takes only one unsuccessful behavioral execution in order to eliminate an
    affordance": 1/2 is out, 2/3 is in."""
    table = table_of(affordance(used=used, successful=successful))
    assert len(likely_to_succeed(table, all_of(table))) == lives


@settings(deadline=None)
@given(rows_drawn(), near_places, st.sampled_from(rules))
def test_only_rows_whose_wrist_position_is_in_reach_are_candidates(
    rows: list[Affordance], at: Point, reachable: Callable[[Point], bool]
) -> None:
    """The robot cannot use a row whose wrist position (attractor - O^s offset) it cannot take."""
    table = AffordanceTable(rows)
    found = wrist_within_reach(table, all_of(table), seen_at(at), robot_at(at, reachable).reaches)
    expected = naive.with_wrist_in_reach(list(enumerate(rows)), seen_at(at), reachable)
    assert found.tolist() == places_of(expected)


@settings(deadline=None)
@given(rows_drawn(), near_places, near_places)
def test_search_3_keeps_the_top_fifth_by_the_distance_expected_between_attractor_and_goal(
    rows: list[Affordance], at: Point, goal: Point
) -> None:
    """§6.2: "Sort the remaining rows (in increasing order) based on the expected distance between
    the attractor object and the goal region if the behavior associated with this row were to be
    performed"; search 4 looks at "the top 20% of the sorted rows". Ties go to the older row."""
    table = AffordanceTable(rows)
    found = top_by_expected_distance(table, all_of(table), seen_at(at), goal_at(*goal))
    ranked = naive.sorted_by_expected_distance(list(enumerate(rows)), seen_at(at), goal_at(*goal))
    assert found.tolist() == (places_of(naive.top_fifth(ranked)) if rows else [])


@pytest.mark.parametrize(
    ("rows", "kept"),
    [(1, 1), (2, 1), (4, 1), (5, 1), (6, 2), (9, 2), (10, 2), (11, 3), (15, 3), (500, 100)],
)
def test_of_n_rows_the_top_20_percent_are_at_least_one_and_a_fifth_rounded_up(
    rows: int, kept: int
) -> None:
    """§6.2: "From the top 20% of the sorted rows": max(1, ceil(0.2 n))."""
    table = table_of(*(affordance(k, moved=(float(k % 7), 1.0)) for k in range(rows)))
    found = top_by_expected_distance(table, all_of(table), observation(), goal_at(0.0, 0.0))
    assert len(found) == kept == max(1, math.ceil(rows / 5))


def assert_cut_like_any_other(sizes: list[float]) -> None:
    """Check the top fifth of a table whose rows promise to miss the goal by `sizes`."""
    n = len(sizes)
    table = AffordanceTable([affordance(1)] * n)
    table.movement_x, table.movement_y = np.array(sizes), np.zeros(n)
    seen, goal = seen_at(Point(0.0, 0.0)), goal_at(0.0, 0.0)
    found = top_by_expected_distance(table, all_of(table), seen, goal)
    oldest_first = sorted(range(n), key=lambda k: (sizes[k], k))
    assert found.tolist() == sorted(oldest_first[: math.ceil(n / 5)])


@pytest.mark.parametrize("order", ["as they come", "nearest first", "farthest first", "all alike"])
def test_a_long_table_is_cut_like_any_other(order: str) -> None:
    n = 8_205
    sizes = np.random.default_rng(0).integers(0, 400, n) * EIGHTH
    if order != "as they come":
        sizes.sort()
    if order == "farthest first":
        sizes = sizes[::-1]
    if order == "all alike":
        sizes[:] = 3.0
    assert_cut_like_any_other(sizes.tolist())


@pytest.mark.parametrize("rows", [5, 17, 50])
def test_of_rows_at_the_same_expected_distance_the_older_are_kept(rows: int) -> None:
    table = table_of(*(affordance(k) for k in range(rows)))
    found = top_by_expected_distance(table, all_of(table), observation(), goal_at(3.0, 3.0))
    assert found.tolist() == list(range(math.ceil(rows / 5)))


@settings(deadline=None)
@given(near_places, near_places, near_places)
def test_the_place_expected_is_where_the_attractor_is_seen_plus_the_movement_of_the_row(
    at: Point, moved: Point, learned_at: Point
) -> None:
    """§6.1: "a predictive model of the results of the exploratory behaviors": seen + (O^e - O^s).
    Where on the table the row was learned does not count."""
    promised = affordance(1, moved=moved, at=learned_at)
    goal = goal_at(at.x + moved.x, at.y + moved.y)
    others = [
        affordance(k, moved=(moved.x + k * EIGHTH, moved.y), at=goal.center) for k in (2, 3, 4, 5)
    ]
    table = table_of(promised, *others)
    found = top_by_expected_distance(table, all_of(table), seen_at(at), goal)
    assert found.tolist() == [0]


@settings(deadline=None)
@given(rows_drawn(), near_places, near_places)
def test_search_4_chooses_the_row_with_the_least_repositioning_of_the_tool(
    rows: list[Affordance], at: Point, wrist: Point
) -> None:
    """§6.2: "choose one row which minimizes the re-positioning of the tool relative to its current
    location": the way from the wrist to (attractor - O^s offset). Ties go to the older row."""
    table = AffordanceTable(rows)
    chosen = least_repositioning(table, all_of(table), seen_at(at), Pose(*wrist))
    expected = naive.least_moved(list(enumerate(rows)), seen_at(at), wrist)
    assert chosen == (None if expected is None else expected[0])


@settings(deadline=None)
@given(rows_drawn(), st.data())
def test_each_search_sees_only_the_rows_that_the_searches_before_it_left(
    rows: list[Affordance], data: st.DataObject
) -> None:
    """§6.2: "Each successive search is performed only on the rows that were not eliminated by the
    previous searches"."""
    table = AffordanceTable(rows)
    numbers = st.sets(st.integers(0, max(0, len(rows) - 1)), max_size=len(rows))
    left = np.array(sorted(data.draw(numbers)) if rows else [], dtype=np.intp)
    few = [(int(k), rows[k]) for k in left]
    seen, goal, wrist = seen_at(Point(0.25, 0.5)), goal_at(0.0, 1.0), Point(0.5, 0.0)
    assert likely_to_succeed(table, left).tolist() == places_of(naive.more_likely_than_not(few))
    ranked = naive.sorted_by_expected_distance(few, seen, goal)
    found = top_by_expected_distance(table, left, seen, goal)
    assert found.tolist() == (places_of(naive.top_fifth(ranked)) if few else [])
    best = naive.least_moved(few, seen, wrist)
    assert least_repositioning(table, left, seen, Pose(*wrist)) == (
        None if best is None else best[0]
    )


@settings(deadline=None)
@given(rows_drawn(), near_places, near_places, near_places, st.sampled_from(rules))
def test_the_searches_are_performed_in_the_order_of_the_paper(
    rows: list[Affordance],
    at: Point,
    goal: Point,
    wrist: Point,
    reachable: Callable[[Point], bool],
) -> None:
    """§6.2: "Four nested searches were performed in the order shown below"; the reach before the
    sort, so that the top 20 % are of rows that can be used. Survivors only become fewer."""
    seen = seen_at(at)
    choice = choose_row(AffordanceTable(rows), seen, goal_at(*goal), robot_at(wrist, reachable))
    left = naive.with_fitting_colors(list(enumerate(rows)), seen, COLOR_TOLERANCE)
    counted = [len(left)]
    left = naive.more_likely_than_not(left)
    counted.append(len(left))
    left = naive.with_wrist_in_reach(left, seen, reachable)
    counted.append(len(left))
    ranked = naive.sorted_by_expected_distance(left, seen, goal_at(*goal))
    left = naive.top_fifth(ranked) if ranked else []
    counted.append(len(left))
    best = naive.least_moved(left, seen, wrist)
    assert rows_left(choice) == tuple(counted)
    assert choice.position == (None if best is None else best[0])
    assert counted == sorted(counted, reverse=True)
    assert (choice.position is None) is (counted[-1] == 0)


@settings(deadline=None)
@given(rows_drawn(), st.lists(st.integers(0, 39), max_size=10), near_places, near_places)
def test_rows_that_cannot_be_used_change_nothing(
    rows: list[Affordance], dead: list[int], at: Point, goal: Point
) -> None:
    """§6.2: rows eliminated by a search do not count in the searches after it: not the dead ones,
    not those of another tool, not those out of reach."""
    far = Point(30.0, 30.0)
    useless = [
        affordance(100, moved=(0.0, 0.0), used=2, successful=1),
        affordance(101, moved=(0.0, 0.0), tool_color=Color((0.0, 0.0, 0.0))),
        affordance(102, moved=(0.0, 0.0), offset=far),
    ]
    added = [replace(useless[k % 3], step=100 + n) for n, k in enumerate(dead)]
    robot = robot_at(Point(0.0, 0.0), lambda p: abs(p.x) < 10.0)
    seen = seen_at(at)
    alone = choose_row(AffordanceTable(rows), seen, goal_at(*goal), robot)
    beside = choose_row(AffordanceTable([*rows, *added]), seen, goal_at(*goal), robot)
    assert beside.position == alone.position
    assert beside.reasons[2:] == alone.reasons[2:]


@settings(deadline=None)
@given(rows_drawn(), near_places, near_places, near_places, places)
def test_only_where_things_stand_to_one_another_counts(
    rows: list[Affordance], at: Point, goal: Point, wrist: Point, shift: Point
) -> None:
    """§6.2 speaks of distances alone: attractor, goal and wrist moved together change nothing."""
    table = AffordanceTable(rows)

    def moved(place: Point) -> Point:
        return Point(place.x + shift.x, place.y + shift.y)

    here = choose_row(table, seen_at(at), goal_at(*goal), robot_at(wrist))
    there = choose_row(table, seen_at(moved(at)), goal_at(*moved(goal)), robot_at(moved(wrist)))
    assert here == there


def test_the_reach_is_asked_before_the_sort() -> None:
    """Eight rows promise the goal but ask for a wrist out of reach; two lesser ones can be done.
    Were the reach asked after the sort, the top 20 % would hold none of these two."""
    far, close = Point(5.0, 8.0), Point(0.0, 8.0)
    promising = [affordance(k, moved=(0.0, 5.0), offset=far) for k in range(1, 9)]
    lesser = [affordance(k, moved=(0.0, 1.0), offset=close) for k in (9, 10)]
    seen = observation(Point(0.0, 24.0))
    robot = robot_at(Point(0.0, 16.0), lambda p: p.x > -1.0)
    choice = choose_row(table_of(*promising, *lesser), seen, goal_at(0.0, 29.0), robot)
    assert choice.position == 8
    assert rows_left(choice) == (10, 10, 2, 1)


def test_repositioning_counts_only_within_the_top_fifth() -> None:
    """A row that needs no re-positioning at all loses to the row that promises most."""
    best = affordance(1, moved=(0.0, 5.0), offset=Point(6.0, 14.0))
    handy = [affordance(k, moved=(0.0, 4.0), offset=Point(0.0, 8.0)) for k in (2, 3, 4, 5)]
    robot = robot_at(Point(0.0, 16.0))
    choice = choose_row(table_of(best, *handy), observation(), goal_at(0.0, 29.0), robot)
    assert choice.position == 0


def test_a_blank_table_gives_no_row() -> None:
    choice = choose_row(AffordanceTable(), observation(), goal_at(0.0, 0.0), robot_at(Point(0, 0)))
    assert choice.position is None
    assert rows_left(choice) == (0, 0, 0, 0)


HELD = affordance().binding
OTHER = BehaviorCall.of(GRASP, {"grasp_point": 9.0})


def planned(rows: list[Affordance], holding: BehaviorCall | None, **params: float) -> Choice:
    """Return what search 4 chooses of all rows, with the tool held in some way."""
    here = replace(standing_with(rows), holding=holding)
    return NestedQuery(1.0, **params).choose(here)


def standing_with(rows: list[Affordance]) -> Situation:
    """Return a robot at the middle of the rows' places, with no tool in its hand."""
    robot = robot_at(Point(0.0, 0.0))
    return situation(table_of(*rows), seen_at(Point(0.0, 0.0)), goal_at(0.0, 0.0), robot)


@given(rows_drawn(), st.sampled_from([0.0, 10.0, 1000.0]))
def test_with_one_grasp_a_new_one_costs_nothing(rows: list[Affordance], cost: float) -> None:
    """Nor where it is not known how the tool is held."""
    expected = planned(rows, None)
    assert planned(rows, HELD, regrasp=cost) == expected
    other = [replace(row, binding=OTHER) for row in rows]
    assert planned(other, None, regrasp=cost).position == expected.position


@given(rows_drawn(), st.data())
def test_a_row_of_another_grasp_is_as_much_farther_away_as_the_grasp_costs(
    rows: list[Affordance], data: st.DataObject
) -> None:
    """Search 4 takes the row with the least way of the wrist and cost of a grasp together."""
    grasps = [data.draw(st.sampled_from([HELD, OTHER])) for _ in rows]
    mixed = [replace(row, binding=one) for row, one in zip(rows, grasps, strict=True)]
    here = standing_with(mixed)
    found = NestedQuery(1.0, regrasp=10.0).candidates(replace(here, holding=HELD))
    ways = {one.position: one.repositioning for one in NestedQuery(1.0).candidates(here)}
    for one in found:
        more = 10.0 if here.table.row(one.position).binding == OTHER else 0.0
        assert one.repositioning == pytest.approx(ways[one.position] + more)
    chosen = planned(mixed, HELD, regrasp=10.0).position
    assert chosen == (found[0].position if found else None)
    if found:
        assert found[0].repositioning == min(one.repositioning for one in found)
