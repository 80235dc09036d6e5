"""gym-pusht's round agent pushes its T: 5 in are 100 of its pixels, so 1 in is 20.

The world is gym-pusht's own: by that scale the T is 6 in long, its bars 1.5 in wide and the agent
1.5 in across. Its table has no friction but damps all speed away at once, so the T stops when it is
let go. The agent is put just before the middle of the crossbar and pushes the T along its stem, for
5 in at 5 in/s: nothing turns, nothing slips off.

With --space: the physics alone. Its Space, in its steps of 10 ms, the agent given the speed it is
to have. Without: the environment as it is used, `step` with the place to go to ten times a second;
it moves the agent by a controller, ten physics steps each, and works out observation and reward.
"""

import os
import sys
from typing import Any

os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"  # it would write into the answers

import numpy as np
import pymunk
from gym_pusht.envs import pusht
from serve import Move, Push, PushAll, serve, travels

PIXELS = 20.0
STEP = 0.01
CONTROL = 0.1
SETTLE = 5
"""Control steps after the last place was given: the controller lags by 0.2 s."""
AGENT, TEE = 15.0, 30.0
"""Radius of the agent, width of the bars (pixels)."""


def begin(table: dict[str, Any]) -> PushAll:
    """Make the environment."""
    environment = pusht.PushTEnv(obs_type="state")
    environment.reset(seed=0)
    gap = 0.02 * PIXELS
    away = np.array([0.0, 1.0])
    block = np.array([256.0, 150.0])

    def lay_out() -> Move:
        """Put the T, and the agent just before its crossbar."""
        agent = block - (AGENT + gap) * away
        # The public way, `reset`, would make a new Space each time.
        environment.agent.velocity = (0.0, 0.0)
        environment.block.velocity = (0.0, 0.0)
        environment.block.angular_velocity = 0.0
        environment._set_state([*agent, *block, 0.0])  # noqa: SLF001
        return float(agent[0]), float(agent[1])

    places = [PIXELS * travel for travel in travels(table, CONTROL)]
    targets = [*places, *([places[-1]] * SETTLE)]

    def by_control(_push: Push) -> Move:
        """Do one push as a user of the environment does."""
        start = np.array(lay_out())
        before = environment.block.position
        for gone in targets:
            environment.step(start + gone * away)
        moved = environment.block.position - before
        return moved.x / PIXELS, moved.y / PIXELS

    gone = [PIXELS * travel for travel in travels(table, STEP)]
    speeds = [(b - a) / STEP for a, b in zip([0.0, *gone], gone, strict=False)]
    velocities = [pymunk.Vec2d(0.0, speed) for speed in speeds]

    def by_space(_push: Push) -> Move:
        """Do one push with the physics alone."""
        lay_out()
        agent, step = environment.agent, environment.space.step
        before = environment.block.position
        for velocity in velocities:
            agent.velocity = velocity
            step(STEP)
        moved = environment.block.position - before
        return moved.x / PIXELS, moved.y / PIXELS

    one = by_space if "--space" in sys.argv else by_control
    return lambda pushes: [one(push) for push in pushes]


if __name__ == "__main__":
    serve(f"gym-pusht 0.1.8 on pymunk {pymunk.version}", STEP, begin)
