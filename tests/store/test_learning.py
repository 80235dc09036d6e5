"""Learning runs: begun, saved chunk by chunk, read again as they were written."""

import math
from collections.abc import Iterable
from dataclasses import replace
from itertools import count

import pytest
import sqlalchemy as sa
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from affcli.core.affordance import Affordance
from affcli.core.behavior import (
    GRASP,
    LONGEST_NAME,
    BehaviorCall,
    BehaviorName,
    ExecutionStatus,
    ExploratoryBehavior,
)
from affcli.core.geometry import Point, Pose, direction_degrees
from affcli.core.identity import Component
from affcli.core.motion import Carry, Slide, Wait
from affcli.core.observation import Observation
from affcli.core.replay import Difference
from affcli.core.specs import LearningStep
from affcli.core.tool import Color, ToolName, unknown_tool
from affcli.errors import DatabaseError, UsageError
from affcli.lab.learning_run import LearningRun
from affcli.store import Store, run_sql
from affcli.store.learning import insert_steps, insert_tools
from affcli.store.rows import params_to_json, to_json
from tests.factories import learning_spec
from tests.store.records import NOW, VERSIONS, begun, learned, learning_step, learning_steps

LATER = "2026-01-02T04:04:05+00:00"


def rows_of(steps: Iterable[LearningStep]) -> list[Affordance]:
    return [record.affordance for record, _ in steps if record.affordance is not None]


def test_a_new_run_is_empty_and_says_what_it_is(store: Store) -> None:
    spec = learning_spec("stick", seed=2**63 - 1, behaviors=50)
    run = store.learning.begin(spec, VERSIONS, NOW)
    assert (run.spec, run.versions, run.status) == (spec, VERSIONS, "running")
    kept = "select started_at, finished_at from learning_run"
    assert run_sql(store.path, kept).rows == ((NOW, None),)
    assert (run.behaviors, run.rows, run.resets, run.redraws, run.robot_seconds) == (0, 0, 0, 0, 0)
    assert (run.checkpoint, run.session_id) == (None, None)


def test_the_same_spec_finds_the_same_run(store: Store) -> None:
    first = store.learning.begin(learning_spec(), VERSIONS, NOW)
    assert store.learning.begin(learning_spec(), {"affcli": "9"}, LATER) == first


@pytest.mark.parametrize(
    "other",
    [
        learning_spec("stick"),
        learning_spec(seed=1),
        learning_spec(robot=1),
        learning_spec(behaviors=21),
        learning_spec(hours=20.0),
        replace(learning_spec(), settings='{"trial.max_steps":6}'),
        replace(learning_spec(), repertoire=learning_spec().repertoire[1:]),
        replace(learning_spec(), binding=BehaviorCall.of(GRASP, {"grasp_point": 2.0})),
        replace(learning_spec(), explorer=Component.parse("focused:share=0.5")),
        replace(learning_spec(), sensor="exact"),
        replace(learning_spec(), world=Component("table", version=9)),
        replace(learning_spec(), held=learning_spec("stick").held),
    ],
)
def test_another_spec_is_another_run(other: object, store: Store) -> None:
    first = store.learning.begin(learning_spec(), VERSIONS, NOW)
    assert store.learning.begin(other, VERSIONS, NOW).id != first.id  # type: ignore[arg-type]


def test_chunks_add_up_to_the_whole_run(store: Store) -> None:
    run = store.learning.begin(learning_spec(behaviors=10), VERSIONS, NOW)
    steps = learning_steps(10)
    checkpoint = {"step": 4, "streams": {"noise": {"state": 2**127 + 1}}, "seen": [0.1, None]}
    assert store.learning.append(run.id, 0, steps[:4], checkpoint, 21.0, done=False, now=LATER)
    halfway = store.learning.begin(run.spec, VERSIONS, NOW)
    assert (halfway.behaviors, halfway.rows, halfway.resets) == (4, 1, 2)
    assert (halfway.robot_seconds, halfway.status, halfway.checkpoint) == (
        *(21.0, "running"),
        checkpoint,
    )
    assert store.learning.append(run.id, 4, steps[4:], checkpoint, 52.5, done=True, now=LATER)
    whole = store.learning.begin(run.spec, VERSIONS, NOW)
    assert (whole.behaviors, whole.rows, whole.resets, whole.redraws) == (10, 3, 5, 0)
    assert (whole.robot_seconds, whole.status) == (52.5, "done")
    kept = f"select finished_at from learning_run where id = {whole.id}"
    assert run_sql(store.path, kept).rows == ((LATER,),)
    assert whole.checkpoint is None
    table, ids = store.learning.table(run.id)
    assert list(table) == rows_of(steps)
    assert list(ids) == [3, 6, 9]


