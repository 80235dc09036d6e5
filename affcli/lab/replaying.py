"""Doing again what the database holds, scene by scene, held against the record (§6, §7)."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from affcli import registry
from affcli.core.choice import Candidate, Choice, Situation
from affcli.core.goal import Goal
from affcli.core.observation import Observation
from affcli.core.ports import Planner
from affcli.core.records import LearningRunInfo
from affcli.core.replay import Considered, Difference, Replay, ReplayedBehavior, ReplayedStep
from affcli.core.scene import Scene
from affcli.core.specs import Counters
from affcli.core.trial import Outcome, TrialEnd, TrialStep, named_before
from affcli.core.world import Setting, World
from affcli.errors import UsageError
from affcli.lab.filming import FRAME_RATE, Reel
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import (
    require_learned,
    require_shape,
    require_world_version,
    settings_of,
    world_of,
)
from affcli.lab.transferring import borrowed_again
from affcli.lab.trials import WithEnd, run_trial
from affcli.store import Store

CLOSE = 5
"""Rows remembered of those that came closest to being chosen, the chosen one among them."""


class _Onlooker:
    """A planner that chooses as another does, notes what each choice was about, and cuts the film
    there.
    """

    def __init__(self, planner: Planner, ids: dict[int, int]) -> None:
        self.reel = Reel()
        self._planner = planner
        self._ids = ids
        self.seen: Observation | None = None
        self.goal: Goal | None = None
        self.considered: tuple[Considered, ...] = ()

    @property
    def angle_degrees(self) -> float:
        return self._planner.angle_degrees

    @property
    def threshold(self) -> float:
        return self._planner.threshold

    def candidates(self, situation: Situation) -> tuple[Candidate, ...]:
        """Return what the other says."""
        return self._planner.candidates(situation)

    def choose(self, situation: Situation) -> Choice:
        """Choose as the other does, and remember what came close."""
        self.reel.cut()
        self.seen, self.goal = situation.seen, situation.goal
        # First, as in the trial: where it fails there, it fails here alike.
        choice = self._planner.choose(situation)
        close = self.candidates(situation)[:CLOSE]
        rows = [situation.table.row(one.position) for one in close]
        self.considered = tuple(
            Considered(self._ids[row.step], row, one.expected_distance, one.repositioning)
            for row, one in zip(rows, close, strict=True)
        )
        return choice


def replay_trial(store: Store, trial_id: int) -> Replay:
    """Do a stored trial again, from its spec and the table it began with.

    A trial recorded as `no row left` that ends with `no plan found` now equals its record, and has
    the name that stands there: before schema revision 0010 there was no other.

    Args:
        store: open.
        trial_id: its number.

    Raises:
        UsageError: there is none of that number, or its world has no replays.
        BadInputError: it names a part that this affcli lacks or has in another version.
        DatabaseError: it, or the table it began with, holds what affcli does not write.
    """
    trial = store.trials.trial(trial_id)
    spec, learned = trial.spec, trial.learned
    require_world_version(spec.world)
    for tool in (learned.held, spec.held):
        require_shape(tool, f"trial {trial_id}: ")
    if spec.counters is Counters.STORED:
        table, ids = store.trials.table_before(trial_id)
    else:
        table, ids = store.learning.table(trial.run_id, as_learned=True)
    world = world_of(learned)
    _require_replays(world)
    lost = None
    if spec.shape != spec.tool:
        lost = world.lost_rows(learned, spec.held, store.learning.row_starts(trial.run_id))
    recorded = len(store.trials.steps(trial_id))
    setting = world.trial(spec, learned)
    onlooker = _Onlooker(registry.planner(spec.planner), ids)
    setting.film(onlooker.reel)
    running = WithEnd(run_trial(spec, learned, table, setting, onlooker))
    steps: list[ReplayedStep] = []
    again = iter(running)
    # An interrupted trial has no end: no more is done than was.
    wanted = again if trial.outcome is not None else islice(again, recorded)
    opening = _scene(setting)
    filmed = False
    for record, truth in wanted:
        judged = lost.lost(record.row) if lost is not None else None
        # Arms that are very quick leave no time for a frame.
        scenes = onlooker.reel.cut() or (_scene(setting),)
        opening, filmed = (opening if filmed else scenes[0]), True
        steps.append(_replayed(TrialStep(record, truth, judged), onlooker, scenes))
    end = None if trial.outcome is None else _by_its_record(running.end, trial.outcome)
    differences = store.trials.differences(trial_id, [one.step for one in steps], end, ids)
    return Replay(
        *(trial_id, trial.run_id, spec, settings_of(learned).workspace),
        *(opening, tuple(steps), end, differences),
    )


def _by_its_record(end: TrialEnd, recorded: Outcome) -> TrialEnd:
    """Return an end by the name that its record has for it, where that is from before."""
    return replace(end, outcome=recorded) if recorded == named_before(end.outcome) else end


def _require_replays(world: World) -> None:
    """Refuse to hold against its record what comes out otherwise each time."""
    if not world.exact_replay:
        raise UsageError(f"the world {world.name} has no replays: it gives no record twice")


def _scene(setting: Setting) -> Scene:
    """Return what is truly on the table; UsageError in a world that cannot tell."""
    scene = setting.scene()
    if scene is None:
        raise UsageError("a world that does not tell what is truly on its table has no replays")
    return scene


def _replayed(step: TrialStep, onlooker: _Onlooker, scenes: tuple[Scene, ...]) -> ReplayedStep:
    """Return a step with what was noted of it."""
    if onlooker.seen is None or onlooker.goal is None:
        raise LookupError("a step without a choice")
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
    """Do a stored learning run again, from its spec.

    Args:
        store: open.
        run: which.
        first: behaviors before this one are done, and held against the record, but not yielded.
        last: the last behavior to do; None for all that are stored.

    Yields:
        Each behavior from `first` on, as soon as it is done; before that, those of the earlier ones
        that differ from their record.

    Raises:
        UsageError, BadInputError, DatabaseError: as `replay_trial`.
    """
    require_learned(run)
    learning = LearningRun(run.spec)
    _require_replays(learning.world)
    setting, reel = learning.setting, Reel()
    if first == 1:
        setting.film(reel)
    count = run.behaviors if last is None else min(last, run.behaviors)
    for record, truth in islice(learning.steps(), count):
        # The film of what goes before is not wanted, and takes longer than the doing.
        if record.step == first - 1:
            reel.skip_to(setting.robot.clock)
            setting.film(reel)
        differences = store.learning.differences(run.id, run.spec.tool, [(record, truth)])
        scenes = reel.cut() or (_scene(setting),)
        if record.step >= first or differences:
            yield ReplayedBehavior(record, truth, scenes, differences)


def replay_borrowing(
    store: Store, run: LearningRunInfo
) -> tuple[int | None, tuple[Difference, ...]]:
    """Borrow again what a stored run borrowed, from the lenders as the store has them.

    Returns:
        How many rows; None where that cannot be told, for a lender is not there any more. And where
        they differ from their record.

    Raises:
        UsageError: see `borrowed_again`.
    """
    again = borrowed_again(store, run)
    if again is None:
        return None, ()
    return len(again), store.transfers.differences(run.id, run.spec.tool, again)


def film_length(replay: Replay, numbers: Sequence[int], speed: float) -> int:
    """Return how many pictures `gif_of` draws of some steps of a trial."""
    frames = sum(len(replay.steps[number - 1].scenes) for number in numbers)
    return 1 + math.ceil((frames - 1) / _every(speed)) if frames else 0


def gif_of(
    replay: Replay,
    numbers: Sequence[int],
    speed: float,
    drawn: Callable[[int], object] = lambda _: None,
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
