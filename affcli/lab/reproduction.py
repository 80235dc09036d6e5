"""The whole paper on many robots: five tools learned, 80 + 16 trials each (§6, §7)."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from affcli import registry
from affcli.core.affordance_table import AffordanceTable
from affcli.core.identity import Component
from affcli.core.specs import (
    BROKEN_SHAPE,
    BROKEN_TOOL,
    Protocol,
    RobotRecord,
    RowStarts,
    SessionSpec,
    TrialRecord,
)
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts, settings_of, world_of
from affcli.lab.trials import trial_specs, whole_trial
from affcli.lab.versions import versions
from affcli.lab.workers import in_order
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import PackedRobot, Store, pack_robot

HOURS = 1.0
"""§6: one hour of run time for every tool."""


@dataclass(frozen=True, slots=True)
class Reproduced:
    """What every robot of a reproduction is a function of, beside its number.

    Args:
        parts: what its learning runs carry.
        planner: how it chooses rows.
        seed: shared by all robots.
        hours: robot hours with each tool.
    """

    parts: RunParts
    planner: Component
    seed: int
    hours: float = HOURS

    def session(self, robots: int) -> SessionSpec:
        """Return what a reproduction of so many robots is a function of."""
        own = ("reproduce", self.seed, robots, self.planner, registry.DEFAULTS["task"])
        return SessionSpec(*own, **self.parts.carried())


def reproduced_again(session: SessionSpec) -> Reproduced:
    """Return what a stored reproduction was of, to go on with it."""
    return Reproduced(RunParts(**session.carried()), session.planner, session.seed)


def one_robot(what: Reproduced, robot: int) -> RobotRecord:
    """Return the life of one robot: a pure function of what is reproduced and its number."""
    learned = []
    trials: list[TrialRecord] = []
    calibration: str | None = None
    world = None
    for name in TOOL_PARTS:
        spec = what.parts.spec(name, what.seed, robot, what.hours)
        run = LearningRun(spec)
        steps = tuple(run.steps())
        calibration = run.calibration
        learned.append((spec, steps, run.setting.robot.clock))
        table = AffordanceTable(r.affordance for r, _ in steps if r.affordance is not None)
        world = world or world_of(spec)
        tasks = world.tasks(registry.DEFAULTS["task"])
        seen = (tasks, what.seed, spec.sensor, what.planner, world)
        whole = trial_specs(Protocol.EXTENSION_OF_REACH, spec, spec.held, *seen)
        trials += [whole_trial(trial, spec, table, world) for trial in whole]
        if name == BROKEN_TOOL:
            starts: RowStarts = {
                r.step: (r.execution.wrist_start, truth.start)
                for r, truth in steps
                if r.affordance and truth is not None
            }
            left = what.parts.tool(BROKEN_SHAPE)
            lost = world.lost_rows(spec, left, starts)
            broken = trial_specs(Protocol.TOOL_ADAPTATION, spec, left, *seen)
            trials += [whole_trial(trial, spec, table, world, lost) for trial in broken]
    return RobotRecord(robot, tuple(learned), tuple(trials), calibration)


def reproduce(
    store: Store,
    what: Reproduced,
    robots: int,
    workers: int,
    now: Callable[[], str],
    warn: Callable[[str], object] = str,
) -> Iterator[int]:
    """Let `robots` independent robots learn and be tested; save each as it is done.

    Robots that the store holds already are not run again, so an interrupted reproduction goes on.
    Robots are saved in the order of their numbers by this process alone: the same store for any
    number of workers.

    Args:
        store: open for writing.
        what: robot i is a function of (what, i).
        robots: how many.
        workers: processes; 1 runs everything in this one.
        now: gives the time as ISO text.
        warn: is told when the processes cannot be started, and one does it all.

    Yields:
        The session's id first, then how many robots are saved, each time one more is.
    """
    world = registry.world(what.parts.world, settings_of(what.parts))
    made_with = versions(world, what.parts.sensor)
    session = store.sessions.begin(what.session(robots), made_with, now())
    yield session
    there = store.sessions.saved_robots(session)
    missing = [i for i in range(robots) if i not in there]
    saved = robots - len(missing)
    for life in in_order(partial(_packed_life, what), missing, workers, warn):
        store.sessions.save_robot(session, life, made_with, now())
        saved += 1
        yield saved
    store.sessions.finish(session, now())


def _packed_life(what: Reproduced, robot: int) -> PackedRobot:
    """Return a robot's life as rows: the process that lived it does the packing."""
    return pack_robot(one_robot(what, robot))
