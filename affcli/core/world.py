"""The port of a world: where robots learn and are tested, and what of it may be asked.

Only worlds, and those who open them, know what is truly on the table; the ports that a robot meets
stand in `core.ports`.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol, TypeGuard, runtime_checkable

import numpy as np

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall
from affcli.core.mask import Mask
from affcli.core.observation import SensorKind
from affcli.core.ports import Experimenter, Robot, Sensor
from affcli.core.records import StepScene
from affcli.core.scene import Scene
from affcli.core.specs import LearningSpec, RowStarts, TrialSpec, VerificationSpec
from affcli.core.task import Task
from affcli.core.tool import Tool
from affcli.core.trial import Truth
from affcli.core.workspace import Workspace

MakeSensor = Callable[[Callable[[], Scene], np.random.Generator, Workspace, Tool], Sensor]
"""Makes a sensor of what gives the scene of each moment, the random stream of its noise, the sizes
of what stands on the table, and the tool that the robot believes to hold."""


@runtime_checkable
class BringsSensors(Protocol):
    """What a world is given sets of tasks by, when it knows the sensors of other packages too."""

    def sensor(self, kind: SensorKind) -> MakeSensor:
        """Return what makes a sensor.

        Raises:
            BadInputError: there is none, or it is here in another version.
        """


Film = Callable[[float, Scene], None]
"""Called again and again while a behavior is executed, with the robot clock and the scene."""


class Setting(Protocol):
    """A world that was laid out for one learning run, trial or verification.

    A world has one setting at a time: opening another ends the one before.
    """

    @property
    def robot(self) -> Robot:
        """The robot."""

    @property
    def sensor(self) -> Sensor:
        """Through what it sees."""

    @property
    def experimenter(self) -> Experimenter:
        """Who serves it."""

    @property
    def binding(self) -> BehaviorCall:
        """How it takes the tool."""

    @property
    def exploratory(self) -> Sequence[BehaviorCall]:
        """What it can try."""

    @property
    def choices(self) -> np.random.Generator:
        """The random stream of its own choices."""

    @property
    def calibration(self) -> str | None:
        """What its camera's calibration gave, as canonical JSON; None without a camera."""

    def truth(self) -> Truth | None:
        """Return where the attractor truly was before and after the last behavior; None in a world
        that cannot tell.
        """

    def scene(self) -> Scene | None:
        """Return what is truly on the table now; None in a world that cannot tell."""

    def film(self, film: Film | None) -> bool:
        """Show a film what happens from now on, or stop to; False in a world that cannot."""

    def snapshot(self) -> dict[str, Any] | None:
        """Return, as JSON types, all that is needed to go on from here; None in a world that
        cannot.
        """

    def restore(self, snapshot: Mapping[str, Any]) -> None:
        """Go on from a snapshot.

        Raises:
            ValueError, KeyError, TypeError: it is none of this world's.
        """


class ShowsTools(Protocol):
    """A world whose robots see the shape of their tool, a capability that it may lack."""

    def mask(self, learned: LearningSpec) -> Mask:
        """Return what the camera of a robot sees of its tool: a function of the spec alone.

        Raises:
            NotSeenError: the camera does not see the tool, or not all of it.
        """


def shows_tools(world: object) -> TypeGuard[ShowsTools]:
    """Tell whether a world shows tools; asked of what stands before one of another package too,
    which `isinstance` does not from Python 3.12 on.
    """
    return callable(getattr(world, "mask", None))


class LostRows(Protocol):
    """Tells which rows a broken tool has truly lost; for the record, never for the robot."""

    def lost(self, row: Affordance) -> bool:
        """Tell whether the tool that is left can no longer do what the row says."""


class World(Protocol):
    """Where robots learn and are tested.

    Equal specs give equal records. A world whose engine fails raises SimulationDivergedError, and
    can be opened again afterwards.
    """

    @property
    def name(self) -> str:
        """By which runs name it."""

    @property
    def version(self) -> int:
        """Raised when equal specs give other records than before."""

    @property
    def unit(self) -> str:
        """Of its lengths: ``in``."""

    @property
    def exact_replay(self) -> bool:
        """Whether doing a run again gives the same record to the bit."""

    def packages(self, sensor: SensorKind) -> tuple[str, ...]:
        """Return the packages whose versions decide its numbers, seen through a sensor."""

    def tasks(self, task_set: str) -> tuple[Task, ...]:
        """Return the tasks of a set by its name; KeyError when it has no such set."""

    def learning(self, spec: LearningSpec, *, laid_out: bool = True) -> Setting:
        """Lay out a learning run (§6); without `laid_out` a snapshot is restored next."""

    def trial(self, spec: TrialSpec, learned: LearningSpec) -> Setting:
        """Lay out a testing trial (§7.1) of a robot that learned by `learned`."""

    def verification(self, spec: VerificationSpec, learned: LearningSpec, uses: int) -> Setting:
        """Lay out a verification (§8).

        Args:
            spec: which.
            learned: how the table was learned.
            uses: how often its rows were used before; a part of its random streams' key.
        """

    def prediction(self, spec: VerificationSpec, learned: LearningSpec) -> Setting:
        """Lay out fresh pushes (§6.1): as a verification, with random streams of their own."""

    def step_again(self, step: StepScene, film: Film) -> bool:
        """Do one step again from its record, shown to a film; False in a world that cannot."""

    def lost_rows(self, learned: LearningSpec, left: Tool, starts: RowStarts) -> LostRows | None:
        """Return who tells which rows were lost when the tool broke to `left`; None in a world that
        cannot tell.
        """