def test_a_chunk_that_another_process_has_saved_is_left_out(store: Store) -> None:
    run = store.learning.begin(learning_spec(), VERSIONS, NOW)
    steps = learning_steps(6)
    assert store.learning.append(run.id, 0, steps[:4], {"step": 4}, 21.0, done=False, now=NOW)
    before = store.learning.begin(run.spec, VERSIONS, NOW)
    assert not store.learning.append(run.id, 0, steps[:4], {"step": 4}, 21.0, done=False, now=NOW)
    assert not store.learning.append(run.id, 2, steps[2:], {"step": 6}, 31.5, done=True, now=NOW)
    assert store.learning.begin(run.spec, VERSIONS, NOW) == before


def test_a_finished_run_takes_nothing_more(store: Store) -> None:
    run = learned(store, 3)
    assert not store.learning.append(
        run.id, 3, learning_steps(1, first=4), None, 99.0, done=True, now=LATER
    )
    assert store.learning.begin(run.spec, VERSIONS, NOW) == run


def test_a_gap_between_chunks_is_a_bug(store: Store) -> None:
    run = store.learning.begin(learning_spec(), VERSIONS, NOW)
    with pytest.raises(ValueError, match="0 behaviors, not 5"):
        store.learning.append(run.id, 5, learning_steps(1, first=6), {}, 1, done=False, now=NOW)


def test_a_chunk_is_saved_whole_or_not_at_all(store: Store) -> None:
    run = store.learning.begin(learning_spec(), VERSIONS, NOW)
    torn = [*learning_steps(3), learning_step(3)]  # step 3 twice
    with pytest.raises(Exception, match="UNIQUE constraint failed"):
        store.learning.append(run.id, 0, torn, {}, 1.0, done=False, now=NOW)
    assert store.learning.begin(run.spec, VERSIONS, NOW) == run
    assert len(store.learning.table(run.id)[0]) == 0


def test_a_run_can_go_on_from_its_stored_checkpoint(store: Store) -> None:
    """What the store keeps of a real run is enough to finish it as if it had not been stopped."""
    spec = learning_spec(behaviors=12)
    whole = list(LearningRun(spec).steps())
    begun = LearningRun(spec)
    steps = begun.steps()
    first = [next(steps) for _ in range(5)]
    run = store.learning.begin(spec, VERSIONS, NOW)
    store.learning.append(run.id, 0, first, begun.checkpoint(), 1.0, done=False, now=NOW)
    stored = store.learning.begin(spec, VERSIONS, NOW)
    rest = list(LearningRun(spec, stored.checkpoint).steps())
    assert first + rest == whole


printable = st.characters(exclude_categories=["C", "Z"], include_characters=" ")
calls = st.builds(
    BehaviorCall.of,
    st.text(printable, min_size=1, max_size=LONGEST_NAME).map(BehaviorName),
    st.dictionaries(
        st.text(st.characters(exclude_categories=["Cs"])),
        st.floats(allow_nan=False, allow_infinity=False),
        max_size=3,
    ),
)
numbers = count()
components = st.floats(-1e6, 1e6)
observations = st.builds(Observation, *[components] * 12)


