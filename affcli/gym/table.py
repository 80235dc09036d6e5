"""A robot at the table: each step a wrist position and a behavior; what environments share."""

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from affcli import registry
from affcli.behaviors.positioning import position_wrist
from affcli.config import settings_by_name, with_sensor
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall, ExecutionStatus
from affcli.core.choice import Situation
from affcli.core.geometry import Point
from affcli.core.goal import Goal
from affcli.core.observation import Observation, SensorKind
from affcli.core.ports import Robot, can_slide
from affcli.core.specs import LearningSpec
from affcli.core.task import GoalRegion
from affcli.core.trial import Attempt
from affcli.core.world import Setting
from affcli.errors import BadInputError, SimulationDivergedError, UsageError
from affcli.lab.drawing import require_figures
from affcli.lab.run_parts import RunParts, settings_of, world_of
from affcli.procedures.attempt import attempt
from affcli.procedures.babbling import made_row
from affcli.report import figures
from affcli.report.table_map import View, table_map

Seen = NDArray[np.float32]
"""o1 to o12 of the observation vector, then the wrist: x, y (in), angle (rad); for a task then the
goal: x, y, half its width (in)."""
Action = Any
"""What the action space says; or a row of an affordance table (`Affordance`), which is used."""

FARTHEST = 100.0
"""No number of an observation lies beyond (in); angles lie within a full turn."""
MAP_LETTERS = 60, 24
"""Columns and rows of the map that ``ansi`` gives."""
DIVERGED = "diverged"
"""The status of a step in which the simulation gave a number that is not finite: it ends all."""


class OutOfLimitsError(BadInputError, ValueError):
    """An action or an option of `reset` that cannot be; the message says the limits."""


