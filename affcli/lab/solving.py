"""Solving tasks with what the store holds: every step updates the stored table (§6.2, §7.1)."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from affcli import registry
from affcli.core.identity import Component
from affcli.core.names import one_of
from affcli.core.observation import SensorKind
from affcli.core.records import LearningRunInfo
from affcli.core.specs import Counters, Protocol, SessionSpec, TrialSpec
from affcli.core.task import ALL_STARTS, Task
from affcli.core.trial import Outcome, StepRecord, TrialEnd
from affcli.core.world import World
from affcli.errors import UsageError
from affcli.lab.believing import require_own
from affcli.lab.run_parts import tasks_of, world_of
from affcli.lab.trials import trial_specs, whole_trial
from affcli.lab.versions import versions
from affcli.store import Store


@dataclass(frozen=True, slots=True)
class WantedTasks:
    """Which tasks are to be done.

    Args:
        task_set: of this set.
        goal: those with the goal of this name; None for all goals.
        start: those from the start of this name; from all for `ALL_STARTS`.
    """

    task_set: str
    goal: str | None = None
    start: str = ALL_STARTS

    def among(self, world: World, seed: int) -> list[Task]:
        """Return the tasks of a world that are meant; UsageError when there are none.

        Args:
            world: where they are to be done.
            seed: of those that are drawn.
        """
        known = tasks_of(world, self.task_set, seed)
        tasks = list(known)
        if self.goal is not None:
            goal = one_of("goal", self.goal, dict.fromkeys(task.goal.name for task in known))
            tasks = [task for task in known if task.goal.name == goal]
        starts = [task.start_name for task in tasks]
        start = one_of("start", self.start, [*starts, ALL_STARTS])
        return [task for task in tasks if start in (task.start_name, ALL_STARTS)]


@dataclass(frozen=True, slots=True)
class SolvedTrial:
    """A trial that ended, just saved.

    Args:
        id: its number in the store.
        trial: which it is.
        end: how it ended.
        steps: its steps, each with the number of the row tried in the store.
    """

    id: int
    trial: TrialSpec
    end: TrialEnd
    steps: tuple[tuple[int, StepRecord], ...]

    def __repr__(self) -> str:
        """Return what a notebook shows: with rows and observations it is 100,000 letters."""
        trial, ended = self.trial, self.end.outcome.value
        return (
            f"SolvedTrial(id={self.id}, tool={trial.tool!r}, goal={trial.task.goal.name!r}, "
            f"start={trial.task.start_name!r}, outcome={ended!r}, steps={self.end.steps})"
        )

    @property
    def solved(self) -> bool:
        """Whether the attractor was brought over the goal region."""
        return self.end.outcome is Outcome.SOLVED

    @property
    def whole(self) -> tuple[TrialSpec, TrialEnd, tuple[StepRecord, ...]]:
        """The trial with its steps: what is measured of it."""
        return self.trial, self.end, tuple(record for _, record in self.steps)


def solve(
    store: Store,
    runs: Sequence[LearningRunInfo],
    wanted: WantedTasks,
    seed: int,
    now: Callable[[], str],
    planner: Component,
    sensor: SensorKind | None = None,
) -> Iterator[SolvedTrial]:
    """Do one trial for each learned tool and task, one after the other.

    Each trial starts from the table as it is in the store, counters included, and is saved with the
    counters that it changed, in one transaction (§3.2: the counters are updated during testing
    trials).

    Args:
        store: open for writing.
        runs: the learning runs whose tables are used, one for each tool.
        wanted: which tasks.
        seed: of the sensor's noise.
        now: gives the time as ISO text.
        planner: how the robots choose rows.
        sensor: through what they see; None for what they learned with.

    Yields:
        Each trial once it is saved.

    Raises:
        UsageError: there are no such tasks.
        BadInputError: a part that this affcli lacks.
    """
    require_own(planner)
    registry.planner(planner)
    planned = []
    for run in runs:
        world, kind = world_of(run.spec), sensor or run.spec.sensor
        specs = trial_specs(
            *(Protocol.EXTENSION_OF_REACH, run.spec, run.spec.held, wanted.among(world, seed)),
            *(seed, kind, planner, world),
        )
        # A camera that is not there, or cannot be calibrated, is found before anything is recorded.
        _ = world.trial(specs[0], run.spec).calibration
        planned.append((run, world, specs))
    _, world, specs = planned[0]
    spec = session_spec("solve", runs[0], specs[0])
    session = store.sessions.begin(spec, versions(world, spec.sensor), now())
    for run, world, specs in planned:
        for as_learned in specs:
            trial = replace(as_learned, counters=Counters.STORED)
            # Others who use this table wait: the counters that a trial begins with are those that
            # the trials before it left, as a replay takes it.
            with store.turn():
                table, ids = store.learning.table(run.id)
                record = whole_trial(trial, run.spec, table, world)
                (number,) = store.trials.save_all(session, run.id, [record], ids)
            steps = tuple((ids[step.record.row.step], step.record) for step in record.steps)
            yield SolvedTrial(number, trial, record.end, steps)
    store.sessions.finish(session, now())


def tasks_named(task: str, goal: str | None, count: int | None = None) -> str:
    """Return which set of tasks is meant: its name, or its file.

    Raises:
        UsageError: of the paper's tasks no goal is named: all of them are of `affcli reproduce`; or
            a number of those in a file.
        BadInputError: the set has another number of tasks than one may ask for.
    """
    if registry.names_file(task):
        if count is not None:
            raise UsageError("--n is of random tasks; those of a file are as many as it says")
        return task
    chosen = registry.component("tasks", task)
    if goal is None and chosen.name == registry.DEFAULTS["task"]:
        raise UsageError("Missing option '--goal'; or give --task anywhere")
    part, given = registry.part("tasks", chosen.name), dict(chosen.params)
    if count is not None and "n" not in part.params:
        raise UsageError(f"--n is of random tasks, not of {chosen.name}; give --task anywhere")
    return str(part.component(given | ({} if count is None else {"n": count})))


def session_spec(kind: str, run: LearningRunInfo, trial: TrialSpec) -> SessionSpec:
    """Return what a session of trials with a stored table is a function of.

    Args:
        kind: which command.
        run: whose table is used; of several the first.
        trial: one of its trials.
    """
    parts = {**run.spec.carried(), "world": trial.world, "sensor": trial.sensor}
    return SessionSpec(kind, trial.seed, 1, trial.planner, trial.task_set, **parts)
