"""One robot babbling: a pure function of its spec, stopped and gone on with at any place (§6)."""

import json
import math
from dataclasses import replace
from itertools import islice, pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli import registry
from affcli.config import Settings, settings_with
from affcli.core.change_detection import change_detected
from affcli.core.identity import Component
from affcli.core.records import LearningRunInfo
from affcli.core.specs import LearningSpec
from affcli.core.tool import hold_of
from affcli.errors import AffcliError, BadInputError, DatabaseError
from affcli.lab import learning
from affcli.lab.learning import learn
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts
from affcli.simulation.arm import reach_at
from affcli.store import Store, run_sql
from tests.factories import learning_spec, seeds
from tests.lab.parts import CURIOUS, SILENT, register
from tests.lab.quick import LEISURELY, Steps, learned, now, spec_of, table_from

SETTINGS = Settings()
NOISE = SETTINGS.sensor.position_noise
BOX = SETTINGS.babbling
tools = st.sampled_from(["stick", "t-hook"])
SHORT = 25


def gone_on_with(run: LearningRun) -> LearningRun:
    """Return a run that goes on from what a checkpoint keeps as text."""
    return LearningRun(run.spec, json.loads(json.dumps(run.checkpoint())))


def curious_spec(behaviors: int = SHORT) -> LearningSpec:
    """Return a run of the explorer that a test brings; it must be registered."""
    parts = RunParts.chosen(SETTINGS, explorer="curious:patience=1")
    return parts.spec("t-hook", 3, 0, None, behaviors)


@settings(max_examples=40)
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


@pytest.mark.parametrize("explorer", sorted(registry.parts("explorers").keys() - {"random"}))
@pytest.mark.parametrize("stop", [1, 13])
def test_a_run_of_an_explorer_that_learns_goes_on_to_the_same_rows(
    explorer: str, stop: int
) -> None:
    """Another process has the checkpoint, and nothing else of what the explorer remembered."""
    spec = RunParts.chosen(SETTINGS, explorer=explorer).spec("t-hook", 3, 0, None, SHORT)
    run = LearningRun(spec)
    before = tuple(islice(run.steps(), stop))
    again = gone_on_with(run)
    after = tuple(again.steps())
    assert after == tuple(run.steps())
    assert before + after == tuple(LearningRun(spec).steps())
    assert again.checkpoint() == run.checkpoint()


@settings(max_examples=15)
@given(tools, st.lists(st.integers(1, 6), min_size=1, max_size=6))
def test_a_run_stopped_time_and_again_goes_on_all_the_same(tool: str, pieces: list[int]) -> None:
    spec = spec_of(tool, SHORT)
    run = LearningRun(spec)
    steps: Steps = ()
    for piece in pieces:
        steps = (*steps, *islice(run.steps(), piece))
        run = gone_on_with(run)
        assert run.behaviors == len(steps)
    assert (*steps, *run.steps()) == learned(spec)


