"""Behavioral babbling against a table without physics (§3.2, §6)."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from itertools import count, cycle, islice, pairwise, repeat

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.behaviors.moving import paper_repertoire
from affcli.core.affordance import Affordance
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import GRASP, POSITION_WRIST, BehaviorCall, ExecutionStatus
from affcli.core.geometry import Point
from affcli.core.trial import BabblingRecord
from affcli.exploration.random_babbling import RandomBabbling
from affcli.procedures.babbling import STINT, BabblingState, OtherGrasps, babble
from tests.factories import BINDING, EIGHTH, EXTEND_5, observation, places
from tests.fakes import (
    FakeExperimenter,
    FakeExplorer,
    FakeRobot,
    FakeSensor,
    FakeTable,
    no_effect,
    nowhere,
    scripted,
)

CALLS = tuple(behavior.call for behavior in paper_repertoire())
MANY_DRAWS = BabblingSettings()
BOX = replace(MANY_DRAWS, draws=4)
"""The box of the product; where every place is in reach, four draws are plenty."""
DONE, BLOCKED = ExecutionStatus.DONE, ExecutionStatus.BLOCKED
small_movements = st.tuples(st.integers(-8, 8), st.integers(-8, 8)).map(
    lambda m: (m[0] * EIGHTH, m[1] * EIGHTH)
)


def babbling(
    behaviors: int,
    robot: FakeRobot | None = None,
    experimenter: FakeExperimenter | None = None,
    *,
    seed: int = 0,
    box: BabblingSettings = BOX,
    state: BabblingState | None = None,
) -> list[BabblingRecord]:
    """Return the records of the first behaviors of a robot that babbles on a fake table."""
    robot = robot or FakeRobot(FakeTable())
    experimenter = experimenter or FakeExperimenter(robot.table)
    explorer = RandomBabbling(CALLS, box, np.random.default_rng(seed))
    state = state or BabblingState()
    sensor = FakeSensor(robot.table)
    return list(islice(babble(robot, sensor, experimenter, BINDING, explorer, state), behaviors))


def choices(records: list[BabblingRecord]) -> list[object]:
    """Return what a robot chose to do."""
    return [(record.placing.call, record.execution.call) for record in records]


@settings(deadline=None)
@given(st.lists(small_movements, min_size=1, max_size=30), st.integers(0, 99))
def test_a_row_is_made_if_and_only_if_t_is_1(
    movements: list[tuple[float, float]], seed: int
) -> None:
    """§3.2: "New rows are added to the table only if T was on while the exploratory behavior was
    performed." And every behavior is recorded, also the one without effect."""
    robot = FakeRobot(FakeTable(), effect=scripted(movements))
    records = babbling(len(movements), robot, seed=seed)
    assert len(records) == len(movements)
    assert [record.step for record in records] == list(range(1, len(movements) + 1))
    for record, (dx, dy) in zip(records, movements, strict=True):
        assert (record.affordance is not None) is (4.0 * (dx * dx + dy * dy) > 1.0)
        assert record.end.object_x - record.start.object_x == dx
        assert record.end.object_y - record.start.object_y == dy


@settings(deadline=None)
@given(st.integers(0, 99))
def test_a_row_holds_what_was_done_and_seen_with_both_counters_1(seed: int) -> None:
    """§3.2: binding behavior and parameters, exploratory behavior and parameters, O^s, O^e, and
    "During learning, the integer counters of all rows are set to 1"."""
    for record in babbling(8, FakeRobot(FakeTable(), effect=lambda call: (0.0, 2.0)), seed=seed):
        assert record.affordance == Affordance(
            step=record.step,
            binding=BINDING,
            exploratory=record.execution.call,
            start=record.start,
            end=record.end,
            truncated=False,
            times_used=1,
            times_successful=1,
            wrist_angle=record.execution.wrist_start.angle,
            travel=Point(0.0, 0.0),
        )


