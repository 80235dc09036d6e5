"""Named fakes of the protocols in `affcli.core.ports`: a table without physics or noise.

Robot, sensor and experimenter share a `FakeTable`. What a behavior does to the attractor, which
wrist positions are in reach and when lowering the tool is blocked are scripted by the test.
"""

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import repeat
from typing import Any

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import Affordance
from affcli.core.behavior import (
    GRASP,
    POSITION_WRIST,
    BehaviorCall,
    Execution,
    ExecutionStatus,
)
from affcli.core.choice import Reaches
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.task import GoalRegion
from affcli.core.tool import Color
from affcli.core.trial import BabblingRecord
from affcli.errors import BadInputError
from tests.factories import TOOL_COLOR, observation

Effect = Callable[[BehaviorCall], tuple[float, float]]
"""By how much an exploratory behavior moves the attractor (in)."""

CALL_SECONDS = 4.0
"""What every behavior of the fake robot takes: a power of two, so that clocks add up exactly."""


def no_effect(call: BehaviorCall) -> tuple[float, float]:
    """Leave the attractor alone."""
    return 0.0, 0.0


def scripted(movements: Iterable[tuple[float, float]]) -> Effect:
    """Move the attractor by one movement after the other, then no more."""
    coming = iter(movements)
    return lambda call: next(coming, (0.0, 0.0))


def everywhere(place: Point) -> bool:
    """Say yes to every place."""
    return True


def nowhere(place: Point) -> bool:
    """Say no to every place."""
    return False


@dataclass(slots=True)
class FakeTable:
    """What the three fakes share: where attractor, wrist and goal are."""

    attractor: Point = Point(0.0, 24.0)
    wrist: Pose = Pose(0.0, 16.0)
    goal: GoalRegion | None = None
    tool_color: Color = TOOL_COLOR


@dataclass(slots=True)
class FakeRobot:
    """A `Robot` without an arm: it goes where it is asked to, and the attractor moves by script.

    Attributes:
        executed: every call with the observation it was given, in order.
        effect: how an exploratory behavior moves the attractor.
        placings: how each position wrist ends, one after the other; done when they run out.
        endings: how each exploratory behavior ends, one after the other; done when they run out.
        reachable: which wrist positions are in reach.
        repertoire: the exploratory behaviors that it has; None for any.
    """

    table: FakeTable
    effect: Effect = no_effect
    placings: Iterable[ExecutionStatus] = ()
    endings: Iterable[ExecutionStatus] = ()
    reachable: Callable[[Point], bool] = everywhere
    repertoire: Collection[BehaviorCall] | None = None
    clock: float = 0.0
    holding: BehaviorCall | None = None
    executed: list[tuple[BehaviorCall, Observation | None]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.placings = iter(self.placings)
        self.endings = iter(self.endings)

    @property
    def wrist(self) -> Pose:
        return self.table.wrist

    @property
    def calls(self) -> list[BehaviorCall]:
        """The calls executed, without observations."""
        return [call for call, _ in self.executed]

    def reaches(
        self,
        x: NDArray[np.float64],
        y: NDArray[np.float64],
        angle: NDArray[np.float64] | float = 0.0,
    ) -> NDArray[np.bool_]:
        places = map(Point, x.tolist(), y.tolist())
        return np.array([self.reachable(place) for place in places], dtype=bool)

    def execute(self, call: BehaviorCall, seen: Observation | None) -> Execution:
        known = self.repertoire is None or call in self.repertoire
        if not known and call.name not in (POSITION_WRIST, GRASP):
            raise BadInputError(f"{call}: not in the repertoire")
        self.executed.append((call, seen))
        start, status = self.table.wrist, ExecutionStatus.DONE
        if call.name == POSITION_WRIST:
            assert seen is not None
            status = next(_ongoing(self.placings))
            x, y = seen.wrist_for(Point(call["x"], call["y"]))
            if self.reachable(Point(x, y)):
                self.table.wrist = Pose(x, y, math.radians(call.get("angle", 0.0)))
            else:
                status = ExecutionStatus.OUT_OF_REACH
        elif call.name == GRASP:
            self.holding = call
        else:
            status = next(_ongoing(self.endings))
            dx, dy = self.effect(call)
            at = self.table.attractor
            self.table.attractor = Point(at.x + dx, at.y + dy)
        self.clock += CALL_SECONDS
        return Execution(call, status, start, self.table.wrist, CALL_SECONDS)


def _ongoing(script: Iterable[ExecutionStatus]) -> Iterator[ExecutionStatus]:
    """Go on with a script, then with `done` for ever."""
    yield from script
    yield from repeat(ExecutionStatus.DONE)


@dataclass(slots=True)
class FakeSensor:
    """A `Sensor` without noise.

    Attributes:
        taken: every observation given, in order.
        goals_seen: how often the goal was looked at.
    """

    table: FakeTable
    taken: list[Observation] = field(default_factory=list)
    goals_seen: int = 0

    def observe(self) -> Observation:
        table = self.table
        self.taken.append(
            observation(table.attractor, wrist=table.wrist, tool_color=table.tool_color)
        )
        return self.taken[-1]

    def observe_goal(self) -> GoalRegion:
        self.goals_seen += 1
        if self.table.goal is None:
            raise LookupError("there is no goal region on the table")
        return self.table.goal


@dataclass(slots=True)
class FakeExperimenter:
    """An `Experimenter` who calls a place lost by rule and puts the attractor back by list.

    Attributes:
        lost: which places of the attractor are out of the tool's reach.
        places: where the attractor is put back, one after the other.
        put_back: how often it was.
        put_for: the rows for which it was put somewhere, in order.
    """

    table: FakeTable
    lost: Callable[[Point], bool] = nowhere
    places: Iterable[Point] = ()
    put_back: int = 0
    put_for: list[Affordance] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.places = iter(self.places)

    def attractor_out_of_reach(self) -> bool:
        return self.lost(self.table.attractor)

    def put_attractor_back(self) -> None:
        self.table.attractor = next(iter(self.places))
        self.put_back += 1

    def put_attractor_for(self, row: Affordance) -> None:
        self.table.attractor = next(iter(self.places))
        self.put_for.append(row)


@dataclass(slots=True)
class FakeExplorer:
    """An `Explorer` that tries one behavior at places of a list, and writes down what it hears.

    Attributes:
        offsets: where the attractor may stand to the wrist, the same each time.
        call: what it tries.
        heard: what it was asked and told, in order, with the argument that matters.
    """

    offsets: Sequence[tuple[float, float]]
    call: BehaviorCall
    heard: list[tuple[str, object]] = field(default_factory=list)

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        self.heard.append(("places", seen.object_position))
        return np.array(self.offsets)

    def refused(self, place: Point) -> None:
        self.heard.append(("refused", place))

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        self.heard.append(("behavior", place))
        return self.call

    def tell(self, record: BabblingRecord) -> None:
        self.heard.append(("tell", record.step))

    def state(self) -> dict[str, Any]:
        return {"heard": len(self.heard)}

    def restore(self, state: Mapping[str, Any]) -> None:
        if state.keys() != {"heard"}:
            raise ValueError("not what it heard")
        self.heard = [("restored", None)] * int(state["heard"])
