"""The world as affcli's ports ask for it: robot, sensor, goal, experimenter, what opens them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from affcli.behaviors.moving import DIRECTIONS
from affcli.core.affordance import Affordance
from affcli.core.behavior import GRASP, POSITION_WRIST, BehaviorCall, Execution, ExecutionStatus
from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.observation import Observation
from affcli.core.specs import LearningSpec, TrialSpec, VerificationSpec
from affcli.core.task import Task
from affcli.errors import BadInputError, SimulationDivergedError
from kinder_hook import schemas
from kinder_hook.episode import Episode, Film
from kinder_hook.parts import COLOR, NAME, VERSION
from kinder_hook.shapes import IN, MIDDLE, ROOM, WALL, At, Block, placed, reached_upright

BUDGET = 3000
"""Steps of an episode: the largest of the budgets that KinDER's baselines have."""
LEARNING, VERIFICATION, PREDICTION = 0, 1, 2
"""First word of a random stream's key: what it is for."""
NO_EVALUATION = 1_000_000
"""Learning resets by seeds from here on: evaluation has those below."""
BLOCK_COLOR = (255.0, 165.0, 0.0)
BLOCK_X, BLOCK_Y, BLOCK_SIDE = (0.583, 2.917), (2.1, 2.95), (0.16, 0.4767)
"""Where blocks are put back, about as by KinDER's resets, and how large they are."""
IN_TOUCH_X, IN_TOUCH_Y = (0.3, 3.2), (1.9, 3.3)
"""A block outside lies where the hook does not get around it."""
OTHER_BLOCK = 0.15
"""While learning, so often the block is taken away for another: KinDER's are of all sizes."""
MOST_PLACES = 1000
STATUS = {
    schemas.Placing.DONE: ExecutionStatus.DONE,
    schemas.Placing.BLOCKED: ExecutionStatus.BLOCKED,
    schemas.Placing.OUT_OF_REACH: ExecutionStatus.OUT_OF_REACH,
}


def to_inches(x: float, y: float) -> Point:
    """Return a place of the room in affcli's frame: x from the middle, y from the lower wall."""
    return Point((x - MIDDLE) * IN, y * IN)


def start_of(obstacles: int, seed: int) -> Point:
    """Return where the block begins by a reset (in)."""
    at = Episode(obstacles, seed, 0).block.at
    return to_inches(at.x, at.y)


@dataclass(slots=True)
class HookRobot:
    """The robot; its clock counts the steps of the world, each a second."""

    episode: Episode
    testing: bool
    holding: BehaviorCall | None = None

    @property
    def clock(self) -> float:
        """Steps so far."""
        return float(self.episode.steps)

    @property
    def wrist(self) -> Pose:
        """The wrist, at an angle of 0: a behavior begins and ends with the hook upright."""
        at = self.episode.wrist
        return Pose(*to_inches(at.x, at.y))

    def execute(self, call: BehaviorCall, seen: Observation | None) -> Execution:
        """Run the motor schema of a call."""
        episode, start, begun = self.episode, self.wrist, self.clock
        status = ExecutionStatus.DONE
        if call.name == GRASP:
            if not schemas.take_hook(episode) and not self.testing:
                raise SimulationDivergedError(f"{NAME}: the hook could not be taken")
            self.holding = call
        elif call.name == POSITION_WRIST and seen is not None:
            x, y = seen.object_x - call["x"], seen.object_y - call["y"]
            status = STATUS[schemas.carry(episode, x / IN + MIDDLE, y / IN)]
        elif call.name in DIRECTIONS:
            x, y = DIRECTIONS[call.name]
            way = call["offset_distance"] / IN
            if not schemas.slide(episode, x * way, y * way):
                status = ExecutionStatus.TRUNCATED
        else:
            raise BadInputError(f"{NAME}: no motor schema for {call}; the paper's eight have one")
        return Execution(call, status, start, self.wrist, self.clock - begun)

    def reaches(
        self,
        x: NDArray[np.float64],
        y: NDArray[np.float64],
        angle: NDArray[np.float64] | float = 0.0,
    ) -> NDArray[np.bool_]:
        """Tell where the hand can hold the hook upright, whatever lies there."""
        return reached_upright(x / IN + MIDDLE, y / IN, self.episode.in_hand)

    slides = reaches


