"""The numbers are those of version 2 of the physics to the bit (see `tests.golden`)."""

from collections.abc import Iterator, Sequence

import pytest

from affcli import registry
from affcli.config import Settings, with_sensor
from affcli.core.affordance_table import AffordanceTable
from affcli.core.identity import Component
from affcli.core.observation import SensorKind
from affcli.core.specs import (
    LearningSpec,
    LearningStep,
    Protocol,
    RobotRecord,
    TrialRecord,
    TrialSpec,
)
from affcli.core.trial import TrialStep
from affcli.core.world import World
from affcli.lab.learning_run import LearningRun
from affcli.lab.reproduction import Reproduced, one_robot
from affcli.lab.run_parts import RunParts, world_of
from affcli.lab.trials import WithEnd, run_trial, trial_specs, whole_trial
from tests.factories import learning_spec, tool_named
from tests.golden import CAMERA_ROWS, GOLDEN, SEED, digest, learning_rows, of_robot, of_trials

PLANNER = Component(registry.DEFAULTS["planner"])
IN_EVERY_RUN = [("noisy", 0), ("noisy", 1), ("exact", 0)]
LONGER = [
    (kind, int(robot))
    for kind in ("noisy", "exact", "camera")
    for robot in GOLDEN[kind]
    if (kind, int(robot)) not in IN_EVERY_RUN
]


def life_of(kind: SensorKind, robot: int) -> RobotRecord:
    """Return the life of one robot of a reproduction."""
    parts = RunParts.chosen(with_sensor(Settings(), kind))
    return one_robot(Reproduced(parts, PLANNER, SEED), robot)


@pytest.mark.parametrize(("kind", "robot"), IN_EVERY_RUN)
def test_a_robot_learns_and_solves_as_ever(kind: SensorKind, robot: int) -> None:
    assert of_robot(life_of(kind, robot)) == GOLDEN[kind][str(robot)]


@pytest.mark.torture
@pytest.mark.parametrize(("kind", "robot"), LONGER)
def test_every_robot_learns_and_solves_as_ever(kind: SensorKind, robot: int, torture: bool) -> None:
    if not torture:
        pytest.skip("the other robots live in `make torture`")
    short = GOLDEN["short"]["camera t-hook 40"]
    if kind == "camera" and digest(seen_through_a_camera("t-hook")) != short:
        pytest.skip("this processor's last bits are not those of the golden calibration")
    assert of_robot(life_of(kind, robot)) == GOLDEN[kind][str(robot)]


def seen_through_a_camera(tool: str) -> list[tuple[object, ...]]:
    """Return what a robot with a camera keeps of its first 40 behaviors."""
    settings = with_sensor(Settings(), "camera")
    run = LearningRun(learning_spec(tool, seed=SEED, behaviors=40, settings=settings))
    return list(learning_rows(run.steps()))


@pytest.mark.parametrize("tool", ["stick", "t-hook"])
def test_a_robot_sees_through_its_camera_as_ever(tool: str) -> None:
    """To a millionth: the least squares of its calibration differ in the ninth digit from processor
    to processor, as BLAS has other sums for each.
    """
    rows, golden = seen_through_a_camera(tool), CAMERA_ROWS[tool]
    assert len(rows) == len(golden)
    for row, expected in zip(rows, golden, strict=True):
        assert [*row] == [
            pytest.approx(value, rel=0.0, abs=1e-6) if isinstance(value, float) else value
            for value in expected
        ]


@pytest.fixture(scope="module")
def demo() -> tuple[LearningStep, ...]:
    """What the robot of ``make demo`` learns: an hour with the T-hook, seed 0."""
    return tuple(LearningRun(learning_spec(hours=1.0)).steps())


def test_the_demo_learns_solves_and_breaks_as_ever(demo: tuple[LearningStep, ...]) -> None:
    assert digest(learning_rows(demo)) == GOLDEN["demo"]["learning"]
    learned = learning_spec(hours=1.0)
    world, whole = world_of(learned), AffordanceTable(r.affordance for r, _ in demo if r.affordance)
    tasks = world.tasks(registry.DEFAULTS["task"])
    seen = (tasks, 0, learned.sensor, PLANNER, world)
    broken, extended = (
        trial_specs(protocol, learned, held, *seen)
        for protocol, held in (
            (Protocol.TOOL_ADAPTATION, tool_named("l-hook")),
            (Protocol.EXTENSION_OF_REACH, learned.held),
        )
    )
    starts = {
        r.step: (r.execution.wrist_start, truth.start)
        for r, truth in demo
        if r.affordance and truth
    }
    lost = world.lost_rows(learned, tool_named("l-hook"), starts)
    trials = [whole_trial(spec, learned, whole, world, lost) for spec in broken]
    trials += [whole_trial(spec, learned, whole, world) for spec in extended]
    assert of_trials(trials) == GOLDEN["demo"]["trials"]

    # As `solve --goal 2` does: each trial with the counters that the last one left.
    assert of_trials(solving(learned, whole, world, extended[4:8])) == GOLDEN["demo"]["solve"]


def solving(
    learned: LearningSpec, table: AffordanceTable, world: World, specs: Sequence[TrialSpec]
) -> Iterator[TrialRecord]:
    """Run trials that share their counters."""
    for spec in specs:
        trial = WithEnd(run_trial(spec, learned, table, world.trial(spec, learned)))
        steps = tuple(TrialStep(record, truth, None) for record, truth in trial)
        yield TrialRecord(spec, steps, trial.end)
