"""The stored table as a predictive model, on pushes it has never seen (§6.1)."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np

from affcli import registry
from affcli.analysis.prediction import STAGES, Prediction, Push
from affcli.core.affordance import Affordance, is_probable
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.core.identity import Component
from affcli.core.log import NOT_LOGGED
from affcli.core.observation import Movement, Observation, SensorKind, movement
from affcli.core.records import LearningRunInfo
from affcli.core.specs import LearningSpec, VerificationSpec
from affcli.core.tool import Tool
from affcli.core.trial import BabblingRecord
from affcli.errors import UsageError
from affcli.lab.run_parts import require_robot, settings_of, world_of
from affcli.planning.prediction import TablePredictor
from affcli.procedures.babbling import BabblingState, OtherGrasps, babble
from affcli.store import Store


def fresh_pushes(spec: VerificationSpec, learned: LearningSpec) -> Iterator[BabblingRecord]:
    """Push as in random babbling, each time with the attractor put at a new random place.

    Args:
        spec: which pushes; as many as its tries.
        learned: how the table was learned.
    """
    setting = world_of(learned).prediction(spec, learned)
    settings = settings_of(learned, spec.sensor)
    chosen = Component(registry.DEFAULTS["explorer"])
    explorers = {
        binding: registry.explorer(chosen, setting, settings) for binding in learned.bindings
    }
    first = explorers.pop(learned.binding)
    records = babble(
        setting.robot,
        setting.sensor,
        setting.experimenter,
        setting.binding,
        first,
        BabblingState(),
        others=OtherGrasps(explorers, setting.choices) if explorers else None,
        elsewhere=True,
    )
    return islice(records, spec.tries)


class StagedTable:
    """A table asked what a push will do: all of it, and what it was after its first rows.

    Args:
        rows: of the table, in the order they were learned.
    """

    def __init__(self, rows: list[Affordance]) -> None:
        few = [number for number in STAGES if number < len(rows)]
        self._stages = {number: TablePredictor(rows[:number]) for number in (*few, len(rows))}

    def push(self, record: BabblingRecord) -> Push:
        """Return what was predicted of a push, and what came of it."""
        start, end = record.execution.wrist_start, record.execution.wrist_end
        return Push(
            moved=record.affordance is not None,
            seen=movement(record.start, record.end),
            wrist=Movement(end.x - start.x, end.y - start.y, 0.0),
            predicted=self.asked(
                record.execution.call, record.start.wrist_to_object, held=record.binding
            ),
        )

    def asked(
        self,
        call: BehaviorCall,
        at: Point,
        without: int | None = None,
        held: BehaviorCall | None = None,
    ) -> dict[int, Prediction]:
        """Return what each stage predicts; see `TablePredictor.predict`."""
        return {
            number: Prediction(
                table.predict(call, at, without, held), table.mean_movement(call, without, held)
            )
            for number, table in self._stages.items()
        }


def logged_pushes(store: Store, run: LearningRunInfo, spec: VerificationSpec) -> Iterator[Push]:
    """Predict the trials of a log, each by the rows of all the others.

    Where the log does not say where the tool was, a row is near when the object was at nearly the
    same place of the table. The counters by which rows are left out were made by all trials.

    Args:
        store: open for reading.
        run: which was imported.
        spec: how many, and the seed by which they are drawn where there are more.

    Raises:
        BadInputError: another sensor, or another tool in the hand, is asked for.
    """
    if spec.sensor != run.spec.sensor or spec.held != run.spec.held:
        require_robot(run.spec)
    rows = _live(store, run)
    tries = store.learning.tries(run.id)
    offsets = [one.offset for one in tries]
    if not all(map(Affordance.is_placed, rows)) or any(math.isnan(at.x + at.y) for at in offsets):
        rows = [replace(row, start=_at_its_place(row.start)) for row in rows]
        tries = tuple(one._replace(offset=one.at) for one in tries)
    staged = StagedTable(rows)
    some = min(spec.tries, len(tries))
    drawn = np.random.default_rng(spec.seed).choice(len(tries), some, replace=False)
    for one in (tries[place] for place in sorted(drawn)):
        predicted = staged.asked(one.call, one.offset, one.step)
        yield Push(one.moved, one.seen, Movement(NOT_LOGGED, NOT_LOGGED, 0.0), predicted)


def _at_its_place(seen: Observation) -> Observation:
    """Return an observation that tells places on the table where it should tell offsets."""
    return seen._replace(wrist_to_object_x=seen.object_x, wrist_to_object_y=seen.object_y)


def _live(store: Store, run: LearningRunInfo) -> list[Affordance]:
    """Return the rows of a table that are not excluded."""
    table, _ = store.learning.table(run.id)
    return [row for row in table if is_probable(row.times_successful, row.times_used)]


def prediction_spec(
    run: LearningRunInfo, held: Tool, seed: int, sensor: SensorKind | None, pushes: int
) -> VerificationSpec:
    """Return which pushes are meant.

    Args:
        run: the learning run whose table is asked.
        held: the tool that the robot truly holds.
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
    kind = sensor or run.spec.sensor
    return VerificationSpec(
        run.spec.tool, held, seed, run.spec.robot, kind, pushes, until_verdict=False
    )


def predict(store: Store, run: LearningRunInfo, spec: VerificationSpec) -> Iterator[Push]:
    """Ask a stored table what pushes will do, and do them; of a log, ask about its own trials.

    Rows that were excluded (probability 1/2 or less) tell nothing.

    Args:
        store: open for reading.
        run: the learning run whose table is asked.
        spec: which pushes.

    Yields:
        Each push with what was predicted of it.
    """
    if run.spec.logged:
        yield from logged_pushes(store, run, spec)
        return
    staged = StagedTable(_live(store, run))
    for record in fresh_pushes(spec, run.spec):
        yield staged.push(record)