@dataclass(frozen=True, slots=True)
class HookSensor:
    """What KinDER lets see, as the twelve numbers of §5.2; while learning there is no goal."""

    episode: Episode
    goal: str | None

    def observe(self) -> Observation:
        """Return the observation vector."""
        block, wrist = self.episode.block.at, self.episode.wrist
        at, hand = to_inches(block.x, block.y), to_inches(wrist.x, wrist.y)
        offset = at.x - hand.x, at.y - hand.y, 0.0
        return Observation(*at, 0.0, *offset, *BLOCK_COLOR, *COLOR)

    def observe_goal(self) -> "WallGoal":
        """Return the wall."""
        if self.goal is None:
            raise LookupError("there is no goal while learning")
        return WallGoal(self.goal, self.episode)


@dataclass(frozen=True, slots=True)
class WallGoal:
    """The wall, as where the middle of the block as it lies now would touch it; a `Goal`.

    Distances are taken to one place of it, as those to the paper's goals are to their middle: to
    the place straight before the block.
    """

    name: str
    episode: Episode

    @property
    def height(self) -> float:
        """Where the middle of the block is when it touches the wall: y (in)."""
        return IN * (WALL + self.episode.block.below)

    @property
    def center(self) -> Point:
        """The place of the wall that is straight before the block."""
        at = self.episode.block.at
        return Point(to_inches(at.x, at.y).x, IN * MIDDLE)

    def reached(self, seen: Observation) -> bool:
        """Tell whether KinDER said that it is solved."""
        return self.episode.solved

    def squared_distance(
        self, at: Point, dx: NDArray[np.float64], dy: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return how far off it the places are, squared."""
        above = np.maximum(at.y + dy - self.height, 0.0)
        return (at.x + dx - self.center.x) ** 2 + above**2

    def outline(self) -> ConvexPolygon:
        """Return the strip in which the middle of a block is that touches the wall."""
        half = IN * ROOM / 2.0
        return ConvexPolygon.box(-half, IN * (2.0 * MIDDLE - WALL), half, self.height)


@dataclass(frozen=True, slots=True)
class HookExperimenter:
    """Puts blocks back while learning; while testing nobody touches anything."""

    robot: HookRobot
    rng: np.random.Generator
    testing: bool

    def attractor_out_of_reach(self) -> bool:
        """Tell whether the block lies where babbling cannot get at it; when testing, whether the
        steps are spent: whether a block can still be touched, nobody knows.
        """
        episode = self.robot.episode
        if self.testing:
            return episode.over
        if self.rng.random() < OTHER_BLOCK:
            return True
        at = episode.block.at
        near = IN_TOUCH_X[0] < at.x < IN_TOUCH_X[1] and IN_TOUCH_Y[0] < at.y < IN_TOUCH_Y[1]
        return episode.solved or not near

    def put_attractor_back(self) -> None:
        """Put a block of any size anywhere above the wall, clear of the hook."""
        episode, rng = self.robot.episode, self.rng
        hook = placed(episode.hook_size.outline(), episode.wrist)
        for _ in range(MOST_PLACES):
            at = At(rng.uniform(*BLOCK_X), rng.uniform(*BLOCK_Y), rng.uniform(-np.pi, np.pi))
            block = Block(at, rng.uniform(*BLOCK_SIDE))
            if hook.distance(block.outline) > 0.03:
                episode.put_block(block)
                return
        raise BadInputError(f"{NAME}: no place for a block clear of the hook")

    def put_attractor_for(self, row: Affordance) -> None:
        """Put a block where the wrist can stand to it as in the row's O^s."""
        for _ in range(MOST_PLACES):
            self.put_attractor_back()
            at = self.robot.episode.block.at
            place, offset = to_inches(at.x, at.y), row.start.wrist_to_object
            x, y = np.array([place.x - offset.x]), np.array([place.y - offset.y])
            if self.robot.reaches(x, y).all():
                return
        raise BadInputError(f"{NAME}: there is no place for row {row.step} within reach")


@dataclass(frozen=True, slots=True)
class HookSetting:
    """One robot in the room; a `Setting`."""

    robot: HookRobot
    sensor: HookSensor
    experimenter: HookExperimenter
    binding: BehaviorCall
    exploratory: tuple[BehaviorCall, ...]
    choices: np.random.Generator
    calibration: None = None

    def truth(self) -> None:
        """Tell nothing: what is seen is all that there is."""

    def scene(self) -> None:
        """Tell nothing."""

    def film(self, film: Any) -> bool:
        """Show no film of affcli's: `film.py` has KinDER's own pictures."""
        return False

    def snapshot(self) -> None:
        """Say that nothing can be gone on with: KinDER's states do not hold all of its physics."""

    def restore(self, snapshot: Mapping[str, Any]) -> None:
        """Refuse."""
        raise ValueError("this world cannot be gone on with")


class HookWorld:
    """KinDER's hook world; a `World`."""

    name = NAME
    version = VERSION
    unit = "in"
    exact_replay = False

    def __init__(self, settings: Any, task_sets: Mapping[str, Any]) -> None:
        self._workspace, self._task_sets = settings.workspace, task_sets

    def packages(self, sensor: str) -> tuple[str, ...]:
        """Return the packages that decide its numbers."""
        return ("kindergarden", "numpy", "pymunk", "shapely")

    def tasks(self, task_set: str) -> tuple[Task, ...]:
        """Return the tasks of a set; KeyError for the sets of other worlds."""
        if not task_set.startswith(NAME):
            raise KeyError(task_set)
        found: tuple[Task, ...] = self._task_sets[task_set](self._workspace)
        return found

    def learning(self, spec: LearningSpec, *, laid_out: bool = True) -> HookSetting:
        """Lay out a learning run: a reset, and blocks that are put back."""
        return self._learning(spec, LEARNING, spec.seed, spec.robot)

    def trial(
        self, spec: TrialSpec, learned: LearningSpec, film: Film | None = None
    ) -> HookSetting:
        """Lay out an episode: the goal names the variant, the start the seed of the reset."""
        obstacles, seed = int(spec.goal.removeprefix("o")), int(spec.start)
        episode = Episode(obstacles, seed, BUDGET, film=film)
        rng = np.random.default_rng((spec.seed, spec.robot, obstacles, seed))
        return _setting(learned, episode, rng, spec.goal)

    def verification(self, spec: VerificationSpec, learned: LearningSpec, uses: int) -> HookSetting:
        """Lay out a verification: as learning."""
        return self._learning(learned, VERIFICATION, spec.seed, spec.robot, uses)

    def prediction(self, spec: VerificationSpec, learned: LearningSpec) -> HookSetting:
        """Lay out fresh pushes: as learning."""
        return self._learning(learned, PREDICTION, spec.seed, spec.robot)

    def step_again(self, step: Any, film: Any) -> bool:
        """Do nothing again."""
        return False

    def lost_rows(self, learned: LearningSpec, left: Any, starts: Any) -> None:
        """Tell nothing: its hook does not break."""

    def _learning(self, learned: LearningSpec, *key: int) -> HookSetting:
        rng = np.random.default_rng(key)
        seed = NO_EVALUATION + int(rng.integers(NO_EVALUATION))
        episode = Episode(0, seed, None, puts_blocks=True)
        return _setting(learned, episode, rng)


def _setting(
    learned: LearningSpec, episode: Episode, rng: np.random.Generator, goal: str | None = None
) -> HookSetting:
    """Wire a robot in the room; BadInputError for a run of another hook, grasp or sensor."""
    testing = goal is not None
    if learned.sensor != "exact":
        raise BadInputError(f"{NAME} is seen as KinDER tells it; give --sensor exact")
    if learned.tool != NAME or dict(learned.binding.params).get("grasp_point") != 1.0:
        raise BadInputError(f"{NAME} has its own hook, taken 1 in above its end: --tool {NAME}")
    robot = HookRobot(episode, testing)
    calls = tuple(behavior.call for behavior in learned.repertoire)
    experimenter = HookExperimenter(robot, rng.spawn(1)[0], testing)
    return HookSetting(robot, HookSensor(episode, goal), experimenter, learned.binding, calls, rng)