@st.composite
def affordances(draw: st.DrawFn) -> Affordance:
    used = draw(st.integers(1, 2**40))
    return Affordance(
        step=draw(st.integers(1, 2**40)),
        binding=replace(draw(calls), name=GRASP),
        exploratory=draw(calls),
        start=draw(observations),
        end=draw(observations),
        truncated=draw(st.booleans()),
        times_used=used,
        times_successful=draw(st.integers(0, used)),
        wrist_angle=draw(components),
        travel=Point(draw(components), draw(components)),
    )


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.lists(affordances(), max_size=5, unique_by=lambda row: row.step))
def test_an_affordance_table_is_read_as_it_was_written(
    store: Store, rows: list[Affordance]
) -> None:
    """Every name, parameter and number comes back the same; as learned the counters are 1."""
    repertoire = tuple(ExploratoryBehavior(call, ()) for call in {row.exploratory for row in rows})
    spec = replace(learning_spec(seed=next(numbers)), repertoire=repertoire)
    run = store.learning.begin(spec, VERSIONS, NOW)
    steps = []
    for row in rows:
        record, truth = learning_step(1)
        executed = replace(record.execution, call=row.exploratory, status=ExecutionStatus.DONE)
        steps.append((replace(record, step=row.step, execution=executed, affordance=row), truth))
    with store.database.writing() as connection:
        assert insert_steps(connection, run.id, run.spec.tool, steps) == len(rows)
    table, ids = store.learning.table(run.id)
    oldest_first = sorted(rows, key=lambda row: row.step)
    assert list(table) == oldest_first
    assert set(ids) == {row.step for row in rows}
    fresh, _ = store.learning.table(run.id, as_learned=True)
    assert list(fresh) == [replace(r, times_used=1, times_successful=1) for r in oldest_first]


def test_every_behavior_is_kept_with_what_was_commanded_seen_and_true(store: Store) -> None:
    run = learned(store, 3)
    result = run_sql(store.path, f"select * from behavior where learning_run_id = {run.id}")
    kept = [dict(zip(result.columns, row, strict=True)) for row in result.rows]
    for stored, (record, truth) in zip(kept, learning_steps(3), strict=True):
        execution, start, end = record.execution, record.start, record.end
        assert truth is not None
        assert stored == {
            "learning_run_id": run.id,
            "step": record.step,
            "clock": record.clock,
            "exploratory_behavior": "extend arm",
            "exploratory_params": '{"offset_distance": 5.0}',
            "status": "done",
            "duration": execution.duration,
            "resets": record.resets,
            "redraws": record.redraws,
            "place_x": record.placing.call["x"],
            "place_y": record.placing.call["y"],
            "wrist_start_x": execution.wrist_start.x,
            "wrist_start_y": execution.wrist_start.y,
            "wrist_start_angle": execution.wrist_start.angle,
            "wrist_end_angle": execution.wrist_end.angle,
            "wrist_end_x": execution.wrist_end.x,
            "wrist_end_y": execution.wrist_end.y,
            "start_object_x": start.object_x,
            "start_object_y": start.object_y,
            "start_wrist_to_object_x": start.wrist_to_object_x,
            "start_wrist_to_object_y": start.wrist_to_object_y,
            "end_object_x": end.object_x,
            "end_object_y": end.object_y,
            "end_wrist_to_object_x": end.wrist_to_object_x,
            "end_wrist_to_object_y": end.wrist_to_object_y,
            "true_start_x": truth.start.x,
            "true_start_y": truth.start.y,
            "true_start_angle": truth.start.angle,
            "true_end_x": truth.end.x,
            "true_end_y": truth.end.y,
            "true_end_angle": truth.end.angle,
            "change_detected": int(record.affordance is not None),
        }


def test_movement_and_direction_are_those_of_the_row(store: Store) -> None:
    run = store.learning.begin(learning_spec(), VERSIONS, NOW)
    moves = [(4.0, 0.0), (3.0, 3.0), (0.0, 2.0), (-1.0, 0.0), (0.0, -5.0), (1.0, -1e-18)]
    steps = [learning_step(n, moved=move) for n, move in enumerate(moves, 1)]
    store.learning.append(run.id, 0, steps, {}, 1.0, done=False, now=NOW)
    stored = run_sql(store.path, "select movement, direction from affordance order by step").rows
    for (movement, direction), row in zip(stored, rows_of(steps), strict=True):
        expected = row.expected_movement
        assert movement == expected.distance
        assert direction == direction_degrees(expected.dx, expected.dy)


