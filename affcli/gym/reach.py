"""``affcli/Reach-v0``: bring the attractor over a goal region (§7.1)."""

import math
from dataclasses import replace
from typing import Any

from affcli import registry
from affcli.core.geometry import Point
from affcli.core.specs import Counters, Protocol, TrialSpec
from affcli.core.task import Task
from affcli.errors import UsageError
from affcli.gym.table import DIVERGED, FARTHEST, Action, OutOfLimitsError, Seen, TableEnv, told_of
from affcli.lab.run_parts import tasks_of

DENSE = 0.1
"""Reward for each inch nearer to the goal, where it is dense."""


class Reach(TableEnv):
    """``affcli/Reach-v0``: bring the attractor over a goal region (§7.1).

    The reward is 1 over the goal, and ends the episode, as does an attractor out of reach. After 60
    steps it is truncated. Options of `reset`: ``goal`` and ``start`` by name, ``attractor`` and
    ``goal_at`` as ``[x, y]`` (in, table frame).

    Args:
        task: a set of tasks by name or file; each episode draws one of them.
        goal, start: only tasks with these.
        shape: the tool that is truly held, in the colour of `tool`, when that broke (§7.2).
        reward: ``sparse``; or ``dense``, with 0.1 for each inch nearer to the goal.
        given: as in `TableEnv`.
    """

    def __init__(
        self,
        *,
        task: str = "extension-of-reach",
        goal: str | None = None,
        start: str | None = None,
        shape: str | None = None,
        reward: str = "sparse",
        **given: Any,
    ) -> None:
        super().__init__(**given)
        if reward not in ("sparse", "dense"):
            raise UsageError(f"reward {reward!r}: give sparse or dense")
        self.observation_space = self._observations(goal=True)
        self._dense = reward == "dense"
        self._tasks = tasks_of(self._world, task, 0)
        self._goal_name, self._start_name = goal, start
        self._of(goal, start)
        tools = self._settings.workspace.tools
        self._held = self.learned.held if shape is None else registry.tool(shape, tools)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Seen, dict[str, Any]]:
        """Lay out a task."""
        super().reset(seed=seed)
        given = dict(options or {})
        task = self._chosen(given.copy())
        spec = TrialSpec(
            *(Protocol.EXTENSION_OF_REACH, self.learned.tool, self._held, task),
            *(self._drawn_seed(), 0, Counters.AS_LEARNED),
            registry.component("planners", registry.DEFAULTS["planner"]),
            *(self.learned.sensor, self.learned.world),
        )
        self._begin(self._world.trial(spec, self.learned))
        if given.get("attractor") is not None:
            self._require_within_reach(task.start)
        self._goal = self.setting.sensor.observe_goal()
        self._told = {"tool": self.learned.tool, "goal": task.goal.name, "start": task.start_name}
        return self._observed(), self._information(told_of(self.setting.robot), lost=False)

    def step(self, action: Action) -> tuple[Seen, float, bool, bool, dict[str, Any]]:
        """Do one step."""
        before = self._distance()
        _, told = self._do(action)
        diverged = told["status"] == DIVERGED
        lost = not diverged and bool(self.setting.experimenter.attractor_out_of_reach())
        solved = not diverged and self._solved()
        reward = float(solved) + (DENSE * (before - self._distance()) if self._dense else 0.0)
        told = self._information(told, lost=lost)
        return self._observed(), reward, solved or lost or diverged, False, told

    def _require_within_reach(self, attractor: Point) -> None:
        """Refuse a place of the attractor at which the episode would end: OutOfLimitsError."""
        if self.setting.experimenter.attractor_out_of_reach():
            table = self._settings.workspace.table
            raise OutOfLimitsError(
                f"reset: attractor [{attractor.x:g}, {attractor.y:g}] is out of reach of the "
                f"{self._held.name}; the table has x of {-table.half_width:g} to "
                f"{table.half_width:g} and y of {table.near:g} to {table.far:g} in"
            )

    def _information(self, told: dict[str, Any], *, lost: bool) -> dict[str, Any]:
        """Return what is told of a step beside its reward."""
        return {**self._told, **told, "is_success": self._solved(), "out_of_reach": lost}

    def _solved(self) -> bool:
        return self._goal is not None and bool(self._goal.reached(self.seen))

    def _distance(self) -> float:
        """Return how far the attractor is seen from the goal's centre (in)."""
        center = self.seen.object_position if self._goal is None else self._goal.center
        return math.dist(self.seen.object_position, center)

    def _of(self, goal: str | None, start: str | None) -> list[Task]:
        """Return the tasks of a goal and a start; UsageError when there are none."""
        found = [
            task
            for task in self._tasks
            if goal in (None, task.goal.name) and start in (None, task.start_name)
        ]
        if not found:
            goals = ", ".join(dict.fromkeys(task.goal.name for task in self._tasks))
            starts = ", ".join(dict.fromkeys(task.start_name for task in self._tasks))
            raise UsageError(
                f"no task with goal {goal} and start {start}; goals: {goals}; starts: {starts}"
            )
        return found

    def _chosen(self, options: dict[str, Any]) -> Task:
        """Return the task that the options of a reset ask for, else one that is drawn."""
        goal, start = (options.pop(key, None) for key in ("goal", "start"))
        places = {key: _place(options.pop(key, None), key) for key in ("attractor", "goal_at")}
        if options:
            known = "goal, start, attractor, goal_at"
            raise UsageError(f"reset: no option {', '.join(map(str, options))}; there are {known}")
        found = self._of(
            self._goal_name if goal is None else str(goal),
            self._start_name if start is None else str(start),
        )
        task = found[int(self.np_random.integers(len(found)))]
        if (at := places["attractor"]) is not None:
            task = replace(task, start_name="given", start=at)
        if (at := places["goal_at"]) is not None:
            task = replace(task, goal=replace(task.goal, center=at))
        return task


def _place(given: object, name: str) -> Point | None:
    """Return a place of the table (in); OutOfLimitsError for anything else."""
    if given is None:
        return None
    try:
        x, y = map(float, given)  # type: ignore[call-overload]
    except (TypeError, ValueError):
        x = y = math.nan
    if not (abs(x) <= FARTHEST and abs(y) <= FARTHEST):
        raise OutOfLimitsError(f"reset: {name} must be [x, y] in inches, each within {FARTHEST:g}")
    return Point(x, y)
