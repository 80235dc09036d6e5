"""The ports of the robot: what robot, sensor, experimenter, goal, planner and explorer are.

Each contract says what is asked, when, how often, and what holds after a failure. The suites in
``affcli.testing`` hold any part, ours or another's, to its contract.
"""

from collections.abc import Mapping
from typing import Any, Protocol, TypeGuard

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, Execution
from affcli.core.choice import Candidate, Choice, Reaches, Situation
from affcli.core.geometry import Point, Pose
from affcli.core.goal import Goal
from affcli.core.observation import Observation
from affcli.core.trial import BabblingRecord


class Robot(Protocol):
    """An arm that executes behaviors and knows its own wrist, reach and clock.

    A behavior is executed to its end before `execute` returns; the clock runs meanwhile and at no
    other time.
    """

    @property
    def clock(self) -> float:
        """Robot seconds since the run or trial began; it never goes back."""

    @property
    def wrist(self) -> Pose:
        """The wrist now (in, rad, table frame), by the joint encoders."""

    @property
    def holding(self) -> BehaviorCall | None:
        """The binding behavior by which the tool is held; None before the first was executed."""

    def execute(self, call: BehaviorCall, seen: Observation | None) -> Execution:
        """Execute one behavior to its end.

        A binding behavior takes the tool; another one than before takes it anew, and position wrist
        comes next. A behavior that cannot be executed says so by its status, and the wrist is where
        the execution says.

        Args:
            call: which behavior, with which parameters.
            seen: the latest observation; position wrist aims by it. None before the first one.

        Raises:
            BadInputError: no such behavior in the repertoire, nor one that is composed of motor
                schemas which it has; nothing is changed.
            SimulationDivergedError: the world gave a number that is not finite.
        """

    def reaches(
        self,
        x: NDArray[np.float64],
        y: NDArray[np.float64],
        angle: NDArray[np.float64] | float = 0.0,
    ) -> NDArray[np.bool_]:
        """Tell for each wrist position (n,), (n,) (in, table frame) whether the arm reaches it with
        the wrist at an angle (rad): one for all, or one each (n,).
        """


class Sliding(Protocol):
    """A robot that knows where it can slide a tool, a capability that it may lack."""

    def slides(
        self,
        x: NDArray[np.float64],
        y: NDArray[np.float64],
        angle: NDArray[np.float64] | float = 0.0,
    ) -> NDArray[np.bool_]:
        """Tell for each wrist position (n,), (n,) (in, table frame), at an angle (rad), whether the
        arm can hold the tool on the table there; a slide ends where it cannot.
        """


def can_slide(robot: object) -> TypeGuard[Sliding]:
    """Tell whether a robot knows where it can slide; asked of what stands before one of another
    package too, which `isinstance` does not from Python 3.12 on.
    """
    return callable(getattr(robot, "slides", None))


class Sensor(Protocol):
    """Where observation vectors come from. Looking changes only the noise of what is seen next."""

    def observe(self) -> Observation:
        """Return the observation vector of this moment."""

    def observe_goal(self) -> Goal:
        """Return the goal as seen now.

        Raises:
            LookupError: there is no goal on the table.
        """


class Experimenter(Protocol):
    """The person of §6 who sees the whole table and serves the robot; it takes no robot time."""

    def attractor_out_of_reach(self) -> bool:
        """Tell whether no behavior can touch the attractor from any wrist position that babbling
        sets the tool down at.
        """

    def put_attractor_back(self) -> None:
        """Put the attractor at a new random position within the tool's reach."""

    def put_attractor_for(self, row: Affordance) -> None:
        """Put the attractor where the start of a row can be set up anew: at a new random place and
        angle from which the arm can do what it did when the row was made.

        Raises:
            BadInputError: there is no such place.
        """


class Planner(Protocol):
    """Chooses the row of the affordance table to use next. It sees the table and the observation.

    It is asked once a step, and may be asked about imagined situations at any time: equal
    situations give equal answers. It never changes the table.
    """

    @property
    def angle_degrees(self) -> float:
        """A use of a row replicates when the movement seen is within this angle of the row's."""

    @property
    def threshold(self) -> float:
        """A row is out of consideration at this replication probability or below."""

    def choose(self, situation: Situation) -> Choice:
        """Return the row to use, with the reasons; or none, which ends the trial: with the outcome
        `no plan found` while rows can be used, else with `no row left`.
        """

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return the rows that came closest, the one chosen first; to be looked at."""


class Explorer(Protocol):
    """Chooses what to try next while learning. It sees the robot's own tries and observations.

    For each behavior it is asked for `places` (again after the attractor was put back), told of the
    places that were `refused`, asked for the `behavior`, and told what it gave. All that it
    remembers is in its `state`, so that a run can be stopped after any behavior and gone on with.
    A robot that may hold the tool in several ways has one for each: it sees what was done so.
    """

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        """Return where the attractor may stand to the wrist (n, 2) (in), the first choice first.

        Those that the arm cannot take up are passed over. When none can be taken up, the attractor
        is put back by hand, and `places` is asked again.

        Args:
            seen: the latest observation.
            reaches: which wrist positions can be taken up.
        """

    def refused(self, place: Point) -> None:
        """Be told that the tool would have come down on the attractor at this place."""

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        """Return which exploratory behavior to try, now that the wrist is where it was asked to be:
        one that it was given, or one composed of motor schemas (`core.behavior.composed`).

        Args:
            place: which of the places it was.
            start: O^s.
        """

    def tell(self, record: BabblingRecord) -> None:
        """Be told what came of the behavior."""

    def state(self) -> dict[str, Any]:
        """Return, as JSON types, all that it remembers but for its random stream."""

    def restore(self, state: Mapping[str, Any]) -> None:
        """Remember what `state` gave. ValueError, KeyError or TypeError for anything else."""
