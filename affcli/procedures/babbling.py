"""Behavioral babbling: how the affordance table is filled (§3.2, §6)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from affcli.core.affordance import Affordance
from affcli.core.behavior import POSITION_WRIST, BehaviorCall, Execution, ExecutionStatus
from affcli.core.change_detection import change_detected
from affcli.core.observation import Observation
from affcli.core.ports import Experimenter, Robot, Sensor
from affcli.core.setting import setting
from affcli.core.trial import BabblingRecord
from affcli.errors import BadInputError

MOST_RESETS = 1_000
"""In a row, before one behavior; with sensible settings one is enough."""


@dataclass(frozen=True, slots=True)
class BabblingSettings:
    """Where babbling puts the attractor relative to the wrist: one box that serves all tools.

    The robot knows nothing of the tool's shape (§4), so the box is that of what any tool might
    touch. Inches, in the wrist's frame.
    """

    offset_x_max: float = setting(7.5, "in", "|x| of position wrist is at most this.")
    offset_y_min: float = setting(6.8, "in", "y of position wrist is at least this.")
    offset_y_max: float = setting(19.2, "in", "y of position wrist is at most this.")
    draws: int = setting(
        256,
        "",
        "After this many wrist positions in vain the attractor is put back, as if out of reach.",
    )


@dataclass(slots=True)
class BabblingState:
    """Where babbling stands between two behaviors; with the random streams all that it needs to
    go on.

    Args:
        step: behaviors executed so far.
        seen: the latest observation; None before the first.
        grasped: the binding behavior was executed.
    """

    step: int = 0
    seen: Observation | None = None
    grasped: bool = False


def babble(
    robot: Robot,
    sensor: Sensor,
    experimenter: Experimenter,
    binding: BehaviorCall,
    exploratory: Sequence[BehaviorCall],
    settings: BabblingSettings,
    rng: np.random.Generator,
    state: BabblingState,
) -> Iterator[BabblingRecord]:
    """Try random behaviors at random wrist positions, without end.

    Each time: the experimenter puts the attractor back if it is out of the tool's reach; a random
    position wrist; a random behavior with a random value of its parameter; a row if the change
    detection function T is 1, with both counters 1 (§3.2).

    Args:
        robot, sensor, experimenter: the world as the robot meets it.
        binding: the binding behavior, executed once at the start.
        exploratory: the calls to draw from, with equal chances.
        settings: the box of wrist offsets.
        rng: the robot's choices.
        state: updated in place before each record is yielded.
    """
    if not state.grasped:
        robot.execute(binding, None)
        state.grasped = True
    while True:
        resets = redraws = 0
        placing: Execution | None = None
        lost = experimenter.attractor_out_of_reach()
        while placing is None:
            if resets >= MOST_RESETS:
                raise BadInputError(
                    f"babbling: {resets} times in a row no wrist position put the attractor where "
                    "a tool might touch it; widen babbling.offset_x_max and offset_y_min to "
                    "offset_y_max, or lower sensor.position_noise"
                )
            if lost:
                experimenter.put_attractor_back()
                state.seen = None
                resets += 1
            state.seen = state.seen or sensor.observe()
            placing, blocked = _place_at_random(robot, state.seen, settings, rng)
            redraws += blocked
            lost = placing is None
        start = sensor.observe()
        call = exploratory[int(rng.integers(len(exploratory)))]
        execution = robot.execute(call, start)
        end = sensor.observe()
        state.step += 1
        state.seen = end
        truncated = execution.status is ExecutionStatus.TRUNCATED
        row = (
            Affordance(state.step, binding, call, start, end, truncated)
            if change_detected(start, end)
            else None
        )
        yield BabblingRecord(
            state.step, robot.clock, resets, redraws, placing, execution, start, end, row
        )


def _place_at_random(
    robot: Robot, seen: Observation, settings: BabblingSettings, rng: np.random.Generator
) -> tuple[Execution | None, int]:
    """Draw wrist offsets until one is in reach and the tool comes down clear of the attractor.

    Returns:
        The position wrist executed, None when all draws were in vain; and how many were blocked.
    """
    width = settings.offset_x_max
    low, high = settings.offset_y_min, settings.offset_y_max
    drawn = rng.random((settings.draws, 2))
    x = (2.0 * drawn[:, 0] - 1.0) * width
    y = low + drawn[:, 1] * (high - low)
    blocked = 0
    for i in np.flatnonzero(robot.reaches(seen.object_x - x, seen.object_y - y)):
        call = BehaviorCall.of(POSITION_WRIST, {"x": float(x[i]), "y": float(y[i])})
        placing = robot.execute(call, seen)
        if placing.status is ExecutionStatus.DONE:
            return placing, blocked
        blocked += 1
    return None, blocked
