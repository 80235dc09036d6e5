"""The rows of a learned table as actions."""

import math
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from affcli.core.affordance_table import COLOR_TOLERANCE, AffordanceTable
from affcli.errors import UsageError
from affcli.gym.reach import Reach
from affcli.gym.table import Action, Seen, within
from affcli.planning.nested_query import NestedQuery
from affcli.store import open_store


class RowActions(gymnasium.Wrapper[Seen, Any, Seen, Action]):
    """The rows of a learned table as the actions of `Reach`: what a planner chooses from.

    Using a row counts in the table as in a trial (§3.2): at a probability of 1/2 it is out of
    consideration. ``info["action_mask"]`` tells which rows can be used now; one that cannot be is
    tried in vain. Each episode begins with the table as it was learned.

    Args:
        env: a `Reach`, maybe wrapped.
        table: what the robot learned with the same tool and behaviors.

    Attributes:
        table: with its counters as they are now.
    """

    def __init__(self, env: gymnasium.Env[Seen, Action], table: AffordanceTable) -> None:
        super().__init__(env)
        if not isinstance(env.unwrapped, Reach):
            raise UsageError("RowActions is for affcli/Reach-v0")
        if not len(table):
            raise UsageError("a blank table has no actions; learn for longer")
        learned = env.unwrapped.learned
        apart = (math.dist(row.start.colors[3:], learned.held.color) for row in table)
        if all(distance > COLOR_TOLERANCE for distance in apart):
            raise UsageError(
                f"no row of the table has the colour of the {learned.tool}: it was learned with "
                "another tool; make the environment with that one"
            )
        lacking = {row.exploratory for row in table} - set(env.unwrapped.calls)
        if lacking:
            raise UsageError(
                f"the table has {next(iter(lacking))}, which is not in the environment's "
                "repertoire; give it the run's"
            )
        other = {row.binding for row in table} - set(learned.bindings)
        if other:
            raise UsageError(
                f"the table has rows held by {next(iter(other))}, which the environment does not "
                "know; give it the run's bindings"
            )
        self._reach = env.unwrapped
        self._learned = table
        self.table = table.as_learned()
        self.action_space = spaces.Discrete(len(table))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Seen, dict[str, Any]]:
        """Lay out a task, with the table as it was learned."""
        self.table = self._learned.as_learned()
        seen, told = self.env.reset(seed=seed, options=options)
        return seen, {**told, "action_mask": self._mask()}

    def step(self, action: Any) -> tuple[Seen, Any, bool, bool, dict[str, Any]]:
        """Use a row, and count the use."""
        position = within("row", action, len(self.table))
        seen, reward, ended, cut, told = self.env.step(self.table.row(position))
        if self._reach.used is not None:
            self.table.count_use(position, success=self._reach.used.replicated)
        return seen, reward, ended, cut, {**told, "action_mask": self._mask()}

    def _mask(self) -> NDArray[np.int8]:
        """Return for each row whether it can be used now (n,)."""
        usable = NestedQuery(share=1.0).candidates(self._reach.situation(self.table))
        mask = np.zeros(len(self.table), np.int8)
        mask[[one.position for one in usable]] = 1
        return mask


def learned_table(database: str | Path, run: int | None = None) -> AffordanceTable:
    """Return the affordance table of a learning run, as it was learned.

    Args:
        database: the SQLite file.
        run: its number; None for the latest finished one.

    Raises:
        UsageError: there is no such run, or it is not done.
        DatabaseError: the file cannot be read.
    """
    with open_store(Path(database), create=False, write=False) as store:
        done = [one.id for one in store.learning.runs() if one.status == "done"]
        chosen = max(done, default=None) if run is None else run
        if chosen not in done or chosen is None:
            raise UsageError(f"{database}: no finished learning run {'' if run is None else run}")
        return store.learning.table(chosen, as_learned=True)[0]
