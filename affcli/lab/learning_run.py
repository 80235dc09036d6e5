"""One robot that babbles with one tool (§6): stopped after any behavior, and gone on with."""

from collections.abc import Iterator
from typing import Any

from affcli import registry
from affcli.core.invention import Invention, Inventor
from affcli.core.observation import Observation
from affcli.core.records import LearningRunInfo
from affcli.core.specs import LearningSpec, LearningStep
from affcli.errors import BadInputError, DatabaseError
from affcli.lab.run_parts import settings_of, world_of
from affcli.procedures.babbling import BabblingState, OtherGrasps, babble


class LearningRun:
    """One robot babbling with one tool; it can be stopped after any behavior and gone on with.

    Args:
        spec: what the run is a function of.
        checkpoint: what `checkpoint` gave when the run was stopped; None to begin.

    Attributes:
        world: where it takes place.
        setting: the world as it was laid out.
        calibration: of the camera that the robot sees through, as JSON; None without one.

    Raises:
        BadInputError: a part that this affcli lacks, or has in another version; an explorer that
            invents, with several grasps.
        DatabaseError: settings or a tool that it does not know.
        ValueError, KeyError, TypeError: the checkpoint is none that `checkpoint` gives.
    """

    def __init__(self, spec: LearningSpec, checkpoint: dict[str, Any] | None = None) -> None:
        self.spec = spec
        self.world = world_of(spec, again=True)
        self.setting = self.world.learning(spec, laid_out=checkpoint is None)
        self.calibration = self.setting.calibration
        settings = settings_of(spec)
        self._explorers = {
            binding: registry.explorer(spec.explorer, self.setting, settings)
            for binding in spec.bindings
        }
        self._explorer = self._explorers[spec.binding]
        if spec.other_bindings and isinstance(self._explorer, Inventor):
            raise BadInputError(
                f"explorer {spec.explorer.name}: invents with one grasp; give one --binding"
            )
        self._state = BabblingState()
        if checkpoint is not None:
            self._restore(checkpoint)

    def steps(self) -> Iterator[LearningStep]:
        """Yield what each behavior gave, until the time or the number of behaviors is up.

        The behavior during which the time runs out is the last.
        """
        setting = self.setting
        others = {one: self._explorers[one] for one in self.spec.other_bindings}
        records = babble(
            setting.robot,
            setting.sensor,
            setting.experimenter,
            setting.binding,
            self._explorer,
            self._state,
            others=OtherGrasps(others, setting.choices) if others else None,
        )
        while not self.done:
            yield next(records), setting.truth()

    @property
    def behaviors(self) -> int:
        """How many behaviors were executed."""
        return self._state.step

    @property
    def seconds(self) -> float:
        """Robot seconds since it began."""
        return self.setting.robot.clock

    @property
    def done(self) -> bool:
        """Whether the time or the number of behaviors is up."""
        if self.spec.behaviors is not None:
            return self._state.step >= self.spec.behaviors
        return self.setting.robot.clock >= 3600.0 * (self.spec.hours or 0.0)

    def inventions(self) -> tuple[Invention, ...]:
        """Return what the robot invented so far; nothing when it explores in another way."""
        return self._explorer.inventions() if isinstance(self._explorer, Inventor) else ()

    def checkpoint(self) -> dict[str, Any] | None:
        """Return, as JSON types, all that a later `LearningRun` needs to go on from here; None in a
        world that cannot be gone on with.
        """
        snapshot = self.setting.snapshot()
        if snapshot is None:
            return None
        states = [explorer.state() for explorer in self._explorers.values()]
        return {
            "step": self._state.step,
            "grasped": self._state.grasped,
            "seen": self._state.seen,
            "explorer": states if self.spec.other_bindings else states[0],
            **snapshot,
        }

    def _restore(self, checkpoint: dict[str, Any]) -> None:
        """Put everything where the checkpoint says."""
        seen = checkpoint["seen"]
        self._state.step = int(checkpoint["step"])
        self._state.grasped = bool(checkpoint["grasped"])
        self._state.seen = None if seen is None else Observation(*map(float, seen))
        # Runs that were begun before explorers had names explored at random, and remember nothing.
        state = checkpoint.get("explorer", {})
        states = state if self.spec.other_bindings else [state]
        for explorer, own in zip(self._explorers.values(), states, strict=True):
            explorer.restore(own)
        self.setting.restore(checkpoint)


def gone_on_with(info: LearningRunInfo) -> LearningRun:
    """Return a run that is not done, as far as it came.

    Raises:
        DatabaseError: what it needs to go on is missing, or is none that `LearningRun` gives.
        BadInputError: a part that it began with is missing here.
    """
    damaged = DatabaseError(
        f"learning run {info.id} cannot be gone on with: its checkpoint is not as affcli writes "
        "it; restore a copy of the database"
    )
    if info.checkpoint is None and info.behaviors:
        raise damaged
    try:
        run = LearningRun(info.spec, info.checkpoint)
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        raise damaged from error
    stands = (run.behaviors, run.setting.robot.clock) == (info.behaviors, info.robot_seconds)
    ended = run.done and info.spec.hours != 0.0  # in no time there is nothing to be done
    if ended or (info.checkpoint is not None and not stands):  # there would be no end to it
        raise damaged
    return run
