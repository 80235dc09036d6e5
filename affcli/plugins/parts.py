"""Parts of other packages by name, and what they build, held to what it must be."""

import atexit
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from affcli.bounded import LARGEST_VALUE
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import (
    BehaviorCall,
    composed,
    composed_motion,
    repertoire_from_json,
    repertoire_json,
)
from affcli.core.choice import Candidate, Choice, Reaches, Reason, Situation
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.part import Kind, Part
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion, Task
from affcli.core.tool import Tool
from affcli.core.trial import BabblingRecord
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError, PartFailedError, one_line
from affcli.own_files.behaviors import require_sound as require_sound_behavior
from affcli.own_files.tools import require_sound as require_sound_tool
from affcli.plugins.entry_points import Offer, offers
from affcli.plugins.guarded import guarded_world
from affcli.plugins.host import Question
from affcli.plugins.hosted import Host

LONGEST_REASONS = LARGEST_VALUE // 2
"""Letters of a planner's reasons as JSON: they have room in a row of a database."""
_hosts: list[Host] = []
"""The processes of parts."""
_found: dict[tuple[Kind, str], Part] = {}
"""The parts that were asked for, by kind and name."""


def names(kind: Kind) -> list[str]:
    """Return the names of what packages offer of a kind."""
    return [offer.name for offer in offers(kind)]


def find(kind: Kind, name: str) -> Part | None:
    """Return a part by name; None when no package offers it.

    Raises:
        PartFailedError: it cannot be loaded, or several packages offer it.
    """
    # One that was found stays what it is: to look through what is installed takes some 20 ms.
    if (kind, name) not in _found:
        found = [offer for offer in offers(kind) if offer.name == name]
        if not found:
            return None
        _require_one(found[0], found)
        _found[kind, name] = part(found[0])
    return _found[kind, name]


def _require_one(offer: Offer, found: Iterable[Offer]) -> None:
    """Refuse a name that several packages have: PartFailedError."""
    others = [one.package for one in found if one.name == offer.name and one != offer]
    if others:
        raise offer.refused(f"{' and '.join(others)} offers one too; uninstall all but one")


@cache
def part(offer: Offer) -> Part:
    """Return the part of an offer; PartFailedError when it cannot be loaded."""
    host = Host(offer)
    _hosts.append(host)
    told = host.part()
    return replace(told, build=_builder(host, told))


@atexit.register
def forget() -> None:
    """End the processes of all parts, and know none."""
    while _hosts:
        _hosts.pop().end()
    _found.clear()
    part.cache_clear()


def _builder(host: Host, told: Part) -> Callable[..., Any]:
    """Return what builds a part that is loaded in a process."""
    match told.kind:
        case "planners":
            return partial(HostedPlanner, host)
        case "explorers":
            return partial(HostedExplorer, host)
        case "sensors":
            return partial(HostedSensor, host)
        case "worlds":
            return partial(guarded_world, host.offer)
        case _:
            return partial(_value, host, told)


def everything(kind: Kind) -> Iterator[tuple[Offer, Part | PartFailedError]]:
    """Yield what packages offer of a kind: each part, or why it cannot be loaded."""
    found = offers(kind)
    for offer in found:
        try:
            _require_one(offer, found)
            yield offer, part(offer)
        except PartFailedError as error:
            yield offer, error


