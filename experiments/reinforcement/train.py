"""Solve the 16 tasks of the T-hook by reinforcement and by the table, and count what both tried.

.venv/reinforcement/bin/python experiments/reinforcement/train.py box --seed 0

Adds what it finds to results.jsonl: for each learner, seed and number of environment steps how many
of the 16 tasks were solved. What is there already is not done again.
"""

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import torch
from gymnasium import spaces
from gymnasium.wrappers import TransformObservation
from sb3_contrib import MaskablePPO
from stable_baselines3 import PPO
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.callbacks import BaseCallback

from affcli import Laboratory
from affcli.gym import RowActions, learned_table

RESULTS = Path(__file__).parent / "results.jsonl"
TOOL = "t-hook"
GOALS = STARTS = ("1", "2", "3", "4")
TABLE_STEPS = (25, 50, 100, 200, 400, 800)
"""Behaviors of babbling that tables are made of."""
ROWS_OF = 400
"""Behaviors behind the table whose rows are actions."""
EVERY, ROLLOUT = 2048, 512
"""Steps between two looks; steps between two updates of a policy."""
MIDDLE = (0.0, 22.0, 0.0, 0.0, 12.0, 0.0, *[0.0] * 6, 0.0, 10.0, 0.0, 0.0, 22.0, 0.0)
SCALE = (8.0, 8.0, 1.0, 8.0, 8.0, 1.0, *[255.0] * 6, 8.0, 8.0, 1.0, 8.0, 8.0, 2.0)
"""What is subtracted from an observation, and by what the rest is divided: networks like numbers
about 1, and the limits of the space are far beyond the table."""
TESTED = 10_000_000
"""Seeds of testing episodes begin here."""
PLANNERS = ("nested-query", "lookahead")
LEARNERS = ("box", "rows")


class Masked(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Keeps what `RowActions` tells of the rows that can be used, where MaskablePPO asks for it."""

    def reset(self, **given: Any) -> tuple[Any, dict[str, Any]]:
        """Begin an episode."""
        seen, told = self.env.reset(**given)
        self._mask = told["action_mask"]
        return seen, told

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Use a row."""
        answer = self.env.step(action)
        self._mask = answer[4]["action_mask"]
        return answer

    def action_masks(self) -> Any:
        """Return which rows can be used; all when none can: one is tried in vain then."""
        mask = self._mask.astype(bool)
        return mask if mask.any() else np.ones_like(mask)


def environment(table: Any = None) -> gymnasium.Env[Any, Any]:
    """Return the environment; with a table, that of its rows."""
    given = {} if table else {"action": "box"}
    env = gymnasium.make(
        "affcli.gym:affcli/Reach-v0", tool=TOOL, reward="dense", sensor="noisy", **given
    )
    env = RowActions(env, table) if table else env
    middle, scale = np.array(MIDDLE, np.float32), np.array(SCALE, np.float32)
    near = spaces.Box(-np.inf, np.inf, middle.shape, np.float32)
    scaled = TransformObservation(env, lambda seen: (seen - middle) / scale, near)
    return Masked(scaled) if table else scaled


def solved(model: BaseAlgorithm, env: gymnasium.Env[Any, Any]) -> int:
    """Return how many of the 16 tasks a policy solves, always by what it holds for best."""
    count = 0
    for number, (goal, start) in enumerate((g, s) for g in GOALS for s in STARTS):
        options = {"goal": goal, "start": start}
        seen, told = env.reset(seed=TESTED + number, options=options)
        ended = cut = False
        while not (ended or cut):
            masks = {"action_masks": env.action_masks()} if isinstance(env, Masked) else {}
            action, _ = model.predict(seen, deterministic=True, **masks)
            seen, _, ended, cut, told = env.step(action)
        count += bool(told["is_success"])
    return count


class Look(BaseCallback):
    """Tests the policy now and then."""

    def __init__(self, learner: str, seed: int, env: gymnasium.Env[Any, Any], before: int) -> None:
        super().__init__()
        self._about, self._env, self._before = (learner, seed), env, before

    def _on_rollout_start(self) -> None:
        if self.num_timesteps % EVERY == 0:
            self.look()

    def _on_step(self) -> bool:
        return True

    def look(self) -> None:
        """Test it now."""
        steps = self._before + self.num_timesteps
        save(*self._about, steps, solved(self.model, self._env))


def save(learner: str, seed: int, steps: int, count: int) -> None:
    """Add a line to the results."""
    line = json.dumps({"learner": learner, "seed": seed, "steps": steps, "solved": count})
    with RESULTS.open("a") as file:
        file.write(line + "\n")
    print(line, flush=True)


def train(learner: str, seed: int, steps: int, folder: Path) -> None:
    """Train a policy for so many steps of the environment."""
    torch.set_num_threads(1)
    about = {"seed": seed, "n_steps": ROLLOUT, "device": "cpu", "ent_coef": 0.01}
    if learner == "box":
        before, table, kind = 0, None, PPO
    else:
        database = folder / "rows.db"
        Laboratory(database).learn(TOOL, behaviors=ROWS_OF, seed=seed)
        before, table, kind = ROWS_OF, learned_table(database), MaskablePPO
    model = kind("MlpPolicy", environment(table), **about)
    look = Look(learner, seed, environment(table), before)
    model.learn(steps, callback=look)
    look.look()


def plan(planner: str, seed: int, folder: Path) -> None:
    """Solve the tasks by tables of more and more behaviors."""
    for behaviors in TABLE_STEPS:
        lab = Laboratory(folder / f"{behaviors}.db")
        lab.learn(TOOL, behaviors=behaviors, seed=seed)
        trials = [lab.solve(goal, tool=TOOL, planner=planner, seed=seed) for goal in GOALS]
        save(planner, seed, behaviors, sum(one.solved for goal in trials for one in goal))


def main() -> None:
    """Do what was not done before."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("learner", choices=(*LEARNERS, *PLANNERS))
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--steps", type=int, default=10 * EVERY)
    asked = parser.parse_args()
    about = (asked.learner, asked.seed)
    lines = RESULTS.read_text().splitlines() if RESULTS.exists() else []
    if about in {(one["learner"], one["seed"]) for one in map(json.loads, lines)}:
        print(f"{asked.learner}, seed {asked.seed}: done already, in {RESULTS.name}")
        return
    with tempfile.TemporaryDirectory() as folder:
        if asked.learner in PLANNERS:
            plan(asked.learner, asked.seed, Path(folder))
        else:
            train(asked.learner, asked.seed, asked.steps, Path(folder))


if __name__ == "__main__":
    main()
