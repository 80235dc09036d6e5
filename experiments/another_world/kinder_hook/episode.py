"""One episode of KinDER's hook world: observations by name, steps counted, and the servo."""

import warnings
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from affcli.errors import SimulationDivergedError
from kinder_hook.shapes import At, Block, HookSize, wrapped

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import kinder
    from kinder.envs.dynamic2d.base_env import PymunkNondeterminismWarning

    kinder.register_all_environments()
# At each state that is set; that such runs are not repeated to the bit, the world says.
warnings.filterwarnings("ignore", category=PymunkNondeterminismWarning)

INDEX = {
    "x": 0,
    "y": 1,
    "angle": 2,
    "arm": 17,
    "gap": 21,
    "hook_x": 24,
    "hook_y": 25,
    "hook_angle": 26,
    "held": 31,
    "hook_width": 36,
    "handle": 37,
    "bar": 38,
    "block_x": 40,
    "block_y": 41,
    "block_angle": 42,
    "side": 52,
}
"""Where in the observation each number stands (`observation_space.devectorize` names them)."""
BLOCK_SPEED, BLOCK_HEIGHT = slice(43, 46), 53
STEP_MOVE, STEP_TURN, STEP_ARM = 0.05, 0.065, 0.1
"""At most so much of each a step."""
PATIENCE = 4
"""After so many steps that brought it no nearer the servo gives up."""

Film = Callable[[NDArray[np.uint8]], None]


class Episode:
    """One reset of the world, and what is done in it.

    Args:
        obstacles: 0, 1 or 5: which variant.
        seed: of its reset.
        budget: steps after which it is over; None for none.
        puts_blocks: the state may be set: while learning, where an experimenter puts blocks back.
        film: shown the picture of every step.

    Attributes:
        steps: taken so far.
        solved: the block touched the wall: KinDER said terminated.
        seen: KinDER's latest observation.
        broken: how often its engine failed.
        grasped: where the hand saw the wrist when it took the hook; None before.
    """

    def __init__(
        self,
        obstacles: int,
        seed: int,
        budget: int | None,
        *,
        puts_blocks: bool = False,
        film: Film | None = None,
    ) -> None:
        self._env = kinder.make(
            f"kinder/DynPushPullHook2D-o{obstacles}-v0",
            allow_state_access=puts_blocks,
            render_mode="rgb_array",
        ).unwrapped
        self._low, self._high = self._env.action_space.low, self._env.action_space.high
        self._puts_blocks, self._film = puts_blocks, film
        self.budget = budget
        self.seen, _ = self._env.reset(seed=seed)
        self.steps, self.solved, self.broken = 0, False, 0
        self.grasped: At | None = None

    def __getitem__(self, name: str) -> float:
        """Return a number of the latest observation by its name."""
        return float(self.seen[INDEX[name]])

    @property
    def over(self) -> bool:
        """Nothing that is done counts any more; while blocks are put back it is never over."""
        spent = self.budget is not None and self.steps >= self.budget
        return not self._puts_blocks and (self.solved or spent)

    @property
    def base(self) -> At:
        """The robot's base."""
        return At(self["x"], self["y"], self["angle"])

    @property
    def hand(self) -> At:
        """The end of its arm."""
        return At(self["arm"], 0.0, 0.0).of(self.base)

    @property
    def hook(self) -> At:
        """The hook's corner."""
        return At(self["hook_x"], self["hook_y"], self["hook_angle"])

    @property
    def hook_size(self) -> HookSize:
        """How large the hook is."""
        return HookSize(self["hook_width"], self["handle"], self["bar"])

    @property
    def wrist(self) -> At:
        """The wrist, read off the hook and not off the hand: a held hook drifts in the hand."""
        return self.hook_size.wrist(self.hook)

    @property
    def in_hand(self) -> At:
        """The wrist as seen from the hand."""
        return self.wrist.seen_from(self.hand)

    @property
    def block(self) -> Block:
        """The block."""
        return Block(At(self["block_x"], self["block_y"], self["block_angle"]), self["side"])

    @property
    def held(self) -> bool:
        """The hook is in the hand."""
        return self["held"] > 0.5

    def act(
        self,
        dx: float = 0.0,
        dy: float = 0.0,
        turn: float = 0.0,
        arm: float = 0.0,
        gap: float = 0.0,
    ) -> None:
        """Take one step; none once the episode is over.

        Raises:
            SimulationDivergedError: the engine failed, in a testing trial.
        """
        if self.over:
            return
        before = self.seen
        action = np.clip(np.array([dx, dy, turn, arm, gap]), self._low, self._high)
        self.steps += 1
        try:
            self.seen, _, solved, _, _ = self._env.step(action)
        except AssertionError as error:  # a block that was squeezed out of the room
            self.broken += 1
            if not self._puts_blocks:
                raise SimulationDivergedError("KinDER's engine failed") from error
            self.seen, solved = before, False
            self.put_block(Block(At(1.75, 2.95, 0.0), self["side"]))
        self.solved = self.solved or bool(solved)
        if self._film is not None:
            self._film(self._env.render())

    def put_block(self, block: Block) -> None:
        """Put another block there, at rest, and the hook as it was taken: it drifts in the hand."""
        state = np.array(self.seen)
        state[[INDEX["block_x"], INDEX["block_y"], INDEX["block_angle"]]] = block.at
        state[[INDEX["side"], BLOCK_HEIGHT]] = block.side
        state[BLOCK_SPEED] = 0.0
        if self.held and self.grasped is not None:
            hook = self.hook_size.corner(self.grasped.of(self.hand))
            state[[INDEX["hook_x"], INDEX["hook_y"], INDEX["hook_angle"]]] = hook
        self._env.set_state(state)
        self.seen = self._env.get_state()
        self.solved = False

    def servo(
        self,
        x: float,
        y: float,
        angle: float,
        arm: float,
        *,
        near: float = 0.004,
        most: int | None = None,
    ) -> bool:
        """Bring base and arm somewhere along a straight line; False when they do not get there.

        Args:
            x, y, angle: of the base.
            arm: its length.
            near: so near is there.
            most: steps; as many as it should take, and a few, if not given.
        """
        far = (
            max(abs(x - self["x"]), abs(y - self["y"])) / STEP_MOVE,
            abs(wrapped(angle - self["angle"])) / STEP_TURN,
            abs(arm - self["arm"]) / STEP_ARM,
        )
        last, stuck = np.inf, 0
        for _ in range(most or int(max(far)) + 12):
            dx, dy, turn = x - self["x"], y - self["y"], wrapped(angle - self["angle"])
            longer = arm - self["arm"]
            if abs(dx) < near and abs(dy) < near and abs(turn) < 0.01 and abs(longer) < 0.01:
                return True
            # Both at the same share of the way, for the line to be straight.
            share = max(1.0, abs(dx) / STEP_MOVE, abs(dy) / STEP_MOVE)
            self.act(dx / share, dy / share, turn, longer)
            left = abs(dx) + abs(dy) + abs(turn) + abs(longer)
            stuck = stuck + 1 if left > last - 1e-4 else 0
            last = left
            if stuck >= PATIENCE or self.over:
                return False
        return False
