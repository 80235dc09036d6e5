"""Solving tasks with what the store holds: every step updates the stored table (§6.2, §7.1)."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from affcli.config import settings_from_json, with_sensor
from affcli.core.observation import SensorKind
from affcli.core.trial import Counters, Outcome, Protocol, StepRecord, TrialEnd, TrialSpec
from affcli.lab.plausible import learned_table
from affcli.lab.sensing import calibration_of
from affcli.lab.trials import Ended, run_trial
from affcli.lab.versions import versions
from affcli.simulation.world import World
from affcli.store import LearningRunInfo, Store


@dataclass(frozen=True, slots=True)
class SolvedStep:
    """One step of a trial, just saved.

    Args:
        trial: which.
        record: the step.
        row: the number of the row tried in the store.
    """

    trial: TrialSpec
    record: StepRecord
    row: int


@dataclass(frozen=True, slots=True)
class SolvedTrial:
    """A trial that ended, just saved.

    Args:
        id: its number in the store.
        trial: which it is.
        end: how it ended.
    """

    id: int
    trial: TrialSpec
    end: TrialEnd

    @property
    def solved(self) -> bool:
        """Whether the attractor was brought over the goal region."""
        return self.end.outcome is Outcome.SOLVED


def solve(
    store: Store,
    runs: Sequence[LearningRunInfo],
    goal: int,
    starts: Sequence[int],
    seed: int,
    now: Callable[[], str],
    sensor: SensorKind | None = None,
) -> Iterator[SolvedStep | SolvedTrial]:
    """Do one trial for each learned tool and start, one after the other.

    Each trial starts from the table as it is in the store, counters included, and each step is
    saved together with the counters it changed, in one transaction (§3.2: the counters are updated
    during testing trials).

    Args:
        store: open for writing.
        runs: the learning runs whose tables are used, one for each tool.
        goal: 1 to 4.
        starts: among 1 to 4.
        seed: of the sensor's noise.
        now: gives the time as ISO text.
        sensor: through what the robot sees; None for what it learned with.

    Yields:
        Each step once it is saved, and each trial's end.
    """
    seeing = [with_sensor(settings_from_json(run.spec.settings), sensor) for run in runs]
    # A camera that is not there, or cannot be calibrated, is found before anything is recorded.
    eyes = [calibration_of(s, seed, r.spec.robot) for s, r in zip(seeing, runs, strict=True)]
    made_with = versions(seeing[0].sensor.kind)
    session = store.begin_session("solve", seed, 1, seeing[0].to_json(), made_with, now())
    for run, settings, calibration in zip(runs, seeing, eyes, strict=True):
        world = World(settings.workspace, settings.physics)
        for start in starts:
            spec = TrialSpec(
                protocol=Protocol.EXTENSION_OF_REACH,
                tool=run.spec.tool,
                shape=run.spec.tool,
                goal=goal,
                start=start,
                seed=seed,
                robot=run.spec.robot,
                counters=Counters.STORED,
                sensor=settings.sensor.kind,
            )
            table, ids = learned_table(store, run, settings)
            trial = store.begin_trial(session, run.id, spec, calibration)
            steps = Ended(run_trial(spec, settings, table, world))
            for record, truth in steps:
                row = ids[record.row.step]
                store.save_step(trial, spec, record, truth, row)
                yield SolvedStep(spec, record, row)
            store.end_trial(trial, steps.end)
            yield SolvedTrial(trial, spec, steps.end)
    store.finish_session(session, now())
