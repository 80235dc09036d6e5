"""One robot that babbles with one tool (§6): stopped after any behavior, and gone on with."""

from collections.abc import Iterator
from typing import Any

from affcli.config import settings_from_json
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.trial import BabblingRecord, LearningSpec, Truth
from affcli.lab.bench import LEARNING, STREAMS, Bench, stable_number, tool_named
from affcli.lab.plausible import bounded, not_written
from affcli.lab.sensing import calibration_of
from affcli.procedures.babbling import BabblingState, babble
from affcli.simulation.world import World
from affcli.store import LearningRunInfo

CHECKPOINT = {"step", "grasped", "seen", "clock", "wrist", "attractor", "streams"}
STREAM = {"bit_generator": 0, "state": 0, "has_uint32": 2, "uinteger": 2**32}
"""What the state of a random stream consists of, with the limit of what is a number."""


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


def gone_on_with(info: LearningRunInfo) -> LearningRun:
    """Return a run that is not done, as far as it came."""
    _check_checkpoint(info)
    run = LearningRun(info.spec, info.checkpoint)
    if run.done:  # and not marked so: there would be no end to it
        raise not_written(f"learning run {info.id}")
    return run


def _check_checkpoint(run: LearningRunInfo) -> None:
    """Refuse to go on with a learning run from where it cannot have been.

    Args:
        run: begun, and not done.

    Raises:
        DatabaseError: what it needs to go on is missing, or is none that `LearningRun` gives.
    """
    place, kept = f"learning run {run.id}", run.checkpoint
    if kept is None:
        if run.behaviors:
            raise not_written(place)
        return
    if kept.keys() != CHECKPOINT:
        raise not_written(place)
    stands = (kept["step"], kept["clock"]) == (run.behaviors, run.robot_seconds)
    seen = kept["seen"] is None or _are_numbers(kept["seen"], len(Observation._fields))
    placed = _are_numbers(kept["wrist"], 2) and _are_numbers(kept["attractor"], 3)
    streams = kept["streams"]
    drawn = (
        isinstance(streams, dict)
        and streams.keys() == set(STREAMS)
        and all(map(_is_stream, streams.values()))
    )
    if not (stands and isinstance(kept["grasped"], bool) and seen and placed and drawn):
        raise not_written(place)


def _are_numbers(value: object, count: int) -> bool:
    """Tell whether a value of JSON is a list of so many numbers within bounds."""
    return (
        isinstance(value, list)
        and len(value) == count
        and all(isinstance(number, int | float) for number in value)
        and bounded(value)
    )


def _is_stream(value: Any) -> bool:
    """Tell whether a value of JSON is the state of a random stream, a PCG64."""
    if not isinstance(value, dict) or value.keys() != STREAM.keys():
        return False
    words = value["state"]
    if not isinstance(words, dict) or words.keys() != {"state", "inc"}:
        return False
    numbers = [(words["state"], 2**128), (words["inc"], 2**128)]
    numbers += [(value[name], limit) for name, limit in STREAM.items() if limit]
    return value["bit_generator"] == "PCG64" and all(
        isinstance(number, int) and 0 <= number < limit for number, limit in numbers
    )
