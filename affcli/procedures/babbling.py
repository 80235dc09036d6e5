"""Behavioral babbling: how the affordance table is filled (§3.2, §6)."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from affcli.behaviors.positioning import position_wrist
from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, Execution, ExecutionStatus
from affcli.core.change_detection import change_detected
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.ports import Experimenter, Explorer, Robot, Sensor
from affcli.core.trial import BabblingRecord
from affcli.errors import BadInputError

MOST_RESETS = 1_000
"""In a row, before one behavior; with sensible settings one is enough."""

STINT = 20
"""Behaviors after which a grasp is drawn anew where there are several. Choice: of 10, 20, 40, and
only when the attractor is put back, as good as any (seed 110, ``experiments/grasps``)."""


@dataclass(slots=True)
class BabblingState:
    """Where babbling stands between two behaviors; with the random streams and the explorer's own
    state all that it needs to go on.

    Args:
        step: behaviors executed so far.
        seen: the latest observation; None before the first.
        grasped: the binding behavior was executed.
    """

    step: int = 0
    seen: Observation | None = None
    grasped: bool = False


@dataclass(frozen=True, slots=True)
class OtherGrasps:
    """How else than by one binding behavior a robot may hold the tool while it babbles.

    Args:
        explorers: further binding behaviors, each with what explores while the tool is held so.
        choices: the robot's own random stream.
    """

    explorers: Mapping[BehaviorCall, Explorer]
    choices: np.random.Generator

    def drawn(self, first: BehaviorCall) -> BehaviorCall:
        """Return one of all binding behaviors, `first` among them, with equal chances."""
        all_of_them = [first, *self.explorers]
        return all_of_them[int(self.choices.integers(len(all_of_them)))]

    def take(self, robot: Robot, first: BehaviorCall) -> None:
        """Have the robot take the tool as drawn, unless it holds it so."""
        drawn = self.drawn(first)
        if drawn != robot.holding:
            robot.execute(drawn, None)


def babble(
    robot: Robot,
    sensor: Sensor,
    experimenter: Experimenter,
    binding: BehaviorCall,
    explorer: Explorer,
    state: BabblingState,
    *,
    others: OtherGrasps | None = None,
    elsewhere: bool = False,
) -> Iterator[BabblingRecord]:
    """Try behaviors at wrist positions that the explorer chooses, without end.

    Each time: the experimenter puts the attractor back if it is out of the tool's reach; position
    wrist; a behavior; a row if the change detection function T is 1, with both counters 1 (§3.2).

    §3.2: "picks binding and exploratory behaviors at random".

    Choice: where there are several binding behaviors, one is drawn at the start, each time that the
    attractor is put back, and before every `STINT`-th behavior. To draw one before each behavior
    would take most of the robot's time. What is learned of one grasp says nothing of another, as
    all places are seen from the wrist: each has an explorer of its own.

    Args:
        robot, sensor, experimenter: the world as the robot meets it.
        binding: the binding behavior.
        explorer: chooses what to try, and is told what came of it.
        state: updated in place before each record is yielded.
        others: how else the tool may be held; None for not at all.
        elsewhere: the experimenter puts the attractor elsewhere before each behavior.
    """
    explorers = {binding: explorer, **(others.explorers if others else {})}
    if not state.grasped:
        robot.execute(others.drawn(binding) if others else binding, None)
        state.grasped = True
    held = binding
    while True:
        resets = redraws = 0
        placing: Execution | None = None
        if others and state.step and state.step % STINT == 0:
            others.take(robot, binding)
        lost = elsewhere or experimenter.attractor_out_of_reach()
        while placing is None:
            if resets >= MOST_RESETS:
                raise BadInputError(
                    f"babbling: {resets} times in a row no wrist position put the attractor where "
                    "a tool might touch it; widen babbling.offset_x_max and offset_y_min to "
                    "offset_y_max, or lower sensor.position_noise"
                )
            if lost:
                # First the tool: the attractor is put where it can be touched with the tool so.
                if others:
                    others.take(robot, binding)
                experimenter.put_attractor_back()
                state.seen = None
                resets += 1
            state.seen = state.seen or sensor.observe()
            held = (robot.holding if others else None) or binding
            explorer = explorers[held]
            placing, blocked = _place(robot, state.seen, explorer)
            redraws += blocked
            lost = placing is None
        start = sensor.observe()
        call = explorer.behavior(Point(placing.call["x"], placing.call["y"]), start)
        execution = robot.execute(call, start)
        end = sensor.observe()
        state.step += 1
        state.seen = end
        row = made_row(state.step, held, execution, start, end)
        done = (placing, execution, start, end, row)
        told = held if others else None
        record = BabblingRecord(state.step, robot.clock, resets, redraws, *done, told)
        explorer.tell(record)
        yield record


def made_row(
    step: int, binding: BehaviorCall, execution: Execution, start: Observation, end: Observation
) -> Affordance | None:
    """Return the row that a behavior makes; None when T = 0."""
    if not change_detected(start, end):
        return None
    before, after = execution.wrist_start, execution.wrist_end
    return Affordance(
        step,
        binding,
        execution.call,
        start,
        end,
        truncated=execution.status is ExecutionStatus.TRUNCATED,
        wrist_angle=before.angle,
        travel=Point(after.x - before.x, after.y - before.y),
    )


def _place(robot: Robot, seen: Observation, explorer: Explorer) -> tuple[Execution | None, int]:
    """Ask for wrist offsets until one is in reach and the tool comes down clear of the attractor.

    Returns:
        The position wrist executed, None when all were in vain; and how many were blocked.
    """
    places = explorer.places(seen, robot.reaches)
    x, y = places[:, 0], places[:, 1]
    blocked = 0
    for i in np.flatnonzero(robot.reaches(seen.object_x - x, seen.object_y - y)):
        place = Point(float(x[i]), float(y[i]))
        placing = robot.execute(position_wrist(place), seen)
        if placing.status is ExecutionStatus.DONE:
            return placing, blocked
        explorer.refused(place)
        blocked += 1
    return None, blocked
