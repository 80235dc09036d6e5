"""One robot babbling: a pure function of its spec, stopped and gone on with at any place (§6)."""

import json
import math
from dataclasses import replace
from itertools import islice, pairwise

import pytest
from affcli.lab.bench import tool_named
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.config import Settings
from affcli.core.change_detection import change_detected
from affcli.errors import AffcliError
from affcli.lab import learning
from affcli.lab.learning import learn
from affcli.lab.learning_run import LearningRun
from affcli.simulation.arm import reach_at
from affcli.store import LearningRunInfo, Store
from tests.factories import learning_spec
from tests.lab.quick import LEISURELY, Steps, learned, now, spec_of, table_from

SETTINGS = Settings()
NOISE = SETTINGS.sensor.position_noise
BOX = SETTINGS.babbling
tools = st.sampled_from(["stick", "t-hook"])
SHORT = 25


def gone_on_with(run: LearningRun) -> LearningRun:
    """Return a run that goes on from what a checkpoint keeps as text."""
    return LearningRun(run.spec, json.loads(json.dumps(run.checkpoint())))


@settings(deadline=None, max_examples=40)
@given(tools, st.integers(0, 3), st.integers(0, SHORT))
def test_a_run_stopped_anywhere_goes_on_as_if_it_had_not_been_stopped(
    tool: str, seed: int, stop: int
) -> None:
    """Stopped after any behavior, before the first and after the last too, and restored from text:
    the same further records, to the bit."""
    spec = spec_of(tool, SHORT, seed)
    run = LearningRun(spec)
    before = tuple(islice(run.steps(), stop))
    again = gone_on_with(run)
    assert again.done is (stop == SHORT)
    assert before + tuple(again.steps()) == learned(spec)


@settings(deadline=None, max_examples=15)
@given(tools, st.lists(st.integers(1, 6), min_size=1, max_size=6))
def test_a_run_stopped_time_and_again_goes_on_all_the_same(tool: str, pieces: list[int]) -> None:
    spec = spec_of(tool, SHORT)
    run = LearningRun(spec)
    steps: Steps = ()
    for piece in pieces:
        steps = (*steps, *islice(run.steps(), piece))
        assert run.checkpoint()["step"] == len(steps)
        run = gone_on_with(run)
    assert (*steps, *run.steps()) == learned(spec)


@settings(deadline=None, max_examples=10)
@given(tools, st.integers(0, 2**63 - 1), st.integers(0, 1000))
def test_the_same_spec_gives_the_same_records(tool: str, seed: int, robot: int) -> None:
    spec = learning_spec(tool, seed=seed, robot=robot, behaviors=5)
    assert tuple(LearningRun(spec).steps()) == tuple(LearningRun(spec).steps())


def test_seed_robot_and_tool_each_change_what_a_run_gives() -> None:
    specs = [
        spec_of("stick", 5, seed, robot) for seed in (0, 1, 2**63 - 1) for robot in (0, 1, 2)
    ] + [spec_of("t-hook", 5), spec_of("t-stick", 5)]
    calls = [tuple(r.placing.call for r, _ in learned(spec)) for spec in specs]
    assert len(set(calls)) == len(specs)


def test_a_longer_run_begins_with_the_shorter_one() -> None:
    assert learned(spec_of(behaviors=SHORT))[:7] == learned(spec_of(behaviors=7))


@pytest.mark.parametrize("behaviors", [1, 2, 30])
def test_a_run_of_so_many_behaviors_has_so_many(behaviors: int) -> None:
    records = [record for record, _ in learned(spec_of(behaviors=behaviors))]
    assert [record.step for record in records] == list(range(1, behaviors + 1))


def test_the_behavior_during_which_the_hour_runs_out_is_the_last() -> None:
    """§6: "limited to one hour of run time for every tool": robot time, resets cost none."""
    hours = 0.05
    run = LearningRun(learning_spec("stick", hours=hours))
    clocks = [record.clock for record, _ in run.steps()]
    assert clocks[-2] < 3600.0 * hours <= clocks[-1]
    assert run.bench.robot.clock == clocks[-1]
    assert all(a < b for a, b in pairwise(clocks))
    assert run.done


def test_an_hour_of_a_slower_robot_holds_fewer_behaviors() -> None:
    quick, slow = (
        sum(1 for _ in LearningRun(learning_spec("stick", hours=0.1, settings=s)).steps())
        for s in (SETTINGS, LEISURELY)
    )
    assert slow < quick


@pytest.fixture(scope="module")
def long_run() -> Steps:
    return learned(spec_of("t-hook", 500))


def test_rows_are_made_where_the_attractor_was_seen_to_move(long_run: Steps) -> None:
    """§3.2: a row if and only if T is 1, with both counters 1."""
    rows = [record.affordance for record, _ in long_run if record.affordance]
    assert 5 <= len(rows) < len(long_run)
    for record, _ in long_run:
        assert (record.affordance is not None) is change_detected(record.start, record.end)
    assert {(row.times_used, row.times_successful) for row in rows} == {(1, 1)}
    assert list(table_from(long_run)) == rows