def test_an_outsiders_explorer_is_stopped_after_any_behavior_and_gone_on_with(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What it remembers is in the checkpoint."""
    register(monkeypatch, CURIOUS)
    whole = tuple(LearningRun(curious_spec(200)).steps())
    tried = {str(record.execution.call) for record, _ in whole if record.affordance}
    assert len(tried) > 4
    assert any(record.redraws for record, _ in whole)
    run = LearningRun(curious_spec(200))
    for step in whole:
        run = gone_on_with(run)
        assert next(run.steps()) == step
    assert run.done


@settings(max_examples=10)
@given(tools, seeds, st.integers(0, 1000))
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


def test_a_run_of_so_many_behaviors_has_so_many() -> None:
    for behaviors in (1, 2, 30):
        records = [record for record, _ in learned(spec_of(behaviors=behaviors))]
        assert [record.step for record in records] == list(range(1, behaviors + 1))


def test_the_behavior_during_which_the_hour_runs_out_is_the_last() -> None:
    """§6: "limited to one hour of run time for every tool": robot time, resets cost none."""
    hours = 0.05
    run = LearningRun(learning_spec("stick", hours=hours))
    clocks = [record.clock for record, _ in run.steps()]
    assert clocks[-2] < 3600.0 * hours <= clocks[-1]
    assert run.setting.robot.clock == clocks[-1]
    assert all(a < b for a, b in pairwise(clocks))
    assert run.done


def test_an_hour_of_a_slower_robot_holds_fewer_behaviors() -> None:
    quick, slow = (
        sum(1 for _ in LearningRun(learning_spec("stick", hours=0.1, settings=s)).steps())
        for s in (SETTINGS, LEISURELY)
    )
    assert slow < quick


def test_a_repertoire_is_what_the_robot_tries() -> None:
    parts = RunParts.chosen(SETTINGS, repertoire=["extend-arm:offset_distance=3", "slide-arm-left"])
    calls = {
        str(record.execution.call) for record, _ in learned(parts.spec("stick", 0, 0, None, 20))
    }
    assert calls == {"extend arm 3", "slide arm left 5"}


def test_rows_carry_the_grasp_by_which_the_tool_was_held() -> None:
    parts = RunParts.chosen(SETTINGS, binding="grasp:grasp_point=4,angle=10")
    rows = list(table_from(learned(parts.spec("t-hook", 0, 0, None, 100))))
    assert len(rows) > 5
    assert {(row.binding["grasp_point"], row.binding["angle"]) for row in rows} == {(4.0, 10.0)}


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
        assert truth is not None
        wrists = record.execution.wrist_start, record.execution.wrist_end
        for seen, true, wrist in zip((record.start, record.end), truth, wrists, strict=True):
            assert math.dist(seen.object_position, true.point) < 8.0 * NOISE
            offset = (true.x - wrist.x, true.y - wrist.y)
            assert math.dist(seen.wrist_to_object, offset) < 12.0 * NOISE
        if record.affordance is None:
            assert math.dist(truth.start.point, truth.end.point) < 0.5 + 12.0 * NOISE


def test_between_resets_nothing_but_behaviors_moves_the_attractor(long_run: Steps) -> None:
    for (_, before), (record, after) in pairwise(long_run):
        assert before is not None
        assert after is not None
        assert (after.start == before.end) is (record.resets == 0)


def test_every_wrist_offset_lies_in_the_box_and_every_wrist_in_reach(long_run: Steps) -> None:
    arm, spec = SETTINGS.workspace.arm, spec_of()
    reach = reach_at(arm, arm.flange_height)
    held = spec.held.held(hold_of(spec.binding))
    for record, truth in long_run:
        assert truth is not None
        assert abs(record.placing.call["x"]) <= BOX.offset_x_max
        assert BOX.offset_y_min <= record.placing.call["y"] <= BOX.offset_y_max
        wrist = record.execution.wrist_start
        assert wrist == record.placing.wrist_end
        assert reach.inner - 1e-6 <= math.hypot(wrist.x, wrist.y) <= reach.outer + 1e-6
        beside = wrist.point._replace(x=truth.start.x - wrist.x, y=truth.start.y - wrist.y)
        gap = min(part.distance(beside) for part in held.outlines)
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
    assert told[1:] == [first.info]
    assert (told[0].behaviors, told[0].status) == (0, "running")
    table, _ = store.learning.table(first.info.id)
    assert list(table) == list(table_from(learned(spec)))
    assert first.info.rows == len(table)
    assert first.info.resets == sum(record.resets for record, _ in learned(spec))
    again = learn(store, spec, now)
    assert not again.new
    assert again.info == first.info


class PowerCutError(AffcliError):
    """Ends a learning run between two chunks."""


def cut_after(store: Store, spec: LearningSpec, behaviors: int) -> LearningRunInfo:
    """Interrupt a run between two chunks; return what the store holds of it."""

    def cut(info: LearningRunInfo) -> None:
        if info.behaviors == behaviors:
            raise PowerCutError

    with pytest.raises(PowerCutError):
        learn(store, spec, now, cut)
    (half,) = store.learning.runs(status="running")
    assert half.behaviors == behaviors
    return half


@pytest.mark.parametrize("chunks", [1, 5])
def test_a_run_interrupted_between_chunks_goes_on_to_the_same_table(
    store: Store, monkeypatch: pytest.MonkeyPatch, chunks: int
) -> None:
    monkeypatch.setattr(learning, "CHUNK", 11)
    spec = spec_of("t-hook", 60)
    cut_after(store, spec, 11 * chunks)
    resumed = learn(store, spec, now)
    assert resumed.new
    assert resumed.info.behaviors == 60
    assert resumed.info.resets == sum(record.resets for record, _ in learned(spec))
    assert resumed.info.redraws == sum(record.redraws for record, _ in learned(spec))
    assert resumed.info.robot_seconds == learned(spec)[-1][0].clock
    assert list(store.learning.table(resumed.info.id)[0]) == list(table_from(learned(spec)))


def test_an_interrupted_run_goes_on_with_the_parts_it_began_with_or_says_what_is_missing(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And the rest of the database works."""
    monkeypatch.setattr(learning, "CHUNK", 10)
    with monkeypatch.context() as with_it:
        register(with_it, CURIOUS)
        spec = curious_spec()
        cut_after(store, spec, 10)
    (half,) = store.learning.runs()
    assert half.spec == spec
    with pytest.raises(BadInputError, match=r"explorer curious:patience=1: this affcli has no"):
        learn(store, half.spec, now)
    other = learn(store, spec_of("stick", 15), now)
    assert other.info.behaviors == 15
    assert store.learning.run(half.id) == half
    register(monkeypatch, CURIOUS)
    finished = learn(store, half.spec, now).info
    assert (finished.id, finished.status) == (half.id, "done")
    whole = tuple(LearningRun(spec).steps())
    assert list(store.learning.table(half.id)[0]) == list(table_from(whole))


def test_a_run_of_another_version_of_its_world_is_not_gone_on_with(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(learning, "CHUNK", 10)
    half = cut_after(store, spec_of("stick"), 10)
    later = replace(half.spec, world=Component("table", version=9))
    store.learning.begin(later, {}, now())
    with pytest.raises(BadInputError, match="made in version 9 of the world table"):
        learn(store, later, now)


def test_a_run_that_is_done_needs_none_of_its_parts(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as earlier:
        register(earlier, SILENT)
        spec = RunParts.chosen(SETTINGS, world="silent").spec("stick", 0, 0, None, 12)
        done = learn(store, spec, now).info
    assert learn(store, spec, now) == learning.Learned(done, new=False)


def test_a_checkpoint_that_is_none_is_damage(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(learning, "CHUNK", 10)
    spec = spec_of("stick", 25)
    half = cut_after(store, spec, 10)
    for broken in ("NULL", "'{}'", "json_set(checkpoint, '$.step', 3)"):
        with store.database.writing() as connection:
            connection.exec_driver_sql(f"UPDATE learning_run SET checkpoint = {broken}")
        with pytest.raises(DatabaseError, match=f"learning run {half.id} cannot be gone on with"):
            learn(store, spec, now)


def test_a_run_that_another_process_carried_on_meanwhile_is_not_done_twice(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever saves a chunk first wins, the other goes on from there."""
    monkeypatch.setattr(learning, "CHUNK", 10)
    spec = spec_of("t-hook", 40)
    overtaken: list[int] = []

    def meanwhile(info: LearningRunInfo) -> None:
        if info.behaviors and not overtaken:
            overtaken.append(info.behaviors)
            learn(store, spec, now)

    finished = learn(store, spec, now, meanwhile)
    assert overtaken == [10]
    assert (finished.info.status, finished.info.behaviors) == ("done", 40)
    assert list(store.learning.table(finished.info.id)[0]) == list(table_from(learned(spec)))


def test_a_world_that_gives_no_snapshots_is_learned_whole_or_begun_anew(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It saves nothing on the way, and does not tell where the attractor truly was."""
    monkeypatch.setattr(learning, "CHUNK", 10)
    register(monkeypatch, SILENT)
    spec = RunParts.chosen(SETTINGS, world="silent").spec("t-hook", 0, 0, None, 120)
    store.learning.begin(spec, {}, now())
    told: list[LearningRunInfo] = []
    info = learn(store, spec, now, told.append).info
    assert [one.behaviors for one in told] == [0, 120]
    assert info.rows > 5
    assert store.learning.row_starts(info.id) == {}
    truth = "select count(*), count(true_start_x), count(true_end_angle) from behavior"
    assert run_sql(store.path, truth).rows == ((120, 0, 0),)


def test_each_run_has_a_table_of_its_own(store: Store) -> None:
    specs = [spec_of(tool, 40, seed) for tool, seed in [("stick", 0), ("stick", 1), ("t-hook", 0)]]
    infos = [learn(store, spec, now).info for spec in specs]
    assert len({info.id for info in infos}) == len(specs)
    for info, spec in zip(infos, specs, strict=True):
        assert list(store.learning.table(info.id)[0]) == list(table_from(learned(spec)))


def test_a_run_with_another_part_is_another_run(store: Store) -> None:
    chosen = [
        RunParts.chosen(SETTINGS),
        RunParts.chosen(LEISURELY),
        RunParts.chosen(SETTINGS, binding="grasp:grasp_point=4"),
        RunParts.chosen(SETTINGS, repertoire=["paper", "extend-arm:offset_distance=3"]),
        RunParts.chosen(settings_with({"sensor": {"kind": "exact"}}, "a test")),
    ]
    ids = {learn(store, one.spec("stick", 0, 0, None, 3), now).info.id for one in chosen}
    assert len(ids) == len(chosen)
