"""The ports: what robot, sensor, experimenter, goal, planner, explorer and world are.

Each contract says what is asked, when, how often, and what holds after a failure. The suites in
``affcli.testing`` hold any part, ours or another's, to its contract.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, Execution
from affcli.core.choice import Candidate, Choice, Situation
from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.observation import Observation, SensorKind
from affcli.core.trial import BabblingRecord, Truth

if TYPE_CHECKING:
    # Only the worlds and those who open them know what is truly on the table.
    from affcli.core.scene import Scene
    from affcli.core.specs import LearningSpec, RowStarts, TrialSpec, VerificationSpec
    from affcli.core.task import Task
    from affcli.core.tool import Tool


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
            KeyError: no such behavior in the repertoire.
            SimulationDivergedError: the world gave a number that is not finite.
        """

    def reaches(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Tell for each wrist position (n,), (n,) (in, table frame) whether the arm reaches it."""


class Goal(Protocol):
    """A goal as the robot sees it."""

    @property
    def name(self) -> str:
        """What it is called."""

    @property
    def center(self) -> Point:
        """The place that distances are taken to (in, table frame)."""

    def reached(self, seen: Observation) -> bool:
        """Tell whether the attractor is seen where it shall be."""

    def squared_distance(
        self, at: Point, dx: NDArray[np.float64], dy: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return the squared distances (n,) (in^2) to the goal of the places `at` + (dx, dy)."""

    def outline(self) -> ConvexPolygon:
        """Return what to draw (in, table frame)."""


class Sensor(Protocol):
    """Where observation vectors come from. Looking changes nothing but the noise that follows."""

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
        """Tell whether no behavior from any wrist position can touch the attractor."""

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
        """Return the row to use, with the reasons; no row when none is left."""

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return the rows that came closest, the one chosen first; to be looked at."""


class Explorer(Protocol):
    """Chooses what to try next while learning. It sees the robot's own tries and observations.

    For each behavior it is asked for `places` (again after the attractor was put back), told of the
    places that were `refused`, asked for the `behavior`, and told what it gave. All that it
    remembers is in its `state`, so that a run can be stopped after any behavior and gone on with.
    """

    def places(self, seen: Observation) -> NDArray[np.float64]:
        """Return where the attractor may stand to the wrist (n, 2) (in), the first choice first.

        Those that the arm cannot take up are passed over. When none can be taken up, the attractor
        is put back by hand, and `places` is asked again.
        """

    def refused(self, place: Point) -> None:
        """Be told that the tool would have come down on the attractor at this place."""

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        """Return which exploratory behavior to try, now that the wrist is where it was asked to be.

        Args:
            place: which of the places it was.
            start: O^s.
        """

    def tell(self, record: BabblingRecord) -> None:
        """Be told what came of the behavior."""

    def state(self) -> dict[str, Any]:
        """Return, as JSON types, all that it remembers but for its random stream."""

    def restore(self, state: Mapping[str, Any]) -> None:
        """Remember what `state` gave. ValueError, KeyError or TypeError when it gave none such."""


Film = Callable[[float, "Scene"], None]
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

    def scene(self) -> "Scene | None":
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

    def tasks(self, task_set: str) -> tuple["Task", ...]:
        """Return the tasks of a set by its name; KeyError when it has none such."""

    def learning(self, spec: "LearningSpec", *, laid_out: bool = True) -> Setting:
        """Lay out a learning run (§6); without `laid_out` a snapshot is restored next."""

    def trial(self, spec: "TrialSpec", learned: "LearningSpec") -> Setting:
        """Lay out a testing trial (§7.1) of a robot that learned by `learned`."""

    def verification(self, spec: "VerificationSpec", learned: "LearningSpec", uses: int) -> Setting:
        """Lay out a verification (§8).

        Args:
            spec: which.
            learned: how the table was learned.
            uses: how often its rows were used before; a part of its random streams' key.
        """

    def prediction(self, spec: "VerificationSpec", learned: "LearningSpec") -> Setting:
        """Lay out fresh pushes (§6.1): as a verification, with random streams of their own."""

    def lost_rows(
        self, learned: "LearningSpec", left: "Tool", starts: "RowStarts"
    ) -> LostRows | None:
        """Return who tells which rows were lost when the tool broke to `left`; None in a world that
        cannot tell.
        """
