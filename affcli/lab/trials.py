"""One testing trial (§7)."""

from collections.abc import Generator, Iterator, Sequence
from dataclasses import replace
from typing import Generic, TypeVar

from affcli import registry
from affcli.core.affordance_table import AffordanceTable
from affcli.core.identity import Component
from affcli.core.observation import SensorKind
from affcli.core.ports import Planner
from affcli.core.specs import Counters, LearningSpec, Protocol, TrialRecord, TrialSpec
from affcli.core.task import Task
from affcli.core.tool import Tool
from affcli.core.trial import StepRecord, TrialEnd, TrialStep, Truth
from affcli.core.world import LostRows, Setting, World
from affcli.lab.run_parts import settings_of
from affcli.procedures.extension_of_reach import extension_of_reach

T = TypeVar("T")


class WithEnd(Generic[T]):
    """An iterator over the steps of a trial that keeps how the trial ended in `end`."""

    end: TrialEnd

    def __init__(self, steps: Generator[T, None, TrialEnd]) -> None:
        self._steps = steps

    def __iter__(self) -> Iterator[T]:
        self.end = yield from self._steps


def run_trial(
    spec: TrialSpec,
    learned: LearningSpec,
    table: AffordanceTable,
    setting: Setting,
    planner: Planner | None = None,
) -> Generator[tuple[StepRecord, Truth | None], None, TrialEnd]:
    """Run one testing trial; its table's counters change as it goes.

    Args:
        spec: which trial.
        learned: how the table was learned.
        table: what the robot learned of `spec.tool`.
        setting: the world, laid out for this trial.
        planner: chooses the rows; None for the one that `spec` names.
    """
    steps = extension_of_reach(
        setting.robot,
        setting.sensor,
        setting.experimenter,
        table,
        setting.binding,
        settings_of(learned).trial,
        planner or registry.planner(spec.planner),
    )
    trial = WithEnd(steps)
    for record in trial:
        yield record, setting.truth()
    return trial.end


def whole_trial(
    spec: TrialSpec,
    learned: LearningSpec,
    table: AffordanceTable,
    world: World,
    lost: LostRows | None = None,
) -> TrialRecord:
    """Run one trial from a table, to its end.

    Args:
        spec, learned: as in `run_trial`.
        table: left as it is; the trial counts in a copy of its own.
        world: where it takes place; it is laid out anew.
        lost: asked of each row tried, when the tool broke.
    """
    setting = world.trial(spec, learned)
    trial = WithEnd(run_trial(spec, learned, table.as_learned(), setting))
    steps = tuple(
        TrialStep(record, truth, lost.lost(record.row) if lost else None) for record, truth in trial
    )
    return TrialRecord(spec, steps, trial.end, setting.calibration)


def trial_specs(
    protocol: Protocol,
    learned: LearningSpec,
    held: Tool,
    tasks: Sequence[Task],
    seed: int,
    sensor: SensorKind,
    planner: Component,
    world: World,
) -> list[TrialSpec]:
    """Return the trials of one tool, one for each task, each from the table as learned.

    Args:
        protocol: what they are part of.
        learned: how the table was learned.
        held: the tool that the robot truly holds.
        tasks: what it is to do.
        seed: of the sensor's noise.
        sensor: through what it sees.
        planner: how it chooses rows.
        world: where they take place.
    """
    place = replace(registry.present("worlds", learned.world), version=world.version)
    robot, counters = learned.robot, Counters.AS_LEARNED
    return [
        TrialSpec(
            *(protocol, learned.tool, held, task, seed, robot, counters, planner, sensor, place)
        )
        for task in tasks
    ]