class HostedPlanner:
    """A planner that chooses in a process of its own; its answers are those of a planner.

    Args:
        host: the process.
        values: its parameters.
    """

    def __init__(self, host: Host, /, **values: Any) -> None:
        self._host, self._refused = host, host.offer.refused
        self._number = host.keep(self, (), values)
        self.angle_degrees = self._share("angle_degrees", 180.0)
        self.threshold = self._share("threshold", 1.0)

    def _share(self, name: str, most: float) -> float:
        value = self._call(name)
        if not isinstance(value, int | float) or not 0.0 <= value <= most:
            raise self._refused(f"its {name} is {one_line(value, 40)}, not 0 to {most:g}")
        return float(value)

    def choose(self, situation: Situation) -> Choice:
        """Return its choice; PartFailedError when it gives none."""
        choice = self._asked("choose", situation)
        try:
            position, reasons = choice
            place = None if position is None else range(len(situation.table))[position]
            told = [reason.json() for reason in reasons]
            if len(json.dumps(told, allow_nan=False)) > LONGEST_REASONS:
                raise ValueError("reasons without end")  # noqa: TRY301
            return Choice(place, tuple(map(Reason.from_json, told)))
        except (TypeError, ValueError, LookupError, AttributeError) as error:
            raise self._refused(f"it chose {one_line(choice, 100)}") from error

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return what came close; PartFailedError when it says something else."""
        found = self._asked("candidates", situation)
        try:
            rows = range(len(situation.table))
            return tuple(Candidate(rows[at], float(d), float(r)) for at, d, r in found)
        except (TypeError, ValueError, LookupError) as error:
            raise self._refused(f"its candidates are {one_line(found, 100)}") from error

    def _asked(self, name: str, situation: Situation) -> Any:
        """Return its answer; it asks back where the arm reaches."""
        questions = [situation.reaches, *filter(None, [situation.slides])]
        asked = [Question(number) for number, _ in enumerate(questions)]
        sent = replace(
            situation,
            table=AffordanceTable(situation.table),  # without what other planners keep in it
            reaches=asked[0],
            slides=asked[1] if len(asked) > 1 else None,
        )
        return self._call(name, sent, questions=questions)

    def _call(self, name: str, *args: Any, questions: Any = ()) -> Any:
        answer, _ = self._host.ask("call", self._number, name, args, None, questions=questions)
        return answer


class HostedExplorer:
    """An explorer in a process of its own; the random stream of its choices is that of this one.

    Args:
        host: the process.
        exploratory: what can be tried.
        box: the box of babbling.
        choices: the random stream.
        values: its parameters.
    """

    def __init__(
        self,
        host: Host,
        exploratory: Any,
        box: Any,
        choices: np.random.Generator,
        /,
        **values: Any,
    ) -> None:
        self._host, self._refused, self._choices = host, host.offer.refused, choices
        self._calls: tuple[BehaviorCall, ...] = tuple(exploratory)
        self._number = host.keep(self, (self._calls, box, choices), values, stream=2)

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        """Return where the attractor may stand."""
        found = self._call("places", seen, Question(0), questions=[reaches])
        try:
            places = np.asarray(found, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise self._refused(f"its places are {one_line(found, 60)}") from error
        if places.ndim != 2 or places.shape[1] != 2 or not np.isfinite(places).all():
            raise self._refused(f"its places are {one_line(found, 60)}, not (n, 2) inches")
        return places

    def refused(self, place: Point) -> None:
        """Tell it of a place that could not be taken up."""
        self._call("refused", place)

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        """Return what it tries."""
        chosen = self._call("behavior", place, start)
        for call in self._calls:
            if call == chosen:
                return call
        try:
            motion = composed_motion(chosen)
            if motion is None:
                raise ValueError("not composed of motor schemas")  # noqa: TRY301
            require_sound_behavior(composed(motion))
        except (AttributeError, TypeError, ValueError, BadInputError) as error:
            why = f"it tries {one_line(chosen, 60)}, which nobody gave it: {one_line(error, 60)}"
            raise self._refused(why) from error
        return composed(motion).call

    def tell(self, record: BabblingRecord) -> None:
        """Tell it what came of that."""
        self._call("tell", record)

    def state(self) -> dict[str, Any]:
        """Return what it remembers."""
        state = self._call("state")
        try:
            return dict(json.loads(json.dumps(state, allow_nan=False)))
        except (TypeError, ValueError) as error:
            raise self._refused(f"its state is {one_line(state, 60)}, no JSON") from error

    def restore(self, state: Mapping[str, Any]) -> None:
        """Have it remember."""
        self._call("restore", dict(state))

    def _call(self, name: str, *args: Any, questions: Any = ()) -> Any:
        stands = self._choices.bit_generator.state
        request = ("call", self._number, name, args, stands)
        answer, self._choices.bit_generator.state = self._host.ask(*request, questions=questions)
        return answer


class HostedSensor:
    """A sensor in a process of its own; the random stream of its noise is that of this one.

    Args:
        host: the process.
        look: gives the scene of this moment.
        noise: the random stream.
        workspace: what stands where, and how large it is.
        tool: that the robot believes to hold.
        values: its parameters.
    """

    def __init__(
        self,
        host: Host,
        look: Callable[[], Scene],
        noise: np.random.Generator,
        workspace: Workspace,
        tool: Tool,
        /,
        **values: Any,
    ) -> None:
        self._host, self._refused, self._look, self._noise = host, host.offer.refused, look, noise
        self._number = host.keep(self, (Question(0), noise, workspace, tool), values, stream=1)

    def observe(self) -> Observation:
        """Return what is seen."""
        seen = self._call("observe")
        try:
            numbers = [float(value) for value in seen]
            if len(numbers) == len(Observation._fields) and all(map(math.isfinite, numbers)):
                return Observation(*numbers)
        except (TypeError, ValueError):
            pass
        raise self._refused(f"it sees {one_line(seen, 100)}, not twelve numbers")

    def observe_goal(self) -> GoalRegion:
        """Return the goal as seen; LookupError when there is none."""
        if self._look().goal is None:
            raise LookupError("there is no goal on the table")
        goal = self._call("observe_goal")
        if not isinstance(goal, GoalRegion) or not _finite(*goal.center, goal.half_width):
            raise self._refused(f"it sees the goal {one_line(goal, 60)}")
        return goal

    def _call(self, name: str) -> Any:
        stands = self._noise.bit_generator.state
        request = ("call", self._number, name, (), stands)
        answer, self._noise.bit_generator.state = self._host.ask(*request, questions=[self._look])
        return answer


def _finite(*numbers: float) -> bool:
    return all(map(math.isfinite, numbers))


def _value(host: Host, told: Part, /, *args: Any, **values: Any) -> Any:
    """Return what a part builds that is a value: a tool, behaviors, tasks, a binding.

    Raises:
        PartFailedError: it is something else.
    """
    made = host.make(args, values)
    try:
        return _CHECKED[told.kind](made, str(told.component(values)))
    except (BadInputError, TypeError, ValueError, LookupError, AttributeError) as error:
        raise host.offer.refused(f"it makes no {told.kind}: {one_line(error, 100)}") from error


def _tool(made: Any, _: str) -> Tool:
    """Return a tool, if it is one that the engine can take."""
    if not isinstance(made, Tool):
        raise TypeError(one_line(made, 60))
    require_sound_tool(made)
    return made


def _behaviors(made: Any, _: str) -> Any:
    """Return behaviors, if they can be stored and read back."""
    own = repertoire_from_json(json.loads(json.dumps(repertoire_json(made), allow_nan=False)))
    for behavior in own:
        require_sound_behavior(behavior)
    return own


def _binding(made: Any, _: str) -> BehaviorCall:
    """Return a call."""
    params = {key: float(value) for key, value in made.params}
    if not all(map(math.isfinite, params.values())):
        raise ValueError(one_line(made, 60))
    return BehaviorCall.of(made.name, params)


def _tasks(made: Any, name: str) -> tuple[Task, ...]:
    """Return tasks, under the name and the version of their part."""
    for task in made:
        numbers = (*task.goal.center, task.goal.half_width, *task.start)
        if not isinstance(task.goal, GoalRegion) or not _finite(*numbers):
            raise ValueError(one_line(task, 60))
    return tuple(replace(task, task_set=name) for task in made)


_CHECKED: Mapping[Kind, Callable[[Any, str], Any]] = {
    "tools": _tool,
    "behaviors": _behaviors,
    "bindings": _binding,
    "tasks": _tasks,
}
