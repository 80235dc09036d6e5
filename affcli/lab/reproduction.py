"""The whole paper on many robots: five tools learned, 80 + 16 trials each (§6, §7)."""

import gc
import os
import signal
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing import active_children, get_context, parent_process
from threading import Thread

from affcli import registry
from affcli.config import with_sensor
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
from affcli.errors import AffcliError
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts, settings_json, settings_of_text, world_of
from affcli.lab.trials import trial_specs, whole_trial
from affcli.lab.versions import versions
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
        hours: robot hours a tool.
    """

    parts: RunParts
    planner: Component
    seed: int
    hours: float = HOURS

    def session(self, robots: int) -> SessionSpec:
        """Return what a reproduction of so many robots is a function of."""
        parts = self.parts
        return SessionSpec(
            kind="reproduce",
            seed=self.seed,
            robots=robots,
            world=parts.world,
            repertoire=parts.repertoire,
            binding=parts.binding,
            explorer=parts.explorer,
            planner=self.planner,
            sensor=parts.sensor,
            settings=settings_json(parts.settings),
            task_set=registry.DEFAULTS["task"],
        )


def reproduced_again(session: SessionSpec) -> Reproduced:
    """Return what a stored reproduction was of, to go on with it."""
    parts = RunParts(
        with_sensor(settings_of_text(session.settings), session.sensor),
        session.world,
        session.repertoire,
        session.binding,
        session.explorer,
        session.sensor,
    )
    return Reproduced(parts, session.planner, session.seed)


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

    Yields:
        The session's id first, then how many robots are saved, each time one more is.
    """
    world = registry.world(what.parts.world, what.parts.settings)
    made_with = versions(world, what.parts.sensor)
    session = store.sessions.begin(what.session(robots), made_with, now())
    yield session
    there = store.sessions.saved_robots(session)
    missing = [i for i in range(robots) if i not in there]
    saved = robots - len(missing)
    for life in _lives(what, missing, workers):
        store.sessions.save_robot(session, life, made_with, now())
        saved += 1
        yield saved
    store.sessions.finish(session, now())


def _lives(what: Reproduced, robots: list[int], workers: int) -> Iterator[PackedRobot]:
    """Yield the robots' lives in order, computed by `workers` processes.

    No more than a few finished lives wait at any time, so memory stays flat however many robots.
    """
    life = partial(_packed_life, what)
    if workers == 1 or len(robots) <= 1:
        yield from map(life, robots)
        return
    context = get_context("spawn")
    with _interrupt_held_back():
        pool = ProcessPoolExecutor(workers, context, initializer=_begin_worker)
    waiting: deque[Future[PackedRobot]] = deque()
    todo = iter(robots)
    try:
        for robot in todo:
            with _interrupt_held_back():
                waiting.append(pool.submit(life, robot))
            if len(waiting) > 2 * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    except BaseException as error:
        # Also when nobody wants more lives: those begun would take seconds to end.
        for worker in active_children():
            worker.terminate()
        if isinstance(error, BrokenProcessPool):
            raise AffcliError(
                "a worker process died, for want of memory perhaps; the robots before are saved: "
                "run the command again, with fewer --workers"
            ) from error
        raise
    finally:
        pool.shutdown(cancel_futures=True)


@contextmanager
def _interrupt_held_back() -> Iterator[None]:
    """Hold ctrl-C back for a moment, and for good in the processes begun in it.

    The terminal sends it to all of them, and one that is still importing would show a traceback.
    A process inherits what is blocked; here it may yet arrive, by a thread of numpy's.
    """
    arrived: list[int] = []
    handler = signal.signal(signal.SIGINT, lambda signum, _: arrived.append(signum))
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
        signal.signal(signal.SIGINT, handler)
        if arrived:
            signal.raise_signal(signal.SIGINT)


def _packed_life(what: Reproduced, robot: int) -> PackedRobot:
    """Return a robot's life as rows: the process that lived it does the packing."""
    return pack_robot(one_robot(what, robot))


def _begin_worker() -> None:
    """Collect seldom, and end when the process that wants the lives has ended.

    A life is many small records and hardly a cycle: looking for cycles as often as Python does by
    default costs 7 % of the time.
    """
    gc.set_threshold(100_000, 20, 20)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Wait for the parent's end, then end too.

    A parent that was killed tells nobody, and its workers would wait for work for ever: each keeps
    the other end of the queue open itself.
    """
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
