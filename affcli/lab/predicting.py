"""The stored table as a predictive model, on pushes it has never seen (§6.1)."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from affcli.config import Settings, settings_from_json, with_sensor
from affcli.core.affordance import Affordance
from affcli.core.observation import Movement, SensorKind, movement
from affcli.core.trial import BabblingRecord
from affcli.errors import UsageError
from affcli.lab.bench import PREDICTION, Bench, stable_number, tool_named
from affcli.lab.plausible import learned_table
from affcli.planning.prediction import TablePredictor
from affcli.procedures.babbling import BabblingState, babble
from affcli.report.prediction import LEARNED_FROM, Foretold, Push
from affcli.simulation.experimenter import SimulatedExperimenter
from affcli.simulation.world import World
from affcli.store import LearningRunInfo, Store


@dataclass(frozen=True, slots=True)
class PredictionSpec:
    """Which pushes a table is tested on.

    Args:
        tool: the tool the robot believes to hold: the one whose table is asked.
        shape: the shape it truly holds.
        seed: of places, choices and noise.
        robot: which of many robots that share the seed.
        sensor: through what it sees.
        pushes: how many.
    """

    tool: str
    shape: str
    seed: int
    robot: int
    sensor: SensorKind
    pushes: int


class Restless:
    """An experimenter who puts the attractor somewhere else before every behavior."""

    def __init__(self, experimenter: SimulatedExperimenter) -> None:
        self._experimenter = experimenter

    def attractor_out_of_reach(self) -> bool:
        """Say that it is: it will be put elsewhere."""
        return True

    def put_attractor_back(self) -> None:
        """Put it at a random place within the tool's reach."""
        self._experimenter.put_attractor_back()

    def put_attractor_for(self, row: Affordance) -> None:
        """Put it where a row can be tried."""
        self._experimenter.put_attractor_for(row)


def fresh_pushes(spec: PredictionSpec, settings: Settings) -> Iterator[BabblingRecord]:
    """Push as in babbling, each time with the attractor put at a new random place.

    Args:
        spec: which pushes.
        settings: those of the learning run, but for the sensor, which `spec` names.
    """
    settings = with_sensor(settings, spec.sensor)
    world = World(settings.workspace, settings.physics)
    names = (stable_number(spec.tool), stable_number(spec.shape))
    bench = Bench.of(settings, world, PREDICTION, spec.seed, spec.robot, *names)
    believed = tool_named(settings, spec.tool)
    bench.experimenter.lay_out_verification(
        tool_named(settings, spec.shape).painted(believed.color)
    )
    records = babble(
        bench.robot,
        bench.sensor,
        Restless(bench.experimenter),
        bench.behaviors.binding,
        bench.behaviors.exploratory,
        settings.babbling,
        bench.streams["choices"],
        BabblingState(),
    )
    return islice(records, spec.pushes)


class Oracle:
    """A table asked what a push will do: all of it, and what it was after its first rows.

    Args:
        rows: of the table, in the order they were learned.
    """

    def __init__(self, rows: list[Affordance]) -> None:
        few = [number for number in LEARNED_FROM if number < len(rows)]
        self._stages = {number: TablePredictor(rows[:number]) for number in (*few, len(rows))}

    def push(self, record: BabblingRecord) -> Push:
        """Return what was foretold of a push, and what came of it."""
        call, offset = record.execution.call, record.start.wrist_to_object
        start, end = record.execution.wrist_start, record.execution.wrist_end
        return Push(
            moved=record.affordance is not None,
            seen=movement(record.start, record.end),
            wrist=Movement(end.x - start.x, end.y - start.y, 0.0),
            foretold={
                number: Foretold(table.predict(call, offset), table.mean_movement(call))
                for number, table in self._stages.items()
            },
        )


def prediction_spec(
    run: LearningRunInfo, shape: str, seed: int, sensor: SensorKind | None, pushes: int
) -> PredictionSpec:
    """Return which pushes are meant.

    Args:
        run: the learning run whose table is asked.
        shape: the shape that the robot truly holds.
        seed: of places, choices and noise.
        sensor: through what the robot sees; None for what it learned with.
        pushes: how many.

    Raises:
        UsageError: the table is blank.
    """
    if not run.rows:
        raise UsageError(
            f"run {run.id} of the {run.spec.tool} made no rows: there is nothing to predict by; "
            "learn for longer"
        )
    kind = sensor or settings_from_json(run.spec.settings).sensor.kind
    return PredictionSpec(run.spec.tool, shape, seed, run.spec.robot, kind, pushes)


def predict(store: Store, run: LearningRunInfo, spec: PredictionSpec) -> Iterator[Push]:
    """Ask a stored table what pushes will do, and do them.

    Rows that were excluded (probability 1/2 or less) tell nothing.

    Args:
        store: open for reading.
        run: the learning run whose table is asked.
        spec: which pushes.

    Yields:
        Each push with what was foretold of it.
    """
    settings = settings_from_json(run.spec.settings)
    table, _ = learned_table(store, run, settings)
    oracle = Oracle([row for row in table if row.replication_probability > 0.5])
    for record in fresh_pushes(spec, settings):
        yield oracle.push(record)