def test_a_behavior_that_met_the_edge_of_the_reach_makes_a_row_marked_truncated() -> None:
    endings = [ExecutionStatus.TRUNCATED, DONE] * 4
    robot = FakeRobot(FakeTable(), effect=lambda call: (0.0, 2.0), endings=endings)
    for record, ending in zip(babbling(8, robot), endings, strict=True):
        assert record.affordance is not None
        assert record.affordance.truncated is (ending is ExecutionStatus.TRUNCATED)
        assert record.affordance.exploratory == record.execution.call
        assert record.execution.call in CALLS


def test_the_tool_is_grasped_once_and_first_of_all() -> None:
    """§5.1: "only one grasping behavior"; it takes a single grasp point."""
    robot = FakeRobot(FakeTable())
    babbling(20, robot)
    assert robot.executed[0] == (BINDING, None)
    assert [call.name for call in robot.calls].count(GRASP) == 1


def test_a_robot_that_goes_on_does_not_grasp_again_and_counts_on() -> None:
    robot = FakeRobot(FakeTable())
    state = BabblingState(step=41, seen=observation(robot.table.attractor), grasped=True)
    records = babbling(2, robot, state=state)
    assert GRASP not in {call.name for call in robot.calls}
    assert [record.step for record in records] == [42, 43]
    assert state.step == 43


def test_each_behavior_goes_with_a_position_wrist_before_it() -> None:
    robot = FakeRobot(FakeTable())
    records = babbling(10, robot)
    done = [call for record in records for call in (record.placing.call, record.execution.call)]
    assert robot.calls == [BINDING, *done]
    assert {record.placing.call.name for record in records} == {POSITION_WRIST}


def test_position_wrist_aims_by_the_latest_observation_and_o_s_is_taken_after_it() -> None:
    """§3.2: O^s is the observation when the exploratory behavior begins, the wrist being there."""
    robot = FakeRobot(FakeTable(), effect=scripted([(1.0, 0.0), (0.0, 0.0), (-2.0, 1.0)] * 4))
    records = babbling(12, robot)
    aimed_by = [seen for call, seen in robot.executed if call.name == POSITION_WRIST]
    assert aimed_by[1:] == [record.end for record in records[:-1]]
    tried_by = [seen for call, seen in robot.executed if call in CALLS]
    assert tried_by == [record.start for record in records]
    for record in records:
        offset = record.start.wrist_to_object
        assert offset.x == pytest.approx(record.placing.call["x"])
        assert offset.y == pytest.approx(record.placing.call["y"])


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**63 - 1))
def test_the_same_seed_gives_the_same_records(seed: int) -> None:
    assert babbling(10, seed=seed) == babbling(10, seed=seed)


def test_other_seeds_give_other_choices() -> None:
    runs = [choices(babbling(5, seed=seed)) for seed in range(20)]
    assert all(a != b for k, a in enumerate(runs) for b in runs[:k])


@pytest.mark.parametrize("blocked", [1, 2, 5])
def test_when_the_tool_would_come_down_on_the_attractor_another_place_is_drawn(
    blocked: int,
) -> None:
    robot = FakeRobot(FakeTable(), placings=[*[BLOCKED] * blocked, DONE, BLOCKED, DONE])
    first, second, third = babbling(3, robot, box=MANY_DRAWS)
    assert (first.redraws, second.redraws, third.redraws) == (blocked, 1, 0)
    assert first.placing.status is DONE
    names = [call.name for call in robot.calls[1 : blocked + 2]]
    assert names == [POSITION_WRIST] * (blocked + 1)
    tried = [call for call in robot.calls if call.name == POSITION_WRIST]
    assert len(set(tried)) == len(tried)


def test_places_out_of_the_arms_reach_are_drawn_again_without_going_there() -> None:
    robot = FakeRobot(FakeTable(), reachable=lambda place: place.x > 3.0)
    records = babbling(30, robot, box=MANY_DRAWS)
    assert all(record.placing.wrist_end.x > 3.0 for record in records)
    assert all(record.redraws == record.resets == 0 for record in records)


