"""Learning a tool: one robot babbles, and what it gives is saved chunk by chunk (§6)."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

from affcli.config import first_defaults, known_settings, was_default
from affcli.core.invention import Invention
from affcli.core.records import AlikeRun, ChangedPart, LearningRunInfo
from affcli.core.setting import Setting
from affcli.core.specs import LearningSpec, LearningStep
from affcli.errors import DatabaseError
from affcli.store import Store

CHUNK = 500
"""Behaviors saved in one transaction: what a kill can cost, and half a robot hour."""

Progress = Callable[[LearningRunInfo], None]
"""Called at the beginning and after every saved chunk with what the store holds of the run."""


@dataclass(frozen=True, slots=True)
class Learned:
    """What `learn` did.

    Args:
        info: the finished run as stored.
        new: whether this call executed any of its behaviors.
    """

    info: LearningRunInfo
    new: bool


@dataclass(frozen=True, slots=True)
class Chunk:
    """What a robot did next, and what it needs to go on from there.

    Args:
        steps: behaviors that follow one another.
        checkpoint: after the last of them; None when the run is over, or cannot be gone on with.
        robot_seconds: the robot clock after the last of them.
        done: the run is over.
        calibration: of the camera that the robot sees through, as JSON; None without one.
        inventions: what the robot invented, when the run is over.
    """

    steps: Sequence[LearningStep]
    checkpoint: Mapping[str, Any] | None
    robot_seconds: float
    done: bool
    calibration: str | None
    inventions: tuple[Invention, ...] = ()


def learn(
    store: Store, spec: LearningSpec, now: Callable[[], str], progress: Progress | None = None
) -> Learned:
    """Learn a tool, going on from what the store holds of the same run.

    Args:
        store: open for writing.
        spec: which run.
        now: gives the time as ISO text, for the record only.
        progress: called at the beginning and after each saved chunk.

    Raises:
        DatabaseError: a chunk could not be saved; the chunks before it are kept.
    """
    info = begun(store, spec, now)
    new = info.status != "done"
    if new and progress is not None:
        progress(info)
    for one in learn_all(store, [info], now):
        info = one
        if progress is not None:
            progress(info)
    return Learned(info, new)


def begun(
    store: Store,
    spec: LearningSpec,
    now: Callable[[], str],
    note: str | None = None,
    tell: Callable[[str], object] = str,
) -> LearningRunInfo:
    """Return the stored run of a spec, as far as it came; begun if there is none: `all_begun`."""
    (info,) = all_begun(store, [spec], now, note, tell)
    return info


def all_begun(
    store: Store,
    specs: Sequence[LearningSpec],
    now: Callable[[], str],
    note: str | None = None,
    tell: Callable[[str], object] = str,
) -> list[LearningRunInfo]:
    """Return the stored runs of specs, as far as they came; those that are missing are begun, or
    none is.

    Args:
        store: open for writing.
        specs: which runs.
        now: gives the time as ISO text, for the record only.
        note: written on them, in place of those they have; None to leave these.
        tell: is told what was made beside them, in lines.

    Raises:
        BadInputError: a part that this affcli lacks, or has in another version.
        UsageError: one cannot borrow what it is to borrow.
        DatabaseError: what one needs to go on is missing.
    """
    found = {spec.key: (spec, store.learning.find(spec)) for spec in specs}
    runs = {key: i for key, (_, i) in found.items() if i is not None and i.status == "done"}
    # Before the first is begun: what keeps another from it leaves none behind.
    missing = {
        key: _beginning(store, spec, info, tell)
        for key, (spec, info) in found.items()
        if key not in runs
    }
    if missing:
        with store.turn():
            runs |= {key: begin(now()) for key, begin in missing.items()}
    if note is not None:
        for key, run in runs.items():
            store.runs.note(run.id, note)
            runs[key] = store.learning.run(run.id)
    return [runs[spec.key] for spec in specs]


def _beginning(
    store: Store, spec: LearningSpec, info: LearningRunInfo | None, tell: Callable[[str], object]
) -> Callable[[str], LearningRunInfo]:
    """Return what begins a run that is not done, at a time."""
    # Only now: who finds the run done needs no physics engine.
    from affcli.lab.learning_run import LearningRun, gone_on_with
    from affcli.lab.transferring import borrowed_from_store
    from affcli.lab.versions import versions

    run = LearningRun(spec) if info is None else gone_on_with(info)
    made = versions(run.world, spec.sensor, masks=spec.transfer is not None)
    if spec.transfer is None or info is not None:
        return lambda at: store.learning.begin(spec, made, at)
    mask, lent = borrowed_from_store(store, spec, tell)

    def begin(at: str) -> LearningRunInfo:
        """Begin it with the rows that it borrows."""
        begun = store.learning.begin(spec, made, at, borrowing=lent)
        store.transfers.save_mask(begun.id, mask)
        return begun

    return begin


def learn_all(
    store: Store,
    runs: Sequence[LearningRunInfo],
    now: Callable[[], str],
    workers: int = 1,
    warn: Callable[[str], object] = str,
) -> Iterator[LearningRunInfo]:
    """Let runs that were begun go on to their end, each a chunk at a time, in turn.

    A run is a pure function of its spec, so several processes that work on the same run compute the
    same behaviors: whoever saves a chunk first wins, the others go on from there. Chunks are saved
    in the order of the runs by this process alone: the same store for any number of workers.

    Args:
        store: open for writing.
        runs: as far as they came.
        now: gives the time as ISO text, for the record only.
        workers: processes that compute; 1 does everything in this one.
        warn: is told when the processes cannot be started, and one does it all.

    Yields:
        What the store now holds of a run, each time a chunk of it is saved.

    Raises:
        DatabaseError: a chunk could not be saved; the chunks before it are kept.
        UsageError: a run was deleted meanwhile.
    """
    from affcli.lab.workers import Failed, working

    found = {run.id: run for run in runs}
    left = [run for run in runs if run.status != "done"]
    with working(next_chunk, min(workers, len(left)), warn) as chunks_of:
        while left:
            # Those that are behind, as after an interruption: the order is as if there were none.
            behind = min(run.behaviors for run in left)
            turn = [run for run in left if run.behaviors == behind]
            for run, chunk in zip(turn, chunks_of(turn), strict=True):
                if isinstance(chunk, Failed):
                    raise chunk.error
                with store.turn():  # what it invented is saved with the end of the run, or not
                    saved = store.learning.append(
                        run.id,
                        run.behaviors,
                        chunk.steps,
                        chunk.checkpoint,
                        chunk.robot_seconds,
                        done=chunk.done,
                        now=now(),
                        calibration=chunk.calibration,
                    )
                    if saved:
                        store.inventions.save(run.id, chunk.inventions)
                found[run.id] = store.learning.run(run.id)
                yield found[run.id]
            left = [run for run in found.values() if run.status != "done"]


def next_chunk(info: LearningRunInfo) -> Chunk:
    """Return what a run that is not done gives next: `CHUNK` behaviors, or fewer at its end.

    What cannot be gone on with is done whole: after an interruption it begins anew.
    """
    from affcli.lab.learning_run import gone_on_with

    run = gone_on_with(info)
    size = None if run.checkpoint() is None else CHUNK
    steps = tuple(islice(run.steps(), size))
    checkpoint = None if run.done else run.checkpoint()
    invented = run.inventions() if run.done else ()
    return Chunk(steps, checkpoint, run.seconds, run.done, run.calibration, invented)


def interrupted(store: Store) -> list[LearningSpec]:
    """Return what the runs that have not come to their end are functions of, oldest first.

    Raises:
        DatabaseError: one is not the run that its key stands for.
    """
    runs = store.learning.runs(status="running")
    found = [store.learning.find(run.spec) for run in runs]
    for run, same in zip(runs, found, strict=True):
        if same is None:
            raise DatabaseError(
                f"learning run {run.id} holds values that its key does not stand for; restore a "
                "copy of the database"
            )
    # An older affcli could begin a run again beside one that it had interrupted.
    return [same.spec for same in found if same is not None and same.status != "done"]


def made_by_other_defaults(store: Store, spec: LearningSpec) -> tuple[AlikeRun, ...]:
    """Return the stored runs of the same command that were made by other defaults or another world.

    Args:
        store: open.
        spec: a new run; none are returned for one that the store has.

    Returns:
        Each with what was otherwise: settings that had a former default and now have another, or
        that are no more, with their values then and now; the world's version. A tool's shape
        follows from these and from the version of affcli, the usual grasp from the tools' sizes.
    """
    if store.learning.find(spec) is not None:
        return ()
    known = known_settings()
    found = []
    for alike in store.learning.find_alike(spec):
        changed = tuple(_with_values(one) for one in alike.changed)
        follows = {"world", "tool"}
        if any(one.name.startswith("tools.") for one in changed):
            follows.add("binding")
        if all(one.name in follows or _by_default(one, known) for one in changed):
            found.append(AlikeRun(alike.run, changed))
    return tuple(found)


def _by_default(part: ChangedPart, known: Mapping[str, Setting]) -> bool:
    """Tell whether a setting differs by what its default was and is, and by nobody's wish."""
    if part.name not in known:
        return part.wanted is None
    return part.wanted == known[part.name].default and was_default(part.name, part.stored)


def _with_values(part: ChangedPart) -> ChangedPart:
    """Return what differs with the first default where none is named."""
    first = first_defaults().get(part.name)
    return ChangedPart(
        part.name,
        first if part.stored is None else part.stored,
        first if part.wanted is None else part.wanted,
    )
