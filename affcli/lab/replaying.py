"""Doing again what the database holds, scene by scene, held against the record (§6, §7)."""

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from affcli.config import settings_from_json
from affcli.core.affordance_table import AffordanceTable
from affcli.core.observation import Observation
from affcli.core.ports import Robot
from affcli.core.replay import Considered, Replay, ReplayedBehavior, ReplayedStep
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.tool import TOOL_PARTS
from affcli.core.trial import Counters, TrialStep
from affcli.lab.filming import FRAME_RATE, Reel
from affcli.lab.learning_run import LearningRun
from affcli.lab.plausible import check_rows, check_starts, check_trial, not_written
from affcli.lab.trials import Ended, LostAffordances, run_trial
from affcli.planning.nested_query import Choice, candidates, choose_row
from affcli.simulation.world import World
from affcli.store import LearningRunInfo, Store

CLOSE = 5
"""Rows remembered of those that search 4 chose from, the chosen one among them."""


class _Onlooker:
    """Notes what each query was about, and cuts the film there."""

    def __init__(self, ids: dict[int, int]) -> None:
        self.reel = Reel()
        self._ids = ids
        self.seen: Observation | None = None
        self.goal: GoalRegion | None = None
        self.considered: tuple[Considered, ...] = ()

    def choose(
        self, table: AffordanceTable, seen: Observation, goal: GoalRegion, robot: Robot
    ) -> Choice:
        """Choose as the robot does, and remember what came close."""
        self.reel.cut()
        self.seen, self.goal = seen, goal
        close = candidates(table, seen, goal, robot)[:CLOSE]
        rows = [table.row(one.position) for one in close]
        self.considered = tuple(
            Considered(self._ids[row.step], row, one.expected_distance, one.repositioning)
            for row, one in zip(rows, close, strict=True)
        )
        return choose_row(table, seen, goal, robot)


def replay_trial(store: Store, trial_id: int) -> Replay:
    """Do a stored trial again, from its settings, its seed and the table it began with.

    Args:
        store: open.
        trial_id: its number.

    Raises:
        UsageError: there is none of that number.
        DatabaseError: it, or the table it began with, holds what affcli does not write.
    """
    trial = store.trial(trial_id)
    settings = settings_from_json(trial.settings)
    spec = trial.spec
    check_trial(trial_id, spec)
    if spec.counters is Counters.STORED:
        table, ids = store.table_before(trial_id)
    else:
        table, ids = store.affordance_table(trial.run_id, as_learned=True)
    check_rows(trial.run_id, settings, table)
    lost = None
    if spec.shape != spec.tool:
        starts = store.row_starts(trial.run_id)
        check_starts(trial.run_id, starts, table)
        lost = LostAffordances(settings, spec.shape, starts)
    recorded = len(store.trial_steps(trial_id))
    world = World(settings.workspace, settings.physics)
    onlooker = _Onlooker(ids)
    running = Ended(run_trial(spec, settings, table, world, onlooker.reel, onlooker.choose))
    steps: list[ReplayedStep] = []
    again = iter(running)
    # An interrupted trial has no end: no more is done than was.
    wanted = again if trial.outcome is not None else islice(again, recorded)
    opening: Scene | None = None
    for record, truth in wanted:
        judged = lost.lost(record.row) if lost is not None else None
        # Arms that are very quick leave no time for a frame.
        scenes = onlooker.reel.cut() or (world.scene,)
        opening = opening or scenes[0]
        steps.append(_replayed(TrialStep(record, truth, judged), onlooker, scenes))
    end = running.end if trial.outcome is not None else None
    differences = store.trial_differences(trial_id, [one.step for one in steps], end, ids)
    return Replay(
        *(trial_id, trial.run_id, spec, settings.workspace),
        *(opening or world.scene, tuple(steps), end, differences),
    )


def _replayed(step: TrialStep, onlooker: _Onlooker, scenes: tuple[Scene, ...]) -> ReplayedStep:
    """Return a step with what was noted of it."""
    if onlooker.seen is None or onlooker.goal is None:
        raise LookupError("a step without a query")
    execution = step.record.execution
    pushing = 0 if execution is None else round(execution.duration * FRAME_RATE)
    return ReplayedStep(
        step,
        onlooker.seen,
        onlooker.goal,
        onlooker.considered,
        scenes,
        max(0, len(scenes) - pushing),
    )


def replay_run(
    store: Store, run: LearningRunInfo, first: int = 1, last: int | None = None
) -> Iterator[ReplayedBehavior]:
    """Do a stored learning run again, from its settings and seed.

    Args:
        store: open.
        run: which.
        first: behaviors before this one are done, and held against the record, but not yielded.
        last: the last behavior to do; None for all that are stored.

    Yields:
        Each behavior from `first` on, as soon as it is done; before that, those of the earlier ones
        that differ from their record.

    Raises:
        DatabaseError: it holds a value that affcli does not know.
    """
    spec = run.spec
    if spec.tool not in TOOL_PARTS or min(spec.seed, spec.robot, run.behaviors) < 0:
        raise not_written(f"learning run {run.id}")
    learning = LearningRun(run.spec)
    reel = Reel()
    if first == 1:
        learning.bench.robot.film = reel
    count = run.behaviors if last is None else min(last, run.behaviors)
    for record, truth in islice(learning.steps(), count):
        # The film of what goes before is not wanted, and takes longer than the doing.
        if record.step == first - 1:
            reel.skip_to(learning.bench.robot.clock)
            learning.bench.robot.film = reel
        differences = store.behavior_differences(run.id, run.spec.tool, [(record, truth)])
        scenes = reel.cut() or (learning.bench.world.scene,)
        if record.step >= first or differences:
            yield ReplayedBehavior(record, truth, scenes, differences)


def film_length(replay: Replay, numbers: Sequence[int], speed: float) -> int:
    """Return how many pictures `gif_of` draws of some steps of a trial."""
    frames = sum(len(replay.steps[number - 1].scenes) for number in numbers)
    return 1 + math.ceil((frames - 1) / _every(speed)) if frames else 0


def gif_of(
    replay: Replay,
    numbers: Sequence[int],
    speed: float,
    drawn: Callable[[int], None] = lambda _: None,
) -> bytes:
    """Return some steps of a trial as a GIF.

    Args:
        replay: the trial.
        numbers: of the steps, counting from 1.
        speed: of the film, 1 for that of the robot. Frames are left out rather than shown faster
            than a viewer can.
        drawn: told how many pictures have been drawn, each time one more is.
    """
    from affcli.perception.animation import gif
    from affcli.report.figures.film import colors_of, pictures_of

    every = _every(speed)

    def pictures() -> Iterator[NDArray[np.uint8]]:
        """Yield the pictures, and say so."""
        for number, picture in enumerate(pictures_of(replay, numbers, every), 1):
            drawn(number)
            yield picture

    return gif(pictures(), 1e3 * every / FRAME_RATE / speed, colors_of(replay))


def _every(speed: float) -> int:
    """Return which share of the frames is in a film: each one, each second, and so on."""
    return max(1, round(speed))
