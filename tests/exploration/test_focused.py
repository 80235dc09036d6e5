"""Focused explorers: what they remember of contact and rows, and which tries they prefer (§8)."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli import registry
from affcli.behaviors.moving import DIRECTIONS
from affcli.core.affordance import Affordance
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import (
    POSITION_WRIST,
    BehaviorCall,
    Execution,
    ExecutionStatus,
    composed,
    composed_motion,
)
from affcli.core.change_detection import MOVEMENT_THRESHOLD, change_detected
from affcli.core.geometry import Point, Pose
from affcli.core.motion import Turn
from affcli.core.part import Part
from affcli.core.ports import Explorer
from affcli.core.trial import BabblingRecord
from affcli.exploration.contact_map import DEPTH, MARGIN, PROBABILITY, ContactMap
from affcli.exploration.focused import Focused
from affcli.exploration.grid import Grid, read, written
from affcli.exploration.memory import Memory
from affcli.exploration.random_babbling import RandomBabbling
from affcli.exploration.row_map import LARGEST, MOST_ROWS, RowMap
from affcli.exploration.tries import Tries
from affcli.exploration.way import Way, turned
from affcli.testing import examples

BOX = BabblingSettings()
PRIOR, CELL = 0.03, 0.5
OTHERS = {"random", "inventing"}
FOCUSED = [part for name, part in registry.parts("explorers").items() if name not in OTHERS]
SEEN = examples.observation(Point(0.0, 24.0), Point(0.0, 11.0))
places = st.tuples(st.floats(-7.0, 7.0), st.floats(7.0, 19.0)).map(lambda at: Point(*at))
travels = st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0)).map(lambda by: Point(*by))
ways = st.builds(Way, travels, st.floats(-0.8, 0.8))
TURNS = tuple(composed((Turn(degrees),)).call for degrees in (10.0, -10.0))


def contact(known: ContactMap, x: float, y: float) -> float:
    """Return the probability of contact with the attractor here to the wrist (in)."""
    return float(known.contact[known.grid.cells(x, y)])


@settings(max_examples=30)
@given(places, ways, st.floats(0.0, 1.0))
def test_what_a_push_passed_is_clear_and_where_it_met_the_attractor_is_contact(
    place: Point, way: Way, share: float
) -> None:
    """The attractor is met as long before the end as it moved; before that it was not there."""
    length = way.length(place)
    known = ContactMap(BOX, CELL, PRIOR)
    known.pushed(place, way, moved := share * length)
    gap = length - moved
    for gone in np.arange(0.0, gap - 2.0 * CELL, CELL):
        x, y = way.standing(place, np.array(gone / length))
        assert contact(known, float(x), float(y)) < PRIOR
    if length > 0.0:
        clear, met = (
            way.standing(place, np.array(max(0.0, far) / length))
            for far in (gap - MOVEMENT_THRESHOLD, gap + DEPTH)
        )
        i, j = (int(number) for number in known.grid.cells(*met))
        inside = 0 < i < known.grid.shape[0] - 1 and 0 < j < known.grid.shape[1] - 1
        # A move and a turn that cancel each other leave it in a cell that was found clear.
        if inside and math.dist(clear, met) > math.sqrt(2.0) * CELL:
            assert known.contact.max() == max(PROBABILITY.values())


@settings(max_examples=30)
@given(places, ways)
def test_only_the_way_truly_travelled_is_known_to_be_clear(place: Point, way: Way) -> None:
    """A behavior that met the edge of the reach says nothing of the way that it did not go."""
    known = ContactMap(BOX, CELL, PRIOR)
    known.passed(place, way)
    length = way.length(place)
    cells = int((known.contact[1:-1, 1:-1] < PRIOR).sum())
    assert cells <= max(0.0, length - CELL) / CELL + 2
    if length > 2.0 * CELL:
        assert contact(known, *place) < PRIOR


@given(places, ways, st.floats(0.0, 1.0))
def test_what_stays_on_the_table_stands_to_the_hand_as_the_hand_went(
    place: Point, way: Way, share: float
) -> None:
    """Set down again by the hand where that is then, it lies where it lay."""
    x, y = turned(*way.standing(place, np.array(share)), share * way.turn)
    assert x + share * way.travel.x == pytest.approx(place.x, abs=1e-9)
    assert y + share * way.travel.y == pytest.approx(place.y, abs=1e-9)


def test_a_blocked_place_is_contact_and_its_surroundings_are_suspected() -> None:
    known = ContactMap(BOX, CELL, PRIOR)
    known.passed(Point(3.0, 12.0), Way(Point(5.0, 0.0), 0.0))
    known.blocked(Point(3.0, 12.0))
    assert contact(known, 3.0, 12.0) > 0.9
    assert PRIOR < contact(known, 3.0, 12.0 + CELL) < 0.9
    assert contact(known, 3.0 - CELL, 12.0) < PRIOR, "found clear: it stays clear"
    assert contact(known, 3.0, 12.0 + 4.0 * CELL) == PRIOR


def test_nothing_is_looked_for_beyond_the_map() -> None:
    known = ContactMap(BOX, CELL, PRIOR)
    assert contact(known, BOX.offset_x_max + 2.0 * MARGIN, 12.0) < PRIOR
    assert contact(known, 0.0, 1000.0) < PRIOR


@settings(max_examples=30)
@given(st.floats(0.001, 1e6), st.floats(0.0, 1e6), st.floats(0.001, 1e6), st.floats(0.1, 5.0))
def test_a_grid_of_any_box_covers_it_with_few_cells(
    width: float, low: float, depth: float, cell: float
) -> None:
    box = BabblingSettings(offset_x_max=width, offset_y_min=low, offset_y_max=low + depth)
    grid = Grid.about(box, 1.0, cell, 50)
    assert max(grid.shape) <= 50
    assert min(grid.shape) >= 1
    i, j = grid.cells([-width, width], [low, low + depth])
    assert i[0] <= i[1] < grid.shape[0]
    assert j[0] <= j[1] < grid.shape[1]


@settings(max_examples=20)
@given(st.lists(st.tuples(st.integers(0, 1), places), max_size=30))
def test_rows_are_counted_the_same_in_whatever_order(
    rows: list[tuple[int, Point]],
) -> None:
    one, other, again = (RowMap(2, BOX, CELL, 1.0) for _ in range(3))
    for call, place in rows:
        one.add(call, place)
    for call, place in sorted(rows):
        other.add(call, place)
    again.restore(one.state())
    calls, at = np.array([0, 1, 0]), np.array([(0.0, 12.0), (1.0, 9.0), (-7.5, 6.8)])
    near = one.near(calls, *at.T)
    assert (near == other.near(calls, *at.T)).all()
    assert (near == again.near(calls, *at.T)).all()


def test_a_row_counts_near_its_start_and_for_its_own_behavior() -> None:
    rows = RowMap(2, BOX, CELL, 1.0)
    for _ in range(2 * MOST_ROWS):
        rows.add(1, Point(0.2, 12.2))
    x = np.array([0.2, 1.2, 6.0])
    near = rows.near(np.ones(3, dtype=np.intp), x, np.full(3, 12.2))
    assert near[0] == MOST_ROWS
    assert near[0] > near[1] > near[2] == 0.0
    assert not rows.near(np.zeros(3, dtype=np.intp), x, np.full(3, 12.2)).any()


@pytest.mark.parametrize("behaviors", [1, 8, 300, 10_000])
def test_the_rows_of_however_many_behaviors_have_room_in_a_database(behaviors: int) -> None:
    rows = RowMap(behaviors, BOX, 0.1, 1.0)
    assert behaviors * rows.grid.shape[0] * rows.grid.shape[1] <= LARGEST


@pytest.mark.parametrize("broken", [[], ["01"], ["0", "12"], ["05", "10"], ["0 ", "10"], [1, 2]])
def test_a_table_that_was_not_written_so_is_not_read(broken: list[str]) -> None:
    assert read(written(np.array([[0, 1], [2, 4]])), (2, 2), 4).tolist() == [[0, 1], [2, 4]]
    with pytest.raises((ValueError, TypeError)):
        read(broken, (2, 2), 4)


def by_slide(place: Point, call: BehaviorCall, half_width: float) -> tuple[Point, Pose]:
    """Return how a rod along y moves the attractor, and how the wrist goes, in a slide (in)."""
    length = call["offset_distance"]
    dx, dy = (length * along for along in DIRECTIONS[call.name])
    left = length - abs(place.x) + half_width if dx * place.x > 0.0 else 0.0
    return Point(max(0.0, left) / length * dx, 0.0), Pose(dx, dy)


def by_turn(place: Point, call: BehaviorCall, half_width: float) -> tuple[Point, Pose]:
    """Return how a rod along y carries the attractor about the wrist, and how it turns."""
    (turn,) = composed_motion(call) or ()
    assert isinstance(turn, Turn)
    angle, far = math.radians(turn.degrees), math.hypot(*place)
    aside = math.atan2(-place.x, place.y) - math.copysign(math.asin(half_width / far), angle)
    left = angle - aside if aside * angle > 0.0 and abs(aside) < abs(angle) else 0.0
    x, y = turned(*place, left)
    return Point(float(x) - place.x, float(y) - place.y), Pose(0.0, 0.0, angle)


def tried(explorer: Explorer, step: int, half_width: float) -> bool:
    """Let an explorer make one try with a tool that is a long rod along y; return T.

    Args:
        explorer: what chooses.
        step: number of the behavior.
        half_width: of the rod with the attractor's radius about it (in).
    """
    for place in (Point(*at) for at in explorer.places(SEEN, examples.anywhere).tolist()):
        if abs(place.x) >= half_width:
            break
        explorer.refused(place)
    call = explorer.behavior(place, SEEN)
    moved, went = (
        by_turn(place, call, half_width) if call in TURNS else by_slide(place, call, half_width)
    )
    wrist = Pose(*SEEN.wrist_for(place))
    end = Pose(wrist.x + went.x, wrist.y + went.y, wrist.angle + went.angle)
    start = examples.observation(SEEN.object_position, wrist.point)
    after = Point(start.object_x + moved.x, start.object_y + moved.y)
    seen = examples.observation(after, end.point)
    row = None
    if change_detected(start, seen):
        row = Affordance(step, examples.BINDING, call, start, seen)
    asked = BehaviorCall.of(POSITION_WRIST, {"x": place.x, "y": place.y})
    placing = Execution(asked, ExecutionStatus.DONE, wrist, wrist, 2.0)
    execution = Execution(call, ExecutionStatus.DONE, wrist, end, 2.0)
    explorer.tell(BabblingRecord(step, 4.0 * step, 0, 0, placing, execution, start, seen, row))
    return row is not None


def made(part: Part, seed: int = 0, calls: Sequence[BehaviorCall] = examples.CALLS) -> Focused:
    """Return an explorer that has not tried anything."""
    usual = {name: one.default for name, one in part.params.items()}
    explorer = part.build(calls, BOX, np.random.default_rng(seed), **usual)
    assert isinstance(explorer, Focused)
    return explorer


@pytest.mark.parametrize("part", FOCUSED, ids=lambda part: part.name)
def test_each_behavior_is_tried_first_to_see_how_it_moves_the_wrist(part: Part) -> None:
    explorer = made(part)
    for left in range(len(examples.CALLS), 0, -1):
        assert np.count_nonzero(explorer.state()["looks"]) == left
        tried(explorer, 1, 0.0)
    assert not any(explorer.state()["looks"])


@pytest.mark.parametrize("part", FOCUSED, ids=lambda part: part.name)
def test_tries_have_an_effect_more_often_than_at_random(part: Part) -> None:
    babbling = RandomBabbling(examples.CALLS, BOX, np.random.default_rng(0))
    at_random, focused = (
        sum(tried(explorer, step, 1.5) for step in range(1, 121))
        for explorer in (babbling, made(part))
    )
    assert focused > 1.5 * at_random


@pytest.mark.parametrize(
    "part", [one for one in FOCUSED if one.name != "goal-babbling"], ids=lambda part: part.name
)
def test_turns_have_an_effect_more_often_than_at_random(part: Part) -> None:
    """A turn moves the tool, though the wrist stays where it is.

    Goal babbling wants movements in all directions, and two turns give none of most.
    """
    babbling = RandomBabbling(TURNS, BOX, np.random.default_rng(0))
    at_random, focused = (
        sum(tried(explorer, step, 1.5) for step in range(1, 121))
        for explorer in (babbling, made(part, calls=TURNS))
    )
    assert focused > 1.5 * at_random


def test_a_turn_is_expected_to_carry_the_attractor_about_the_wrist() -> None:
    """Met at once, it comes along for the whole turn."""
    memory = Memory(1, BOX, cell=CELL, contact=PRIOR, near=1.0, place=2.0)
    memory.ways = [Way(Point(0.0, 0.0), math.radians(30.0))]
    place = np.array([[0.0, 12.0]])
    tries = Tries.of(np.zeros(1, dtype=np.intp), place, memory, SEEN, examples.anywhere)
    moved = tries.movement(np.ones(memory.contacts.grid.shape))
    assert moved[0].tolist() == pytest.approx([-12.0 * 0.5, 12.0 * (math.sqrt(0.75) - 1.0)])


def test_a_place_where_the_tool_came_down_on_the_attractor_is_not_asked_for_again() -> None:
    explorer = made(FOCUSED[0])
    for step in range(1, 9):
        tried(explorer, step, 0.0)
    first = Point(*explorer.places(SEEN, examples.anywhere)[0].tolist())
    explorer.refused(first)
    for _ in range(20):
        place = explorer.places(SEEN, examples.anywhere)[0]
        assert math.dist(place, first) > CELL
