"""The robot that sees: camera runs are as deterministic, resumable and recorded as any other."""

import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from affcli.config import Settings, settings_from, settings_with, with_sensor
from affcli.core.observation import SENSOR_KINDS, SensorKind
from affcli.core.ports import Sensor
from affcli.core.scene import Scene
from affcli.core.tool import Tool
from affcli.core.workspace import Workspace
from affcli.core.world import MakeSensor
from affcli.lab.breaking import break_tool
from affcli.lab.learning import learn
from affcli.lab.learning_run import LearningRun
from affcli.lab.reproduction import Reproduced, one_robot, reproduce
from affcli.lab.run_parts import RunParts
from affcli.lab.trials import whole_trial
from affcli.perception.camera import Camera
from affcli.perception.noisy_sensor import NoisySensor
from affcli.simulation.sensing import SimulatedSight, eye_of
from affcli.simulation.table_world import TableWorld
from affcli.store import Store, run_sql
from tests.factories import learning_spec, setting_with, tool_named, trial_spec
from tests.lab.quick import (
    PLANNER,
    learned,
    now,
    solving,
    spec_of,
    stored,
    table_from,
)

NOISE = Settings().sensor
SEEING = with_sensor(Settings(), "camera")
QUICK = with_sensor(
    settings_with({"motion": {"hold": 40.0}, "trial": {"max_steps": 1}}, "a test"), "camera"
)


def sight_of(kind: SensorKind, seed: int = 0, robot: int = 0) -> SimulatedSight:
    """Return what a robot sees through."""
    usual = Settings()
    place = (usual.sensor, usual.camera, usual.workspace, tool_named("t-hook"))
    return SimulatedSight(kind, *place, seed, robot)


def test_each_kind_of_sensor_sees_the_same_table_with_its_own_error() -> None:
    look = setting_with("t-hook").scene()
    off: dict[SensorKind, float] = {}
    for kind in SENSOR_KINDS:
        sensor = sight_of(kind).sensor(lambda: look, np.random.default_rng(0))
        seen = [sensor.observe() for _ in range(30)]
        errors = [np.subtract(one.object_position, look.attractor.point) for one in seen]
        off[kind] = float(np.sqrt(np.mean(np.square(errors))))
    assert off["exact"] == 0.0
    assert 0.0 < off["noisy"] < 0.02
    assert 0.0 < off["camera"] < 0.02


def test_a_sensor_that_was_brought_is_given_the_place_the_tool_and_the_noise() -> None:
    look = setting_with("t-hook").scene()
    given: list[tuple[Scene, np.random.Generator, Workspace, Tool]] = []

    def make(
        look: Callable[[], Scene], rng: np.random.Generator, workspace: Workspace, tool: Tool
    ) -> Sensor:
        given.append((look(), rng, workspace, tool))
        return NoisySensor(look, NOISE, rng)

    class Brought:
        """What comes with another package."""

        def sensor(self, kind: str) -> MakeSensor:
            return {"theirs": make}[kind]

    rng, usual, tool = np.random.default_rng(3), Settings(), tool_named("t-hook")
    sight = SimulatedSight(
        *("theirs", NOISE, usual.camera, usual.workspace, tool, 0, 0), brought=Brought()
    )
    seen = sight.sensor(lambda: look, rng).observe()
    assert given == [(look, rng, usual.workspace, tool)]
    own = NoisySensor(lambda: look, NOISE, np.random.default_rng(3)).observe()
    assert seen == own
    assert sight.calibration is None


def test_the_default_noise_is_the_camera_s_own_error() -> None:
    """Root mean square over what two robots saw of puck and wrist, on seeds used for nothing
    else."""
    squares = []
    for tool, seed in (("t-hook", 901), ("l-stick", 902)):
        run = LearningRun(learning_spec(tool, seed=seed, behaviors=150, settings=SEEING))
        for record, truth in run.steps():
            assert truth is not None
            wrist = (
                record.end.object_x - record.end.wrist_to_object_x,
                record.end.object_y - record.end.wrist_to_object_y,
            )
            squares.append(np.subtract(record.end.object_position, truth.end.point) ** 2)
            squares.append(np.subtract(wrist, record.execution.wrist_end.point) ** 2)
    rms = float(np.sqrt(np.mean(squares)))
    assert Settings().sensor.position_noise == pytest.approx(rms, rel=0.3)


