"""One testing trial (§7)."""

from collections.abc import Generator, Iterator, Mapping
from typing import Generic, TypeVar

from affcli.config import Settings, with_sensor
from affcli.core.affordance import Affordance, replicates
from affcli.core.affordance_table import AffordanceTable
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Movement, SensorKind
from affcli.core.task import GOAL_NUMBERS, START_NUMBERS, goal_regions, start_positions
from affcli.core.trial import (
    Counters,
    Protocol,
    StepRecord,
    TrialEnd,
    TrialRecord,
    TrialSpec,
    TrialStep,
    Truth,
)
from affcli.lab.bench import TRIAL, Bench, stable_number, tool_named
from affcli.lab.sensing import calibration_of
from affcli.planning.nested_query import Choose, choose_row
from affcli.procedures.extension_of_reach import extension_of_reach
from affcli.simulation.robot import Film
from affcli.simulation.world import World

T = TypeVar("T")


class Ended(Generic[T]):
    """An iterator over the steps of a trial that keeps how the trial ended in `end`."""

    end: TrialEnd

    def __init__(self, steps: Generator[T, None, TrialEnd]) -> None:
        self._steps = steps

    def __iter__(self) -> Iterator[T]:
        self.end = yield from self._steps


def run_trial(
    spec: TrialSpec,
    settings: Settings,
    table: AffordanceTable,
    world: World,
    film: Film | None = None,
    choose: Choose = choose_row,
) -> Generator[tuple[StepRecord, Truth], None, TrialEnd]:
    """Run one testing trial; its table's counters change as it goes.

    Args:
        spec: which trial.
        settings: those of the learning run, but for the sensor, which `spec` names.
        table: what the robot learned of `spec.tool`.
        world: any world of these settings; it is laid out anew. Sharing one saves time.
        film: shown what happens.
        choose: the nested searches.
    """
    settings = with_sensor(settings, spec.sensor)
    layout = settings.workspace.layout
    key = (TRIAL, spec.seed, spec.robot, stable_number(spec.tool), stable_number(spec.shape))
    bench = Bench.of(settings, world, *key, spec.goal, spec.start)
    believed = tool_named(settings, spec.tool)
    held = tool_named(settings, spec.shape).painted(believed.color)
    start = start_positions(layout)[spec.start]
    bench.experimenter.lay_out_trial(held, start, goal_regions(layout)[spec.goal])
    bench.robot.film = film
    steps = extension_of_reach(
        bench.robot,
        bench.sensor,
        bench.experimenter,
        table,
        bench.behaviors.binding,
        settings.trial,
        choose,
    )
    trial = Ended(steps)
    for record in trial:
        yield record, bench.truth()
    return trial.end


class LostAffordances:
    """Which rows a broken tool has truly lost, for the record and never for the robot.

    A row is lost when the broken shape, put where the whole tool was when the row was made and with
    the attractor where it truly was, no longer gives a movement that replicates the row.

    Args:
        settings: those of the learning run.
        shape: name of the shape that is left.
        starts: for each row, by its learning step: where the wrist and the attractor truly were.
    """

    def __init__(
        self, settings: Settings, shape: str, starts: Mapping[int, tuple[Point, Pose]]
    ) -> None:
        world = World(settings.workspace, settings.physics)
        self._bench = Bench.of(with_sensor(settings, "exact"), world, TRIAL, 0, 0)
        self._bench.world.tool = tool_named(settings, shape)
        self._starts = starts
        self._known: dict[int, bool] = {}

    def lost(self, row: Affordance) -> bool:
        """Tell whether `row` was lost; simulated once for each row."""
        if row.step not in self._known:
            world = self._bench.world
            world.wrist, world.attractor = self._starts[row.step]
            before = world.attractor
            self._bench.robot.execute(row.exploratory, row.start)
            after = world.attractor
            seen = Movement(after.x - before.x, after.y - before.y, 0.0)
            self._known[row.step] = not replicates(row.expected_movement, seen)
        return self._known[row.step]


def whole_trial(
    spec: TrialSpec,
    settings: Settings,
    table: AffordanceTable,
    world: World,
    lost: LostAffordances | None = None,
) -> TrialRecord:
    """Run one trial from the table as learned, to its end.

    Args:
        spec, settings, world: as in `run_trial`.
        table: counters as learned; left as they are.
        lost: asked of each row tried, when the tool broke.
    """
    trial = Ended(run_trial(spec, settings, table.as_learned(), world))
    steps = tuple(
        TrialStep(record, truth, lost.lost(record.row) if lost else None) for record, truth in trial
    )
    eye = calibration_of(with_sensor(settings, spec.sensor), spec.seed, spec.robot)
    return TrialRecord(spec, steps, trial.end, eye)


def trial_specs(
    protocol: Protocol, tool: str, shape: str, seed: int, robot: int, sensor: SensorKind
) -> list[TrialSpec]:
    """Return the 16 trials of one tool: 4 goals x 4 starts, each from the table as learned."""
    return [
        TrialSpec(protocol, tool, shape, goal, start, seed, robot, Counters.AS_LEARNED, sensor)
        for goal in GOAL_NUMBERS
        for start in START_NUMBERS
    ]
