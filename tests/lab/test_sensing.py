"""The robot that sees: camera runs are as deterministic, resumable and recorded as any other."""

import json
from dataclasses import replace

import numpy as np
import pytest
from affcli.lab.sensing import calibration_of, eye_of, sensor_for
from affcli.simulation.world import World

from affcli.config import Settings, settings_from_json, settings_with, with_sensor
from affcli.core.observation import SENSOR_KINDS, SensorKind
from affcli.core.trial import LearningSpec, Protocol
from affcli.lab.breaking import break_tool
from affcli.lab.learning import learn
from affcli.lab.learning_run import LearningRun
from affcli.lab.reproduction import one_robot, reproduce
from affcli.lab.solving import SolvedTrial, solve
from affcli.lab.trials import trial_specs, whole_trial
from affcli.perception.camera import Camera
from affcli.store import Store, run_sql
from tests.factories import bench_with
from tests.lab.quick import LEISURELY, now, spec_of, table_from

SEEING = with_sensor(Settings(), "camera")
QUICK = with_sensor(LEISURELY, "camera")


def test_each_kind_of_sensor_sees_the_same_table_with_its_own_error() -> None:
    look = bench_with("t-hook").world.scene
    off: dict[SensorKind, float] = {}
    for kind in SENSOR_KINDS:
        settings = with_sensor(Settings(), kind)
        sensor = sensor_for(settings, lambda: look, np.random.default_rng(0), 0, 0)
        seen = [sensor.observe() for _ in range(30)]
        errors = [np.subtract(one.object_position, look.attractor.point) for one in seen]
        off[kind] = float(np.sqrt(np.mean(np.square(errors))))
    assert off["exact"] == 0.0
    assert 0.0 < off["noisy"] < 0.02
    assert 0.0 < off["camera"] < 0.02


def test_the_default_noise_is_the_camera_s_own_error() -> None:
    """Root mean square over what two robots saw of puck and wrist, on seeds used for nothing
    else."""
    squares = []
    for tool, seed in (("t-hook", 901), ("l-stick", 902)):
        run = LearningRun(LearningSpec(tool, seed, 0, None, 150, SEEING.to_json()))
        for record, truth in run.steps():
            wrist = (
                record.end.object_x - record.end.wrist_to_object_x,
                record.end.object_y - record.end.wrist_to_object_y,
            )
            squares.append(np.subtract(record.end.object_position, truth.end.point) ** 2)
            squares.append(np.subtract(wrist, record.execution.wrist_end) ** 2)
    rms = float(np.sqrt(np.mean(squares)))
    assert Settings().sensor.position_noise == pytest.approx(rms, rel=0.3)


def test_a_camera_run_that_is_stopped_goes_on_as_if_it_had_not_been() -> None:
    spec = spec_of("l-hook", behaviors=60, settings=SEEING)
    whole = list(LearningRun(spec).steps())
    first = LearningRun(spec)
    steps = first.steps()
    begun = [next(steps) for _ in range(25)]
    second = LearningRun(spec, json.loads(json.dumps(first.checkpoint())))
    assert [*begun, *second.steps()] == whole


def test_a_robot_s_calibration_is_its_own() -> None:
    same = calibration_of(SEEING, 4, 2)
    assert same == calibration_of(SEEING, 4, 2)
    assert same is not None
    others = {calibration_of(SEEING, seed, robot) for seed, robot in ((5, 2), (4, 3))}
    assert len(others | {same}) == 3
    assert Camera.from_json(json.loads(same)) == eye_of(SEEING, 4, 2).calibration.camera
    assert calibration_of(Settings(), 4, 2) is None
    assert calibration_of(with_sensor(Settings(), "exact"), 4, 2) is None


def test_the_calibration_is_stored_with_the_run_and_with_its_trials(store: Store) -> None:
    learned = learn(store, spec_of(behaviors=300, settings=SEEING), now)
    list(solve(store, [learned.info], 3, [3], 0, now))
    list(solve(store, [learned.info], 3, [3], 0, now, "exact"))
    (run,) = run_sql(store.path, "select calibration, versions from learning_run").rows
    assert run[0] == calibration_of(SEEING, 0, 0)
    assert {"opencv-python-headless", "scipy"} <= set(json.loads(str(run[1])))
    trials = run_sql(store.path, "select sensor, calibration from trial order by id").rows
    assert trials == (("camera", run[0]), ("exact", None))
    kinds = "select json_extract(settings, '$.sensor.kind') from session order by id"
    assert run_sql(store.path, kinds).rows == (("camera",), ("exact",))


@pytest.mark.parametrize("kind", SENSOR_KINDS)
def test_a_table_learned_through_one_sensor_serves_through_another(
    kind: SensorKind, store: Store
) -> None:
    """Search 1 works on colours as the camera measures them, too."""
    learned = learn(store, spec_of(behaviors=400), now)
    (trial,) = (
        event
        for event in solve(store, [learned.info], 3, [3], 0, now, kind)
        if isinstance(event, SolvedTrial)
    )
    assert trial.solved
    (left,) = run_sql(store.path, "select min(rows_consistent) from step").rows
    assert left == (learned.info.rows,)


def test_the_broken_tool_is_met_through_the_camera(store: Store) -> None:
    quick = settings_with({"trial": {"max_steps": 3}}, "a test")
    learned = learn(store, spec_of(behaviors=200, settings=quick), now)
    trials = [t for _, t in break_tool(store, learned.info, "l-hook", 0, now, "camera")]
    assert len(trials) == 32
    assert {trial.spec.sensor for trial in trials} == {"camera"}
    stored = "select distinct sensor, calibration is not null from trial"
    assert run_sql(store.path, stored).rows == (("camera", 1),)


def test_a_trial_is_a_function_of_its_spec(store: Store) -> None:
    steps = tuple(LearningRun(spec_of(behaviors=300, settings=SEEING)).steps())
    table = table_from(steps)
    world = World(SEEING.workspace, SEEING.physics)
    protocol = Protocol.EXTENSION_OF_REACH
    spec = trial_specs(protocol, "t-hook", "t-hook", 0, 0, "camera")[14]
    first, second = (whole_trial(spec, SEEING, table, world) for _ in range(2))
    assert first == second
    through_noise = whole_trial(replace(spec, sensor="noisy"), SEEING, table, world)
    assert through_noise.steps != first.steps


def test_robots_that_see_are_the_same_on_any_number_of_workers(store: Store) -> None:
    session, *_ = reproduce(store, QUICK, 2, 3, 2, now)
    alone = one_robot(QUICK, 3, 1)
    seen = (
        "select count(*), sum(end_object_x) from behavior join learning_run on id = "
        f"learning_run_id where robot = 1 and session_id = {session}"
    )
    ours = [record.end.object_x for _, steps, _ in alone.learned for record, _ in steps]
    ((count, total),) = run_sql(store.path, seen).rows
    assert count == len(ours)
    assert total == pytest.approx(sum(ours), abs=1e-9)
    eyes = run_sql(store.path, "select distinct calibration from learning_run where robot = 1").rows
    assert eyes == ((alone.calibration,),)
    assert alone.calibration is not None


def test_a_sensor_is_part_of_the_settings() -> None:
    for kind in SENSOR_KINDS:
        settings = with_sensor(Settings(), kind)
        assert settings_from_json(settings.to_json()) == settings
        assert settings == settings_with({"sensor": {"kind": kind}}, "a test")
    assert with_sensor(SEEING, None) is SEEING