def test_a_camera_run_that_is_stopped_goes_on_as_if_it_had_not_been() -> None:
    spec = spec_of("l-hook", behaviors=40, settings=SEEING)
    whole = list(learned(spec))
    first = LearningRun(spec)
    steps = first.steps()
    begun = [next(steps) for _ in range(25)]
    second = LearningRun(spec, json.loads(json.dumps(first.checkpoint())))
    assert [*begun, *second.steps()] == whole


def test_a_robot_s_calibration_is_its_own() -> None:
    same = sight_of("camera", 4, 2).calibration
    assert same == sight_of("camera", 4, 2).calibration
    assert same is not None
    others = {sight_of("camera", seed, robot).calibration for seed, robot in ((5, 2), (4, 3))}
    assert len(others | {same}) == 3
    eye = eye_of(SEEING.camera, SEEING.workspace, tool_named("t-hook"), 4, 2)
    assert Camera.from_json(json.loads(same)) == eye.calibration.camera
    assert sight_of("noisy").calibration is None
    assert sight_of("exact").calibration is None


def test_the_calibration_is_stored_with_the_run_and_with_its_trials(store: Store) -> None:
    info = learn(store, spec_of(behaviors=100, settings=SEEING), now).info
    list(solving(store, info, "3", "3"))
    list(solving(store, info, "3", "3", sensor="exact"))
    (run,) = run_sql(store.path, "select calibration, versions from learning_run").rows
    assert run[0] == sight_of("camera").calibration
    assert {"opencv-python-headless", "scipy"} <= set(json.loads(str(run[1])))
    trials = run_sql(store.path, "select sensor, calibration from trial order by id").rows
    assert trials == (("camera", run[0]), ("exact", None))
    kinds = "select sensor from session order by id"
    assert run_sql(store.path, kinds).rows == (("camera",), ("exact",))


@pytest.mark.parametrize("kind", SENSOR_KINDS)
def test_a_table_learned_through_one_sensor_serves_through_another(
    kind: SensorKind, store: Store
) -> None:
    """Search 1 works on colours as the camera measures them, too."""
    run = stored(store, spec_of(behaviors=400))
    (trial,) = (event for event in solving(store, run, "3", "3", sensor=kind))
    assert trial.solved
    left = {step.reasons[0] for step in store.trials.steps(trial.id)}
    assert {(reason.name, reason.rows) for reason in left} == {("consistent", run.rows)}


def test_the_broken_tool_is_met_through_the_camera(store: Store) -> None:
    quick = settings_with({"trial": {"max_steps": 3}}, "a test")
    run = stored(store, spec_of(behaviors=200, settings=quick))
    found = break_tool(store, run, tool_named("l-hook"), 0, now, PLANNER, "camera")
    trials = [trial for _, trial, _ in found]
    assert len(trials) == 32
    assert {trial.spec.sensor for trial in trials} == {"camera"}
    kept = "select distinct sensor, calibration is not null from trial"
    assert run_sql(store.path, kept).rows == (("camera", 1),)


def test_a_trial_is_a_function_of_its_spec() -> None:
    run = spec_of(behaviors=100, settings=SEEING)
    table, world = table_from(learned(run)), TableWorld(SEEING)
    spec = trial_spec(run, goal="4", start="3")
    first, second = (whole_trial(spec, run, table, world) for _ in range(2))
    assert first == second
    through_noise = whole_trial(replace(spec, sensor="noisy"), run, table, world)
    assert through_noise.steps != first.steps


def test_robots_that_see_are_the_same_on_any_number_of_workers(store: Store) -> None:
    what = Reproduced(RunParts.chosen(QUICK), PLANNER, 3, hours=0.2)
    session, *_ = reproduce(store, what, 2, 2, now)
    alone = one_robot(what, 1)
    seen = (
        "select count(*), sum(end_object_x) from behavior join learning_run on id = "
        f"learning_run_id where robot = 1 and session_id = {session}"
    )
    ours = [record.end.object_x for _, steps, _ in alone.learned for record, _ in steps]
    ((count, total),) = run_sql(store.path, seen).rows
    assert count == len(ours)
    assert total == pytest.approx(sum(ours), abs=1e-9)
    eyes = run_sql(store.path, "select distinct calibration from learning_run where robot = 1").rows
    assert {(calibration,) for calibration in alone.calibrations} == set(eyes)
    assert None not in alone.calibrations


def test_a_sensor_is_part_of_the_settings() -> None:
    for kind in SENSOR_KINDS:
        settings = with_sensor(Settings(), kind)
        assert with_sensor(settings_from(settings.differing()), kind) == settings
        assert settings == settings_with({"sensor": {"kind": kind}}, "a test")
    assert with_sensor(SEEING, None) is SEEING