def test_what_the_robot_saw_is_what_truly_was_but_for_noise(long_run: Steps) -> None:
    for record, truth in long_run:
        wrists = record.execution.wrist_start, record.execution.wrist_end
        for seen, true, wrist in zip((record.start, record.end), truth, wrists, strict=True):
            assert math.dist(seen.object_position, true.point) < 8.0 * NOISE
            offset = (true.x - wrist.x, true.y - wrist.y)
            assert math.dist(seen.wrist_to_object, offset) < 12.0 * NOISE
        if record.affordance is None:
            assert math.dist(truth.start.point, truth.end.point) < 0.5 + 12.0 * NOISE


def test_between_resets_nothing_but_behaviors_moves_the_attractor(long_run: Steps) -> None:
    for (_, before), (record, after) in pairwise(long_run):
        assert (after.start == before.end) is (record.resets == 0)


def test_every_wrist_offset_lies_in_the_box_and_every_wrist_in_reach(long_run: Steps) -> None:
    arm = SETTINGS.workspace.arm
    reach = reach_at(arm, arm.flange_height)
    shape = tool_named(SETTINGS, "t-hook")
    for record, truth in long_run:
        assert abs(record.placing.call["x"]) <= BOX.offset_x_max
        assert BOX.offset_y_min <= record.placing.call["y"] <= BOX.offset_y_max
        wrist = record.execution.wrist_start
        assert wrist == record.placing.wrist_end
        assert reach.inner - 1e-6 <= math.hypot(*wrist) <= reach.outer + 1e-6
        beside = type(wrist)(truth.start.x - wrist.x, truth.start.y - wrist.y)
        gap = min(part.distance(beside) for part in shape.outlines)
        assert gap >= SETTINGS.workspace.puck.radius


def test_the_clock_of_a_run_counts_every_behavior_and_no_reset(long_run: Steps) -> None:
    """§6: putting the attractor back suspends the trial: it takes no time of the robot's hour. A
    position wrist that was blocked does."""
    clocks = [SETTINGS.workspace.motion.grasp_time, *(record.clock for record, _ in long_run)]
    for before, (record, _) in zip(clocks, long_run, strict=False):
        took = record.placing.duration + record.execution.duration
        if record.redraws:
            assert record.clock - before > took
        else:
            assert record.clock - before == pytest.approx(took)
    assert any(record.redraws for record, _ in long_run)


def test_learning_saves_the_run_and_the_same_again_says_that_it_is_done(store: Store) -> None:
    spec = spec_of("t-hook", 60)
    told: list[LearningRunInfo] = []
    first = learn(store, spec, now, told.append)
    assert first.new
    assert (first.info.status, first.info.behaviors) == ("done", 60)
    assert told == [first.info]
    table, _ = store.affordance_table(first.info.id)
    assert list(table) == list(table_from(learned(spec)))
    assert first.info.rows == len(table)
    assert first.info.resets == sum(record.resets for record, _ in learned(spec))
    again = learn(store, spec, now)
    assert not again.new
    assert again.info == first.info


class PowerCutError(AffcliError):
    """Ends a learning run between two chunks."""


@pytest.mark.parametrize("chunks", [1, 3, 5])
def test_a_run_interrupted_between_chunks_goes_on_to_the_same_table(
    store: Store, monkeypatch: pytest.MonkeyPatch, chunks: int
) -> None:
    monkeypatch.setattr(learning, "CHUNK", 11)
    spec = spec_of("t-hook", 60)

    def cut(info: LearningRunInfo) -> None:
        if info.behaviors == 11 * chunks:
            raise PowerCutError

    with pytest.raises(PowerCutError):
        learn(store, spec, now, cut)
    (half,) = store.learning_runs()
    assert (half.status, half.behaviors) == ("running", 11 * chunks)
    resumed = learn(store, spec, now)
    assert resumed.new
    assert resumed.info.behaviors == 60
    assert resumed.info.resets == sum(record.resets for record, _ in learned(spec))
    assert resumed.info.redraws == sum(record.redraws for record, _ in learned(spec))
    assert resumed.info.robot_seconds == learned(spec)[-1][0].clock
    assert list(store.affordance_table(resumed.info.id)[0]) == list(table_from(learned(spec)))


def test_a_run_that_another_process_carried_on_meanwhile_is_not_done_twice(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever saves a chunk first wins, the other goes on from there."""
    monkeypatch.setattr(learning, "CHUNK", 10)
    spec = spec_of("t-hook", 40)
    overtaken: list[int] = []

    def meanwhile(info: LearningRunInfo) -> None:
        if not overtaken:
            overtaken.append(info.behaviors)
            learn(store, spec, now)

    finished = learn(store, spec, now, meanwhile)
    assert overtaken == [10]
    assert (finished.info.status, finished.info.behaviors) == ("done", 40)
    assert list(store.affordance_table(finished.info.id)[0]) == list(table_from(learned(spec)))


RUNS = [("stick", 0), ("stick", 1), ("t-hook", 0)]


def test_each_run_has_a_table_of_its_own(store: Store) -> None:
    infos = [learn(store, spec_of(tool, 40, seed), now).info for tool, seed in RUNS]
    assert len({info.id for info in infos}) == len(RUNS)
    for info, (tool, seed) in zip(infos, RUNS, strict=True):
        rows = list(store.affordance_table(info.id)[0])
        assert rows == list(table_from(learned(spec_of(tool, 40, seed))))


def test_a_run_of_other_settings_is_another_run(store: Store) -> None:
    one = spec_of("stick", 5)
    other = replace(one, settings=LEISURELY.to_json())
    assert learn(store, one, now).info.id != learn(store, other, now).info.id
