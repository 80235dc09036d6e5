"""Letting the robots of an experiment live, on many cores, and saving each exactly once.

Another process may live a robot; this one alone saves it, in one transaction. To go on is to see
who is missing.
"""

import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NoReturn

from affcli.core.identity import canonical_json
from affcli.core.records import ExperimentInfo, FailedRobot
from affcli.core.specs import EXPERIMENT, Keep
from affcli.errors import AffcliError, UsageError, one_line
from affcli.lab.experiment import Condition, Experiment, one_robot
from affcli.lab.own_parts import TABLES as OWN_TABLES
from affcli.lab.versions import versions
from affcli.lab.workers import Failed, Pool, in_order
from affcli.store import PackedRobot, Store, open_store, pack_robot

FAIL_AT_ONCE = 3
"""When so many robots at the beginning fail, and none lives, all of them would."""
LONGEST_MESSAGE, LONGEST_TRACEBACK = 500, 20_000
"""Letters of what is noted of a robot that failed."""


def begin(
    store: Store, experiment: Experiment, now: Callable[[], str], keep: Keep | None = None
) -> ExperimentInfo:
    """Return the stored experiment, new or as far as it came.

    Choice: of one that has robots the question and the number of robots may change; whoever changes
    more gives it another name, so that under one name all robots are of one experiment. One without
    any is replaced.

    Args:
        store: open for writing.
        experiment: what is to be done.
        now: gives the time as ISO text.
        keep: how much of lives is to be saved; None for as much as of those that are there.

    Raises:
        UsageError: the one of this name in the store is another, has more robots, or more or less
            is kept of them.
    """
    conditions = [
        (
            condition.name,
            condition.session(EXPERIMENT, experiment.seed, experiment.robots),
            _made_with(condition),
        )
        for condition in experiment.conditions
    ]
    name, file = one_line(experiment.name), one_line(store.path)
    with store.turn():  # another process may begin one of this name now
        found = store.experiments.find(experiment.name)
        saved = store.sessions.saved_robots(found.conditions[0][1]) if found is not None else ()
        if found is not None and saved and found.key != experiment.key:
            raise UsageError(
                f"experiment {name} is in {file} already, but {_changes(found, experiment)}; give "
                "this one another name, or another --db"
            )
        if max(saved, default=0) >= experiment.robots:
            raise UsageError(
                f"experiment {name}: {len(saved)} robots are in {file} already; write robots = "
                f"{max(saved) + 1} or more"
            )
        kept = None if found is None else store.experiments.kept(found.id)
        if None not in (keep, kept) and keep != kept:
            raise UsageError(
                f"experiment {name} is in {file} already, with --keep {kept}, not {keep}; give the "
                "same, or another --db"
            )
        return store.experiments.begin(
            experiment.name, experiment.key, experiment.definition, conditions, now()
        )


def conduct(
    store: Store,
    experiment: Experiment,
    sessions: Sequence[int],
    robots: Sequence[int],
    workers: int | Pool,
    now: Callable[[], str],
    warn: Callable[[str], object] = str,
    keep: Keep = Keep.ALL,
) -> Iterator[int]:
    """Let robots of an experiment live; save each as it is done.

    Robots that the store holds already are not run again. The others are saved in the order given,
    by this process alone: the same store for any number of workers. Of a robot that fails, the same
    way each time it is tried, that is noted; it is tried again when it is asked for again.

    Args:
        store: open for writing.
        experiment: robot i is a function of (experiment, i).
        sessions: those of its conditions, in order.
        robots: their numbers.
        workers: processes, 1 runs everything in this one; or another pool.
        now: gives the time as ISO text.
        warn: is told when the processes cannot be started, and one does it all; or what of another
            pool is as it should not be.
        keep: how much of their lives is saved.

    Yields:
        How many of these robots are saved: at the beginning, and each time one more is.

    Raises:
        AffcliError, or what a robot raised: none of these robots is saved, for all failed, or the
            first three.
    """
    made_with = dict(zip(sessions, map(_made_with, experiment.conditions), strict=True))
    there = store.sessions.saved_robots(sessions[0])
    missing = [robot for robot in robots if robot not in there]
    saved = len(robots) - len(missing)
    yield saved
    failed: dict[int, Exception] = {}
    work = partial(_packed_life, experiment, keep)
    # Whatever ends this, no worker lives on.
    with closing(in_order(work, missing, workers, warn)) as lives:
        for robot, life in zip(missing, lives, strict=True):
            if isinstance(life, Failed):
                failed[robot] = life.error
                store.sessions.save_failure(sessions[0], _failed(robot, life), now())
                if not saved and len(failed) == FAIL_AT_ONCE:
                    break
            else:
                store.sessions.save_robot(made_with, life, now())
                saved += 1
                yield saved
    if failed and not saved:
        _raise(failed)