def test_runs_are_listed_and_the_latest_finished_one_found(store: Store) -> None:
    assert store.learning.latest("t-hook") is None
    first = learned(store, 3)
    second = learned(store, 6)
    running = store.learning.begin(learning_spec(seed=5), VERSIONS, NOW)
    stick = learned(store, spec=learning_spec("stick", behaviors=9))
    session = begun(store, "reproduce")
    part = store.learning.begin(learning_spec(), VERSIONS, LATER, session)
    store.learning.append(part.id, 0, learning_steps(3), None, 1.0, done=True, now=LATER)
    assert store.learning.runs() == (first, second, running, stick)
    assert store.learning.runs(tool="t-hook", status="done") == (first, second)
    assert [run.id for run in store.learning.runs(session_id=session)] == [part.id]
    assert store.learning.latest("t-hook") == second
    assert store.learning.latest("l-hook") is None


def test_row_starts_tell_where_wrist_and_attractor_were(store: Store) -> None:
    run = learned(store, 6)
    starts = store.learning.row_starts(run.id)
    assert starts == {
        record.step: (record.execution.wrist_start, truth.start)
        for record, truth in learning_steps(6)
        if record.affordance is not None and truth is not None
    }
    wrist, attractor = starts[3]
    assert type(wrist) is type(attractor) is Pose


@pytest.mark.parametrize(
    "tool", ["x'); DROP TABLE affordance; --", "[/]", '"; PRAGMA x', "\x1b[0m"]
)
def test_text_from_outside_is_inert(tool: str, store: Store) -> None:
    named = replace(
        learning_spec(behaviors=9), held=replace(learning_spec().held, name=ToolName(tool))
    )
    run = learned(store, spec=named)
    assert store.learning.latest(tool) == run
    assert len(store.learning.table(run.id)[0]) == 3
    assert [r.spec.tool for r in store.learning.runs()] == [tool]


@pytest.mark.parametrize("params", ["{", "[]", '{"offset_distance": "far"}', "null"])
def test_a_value_that_affcli_did_not_write_is_named(params: str, store: Store) -> None:
    run = learned(store)
    with store.database.writing() as connection:
        connection.exec_driver_sql("UPDATE affordance SET binding_params = ?", (params,))
    with pytest.raises(DatabaseError, match=f"the affordance table of run {run.id} holds a value"):
        store.learning.table(run.id)


@pytest.mark.parametrize("column", ["binding_behavior", "exploratory_behavior"])
def test_a_row_of_a_behavior_that_its_run_never_had_is_damage(column: str, store: Store) -> None:
    run = learned(store)
    with store.database.writing() as connection:
        connection.exec_driver_sql(f"UPDATE affordance SET {column} = 'juggle'")
    with pytest.raises(DatabaseError, match=f"the affordance table of run {run.id} holds a value"):
        store.learning.table(run.id)


@pytest.mark.fault(43)
def test_the_latest_run_is_the_one_begun_last_whatever_the_clock_says(store: Store) -> None:
    earlier = store.learning.begin(learning_spec(seed=1, behaviors=3), VERSIONS, LATER)
    later = learned(store, 3)
    steps = learning_steps(3)
    assert store.learning.append(earlier.id, 0, steps, None, 1.0, done=True, now=LATER)
    assert store.learning.latest("t-hook") == later


def test_parts_that_nobody_here_knows_are_read_as_they_were_written(store: Store) -> None:
    """A colleague's run can be listed, and found again."""
    rake = replace(learning_spec().held, name=ToolName("rake"))
    push = ExploratoryBehavior(
        BehaviorCall.of(BehaviorName("push around"), {"radius": 2.5, "angle": 30.0}),
        (Slide(1.0, 0.1), Wait(0.5), Carry(Pose(1.0, 2.0, 0.3))),
    )
    spec = replace(
        learning_spec(),
        held=rake,
        repertoire=(push,),
        binding=BehaviorCall.of(BehaviorName("pinch"), {"grasp_point": 0.1 + 0.2, "angle": 5.0}),
        explorer=Component.parse("curious:rate=0.1,width=3"),
        world=Component.parse("moon@3:gravity=1.62"),
        settings='{"moon.dust":0.5}',
    )
    run = store.learning.begin(spec, VERSIONS, NOW)
    assert run.spec == spec
    assert run.spec.key == spec.key
    assert store.learning.find(run.spec) == run


