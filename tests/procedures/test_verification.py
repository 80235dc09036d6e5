"""Rows tried again, against a table without physics (§3.1, §8)."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import islice, repeat

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.behaviors.moving import CONTRACT_ARM, EXTEND_ARM, SLIDE_ARM_LEFT
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import POSITION_WRIST, BehaviorCall, ExecutionStatus
from affcli.core.geometry import Point
from affcli.core.verification import ReplicationRecord
from affcli.errors import BadInputError
from affcli.procedures import verification
from affcli.procedures.verification import verify
from tests.factories import BINDING, affordance, table_of
from tests.fakes import (
    CALL_SECONDS,
    Effect,
    FakeExperimenter,
    FakeRobot,
    FakeSensor,
    FakeTable,
    everywhere,
    nowhere,
)

PLACES = {EXTEND_ARM: (0.0, 5.0), CONTRACT_ARM: (0.0, -5.0), SLIDE_ARM_LEFT: (-5.0, 0.0)}


def row(
    step: int, name: str = "extend arm", x: float = 0.0, used: int = 1, successful: int = 1
) -> Affordance:
    """Return a row of a behavior that moves the attractor 5 in its own way."""
    call = next(n for n in PLACES if n == name)
    return affordance(
        step,
        moved=PLACES[call],
        offset=Point(x, 8.0),
        call=BehaviorCall.of(call, {"offset_distance": 5.0}),
        used=used,
        successful=successful,
    )


ROWS = (
    row(2, "extend arm", -2.0),
    row(5, "contract arm", 1.0),
    row(6, "slide arm left", 4.0, used=2, successful=1),
    row(9, "extend arm", 3.0, used=3, successful=3),
)


def as_expected(call: BehaviorCall) -> tuple[float, float]:
    """Move the attractor as the rows say."""
    return PLACES[call.name]


@dataclass
class Test:
    """So many tries on a fake table."""

    __test__ = False
    rows: Iterable[Affordance] = ROWS
    tries: int = 4
    seed: int = 0
    effect: Effect = as_expected
    placings: Iterable[ExecutionStatus] = ()
    reachable: Callable[[Point], bool] = everywhere
    places: Iterable[Point] = repeat(Point(1.0, 24.0))

    def __post_init__(self) -> None:
        world = FakeTable()
        self.table: AffordanceTable = table_of(*self.rows)
        self.robot = FakeRobot(world, self.effect, self.placings, reachable=self.reachable)
        self.sensor = FakeSensor(world)
        self.experimenter = FakeExperimenter(world, places=self.places)
        rng = np.random.default_rng(self.seed)
        running = verify(self.robot, self.sensor, self.experimenter, self.table, BINDING, rng)
        self.records: list[ReplicationRecord] = list(islice(running, self.tries))


@settings(deadline=None)
@given(st.integers(1, 30), st.integers(0, 2**32), st.integers(1, 4))
def test_every_row_comes_once_in_each_round(count: int, seed: int, rounds: int) -> None:
    test = Test([row(n) for n in range(1, count + 1)], rounds * count, seed)
    steps = [record.row.step for record in test.records]
    for k in range(rounds):
        assert sorted(steps[k * count : (k + 1) * count]) == list(range(1, count + 1))


def test_the_order_is_random_and_another_in_every_round() -> None:
    test = Test([row(n) for n in range(1, 21)], 40)
    steps = [record.row.step for record in test.records]
    assert steps[:20] != sorted(steps[:20])
    assert steps[:20] != steps[20:]


def test_each_try_sets_up_the_rows_start_then_runs_its_behavior() -> None:
    """§8: "executing the same set of exploratory behaviors that was used in the past"."""
    test = Test(tries=8)
    assert test.robot.calls[0] == BINDING
    done = test.robot.calls[1:]
    assert len(done) == 16
    for record, placing, executed in zip(test.records, done[::2], done[1::2], strict=True):
        offset = record.row.start.wrist_to_object
        assert placing == BehaviorCall.of(POSITION_WRIST, {"x": offset.x, "y": offset.y})
        assert executed == record.row.exploratory
        assert record.start.wrist_to_object == offset
    assert [r.row.step for r in test.records] == [r.step for r in test.experimenter.put_for]


def test_what_is_seen_decides_and_is_counted() -> None:
    """§5.2: within 40 degrees of the movement stored in the table."""
    test = Test(tries=4, effect=lambda call: (0.0, 3.0))
    for record in test.records:
        assert record.replicated is (record.row.exploratory.name == EXTEND_ARM)
        now = next(r for r in test.table if r.step == record.row.step)
        assert now.times_used == record.times_used_after == record.row.times_used + 1
        assert now.times_successful == record.times_successful_after
        assert record.times_successful_after == record.row.times_successful + record.replicated


def test_excluded_rows_are_tried_too_and_may_come_back() -> None:
    """1/2 is excluded; 2/3 no longer is: only so is a repaired tool noticed."""
    test = Test(tries=4)
    dead = next(record for record in test.records if record.row.step == 6)
    assert not dead.live
    assert dead.replicated
    assert not dead.died
    assert sum(record.live for record in test.records) == 3
    assert bool(test.table.probable.all())


def test_numbers_and_clock_go_on() -> None:
    test = Test(tries=9)
    assert [record.number for record in test.records] == list(range(1, 10))
    assert [record.clock for record in test.records] == [
        CALL_SECONDS * (1 + 2 * n) for n in range(1, 10)
    ]


def test_a_tool_that_comes_down_on_the_attractor_has_failed() -> None:
    """As in a trial: whatever the tool is now, the row's start cannot be set up with it."""
    test = Test(tries=2, placings=[ExecutionStatus.BLOCKED])
    blocked, other = test.records
    assert blocked.execution is None
    assert not blocked.replicated
    assert blocked.seen.distance == 0.0
    assert other.replicated


def test_a_place_that_looks_out_of_reach_is_asked_for_anew() -> None:
    """By what is seen the wrist would go to x = place - offset."""
    far, near = Point(50.0, 24.0), Point(1.0, 24.0)
    test = Test(ROWS[:1], 1, places=[far, far, near], reachable=lambda wrist: abs(wrist.x) < 20.0)
    assert len(test.experimenter.put_for) == 3
    assert len(test.robot.calls) == 3
    assert test.records[0].start.object_position == near


def test_where_no_place_is_in_reach_the_row_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verification, "MOST_PLACES", 5)
    with pytest.raises(BadInputError, match=r"^row 2 \(extend arm 5\): 5 places in a row") as told:
        Test(ROWS[:1], 1, reachable=nowhere)
    assert "\n" not in str(told.value)


def test_the_same_stream_gives_the_same_tries_and_another_does_not() -> None:
    assert Test(tries=12).records == Test(tries=12).records
    orders = {tuple(r.row.step for r in Test(tries=12, seed=s).records) for s in range(5)}
    assert len(orders) > 1