class TableEnv(gymnasium.Env[Seen, Action]):
    """A robot at the table with a tool in its hand.

    Args:
        tool: a registered one, or a file.
        sensor: noisy, exact, camera, or one of a package.
        repertoire: the exploratory behaviors, by name or file.
        binding: how the tool is held; of several it begins with the first, and rows ask for theirs.
        world: where it takes place.
        settings: those that differ, as ``{"friction.tool_puck": 0.3}``.
        action: ``dict``: a behavior and an offset (in); ``box``: numbers of -1 to 1, the offset and
            for each behavior how much it is wanted, for learners that take nothing else.
        render_mode: ``rgb_array`` (extra ``figures``), or ``ansi``, a map in letters.

    Attributes:
        learned: the learning run whose robot, tool and settings these are.
        calls: the exploratory behaviors, in the order of their numbers.
        used: what came of the row that was used last, where a row was.

    Raises:
        UsageError, BadInputError: a part or a setting that is not there.
    """

    metadata = {"render_modes": ["rgb_array", "ansi"], "render_fps": 2}  # noqa: RUF012  # Gymnasium's

    def __init__(
        self,
        *,
        tool: str = "t-hook",
        sensor: SensorKind = "noisy",
        repertoire: Sequence[str] = ("paper",),
        binding: str | Sequence[str] = "grasp",
        world: str = "table",
        settings: Mapping[str, Any] | None = None,
        action: str = "dict",
        render_mode: str | None = None,
    ) -> None:
        if action not in ("dict", "box"):
            raise UsageError(f"action {action!r}: give dict or box")
        seen_through = str(registry.component("sensors", sensor))
        changed = with_sensor(settings_by_name(dict(settings or {}), "settings"), seen_through)
        parts = RunParts.chosen(changed, repertoire=list(repertoire), binding=binding, world=world)
        self.learned: LearningSpec = parts.spec(tool, 0, 0, 1.0)
        self.calls: tuple[BehaviorCall, ...] = tuple(one.call for one in parts.repertoire)
        self.render_mode = render_mode
        self.used: Attempt | None = None
        self._settings = settings_of(self.learned)
        self._world = world_of(self.learned)
        self._setting: Setting | None = None
        self._goal: Goal | None = None
        self._seen: Observation | None = None
        box = self._settings.babbling
        self._low = np.array([-box.offset_x_max, box.offset_y_min])
        self._high = np.array([box.offset_x_max, box.offset_y_max])
        low, high = self._low.astype(np.float32), self._high.astype(np.float32)
        many = len(self.calls)
        self.action_space: Any = (
            spaces.Dict({"behavior": spaces.Discrete(many), "offset": spaces.Box(low, high)})
            if action == "dict"
            else spaces.Box(-1.0, 1.0, (2 + many,), np.float32)
        )
        self.observation_space: Any = self._observations(goal=False)

    @property
    def setting(self) -> Setting:
        """The world as it was laid out by `reset`."""
        if self._setting is None:
            raise UsageError("reset the environment first")
        return self._setting

    @property
    def seen(self) -> Observation:
        """The latest observation."""
        if self._seen is None:
            raise UsageError("reset the environment first")
        return self._seen

    def situation(self, table: AffordanceTable) -> Situation:
        """Return where the robot stands, as a planner is told it, with a table of its own.

        Raises:
            UsageError: there is no goal.
        """
        if self._goal is None:
            raise UsageError("there is no goal: use affcli/Reach-v0, and reset it first")
        robot = self.setting.robot
        slides = robot.slides if can_slide(robot) else None
        stands = (robot.wrist, robot.reaches, robot.holding, slides)
        return Situation(table, self.seen, self._goal, *stands)

    def render(self) -> Any:
        """Return the table from above as a picture (rows, columns, 3), or as lines of letters."""
        scene = None if self._setting is None else self._setting.scene()
        if scene is None or self.render_mode is None:
            return None
        workspace = self._settings.workspace
        if self.render_mode == "ansi":
            view = View.of(workspace, *MAP_LETTERS)
            return str(table_map(scene, workspace, [], view, braille=False))
        require_figures()
        film = figures.film.Film(workspace, scene.goal)
        return film.picture(scene, (), self.learned.tool, "")

    def _observations(self, *, goal: bool) -> spaces.Box:
        """Return the space of observations."""
        reach = [FARTHEST] * 6
        low = [*(-far for far in reach), *[0.0] * 6, -FARTHEST, -FARTHEST, -math.tau]
        high = [*reach, *[255.0] * 6, FARTHEST, FARTHEST, math.tau]
        if goal:
            low, high = [*low, -FARTHEST, -FARTHEST, 0.0], [*high, FARTHEST, FARTHEST, FARTHEST]
        return spaces.Box(np.array(low, np.float32), np.array(high, np.float32))

    def _observed(self) -> Seen:
        """Return what is seen, as the space has it."""
        numbers: list[float] = [*self.seen, *self.setting.robot.wrist]
        if isinstance(self._goal, GoalRegion):
            numbers += [*self._goal.center, self._goal.half_width]
        space = self.observation_space
        return np.asarray(np.clip(np.array(numbers, np.float32), space.low, space.high))

    def _drawn_seed(self) -> int:
        """Return a seed of a run or a trial, drawn from the environment's own random stream."""
        return int(self.np_random.integers(2**63 - 1))

    def _begin(self, setting: Setting) -> None:
        """Take the tool, and look."""
        self._setting, self.used = setting, None
        setting.robot.execute(setting.binding, None)
        self._seen = setting.sensor.observe()

    def _do(self, action: Action) -> tuple[Affordance | None, dict[str, Any]]:
        """Do one step; return the row that it makes, and what is told of it.

        The information has the behavior, how it ended, and the robot's seconds since the reset.
        """
        robot, sensor = self.setting.robot, self.setting.sensor
        row, self.used, status = None, None, DIVERGED
        given = action if isinstance(action, Affordance) else None
        offset, call = self._asked(action)
        with suppress(SimulationDivergedError):
            if given is not None:
                self.used = attempt(robot, sensor, given, self.seen)
                done = self.used.execution or self.used.placing
                start, self._seen = self.used.start, self.used.end
            else:
                start, done = self.seen, robot.execute(position_wrist(offset), self.seen)
                if done.status is ExecutionStatus.DONE:
                    start = sensor.observe()
                    done = robot.execute(call, start)
                self._seen = sensor.observe()
            status = done.status.value
            if done.call == call:
                held = robot.holding or self.setting.binding
                row = made_row(1, held, done, start, self.seen)
        return row, told_of(robot, str(call), status)

    def _asked(self, action: Action) -> tuple[Point, BehaviorCall]:
        """Return which offset (in) and which behavior an action asks for."""
        if isinstance(action, Affordance):
            return action.start.wrist_to_object, action.exploratory
        if isinstance(self.action_space, spaces.Dict):
            x, y = map(float, action["offset"])
            if not (abs(x) <= FARTHEST and abs(y) <= FARTHEST):
                raise OutOfLimitsError(
                    f"step: offset must lie within {FARTHEST:g} in: {x:g}, {y:g}"
                )
            return Point(x, y), self.calls[within("behavior", action["behavior"], len(self.calls))]
        numbers = np.asarray(action, dtype=float)
        share = 0.5 * (np.clip(numbers[:2], -1.0, 1.0) + 1.0)
        x, y = (self._low + share * (self._high - self._low)).tolist()
        return Point(x, y), self.calls[int(np.argmax(numbers[2:]))]


def within(what: str, number: Any, many: int) -> int:
    """Return a number of 0 to many - 1 that an action gives; else OutOfLimitsError."""
    if not 0 <= int(number) < many:
        raise OutOfLimitsError(f"step: {what} {int(number)}: must lie in 0 to {many - 1}")
    return int(number)


def told_of(robot: Robot, behavior: str = "", status: str = "") -> dict[str, Any]:
    """Return what is told of every step, and of a reset without a behavior."""
    return {"behavior": behavior, "status": status, "robot_seconds": float(robot.clock)}