def _failed(robot: int, life: Failed) -> FailedRobot:
    """Return what is noted of a robot that failed; of a bug with its traceback."""
    error, where = life.error, None
    if not isinstance(error, AffcliError):
        where = "".join(traceback.format_exception(error))[-LONGEST_TRACEBACK:]
    kind, message = type(error).__name__, one_line(error, LONGEST_MESSAGE)
    return FailedRobot(robot, kind, message, life.tries, where)


def _raise(failed: Mapping[int, Exception]) -> NoReturn:
    """Say which robots failed and why the first did; a bug keeps its traceback."""
    (robot, error), *others = failed.items()
    more = f" (and {len(others)} more)" if others else ""
    if isinstance(error, AffcliError):
        raise type(error)(f"robot {robot}{more}: {error}; the same command tries again") from error
    error.add_note(f"robot {robot}{more}")
    raise error


def run(
    store: Store,
    experiment: Experiment,
    info: ExperimentInfo,
    workers: int | Pool,
    now: Callable[[], str],
    warn: Callable[[str], object] = str,
    robots: Sequence[int] | None = None,
    keep: Keep | None = None,
) -> Iterator[int]:
    """Let robots of an experiment live, all or some, as `conduct` does.

    It is done when all that it is to have are in the store, whoever brought them there. As much is
    kept of them as `begin` was told, or else as of those that are there.
    """
    kept = keep or store.experiments.kept(info.id) or Keep.ALL
    sessions = [session for _, session in info.conditions]
    chosen = range(experiment.robots) if robots is None else robots
    yield from conduct(store, experiment, sessions, chosen, workers, now, warn, kept)
    store.experiments.finish(info.id, now())


@dataclass(frozen=True, slots=True)
class Estimate:
    """What an experiment will take, by one of its robots, which has just lived.

    Args:
        robots, learning_runs, trials: how many in all.
        robot_hours: of learning, in all.
        seconds: that the one robot took, on one core.
        bytes: of a database, that it took.
    """

    robots: int
    learning_runs: int
    trials: int
    robot_hours: float
    seconds: float
    bytes: int


def estimate(
    experiment: Experiment,
    now: Callable[[], str],
    keep: Keep = Keep.ALL,
    robots: Sequence[int] | None = None,
) -> Estimate:
    """Let the first robot live, save it in a database that is thrown away, and measure both.

    Args:
        experiment: robot i is a function of (experiment, i).
        now: gives the time as ISO text.
        keep: how much of their lives is to be saved.
        robots: the numbers of those that are to live; None for all.
    """
    began = time.perf_counter()
    packed = _packed_life(experiment, keep, 0)
    seconds = time.perf_counter() - began
    with TemporaryDirectory() as folder:
        path = Path(folder, "one_robot.db")
        with open_store(path, create=True, write=True) as store:
            sessions = [number for _, number in begin(store, experiment, now).conditions]
        empty = path.stat().st_size
        with open_store(path, create=False, write=True) as store:
            made_with = dict(zip(sessions, map(_made_with, experiment.conditions), strict=True))
            store.sessions.save_robot(made_with, packed, now())
        size = path.stat().st_size - empty
    count = experiment.robots if robots is None else len(robots)
    trials = sum(len(trials) for run in packed.runs for trials in run.trials.values())
    hours = sum(run.spec.hours or 0.0 for run in packed.runs)
    return Estimate(count, count * len(packed.runs), count * trials, count * hours, seconds, size)


def _made_with(condition: Condition) -> dict[str, str]:
    """Return the versions that decide the numbers of a condition."""
    masks = condition.transferring is not None
    return versions(condition.world, condition.parts.sensor, masks=masks)


def _packed_life(experiment: Experiment, keep: Keep, robot: int) -> PackedRobot:
    """Return a robot's life as rows: the process that lived it does the packing."""
    return pack_robot(one_robot(experiment, robot), keep)


def _changes(stored: ExperimentInfo, wanted: Experiment) -> str:
    """Say what a stored experiment differs in first from one of the same name."""
    was, now = stored.definition, wanted.definition
    if was["experiment"]["seed"] != wanted.seed:
        return f"its seed is {was['experiment']['seed']}, not {wanted.seed}"
    if any(was.get(table) != now.get(table) for table in OWN_TABLES):
        return "a file that it names says otherwise now"
    old, new = ({one["name"]: one for one in form["condition"]} for form in (was, now))
    if list(old) != list(new):
        return f"its conditions are {', '.join(map(one_line, old))}"
    for name, own in old.items():
        before, after = ({**one, **one["settings"], "settings": 0} for one in (own, new[name]))
        for key in sorted(before.keys() | after.keys()):
            values = [
                one_line(canonical_json(one.get(key, "its default")).replace('"', ""))
                for one in (before, after)
            ]
            if values[0] != values[1]:
                return f"{key} of {one_line(name)} is {', not '.join(values)}"
    return "this affcli makes other parts of the same names"