def test_an_attractor_out_of_the_tools_reach_is_put_back_and_looked_at_again() -> None:
    """§6: "If the attractor was pushed out of tool reach by the robot then the learning trial was
    temporarily suspended while the attractor was manually placed in a new random position"."""
    table = FakeTable(attractor=Point(0.0, 90.0))
    robot = FakeRobot(table, effect=scripted([(0.0, 0.0), (0.0, 60.0), (0.0, 0.0)]))
    back = [Point(2.0, 24.0), Point(-3.0, 22.0)]
    experimenter = FakeExperimenter(table, lost=lambda place: place.y > 50.0, places=back)
    records = babbling(4, robot, experimenter)
    assert [record.resets for record in records] == [1, 0, 1, 0]
    assert experimenter.put_back == 2
    aimed_by = [seen for call, seen in robot.executed if call.name == POSITION_WRIST]
    assert [seen.object_position for seen in aimed_by if seen] == [
        back[0],
        back[0],
        back[1],
        back[1],
    ]


@settings(deadline=None, max_examples=30)
@given(st.lists(places, min_size=1, max_size=10), st.integers(0, 99))
def test_no_behavior_is_tried_on_an_attractor_out_of_reach(back: list[Point], seed: int) -> None:
    """§6: the trial is suspended until the attractor is back."""
    table = FakeTable(attractor=Point(90.0, 90.0))
    robot = FakeRobot(table, effect=lambda call: (200.0, 0.0))
    experimenter = FakeExperimenter(table, lost=lambda place: place.x > 50.0, places=back)
    records = babbling(len(back), robot, experimenter, seed=seed)
    assert [record.start.object_position for record in records] == back
    assert all(record.resets == 1 for record in records)


def test_when_all_draws_are_in_vain_the_attractor_is_put_back_as_if_out_of_reach() -> None:
    table = FakeTable(attractor=Point(0.0, 24.0))
    robot = FakeRobot(table, reachable=lambda place: place.x > 40.0)
    far = Point(60.0, 24.0)
    experimenter = FakeExperimenter(table, places=[Point(1.0, 24.0), far])
    (record,) = babbling(1, robot, experimenter, box=MANY_DRAWS)
    assert record.resets == 2
    assert record.redraws == 0
    assert record.start.object_position == far


def test_a_tool_blocked_at_every_draw_puts_the_attractor_back_and_counts_every_redraw() -> None:
    box = replace(BOX, draws=16)
    table = FakeTable()
    robot = FakeRobot(table, placings=[*[BLOCKED] * 17, DONE])
    experimenter = FakeExperimenter(table, places=[Point(1.0, 22.0)])
    (record,) = babbling(1, robot, experimenter, box=box)
    assert (record.resets, record.redraws) == (1, 17)


def test_the_records_carry_the_robots_clock() -> None:
    """§6: "one hour of run time": the clock of a record is that at the end of its step."""
    robot = FakeRobot(FakeTable(), placings=[DONE, BLOCKED, BLOCKED, DONE])
    records = babbling(3, robot)
    assert [record.clock for record in records] == [12.0, 28.0, 36.0]
    assert robot.clock == records[-1].clock


def test_babbling_has_no_end_of_its_own() -> None:
    rng = np.random.default_rng(0)
    table = FakeTable()
    records = babble(
        FakeRobot(table, effect=no_effect, placings=repeat(DONE)),
        FakeSensor(table),
        FakeExperimenter(table, lost=nowhere, places=(Point(0.0, k) for k in count())),
        BINDING,
        RandomBabbling(CALLS, BOX, rng),
        BabblingState(),
    )
    last = next(islice(records, 2999, None))
    assert last.step == 3000


def heard(robot: FakeRobot, behaviors: int, back: Iterable[Point] = ()) -> list[tuple[str, object]]:
    """Return what an explorer of two places is asked and told."""
    explorer = FakeExplorer([(0.0, 8.0), (2.0, 9.0)], EXTEND_5)
    experimenter = FakeExperimenter(robot.table, lost=lambda at: at.y > 50.0, places=back)
    running = babble(
        *(robot, FakeSensor(robot.table), experimenter, BINDING, explorer, BabblingState())
    )
    assert len(list(islice(running, behaviors))) == behaviors
    return explorer.heard


def test_an_explorer_is_asked_for_places_and_a_behavior_and_told_what_came_of_it() -> None:
    at, place = Point(0.0, 24.0), Point(0.0, 8.0)
    one = [("places", at), ("behavior", place)]
    expected = [*one, ("tell", 1), *one, ("tell", 2)]
    assert heard(FakeRobot(FakeTable(attractor=at)), 2) == expected


