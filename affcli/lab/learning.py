"""Learning a tool: one robot babbles, and what it gives is saved chunk by chunk (§6)."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from affcli.config import settings_from_json
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.trial import BabblingRecord, LearningSpec, Truth
from affcli.lab.bench import LEARNING, Bench, stable_number, tool_named
from affcli.lab.plausible import check_checkpoint, not_written
from affcli.lab.sensing import calibration_of
from affcli.lab.versions import versions
from affcli.procedures.babbling import BabblingState, babble
from affcli.simulation.world import World
from affcli.store import LearningRunInfo, Store

CHUNK = 500
"""Behaviors saved in one transaction: what a kill can cost, and half a robot hour."""


class LearningRun:
    """One robot babbling with one tool; it can be stopped after any behavior and gone on with.

    Args:
        spec: what the run is a function of.
        checkpoint: what `checkpoint` gave when the run was stopped; None to begin.

    Attributes:
        calibration: of the camera that the robot sees through, as JSON; None without one.
    """

    def __init__(self, spec: LearningSpec, checkpoint: dict[str, Any] | None = None) -> None:
        settings = settings_from_json(spec.settings)
        world = World(settings.workspace, settings.physics)
        key = (LEARNING, spec.seed, spec.robot, stable_number(spec.tool))
        self.spec = spec
        self.calibration = calibration_of(settings, spec.seed, spec.robot)
        self.bench = Bench.of(settings, world, *key)
        self._state = BabblingState()
        tool = tool_named(settings, spec.tool)
        if checkpoint is None:
            self.bench.experimenter.lay_out_learning(tool)
        else:
            world.tool = tool
            self._restore(checkpoint)

    def steps(self) -> Iterator[tuple[BabblingRecord, Truth]]:
        """Yield what each behavior gave, until the time or the number of behaviors is up.

        The behavior during which the time runs out is the last.
        """
        bench = self.bench
        records = babble(
            bench.robot,
            bench.sensor,
            bench.experimenter,
            bench.behaviors.binding,
            bench.behaviors.exploratory,
            bench.settings.babbling,
            bench.streams["choices"],
            self._state,
        )
        while not self.done:
            yield next(records), bench.truth()

    @property
    def done(self) -> bool:
        """Whether the time or the number of behaviors is up."""
        if self.spec.behaviors is not None:
            return self._state.step >= self.spec.behaviors
        return self.bench.robot.clock >= 3600.0 * (self.spec.hours or 0.0)

    def checkpoint(self) -> dict[str, Any]:
        """Return, as JSON types, all that a later `LearningRun` needs to go on from here."""
        world = self.bench.world
        return {
            "step": self._state.step,
            "grasped": self._state.grasped,
            "seen": self._state.seen,
            "clock": self.bench.robot.clock,
            "wrist": world.wrist,
            "attractor": world.attractor,
            "streams": {n: s.bit_generator.state for n, s in self.bench.streams.items()},
        }

    def _restore(self, checkpoint: dict[str, Any]) -> None:
        """Put everything where the checkpoint says."""
        seen = checkpoint["seen"]
        self._state.step = checkpoint["step"]
        self._state.grasped = checkpoint["grasped"]
        self._state.seen = None if seen is None else Observation(*seen)
        self.bench.robot.clock = checkpoint["clock"]
        self.bench.world.wrist = Point(*checkpoint["wrist"])
        self.bench.world.attractor = Pose(*checkpoint["attractor"])
        for name, stream in self.bench.streams.items():
            stream.bit_generator.state = checkpoint["streams"][name]


Progress = Callable[[LearningRunInfo], None]
"""Called after every saved chunk with what the store now holds of the run."""


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
        progress: called after each saved chunk.

    Raises:
        DatabaseError: a chunk could not be saved; the chunks before it are kept.
    """
    made_with = versions(settings_from_json(spec.settings).sensor.kind)
    info = store.begin_learning(spec, made_with, now())
    new = False
    while info.status != "done":
        run = _gone_on_with(info)
        for chunk in _chunks(run.steps()):
            new = True
            saved = store.append_learning(
                info.id,
                info.behaviors,
                chunk,
                None if run.done else run.checkpoint(),
                robot_seconds=run.bench.robot.clock,
                done=run.done,
                now=now(),
                calibration=run.calibration,
            )
            info = store.begin_learning(spec, made_with, now())
            if progress is not None:
                progress(info)
            if not saved:
                break
    return Learned(info, new)


def _gone_on_with(info: LearningRunInfo) -> LearningRun:
    """Return a run that is not done, as far as it came."""
    check_checkpoint(info)
    run = LearningRun(info.spec, info.checkpoint)
    if run.done:  # and not marked so: there would be no end to it
        raise not_written(f"learning run {info.id}")
    return run


def _chunks(
    steps: Iterator[tuple[BabblingRecord, Truth]],
) -> Iterator[Sequence[tuple[BabblingRecord, Truth]]]:
    """Gather steps into chunks of `CHUNK`; the last may be shorter."""
    chunk: list[tuple[BabblingRecord, Truth]] = []
    for step in steps:
        chunk.append(step)
        if len(chunk) == CHUNK:
            yield chunk
            chunk = []
    if chunk:
        yield chunk