def test_a_tool_of_unknown_shape_has_no_value(store: Store) -> None:
    spec = replace(learning_spec(), held=unknown_tool("rake"))
    assert store.learning.begin(spec, VERSIONS, NOW).spec == spec
    assert run_sql(store.path, "select count(*) from tool").rows == ((0,),)


def test_tools_are_stored_once_by_value(store: Store) -> None:
    held = learning_spec().held
    for tool in (held, held, held.painted(Color((1.0, 2.0, 3.0)))):
        spec = replace(learning_spec(), held=tool)
        assert store.learning.begin(spec, VERSIONS, NOW).spec.held == tool
    assert run_sql(store.path, "select name from tool").rows == (("t-hook",), ("t-hook",))


def test_a_tool_that_cannot_be_stored_is_not_passed_over(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only one that is there already is."""
    monkeypatch.setattr("affcli.store.rows.tool_row", lambda _: ("key", None, "{}"))
    with pytest.raises(sa.exc.IntegrityError), store.database.writing() as connection:
        insert_tools(connection, learning_spec())


def test_a_world_that_does_not_tell_leaves_the_truth_open(store: Store) -> None:
    run = store.learning.begin(learning_spec(), VERSIONS, NOW)
    steps = [(record, None) for record, _ in learning_steps(3)]
    store.learning.append(run.id, 0, steps, None, 1.0, done=True, now=NOW)
    assert store.learning.row_starts(run.id) == {}
    assert store.learning.differences(run.id, "t-hook", steps) == ()
    with pytest.raises(UsageError, match="its world does not tell where the attractor was"):
        store.learning.scene(run.id, 3)


def test_a_behavior_s_scene_is_as_it_truly_was(store: Store) -> None:
    run = learned(store, 3)
    (before, _), (record, truth) = learning_steps(3)[1:]
    scene = store.learning.scene(run.id, 3)
    assert not scene.blocked
    assert truth is not None
    assert (scene.title, scene.key) == (f"Run {run.id}, behavior 3 of 3", (run.id, 3))
    assert (scene.learned, scene.held, scene.goal) == (run.spec, run.spec.held, None)
    assert scene.wrist_before == before.execution.wrist_end
    assert (scene.wrist_start, scene.attractor_end) == (
        *(record.execution.wrist_start, truth.end.point),
    )
    assert store.learning.scene(run.id, 1).wrist_before is None
    with pytest.raises(UsageError, match=f"no behavior 4 in run {run.id}; it has 1 to 3"):
        store.learning.scene(run.id, 4)
    with pytest.raises(UsageError, match="no learning run 9; they are numbered 1 to 1"):
        store.learning.scene(9, 1)


def test_a_behavior_that_cannot_be_read_is_named(store: Store) -> None:
    run = learned(store, 3)
    with store.database.writing() as connection:
        connection.exec_driver_sql("update behavior set exploratory_params = '[1]' where step = 3")
    with pytest.raises(DatabaseError, match=f"Run {run.id}, behavior 3 of 3"):
        store.learning.scene(run.id, 3)


def test_what_came_out_otherwise_is_named(store: Store) -> None:
    run = learned(store, 3)
    steps = learning_steps(3)
    assert store.learning.differences(run.id, "t-hook", steps) == ()
    record, truth = steps[2]
    assert record.affordance is not None
    other = replace(record, clock=9.0, affordance=replace(record.affordance, truncated=True))
    assert store.learning.differences(run.id, "t-hook", [(other, truth)]) == (
        Difference(3, "clock", record.clock, 9.0),
        Difference(3, "truncated", 0, True),
    )
    (missing, *_) = store.learning.differences(run.id, "t-hook", learning_steps(1, first=4))
    assert missing == Difference(4, "number", None, 4)


@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_a_number_that_json_does_not_have_is_not_stored(number: float) -> None:
    """SQLite's own functions for JSON would refuse the whole column."""
    call = BehaviorCall.of(BehaviorName("shove"), {"offset_distance": number})
    with pytest.raises(ValueError, match="not JSON compliant"):
        params_to_json(call)
    with pytest.raises(ValueError, match="not JSON compliant"):
        to_json([number])