def test_an_explorer_is_told_of_refused_places_and_asked_for_others_after_all_were() -> None:
    at, back = Point(0.0, 24.0), Point(3.0, 22.0)
    robot = FakeRobot(FakeTable(attractor=at), placings=[BLOCKED, BLOCKED, BLOCKED, DONE])
    first, second = Point(0.0, 8.0), Point(2.0, 9.0)
    assert heard(robot, 1, [back]) == [
        *(("places", at), ("refused", first), ("refused", second)),
        *(("places", back), ("refused", first), ("behavior", second), ("tell", 1)),
    ]


def test_an_explorer_is_not_told_of_places_that_the_arm_cannot_take_up() -> None:
    at = Point(0.0, 24.0)
    robot = FakeRobot(FakeTable(attractor=at), reachable=lambda wrist: wrist.x < 0.0)
    expected = [("places", at), ("behavior", Point(2.0, 9.0)), ("tell", 1)]
    assert heard(robot, 1) == expected


def test_an_explorer_is_asked_again_when_the_attractor_was_lost() -> None:
    back = Point(3.0, 22.0)
    robot = FakeRobot(FakeTable(attractor=Point(0.0, 60.0)))
    assert heard(robot, 1, [back])[0] == ("places", back)


HIGHER = BehaviorCall.of(GRASP, {"grasp_point": 5.0})
TURNED = BehaviorCall.of(GRASP, {"grasp_point": 1.0, "angle": 180.0})


@given(st.integers(0, 999))
def test_the_grasp_is_drawn_at_the_start_for_each_stint_and_when_the_attractor_is_put_back(
    seed: int,
) -> None:
    """§3.2: "picks binding and exploratory behaviors at random". In between the tool stays in the
    hand; it is taken before the attractor is put back, and what is tried is asked of the explorer
    of its grasp alone."""
    table = FakeTable()
    robot = FakeRobot(table, effect=scripted(cycle([*[(0.0, 1.0)] * 7, (0.0, 40.0)])))
    hand = FakeExperimenter(table, lost=lambda at: at.y > 50.0, places=repeat(Point(0.0, 24.0)))
    bindings = (BINDING, HIGHER, TURNED)
    explorers = {one: FakeExplorer([(0.0, 8.0)], EXTEND_5) for one in bindings}
    others = {one: explorers[one] for one in (HIGHER, TURNED)}
    drawing = OtherGrasps(others, np.random.default_rng(seed))
    babbled = babble(
        *(robot, FakeSensor(table), hand, BINDING, explorers[BINDING], BabblingState()),
        others=drawing,
    )
    records = list(islice(babbled, 5 * STINT))
    held, before = BINDING, BINDING
    for record in records:
        held = record.binding or held
        assert record.affordance is not None
        assert record.affordance.binding == held
        assert record.resets > 0 or record.step % STINT == 1 or held == before
        before = held
    assert {record.binding for record in records} <= set(bindings)
    assert len({record.binding for record in records}) > 1
    for one, of in explorers.items():
        told = [what for word, what in of.heard if word == "tell"]
        assert told == [record.step for record in records if record.binding == one]
    taken = [call for call, _ in robot.executed if call.name == GRASP]
    assert all(one != other for one, other in pairwise(taken))


def test_each_of_several_grasps_is_drawn_as_often() -> None:
    drawing = OtherGrasps(
        {one: FakeExplorer([], EXTEND_5) for one in (HIGHER, TURNED)}, np.random.default_rng(1)
    )
    drawn = Counter(drawing.drawn(BINDING) for _ in range(3000))
    assert drawn.keys() == {BINDING, HIGHER, TURNED}
    assert all(850 < count < 1150 for count in drawn.values())


def test_one_grasp_is_taken_once_and_nothing_is_drawn_for_it() -> None:
    rng = np.random.default_rng(3)
    records = babbling(20)
    assert {record.binding for record in records} == {None}
    assert OtherGrasps({}, rng).drawn(BINDING) == BINDING
