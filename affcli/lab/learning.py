"""Learning a tool: one robot babbles, and what it gives is saved chunk by chunk (§6)."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice

from affcli.config import first_defaults, known_settings, was_default
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


def learn(
    store: Store, spec: LearningSpec, now: Callable[[], str], progress: Progress | None = None
) -> Learned:
    """Learn a tool, going on from what the store holds of the same run.

    A run is a pure function of its spec, so two processes that work on the same run compute the
    same behaviors: whoever saves a chunk first wins, the other goes on from there.

    Args:
        store: open for writing.
        spec: which run.
        now: gives the time as ISO text, for the record only.
        progress: called at the beginning and after each saved chunk.

    Raises:
        DatabaseError: a chunk could not be saved; the chunks before it are kept.
    """
    found = store.learning.find(spec)
    if found is not None and found.status == "done":
        return Learned(found, new=False)
    # Only now: who finds the run done needs no physics engine.
    from affcli.lab.learning_run import gone_on_with
    from affcli.lab.run_parts import world_of
    from affcli.lab.versions import versions

    made_with = versions(world_of(spec, again=True), spec.sensor)
    info = store.learning.begin(spec, made_with, now())
    if progress is not None:
        progress(info)
    new = False
    while info.status != "done":
        run = gone_on_with(info)
        # What cannot be gone on with is saved whole: after an interruption it begins anew.
        size = None if run.checkpoint() is None else CHUNK
        for chunk in _chunks(run.steps(), size):
            new = True
            saved = store.learning.append(
                info.id,
                info.behaviors,
                chunk,
                None if run.done else run.checkpoint(),
                run.setting.robot.clock,
                done=run.done,
                now=now(),
                calibration=run.calibration,
            )
            info = store.learning.begin(spec, made_with, now())
            if progress is not None:
                progress(info)
            if not saved:
                break
    return Learned(info, new)


def _chunks(steps: Iterator[LearningStep], size: int | None) -> Iterator[Sequence[LearningStep]]:
    """Gather steps into chunks of this size, all in one for None; the last may be shorter."""
    while chunk := list(islice(steps, size)):
        yield chunk


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
