"""The protocols behind which two real things stand: a simulated one today, others later."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, Execution
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.task import GoalRegion


class Robot(Protocol):
    """An arm that executes behaviors and knows its own wrist, reach and clock."""

    @property
    def clock(self) -> float:
        """Robot seconds since the run or trial began."""

    @property
    def wrist(self) -> Point:
        """The wrist now (in, table frame), by the joint encoders."""

    def execute(self, call: BehaviorCall, seen: Observation | None) -> Execution:
        """Execute one behavior to its end.

        Args:
            call: which behavior, with which parameters.
            seen: the latest observation; position wrist aims by it. None before the first one.

        Raises:
            KeyError: no such behavior in the registry.
            SimulationDivergedError: the world gave a number that is not finite.
        """

    def reaches(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Tell for each wrist position (n,), (n,) (in, table frame) whether the arm reaches it."""


class Sensor(Protocol):
    """Where observation vectors come from."""

    def observe(self) -> Observation:
        """Return the observation vector of this moment."""

    def observe_goal(self) -> GoalRegion:
        """Return the goal region as seen now.

        Raises:
            LookupError: there is no goal on the table.
        """


class Experimenter(Protocol):
    """The person of §6 who sees the whole table and serves the robot."""

    def attractor_out_of_reach(self) -> bool:
        """Tell whether no behavior from any wrist position can touch the attractor."""

    def put_attractor_back(self) -> None:
        """Put the attractor at a new random position within the tool's reach; takes no time."""

    def put_attractor_for(self, row: Affordance) -> None:
        """Put the attractor where the start of a row can be set up anew: at a new random place and
        angle from which the arm can do what it did when the row was made; takes no time.

        Raises:
            BadInputError: there is no such place.
        """
